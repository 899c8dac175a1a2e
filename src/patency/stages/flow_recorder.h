// SPDX-License-Identifier: Apache-2.0
// Records a flow while it goes on: waveforms at openings, probes, profiles.
// Rows go to whoever takes them; knows no files.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "patency/stages/flow_means.h"

namespace patency {

/// A table of numbers that grows: the columns carry their units.
struct RecordedTable {
    std::string name;   ///< waveforms, probes, profile_NAME
    std::vector<std::string> columns;
};

class FlowRecorder {
public:
    /// Throws DeckError if a probe or a whole profile lies outside the blood.
    explicit FlowRecorder(const Scene& scene);

    const std::vector<RecordedTable>& tables() const { return tables_; }
    /// Takes a row of the table of that index.
    std::function<void(std::size_t table, std::span<const double>)> write_row;

    /// Times that steps must end at: profiles [s].
    const std::vector<double>& exact_times() const { return exact_times_; }
    /// To be called once, before the first step of a run that is not resumed: profiles of that time.
    void begin(const Scene& scene);
    /// The largest time that a row of a table may stand at after what the state knows; `now`: the state's time [s].
    double last_row_of(std::size_t table, double now) const;
    /// To be called after every step; is_end: there is no other.
    void observe(const Scene& scene, bool is_end);

    /// The state, for checkpoints: rows written, the mark of the last.
    struct State {
        double last_row = 0;
        FlowMark row_mark;
    };
    State state() const { return {last_row_, row_mark_}; }
    void restore(const State& state);

private:
    void write_waveforms(const Scene& scene);
    void write_probes(const Scene& scene);
    void write_profile(const Scene& scene, std::size_t profile);

    std::vector<RecordedTable> tables_;
    std::size_t first_profile_ = 0;
    double row_interval_ = 0, last_row_ = 0;
    std::vector<double> exact_times_;
    FlowMark row_mark_;
};

}   // namespace patency

// SPDX-License-Identifier: Apache-2.0
// Records a flow while it goes on: waveforms at openings, probes, profiles, and the mark from which means are taken.
// Rows go to whoever takes them; knows no files.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "patency/stages/flow_means.h"

namespace patency {

/// A table of numbers that grows: the columns carry their units.
struct RecordedTable {
    std::string name;                    ///< waveforms, probes, profile_NAME
    std::vector<std::string> columns;
};

class FlowRecorder {
public:
    /// Throws DeckError if a probe or a whole profile lies outside the blood.
    explicit FlowRecorder(const Scene& scene);

    const std::vector<RecordedTable>& tables() const { return tables_; }
    /// Takes a row of the table of that index.
    std::function<void(std::size_t table, std::span<const double>)> write_row;

    /// Times that steps must end at: profiles, and where the means begin [s].
    const std::vector<double>& exact_times() const { return exact_times_; }
    /// To be called after every step.
    void observe(const Scene& scene);
    /// Where the means begin; the last state while that is still ahead.
    FlowMark window(const Scene& scene) const { return window_ ? *window_ : mark_flow(scene); }

    /// The state, for checkpoints: rows written, the marks.
    struct State {
        double last_row = 0;
        FlowMark row_mark;
        std::optional<FlowMark> window;
    };
    State state() const { return {last_row_, row_mark_, window_}; }
    void restore(const State& state);

private:
    void write_waveforms(const Scene& scene);
    void write_probes(const Scene& scene);
    void write_profile(const Scene& scene, std::size_t profile);

    std::vector<RecordedTable> tables_;
    std::size_t first_profile_ = 0;
    double row_interval_ = 0, last_row_ = 0, window_start_ = 0;
    std::vector<double> exact_times_;
    FlowMark row_mark_;
    std::optional<FlowMark> window_;
};

}  // namespace patency

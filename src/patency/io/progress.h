// SPDX-License-Identifier: Apache-2.0
// Tells a person how far a stage is: one line that renews itself on a terminal, a line now and then in
// a file. Makes the text and chooses the moment; the app gives the place it goes to.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace patency {

/// How far a stage is.
struct ProgressState {
    std::string_view stage;   ///< "flow (before)"
    double fraction = 0;      ///< done, 0..1
    double time = 0;          ///< simulated [s]
    std::int64_t step = 0;
    std::optional<double> net_inflow{};   ///< inflow minus outflow [m^3/s; planar: m^2/s, per metre of depth]
};

/// "flow: 42 %  t 0.4200 s  step 12000  in-out +0.12 mL/min  left 1 min 20 s"; seconds_left of wall time.
std::string progress_text(const ProgressState& state, std::optional<double> seconds_left);

/// "45 s", "1 min 20 s", "2 h 05 min"
std::string duration_text(double seconds);

enum class ProgressStyle {
    terminal,   ///< begins with a carriage return and clears the rest of the line: it renews itself
    lines,      ///< whole lines, for files and pipes
};

struct ProgressOptions {
    ProgressStyle style = ProgressStyle::lines;
    double interval = 30;              ///< s of wall time between texts; 0.2 suits a terminal
    std::size_t width = 0;             ///< columns of the terminal; longer texts are cut; 0: never cut
    std::function<double()> clock{};   ///< s; empty: the machine's steady clock
};

class Progress {
public:
    /// Takes text as it is to be printed, control characters and line ends included.
    using Sink = std::function<void(std::string_view)>;

    /// An empty sink: nothing is said.
    explicit Progress(Sink sink = {}, ProgressOptions options = {});

    /// To be called in every step; it costs a look at the clock. Speaks at the first call of a stage and
    /// then once per interval. The time left counts from that first call, so that a resumed run is judged
    /// by its own speed.
    void update(const ProgressState& state);
    /// The stage is over: says the last state, ends the terminal's line.
    void finish(const ProgressState& state);

private:
    struct Mark {
        std::string stage;
        double fraction, clock;
    };
    void say(const ProgressState& state, double now);

    Sink sink_;
    ProgressOptions options_;
    std::optional<Mark> start_;   // of the present stage
    double next_ = 0;             // when to speak again
};

}   // namespace patency

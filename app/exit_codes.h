// SPDX-License-Identifier: Apache-2.0
// What the program's exit codes mean, for its help and its manual.
#pragma once

#include <span>
#include <string_view>

namespace patency::app {

struct ExitMeaning {
    std::string_view code, meaning;
};

inline std::span<const ExitMeaning> exit_meanings() {
    static constexpr ExitMeaning meanings[] = {
        {"0", "done"},
        {"2", "the command line is wrong"},
        {"3", "the deck is wrong"},
        {"4", "the geometry is wrong"},
        {"5", "the computation diverged"},
        {"6", "finished, but a bar or the convergence was missed"},
        {"7", "a file cannot be read or written"},
        {"8", "the folder holds a checkpoint or results of another deck, other inputs or another version"},
        {"130, 143", "interrupted; the next run goes on from a checkpoint, or begins a steady flow on cells anew"},
    };
    return meanings;
}

}   // namespace patency::app

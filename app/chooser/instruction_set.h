// SPDX-License-Identifier: Apache-2.0
// Which of a package's programs is run. They are one source compiled for several instruction sets, and differ in speed, not in
// results. What the processor bears is asked in main.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "patency/base/errors.h"

namespace patency::chooser {

/// From the narrowest to the widest, each with all of those before it: plain x86-64, x86-64-v3, x86-64-v4.
inline constexpr std::array<std::string_view, 3> instruction_sets = {"baseline", "avx2", "avx512"};

/// What a processor bears, and its operating system lets it: `bears_avx512` counts only beside `bears_avx2`.
struct Processor {
    bool bears_avx2 = false, bears_avx512 = false;
};

/// How many of instruction_sets.
inline std::size_t count_sets(const Processor& processor) {
    if (!processor.bears_avx2) return 1;
    return processor.bears_avx512 ? 3 : 2;
}

/// The name of the set to run: the widest, or the one that is wanted if that is not empty. Throws UsageError if there is no such set,
/// or not here.
inline std::string choose_set(const Processor& processor, std::string_view wanted) {
    const std::size_t here = count_sets(processor);
    if (wanted.empty()) return std::string(instruction_sets[here - 1]);
    std::string all;
    for (std::size_t k = 0; k < instruction_sets.size(); ++k) {
        if (wanted == instruction_sets[k]) {
            if (k < here) return std::string(wanted);
            throw UsageError("PATENCY_ISA asks for " + std::string(wanted) +
                             ", which this processor does not have; the widest here is " +
                             std::string(instruction_sets[here - 1]));
        }
        all += (k == 0 ? "" : k + 1 < instruction_sets.size() ? ", " : " or ") + std::string(instruction_sets[k]);
    }
    throw UsageError("PATENCY_ISA is '" + std::string(wanted) + "'; it may be " + all +
                     ", or unset for the widest that the processor has");
}

}   // namespace patency::chooser

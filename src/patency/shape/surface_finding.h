// SPDX-License-Identifier: Apache-2.0
// What was found wrong with a surface, where, and what became of it. Found and repaired in surface_repair.h and
// surface_check.h.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "patency/shape/surface.h"

namespace patency {

enum class Verdict {
    repaired,   ///< mended, and the surface goes on
    harmless,   ///< left as it is; nothing computed here minds
    refused,    ///< the user must mend it
};
std::string word_of(Verdict verdict);   ///< "repaired"

struct Finding {
    std::string kind;   ///< a plain name, "holes"; also names the file it is written to
    Verdict verdict;
    std::size_t count;
    Vec3 place;             ///< of the largest one [m]
    double size;            ///< extent of the largest one [m]
    std::string sentence;   ///< for the reader, with what to do about it
    Surface shown{};        ///< the triangles concerned, as they were read; or the points of the lines
    std::vector<std::vector<std::uint32_t>> lines{};   ///< indices of shown.points
};

}   // namespace patency

// SPDX-License-Identifier: Apache-2.0
// What is done with a file that may be damaged, and how it ends. Damages nothing and runs nothing itself: campaign.h and
// libFuzzer do.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace patency {

/// A result that breaks a law of its own, though nothing was thrown.
struct BrokenLaw : std::logic_error {
    using std::logic_error::logic_error;
};

/// What the program does with a file of that extension before it makes particles: a deck (.yaml) is read and checked, a
/// vessel is inspected. A surface's file is written to `path` first, for its readers open files. Throws Error for what
/// it refuses, BrokenLaw for a result that cannot be.
void use_file(const std::filesystem::path& path, const std::string& contents);

enum class Ending { accepted, usage, deck, geometry, file, found };   ///< found: what must never happen
inline constexpr int endings = 6;

/// use_file, with what it throws as an ending; a `sentence` unless it was accepted.
Ending end_of(const std::filesystem::path& path, const std::string& contents, std::string& sentence);

}   // namespace patency

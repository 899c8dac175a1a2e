// SPDX-License-Identifier: Apache-2.0
// Reading a deck into a Case and writing a Case back. All mistakes are reported at once; nothing is guessed.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "patency/config/case.h"
#include "patency/config/opening_names.h"

namespace patency::deck {

/// Settings like "numerics.spacing=0.2 mm" that go over what the file says; values are YAML, of which null takes the key away.
using Settings = std::vector<std::string>;

/// Read a deck. Paths in it become absolute, relative to the deck's folder. Throws FileError if the file
/// cannot be read; DeckError with every mistake as "file:line:column: key: sentence" otherwise.
Case read_case(const std::filesystem::path& path, const Settings& settings = {});

struct NamedCase {
    std::string name;
    Case resolved;
};
/// The deck's variants, each the deck with what its run sets (settings go over both), in the deck's order.
/// Without `runs` it is the deck alone, under the case's name. The deck itself may be incomplete if every run
/// completes it. Openings that the lumen does not have are mistakes too if it can be known which it has. Errors as read_case.
std::vector<NamedCase> read_runs(const std::filesystem::path& path, const Settings& settings = {},
                                 const FindOpeningNames& find_names = {});

/// The same from text; `source` stands for the file name in messages, relative paths are in `folder`.
Case parse_case(std::string_view text, const std::string& source = "deck", const std::filesystem::path& folder = {},
                const Settings& settings = {});
std::vector<NamedCase> parse_runs(std::string_view text, const std::string& source = "deck",
                                  const std::filesystem::path& folder = {}, const Settings& settings = {},
                                  const FindOpeningNames& find_names = {});

/// The whole case as a deck, defaults included, from which the identical case is read; paths are written
/// relative to `folder`.
std::string format_case(const Case& c, const std::filesystem::path& folder = {});
/// format_case into a file (case.resolved.yaml). Throws FileError.
void write_case(const Case& c, const std::filesystem::path& path);

}   // namespace patency::deck

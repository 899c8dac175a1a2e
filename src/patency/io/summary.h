// SPDX-License-Identifier: Apache-2.0
// Results as JSON files: summary.json, timing.json, a verification case's figures. Says how they are
// written, not what is in them.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

namespace patency {

/// Write a document: keys in the order of their insertion, two blanks per level, numbers that read back
/// as the same double; the same document gives the same bytes. A number that is not finite is refused
/// with DivergedError naming its key ("openings.inlet.flow_m3_per_s"): NaN never reaches a result file,
/// and what does not exist is null. Throws FileError.
void write_summary(const std::filesystem::path& path, const nlohmann::ordered_json& document);

/// Read a document back. Throws FileError when it cannot be read or is not JSON.
nlohmann::ordered_json read_summary(const std::filesystem::path& path);

}   // namespace patency

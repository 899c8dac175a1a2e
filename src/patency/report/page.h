// SPDX-License-Identifier: Apache-2.0
// report.html: the one page that says what a run found. It is one file that needs no other and no network.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "patency/report/results.h"

namespace patency {

/// The page as text; `version` of the program is named in it.
std::string make_page(const RunResults& results, std::string_view version);

/// Reads the results in a folder and writes OUT/report.html. Returns its path. Throws FileError.
std::filesystem::path write_report(const std::filesystem::path& folder, std::string_view version);

}   // namespace patency

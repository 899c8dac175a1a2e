// SPDX-License-Identifier: Apache-2.0
// The text files of a result folder: whole files that are either old or complete, and tables that grow row by row.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace patency {

/// Writes beside the file and renames. Throws FileError.
void write_text_file(const std::filesystem::path& path, const std::string& text);

/// A new table of numbers; each row is in the file when write_row returns, in the fewest digits that read back as the
/// same double. Throws FileError; DivergedError for a number that is not finite.
class TableFile {
public:
    TableFile(std::filesystem::path path, const std::vector<std::string>& columns);
    void write_row(std::span<const double> values);

private:
    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    std::filesystem::path path_;
    std::vector<std::string> columns_;
    std::unique_ptr<std::FILE, Close> file_;
};

/// Makes the folder for results, or takes one that holds results of this program (log.txt or case.resolved.yaml
/// says so) or nothing.
/// Throws FileError for any other.
void open_result_folder(const std::filesystem::path& folder);

}  // namespace patency

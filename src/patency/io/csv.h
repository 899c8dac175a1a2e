// SPDX-License-Identifier: Apache-2.0
// Tables of numbers as text: rows written while a run goes on, and tables that users bring (waveforms).
// No quoting, no text cells.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace patency {

/// Writes a table row by row; each row is in the file when write_row returns. Numbers have the fewest
/// digits that read back as the same double.
class CsvWriter {
public:
    /// A new file with its header; columns carry their unit: {"time_s", "flow_inlet_m3_per_s"}.
    /// Throws FileError.
    CsvWriter(const std::filesystem::path& path, const std::vector<std::string>& columns);

    /// Go on with the table of an interrupted run: keeps the rows whose first column is at most
    /// last_time and drops the rest, also a row that was cut off. A missing file begins anew; one with
    /// other columns is a FileError.
    static CsvWriter resumed(const std::filesystem::path& path, std::vector<std::string> columns, double last_time);

    /// One value per column. A value that is not finite is refused with DivergedError naming the column:
    /// NaN never reaches a result file.
    void write_row(std::span<const double> values);
    void write_row(std::initializer_list<double> values) { write_row(std::span(values.begin(), values.size())); }

    const std::filesystem::path& path() const { return path_; }

private:
    using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;
    CsvWriter(const std::filesystem::path& path, std::vector<std::string> columns, std::string_view beginning);

    std::filesystem::path path_;
    std::vector<std::string> columns_;
    File file_;
};

struct CsvTable {
    std::vector<std::string> names;
    std::vector<std::vector<double>> columns;   ///< columns[c][row], as many as names

    std::size_t row_count() const { return columns.empty() ? 0 : columns.front().size(); }
    /// The column of that name, or nullptr.
    const std::vector<double>* find(std::string_view name) const;
};

/// Read a table whose first line names its columns. Cells are separated by commas, semicolons or white
/// space, whichever the first line has; lines that are empty or begin with # are skipped. Throws
/// FileError when the file cannot be read and DeckError with file:line for anything that is not a table
/// of finite numbers with at least one row.
CsvTable read_csv(const std::filesystem::path& path);

}   // namespace patency

// SPDX-License-Identifier: Apache-2.0
#include "patency/io/csv.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <iterator>
#include <optional>

#include "patency/base/errors.h"
#include "patency/base/text.h"
#include "patency/io/atomic_file.h"

namespace patency {
namespace {

constexpr std::string_view blanks = " \t\r\v\f";

/// The next line without its end, taken off the text.
std::string_view take_line(std::string_view& text) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end == text.npos ? text.size() : end + 1);
    return line;
}

enum class Separator : char { comma = ',', semicolon = ';', blank = ' ' };

Separator separator_of(std::string_view line) {
    if (line.find(',') != line.npos) return Separator::comma;
    if (line.find(';') != line.npos) return Separator::semicolon;
    return Separator::blank;
}

std::vector<std::string_view> split(std::string_view line, Separator separator) {
    std::vector<std::string_view> cells;
    if (separator == Separator::blank) {
        for (line = trimmed(line); !line.empty(); line = trimmed(line)) {
            const std::size_t end = std::min(line.find_first_of(blanks), line.size());
            cells.push_back(line.substr(0, end));
            line.remove_prefix(end);
        }
        return cells;
    }
    for (;;) {
        const std::size_t end = line.find(char(separator));
        cells.push_back(trimmed(line.substr(0, end)));
        if (end == line.npos) return cells;
        line.remove_prefix(end + 1);
    }
}

std::optional<double> number(std::string_view cell) {
    if (cell.starts_with('+')) cell.remove_prefix(1);   // from_chars knows no plus sign
    double value = 0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error != std::errc{} || end != cell.data() + cell.size()) return std::nullopt;
    return value;
}

/// What a hostile file has in a cell, short enough and fit to be printed.
std::string shown(std::string_view cell) { return double_quoted(shortened(cell, 40)); }

std::string header_line(const std::vector<std::string>& columns) {
    return fmt::format("{}\n", fmt::join(columns, ","));
}

/// The lines of an earlier table up to last_time.
std::string kept_lines(const std::filesystem::path& path, const std::vector<std::string>& columns, double last_time) {
    const std::string contents = read_file(path);
    std::string kept = header_line(columns);
    if (!contents.starts_with(kept)) {
        if (kept.starts_with(contents)) return kept;   // cut off while the header was written
        throw FileError(fmt::format("cannot continue '{}': its columns are not those of this run ({}). Move it away.",
                                    path.string(), fmt::join(columns, ",")));
    }
    std::string_view rest = std::string_view(contents).substr(kept.size());
    while (rest.find('\n') != rest.npos) {   // a line without its end was cut off
        const std::string_view line = take_line(rest);
        const auto cells = split(line, Separator::comma);
        const auto time = number(cells.front());
        if (!time || cells.size() != columns.size())
            throw FileError(fmt::format("cannot continue '{}': {} is not one of its rows. Move it away.", path.string(),
                                        shown(line)));
        if (*time > last_time) break;
        kept.append(line) += '\n';
    }
    return kept;
}

}   // namespace

CsvWriter::CsvWriter(const std::filesystem::path& path, const std::vector<std::string>& columns)
    : CsvWriter(path, columns, header_line(columns)) {}

CsvWriter::CsvWriter(const std::filesystem::path& path, std::vector<std::string> columns, std::string_view beginning)
    : path_(path), columns_(std::move(columns)), file_(nullptr, &std::fclose) {
    write_file(path_, beginning);
    file_.reset(std::fopen(path_.c_str(), "abe"));
    if (!file_) throw FileError(file_error_sentence("write", path_, errno));
}

CsvWriter CsvWriter::resumed(const std::filesystem::path& path, std::vector<std::string> columns, double last_time) {
    if (!std::filesystem::exists(path)) return CsvWriter(path, columns);
    const std::string kept = kept_lines(path, columns, last_time);
    return CsvWriter(path, std::move(columns), kept);
}

void CsvWriter::write_row(std::span<const double> values) {
    assert(values.size() == columns_.size() && "a row has one value per column");
    for (std::size_t c = 0; c < values.size(); ++c)
        if (!std::isfinite(values[c]))
            throw DivergedError(
                fmt::format("{} of column {} would go into '{}' (first column {}): the computation has "
                            "left the realm of numbers.",
                            values[c], columns_[c], path_.string(), values[0]));
    const std::string row = fmt::format("{}\n", fmt::join(values, ","));
    if (std::fwrite(row.data(), 1, row.size(), file_.get()) != row.size() || std::fflush(file_.get()) != 0)
        throw FileError(file_error_sentence("write", path_, errno));
}

const std::vector<double>* CsvTable::find(std::string_view name) const {
    const auto at = std::find(names.begin(), names.end(), name);
    return at == names.end() ? nullptr : &columns[std::size_t(at - names.begin())];
}

CsvTable read_csv(const std::filesystem::path& path) {
    const std::string contents = read_file(path);
    std::string_view rest = contents;
    if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);   // byte order mark of spreadsheets

    CsvTable table;
    Separator separator{};
    for (int line_number = 1; !rest.empty(); ++line_number) {
        const std::string_view line = trimmed(take_line(rest));
        if (line.empty() || line.front() == '#') continue;
        const auto wrong = [&](const std::string& what) {
            return DeckError(fmt::format("{}:{}: {}", path.string(), line_number, what));
        };
        if (table.names.empty()) {
            separator = separator_of(line);
            for (std::string_view name : split(line, separator)) {
                if (name.empty() || number(name))
                    throw wrong(
                        fmt::format("{} stands where a column's name is expected; the first line names the "
                                    "columns, for example time_s,flow_m3_per_s.",
                                    shown(name)));
                if (table.find(name)) throw wrong(fmt::format("two columns are called {}.", shown(name)));
                table.names.emplace_back(name);
                table.columns.emplace_back();
            }
            continue;
        }
        const auto cells = split(line, separator);
        if (cells.size() != table.names.size())
            throw wrong(fmt::format("{} value{} where the first line names {} column{}.", cells.size(),
                                    cells.size() == 1 ? "" : "s", table.names.size(),
                                    table.names.size() == 1 ? "" : "s"));
        for (std::size_t c = 0; c < cells.size(); ++c) {
            const auto value = number(cells[c]);
            if (!value || !std::isfinite(*value))
                throw wrong(
                    fmt::format("{} in column {} is not a finite number.", shown(cells[c]), shown(table.names[c])));
            table.columns[c].push_back(*value);
        }
    }
    if (table.row_count() == 0)
        throw DeckError(fmt::format("{}: there are no rows; a table has a line of column names and at least one row.",
                                    path.string()));
    return table;
}

}   // namespace patency

// SPDX-License-Identifier: Apache-2.0
// Small helpers on text: trimming, joining, quoting, the nearest of some names.
// No formatting of quantities (units.h), no files.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace patency {

/// Without white space at both ends.
std::string_view trimmed(std::string_view text);

/// The parts between separators; an empty text has one empty part.
std::vector<std::string> split(std::string_view text, char separator);

/// "a, b or c" with comma ", " and last " or "; the last separator is the comma if last is empty.
std::string join(std::span<const std::string> parts, std::string_view comma, std::string_view last = {});

/// In double quotes, with quotes, backslashes and control characters escaped: valid in YAML and JSON.
std::string double_quoted(std::string_view text);

/// The text cut to `length` bytes, with "..." in place of the rest; never inside a UTF-8 character.
std::string shortened(std::string_view text, std::size_t length = 60);

/// Whether the bytes are UTF-8 without NUL.
bool is_utf8_text(std::string_view bytes);

/// Whether the text may name a file, a column or a key: letters, digits, _ and -, at most 64.
bool is_plain_name(std::string_view text);

/// Edits (insert, delete, replace, swap neighbours) that lead from a to b, upper and lower case alike.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The candidate a person probably meant: the fewest edits, at most a third of the longer word's length
/// (at least one). The empty string if none is so near.
std::string nearest_name(std::string_view word, std::span<const std::string> candidates);

}   // namespace patency

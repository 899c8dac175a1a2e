// SPDX-License-Identifier: Apache-2.0
#include "patency/config/sweep.h"

#include <fmt/format.h>

#include <set>

#include "patency/base/errors.h"
#include "patency/base/text.h"

namespace patency::deck {

namespace {

/// Parts between commas that stand in no brackets, braces or quotes.
std::vector<std::string> split_values(std::string_view text) {
    std::vector<std::string> values{""};
    int depth = 0;
    char quote = 0;
    for (const char c : text) {
        if (quote) {
            if (c == quote) quote = 0;
        } else if (c == '"' || c == '\'') {
            quote = c;
        } else if (c == '[' || c == '{') {
            ++depth;
        } else if (c == ']' || c == '}') {
            --depth;
        } else if (c == ',' && depth == 0) {
            values.emplace_back();
            continue;
        }
        values.back() += c;
    }
    for (std::string& value : values) value = trimmed(value);
    return values;
}

std::string_view last_part(std::string_view key) { return key.substr(key.rfind('.') + 1); }

/// Letters, digits and what no shell minds; a run of anything else is one _.
std::string file_word(std::string_view text) {
    std::string word;
    for (const char c : text.substr(0, 40)) {
        const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
                              c == '-' || c == '+';
        if (is_plain)
            word += c;
        else if (!word.empty() && word.back() != '_')
            word += '_';
    }
    while (!word.empty() && word.back() == '_') word.pop_back();
    return word;
}

/// The key's last part where no other axis has the same.
std::string short_key(const std::vector<SweepAxis>& axes, const SweepAxis& axis) {
    for (const SweepAxis& other : axes)
        if (&other != &axis && last_part(other.key) == last_part(axis.key)) return axis.key;
    return std::string(last_part(axis.key));
}

std::string name_of(const std::vector<SweepAxis>& axes, const std::vector<std::string>& values) {
    std::vector<std::string> parts;
    for (std::size_t a = 0; a < axes.size(); ++a)
        if (axes[a].values.size() > 1)
            parts.push_back(file_word(short_key(axes, axes[a])) + "=" + file_word(values[a]));
    return join(parts, ",");
}

}   // namespace

SweepAxis parse_axis(std::string_view setting) {
    const std::size_t equals = setting.find('=');
    const auto wrong = [&](std::string_view why) {
        return UsageError(fmt::format("--set {}: {}; it is key=value, or key=value,value...",
                                      double_quoted(shortened(setting)), why));
    };
    if (equals == setting.npos || trimmed(setting.substr(0, equals)).empty()) throw wrong("a key is missing");
    SweepAxis axis{std::string(trimmed(setting.substr(0, equals))), split_values(setting.substr(equals + 1))};
    std::set<std::string> known;
    for (const std::string& value : axis.values) {
        if (value.empty()) throw wrong("a value is missing");
        if (!known.insert(value).second) throw wrong(fmt::format("{} stands there twice", value));
    }
    return axis;
}

std::vector<SweepPoint> combine(const std::vector<SweepAxis>& axes) {
    std::set<std::string> keys;
    bool varies = false;
    for (const SweepAxis& axis : axes) {
        if (!keys.insert(axis.key).second)
            throw UsageError(fmt::format("--set: {} is set twice; give its values with commas between them", axis.key));
        varies = varies || axis.values.size() > 1;
    }
    if (!varies) throw UsageError("nothing varies: give a key several values, --set key=value,value");

    std::vector<SweepPoint> points{{}};
    for (const SweepAxis& axis : axes) {
        std::vector<SweepPoint> more;
        for (const SweepPoint& point : points)
            for (const std::string& value : axis.values) {
                more.push_back(point);
                more.back().values.push_back(value);
            }
        points = std::move(more);
    }
    std::set<std::string> names;
    for (SweepPoint& point : points) {
        const std::string name = name_of(axes, point.values);
        point.name = name;
        for (int n = 2; !names.insert(point.name).second; ++n)
            point.name = fmt::format("{}_{}", name, n);   // alike but for signs a folder cannot have
    }
    return points;
}

}   // namespace patency::deck

// SPDX-License-Identifier: Apache-2.0
#include "patency/config/table.h"

#include <algorithm>
#include <cmath>

#include "patency/base/text.h"

namespace patency::deck {

const Row* Table::find(std::string_view key) const {
    const auto found = std::find_if(rows.begin(), rows.end(), [&](const Row& row) { return row.key == key; });
    return found == rows.end() ? nullptr : &*found;
}

std::string range_text(const Row& row) {
    const Range& range = row.range;
    const auto shown = [&](double value) { return format_quantity(value, row.unit == signal_unit ? "" : row.unit); };
    const bool has_low = std::isfinite(range.low), has_high = std::isfinite(range.high);
    if (!has_low && !has_high) return {};
    if (range.low == range.high) return "only " + shown(range.low);
    if (!has_high) return (range.without_low ? "above " : "at least ") + shown(range.low);
    if (!has_low) return "at most " + shown(range.high);
    return (range.without_low ? "above " : "") + shown(range.low) + (range.without_low ? ", at most " : " to ") +
           shown(range.high);
}

namespace {

std::string list_of(const std::string& item, std::size_t count) {
    std::string text = "[";
    return text.append(join(std::vector<std::string>(count, item), ", ")).append("]");
}

}   // namespace

std::string example_text(const Row& row) {
    const std::string_view unit = row.unit == signal_unit ? "mL/min" : std::string_view(row.unit);
    std::string quantity;
    if (!unit.empty())
        quantity = double_quoted(row.example.empty() ? dimension_example(find_unit(unit)->dimension)
                                                     : std::string_view(row.example));
    const std::size_t count = row.form.kind == Form::Kind::vector ? 3 : row.count == 0 ? 2 : row.count;
    switch (row.form.kind) {
        case Form::Kind::number: return unit.empty() ? row.example : quantity;
        case Form::Kind::vector:
        case Form::Kind::list: return unit.empty() ? row.example : list_of(quantity, count);
        case Form::Kind::word: return std::string(row.form.words.front());
        default: return row.example;
    }
}

std::string joined_path(const std::string& path, std::string_view key) {
    std::string joined = path;
    return joined.append(path.empty() ? "" : ".").append(key);
}

const Table* Row::inner_table() const {
    const Form* innermost = &form;
    while (!innermost->item.empty()) innermost = &innermost->item[0];
    return innermost->table ? &innermost->table() : nullptr;
}

std::string Row::inner_path(const std::string& path_of_record) const {
    std::string path = joined_path(path_of_record, key);
    for (const Form* f = &form; !f->item.empty(); f = &f->item[0]) path += f->kind == Form::Kind::map ? ".NAME" : ".N";
    return path;
}

std::string find_path(const Table& table, const std::string& path, std::string_view key) {
    if (table.find(key)) return joined_path(path, key);
    for (const Row& row : table.rows)
        if (const Table* inner = row.inner_table())
            if (std::string found = find_path(*inner, row.inner_path(path), key); !found.empty()) return found;
    return {};
}

bool has_path(const Table& table, std::span<const std::string> keys) {
    const Row* row = keys.empty() ? nullptr : table.find(keys.front());
    if (!row) return false;
    const Form* form = &row->form;
    for (keys = keys.subspan(1); !keys.empty() && !form->item.empty(); keys = keys.subspan(1)) form = &form->item[0];
    return keys.empty() || (form->table && has_path(form->table(), keys));
}

Node write_number(double value, const Row& row, const Scope& scope) {
    if (row.unit.empty()) return make_scalar(format_number(value), false);
    if (row.unit != signal_unit) return make_scalar(format_quantity(value, row.unit), true);
    return make_scalar(format_quantity(value, unit_names(scope.signal.value_or(Dimension::number)).front()), true);
}

Node write_path(const std::filesystem::path& path, const Scope& scope) {
    return make_scalar(path.lexically_proximate(scope.folder).generic_string(), true);
}

Node write_kept(const Kept& kept) {
    Mistakes none;   // what was read once is valid
    return parse_yaml(kept.yaml, "kept", none);
}

Node write_record(const Table& table, const void* record, const Scope& scope) {
    Scope inner = scope;
    if (const Row* type = table.find("type"); type && type->form.kind == Form::Kind::word)
        if (const auto named = find_dimension(type->write(record, scope)->text)) inner.signal = named;
    const auto may_stand = [&](const Row& row) {
        if (!row.only) return true;
        if (row.only->absent) return !table.find(row.only->key)->write(record, inner);
        const std::string word = table.find(row.only->key)->write(record, inner)->text;
        return std::find(row.only->words.begin(), row.only->words.end(), word) != row.only->words.end();
    };
    Node map;
    map.kind = Node::Kind::map;
    for (const Row& row : table.rows) {
        if (!may_stand(row)) continue;
        Scope below = inner;
        if (row.signal) below.signal = row.signal;
        std::optional<Node> value = row.write(record, below);
        if (value && !(value->kind == Node::Kind::map && value->items.empty()))
            add_entry(map, row.key, std::move(*value));
    }
    return map;
}

}   // namespace patency::deck

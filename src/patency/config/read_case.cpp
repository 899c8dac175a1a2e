// SPDX-License-Identifier: Apache-2.0
// Reading values and records of a deck by the rows of the schema.
#include <algorithm>
#include <charconv>
#include <cmath>

#include "patency/base/errors.h"
#include "patency/base/text.h"
#include "patency/config/table.h"

namespace patency::deck {

namespace {

std::string kind_name(const Node& node) {
    switch (node.kind) {
        case Node::Kind::null: return "empty";
        case Node::Kind::list: return "a list";
        case Node::Kind::map: return "a record of keys";
        default: return node.in_quotes ? double_quoted(shortened(node.text)) : shortened(node.text);
    }
}

bool expect_scalar(const Node& node, const std::string& needed, const Scope& scope) {
    if (node.kind == Node::Kind::scalar) return true;
    scope.mistake(node, "is " + kind_name(node) + "; " + needed + " is needed");
    return false;
}

std::optional<Dimension> dimension_of(const Row& row, const Scope& scope) {
    if (row.unit == signal_unit) return scope.signal;
    return row.unit.empty() ? Dimension::number : find_unit(row.unit)->dimension;
}

std::vector<std::string> as_strings(const Words& words) { return {words.begin(), words.end()}; }

// A record being read: which of its keys may, must and do stand in the deck.
class RecordReader {
public:
    RecordReader(const Node& node, const Table& table, const Scope& scope)
        : node_(node), table_(table), scope_(scope) {}

    void read(void* record) {
        for (const Row& row : table_.rows) read_row(row, record);
        for (const Choice& choice : table_.choices) check_choice(choice);
        for (const Node& key : node_.keys)
            if (!table_.find(key.text)) report_unknown(key);
    }

private:
    // The word that holds for a key, or nothing if it is missing or no such word.
    std::optional<std::string> word_at(const std::string& key) const {
        const Row* row = table_.find(key);
        if (!row) return {};
        const Node* given = node_.find(key);
        if (!given) {
            const auto standard = table_.standard(*row, scope_);
            return standard ? std::optional(standard->text) : std::nullopt;
        }
        const auto known = std::find(row->form.words.begin(), row->form.words.end(), given->text);
        return known == row->form.words.end() ? std::nullopt : std::optional(given->text);
    }

    // Nothing if the word it depends on is not known: then neither presence nor absence is a mistake.
    std::optional<bool> holds(const std::optional<Condition>& condition) const {
        if (!condition) return false;
        if (condition->key.empty()) return true;
        if (condition->absent) return node_.find(condition->key) == nullptr;
        const auto word = word_at(condition->key);
        if (!word) return {};
        return std::find(condition->words.begin(), condition->words.end(), *word) != condition->words.end();
    }
    std::optional<bool> may_stand(const std::optional<Condition>& only) const { return only ? holds(only) : true; }

    void read_row(const Row& row, void* record) const {
        Scope scope = scope_below(row.key);
        if (row.signal) scope.signal = row.signal;
        const Node* given = node_.find(row.key);
        const std::optional<bool> may = may_stand(row.only);
        if (!given) {
            if (may == true && holds(row.need) == true) report_missing(row, scope);
        } else if (may == false) {
            const std::vector<std::string>& words_of_key = row.only->words;
            if (row.only->absent)
                scope.mistake(*given, "does not go together with " + row.only->key);
            else
                scope.mistake(*given, "belongs to " + row.only->key + " " + join(words_of_key, ", ", " or ") +
                                          ", not to " + *word_at(row.only->key));
        } else {
            row.read(*given, scope, record);
        }
    }

    Scope scope_below(const std::string& key) const {
        Scope scope = scope_.below(key);
        // An opening's type names the dimension of what stands in it.
        if (const auto type = word_at("type"))
            if (const auto named = find_dimension(*type)) scope.signal = named;
        return scope;
    }

    void report_missing(const Row& row, const Scope& scope) const {
        const std::string example = example_text(row);
        std::vector<std::string> needed;   // of a record
        if (row.form.table)
            for (const Row& inner : row.form.table().rows)
                if (inner.need && !inner.only) needed.push_back(inner.key);
        scope_.mistakes->add_missing(node_.place, scope.path,
                                     row.help + (example.empty() ? "" : ", for example " + example) +
                                         (needed.empty() ? "" : "; it needs " + join(needed, ", ", " and ")));
    }

    void check_choice(const Choice& choice) const {
        if (may_stand(choice.only) != true) return;
        std::vector<std::string> given;
        for (const std::string& key : choice.keys)
            if (node_.find(key)) given.push_back(key);
        if (given.empty() && choice.required)
            scope_.mistakes->add(node_.place, scope_.path,
                                 "needs " + std::string(choice.keys.size() == 2 ? "either " : "one of ") +
                                     join(choice.keys, ", ", " or "));
        if (given.size() > 1)
            scope_.below(given[1]).mistake(
                *node_.find(given[1]),
                "stands beside " + given[0] + "; only one of " + join(choice.keys, ", ", " and ") + " may be given");
    }

    void report_unknown(const Node& key) const {
        if (scope_.mistakes->are_full()) return;
        std::vector<std::string> known;
        for (const Row& row : table_.rows)
            if (may_stand(row.only) != false) known.push_back(row.key);
        std::string hint = nearest_name(key.text, known);
        if (!hint.empty()) {
            hint = ". Did you mean " + double_quoted(hint) + "?";
        } else {
            const std::string elsewhere = find_path(table_of<Case>(), "", key.text);
            if (!elsewhere.empty()) hint = "; a key of this name stands at " + elsewhere;
        }
        if (hint.empty()) hint = "; the keys here are " + join(known, ", ", " and ");
        scope_.mistakes->add(key.place, scope_.below(shortened(key.text)).path, "unknown key" + hint);
    }

    const Node& node_;
    const Table& table_;
    const Scope& scope_;
};

}   // namespace

Scope Scope::below(std::string_view key) const {
    Scope scope = *this;
    scope.path = joined_path(path, key);
    return scope;
}

std::optional<bool> read_flag(const Node& node, const Scope& scope) {
    if (!expect_scalar(node, "true or false", scope)) return {};
    if (!node.in_quotes && node.text == "true") return true;
    if (!node.in_quotes && node.text == "false") return false;
    scope.mistake(node, kind_name(node) + " is neither true nor false");
    return {};
}

std::optional<int> read_integer(const Node& node, const Row& row, const Scope& scope) {
    if (!expect_scalar(node, "a whole number", scope)) return {};
    int value = 0;
    const char* last = node.text.data() + node.text.size();
    const auto [end, error] = std::from_chars(node.text.data(), last, value);
    if (node.in_quotes || end != last || error == std::errc::invalid_argument)
        scope.mistake(node, kind_name(node) + " is not a whole number" +
                                (node.in_quotes ? " but text; leave the quotes out" : ""));
    else if (error == std::errc::result_out_of_range || !row.range.contains(value))
        scope.mistake(node, kind_name(node) + " is out of range: " + range_text(row));
    else
        return value;
    return {};
}

std::optional<double> read_number(const Node& node, const Row& row, const Scope& scope) {
    const std::optional<Dimension> dimension = dimension_of(row, scope);
    if (!dimension) return {};   // the opening's type is itself a mistake
    const bool is_plain = *dimension == Dimension::number;
    if (!expect_scalar(node, dimension_phrase(*dimension), scope)) return {};
    if (is_plain && node.in_quotes) {
        scope.mistake(node, kind_name(node) + " is text; a number without quotes is needed");
        return {};
    }
    try {
        const std::string example = row.form.kind == Form::Kind::number ? row.example : "";
        const double value = is_plain ? parse_number(node.text) : parse_quantity(node.text, *dimension, example);
        if (row.range.contains(value)) return value;
        scope.mistake(node, kind_name(node) + " is out of range: " + range_text(row));
    } catch (const DeckError& e) {
        scope.mistake(node, e.what());
    }
    return {};
}

std::optional<std::string> read_text(const Node& node, const Row&, const Scope& scope) {
    if (!expect_scalar(node, "text", scope)) return {};
    if (!trimmed(node.text).empty()) return node.text;
    scope.mistake(node, "is empty text");
    return {};
}

std::optional<std::filesystem::path> read_path(const Node& node, const Row& row, const Scope& scope) {
    const auto text = read_text(node, row, scope);
    if (!text) return {};
    return (scope.folder / *text).lexically_normal();
}

std::optional<std::size_t> read_word(const Node& node, const Words& words, const Scope& scope) {
    const std::vector<std::string> known = as_strings(words);
    if (!expect_scalar(node, "one of " + join(known, ", ", " or "), scope)) return {};
    const auto found = std::find(known.begin(), known.end(), node.text);
    if (found != known.end()) return std::size_t(found - known.begin());
    const std::string near = nearest_name(node.text, known);
    scope.mistake(node, double_quoted(shortened(node.text)) + " is not one of " + join(known, ", ", " or ") +
                            (near.empty() ? "" : ". Did you mean " + double_quoted(near) + "?"));
    return {};
}

std::optional<Vec3> read_vector(const Node& node, const Row& row, const Scope& scope) {
    if (node.kind != Node::Kind::list || node.items.size() != 3) {
        scope.mistake(node, "a list of three is needed, for example " + example_text(row));
        return {};
    }
    std::array<std::optional<double>, 3> v;
    for (std::size_t i = 0; i < 3; ++i) v[i] = read_number(node.items[i], row, scope.below(std::to_string(i)));
    if (!v[0] || !v[1] || !v[2]) return {};
    return Vec3{*v[0], *v[1], *v[2]};
}

std::optional<std::array<bool, 3>> read_flags(const Node& node, const Scope& scope) {
    if (node.kind != Node::Kind::list || node.items.size() != 3) {
        scope.mistake(node, "a list of three is needed, for example [true, true, false]");
        return {};
    }
    std::array<std::optional<bool>, 3> v;
    for (std::size_t i = 0; i < 3; ++i) v[i] = read_flag(node.items[i], scope.below(std::to_string(i)));
    if (!v[0] || !v[1] || !v[2]) return {};
    return std::array<bool, 3>{*v[0], *v[1], *v[2]};
}

bool expect_list(const Node& node, const Row& row, const Scope& scope) {
    std::string example = example_text(row);
    if (!example.empty()) example = ", for example " + example;
    if (node.kind != Node::Kind::list)
        scope.mistake(node, "is " + kind_name(node) + "; a list is needed" + example);
    else if (node.items.empty())
        scope.mistake(node, "is an empty list; leave the key out or list something" + example);
    else if (row.count != 0 && node.items.size() != row.count)
        scope.mistake(node, "has " + std::to_string(node.items.size()) + " items; " + std::to_string(row.count) +
                                " are needed" + example);
    else
        return true;
    return false;
}

bool expect_map(const Node& node, const Row& row, const Scope& scope) {
    if (node.kind != Node::Kind::map || node.items.empty()) {
        scope.mistake(node, "is " + (node.kind == Node::Kind::map ? std::string("an empty record") : kind_name(node)) +
                                "; names with values are needed: " + row.help);
        return false;
    }
    for (const Node& key : node.keys)
        if (row.form.item[0].kind != Form::Kind::kept && !is_plain_name(key.text))   // kept: the keys are paths
            scope.mistake(key, double_quoted(shortened(key.text)) +
                                   " is no name; names have letters, digits, _ and -, at most 64");
    return true;
}

void read_record(const Node& node, const Table& table, void* record, const Scope& scope) {
    if (node.kind == Node::Kind::map) return RecordReader(node, table, scope).read(record);
    std::vector<std::string> keys;
    for (const Row& row : table.rows) keys.push_back(row.key);
    const std::string how_many = node.kind == Node::Kind::list ? "one" : "a";   // not two stents, nor two walls
    scope.mistake(node, "is " + kind_name(node) + "; " + how_many + " record of keys is needed: " + join(keys, ", "));
}

}   // namespace patency::deck

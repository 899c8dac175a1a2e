// SPDX-License-Identifier: Apache-2.0
// The machinery of the schema: a row says everything about one key of the deck and is bound to the member of
// the case that holds it; from rows follow reading, writing and documentation. The rows are in schema.cpp.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "patency/base/units.h"
#include "patency/base/vec.h"
#include "patency/config/case.h"
#include "patency/config/document.h"

namespace patency::deck {

/// Where in the deck we are, and what came before.
struct Scope {
    Mistakes* mistakes = nullptr;      ///< null when writing
    std::filesystem::path folder;      ///< of the deck read or written: paths are relative to it
    std::string path;                  ///< "numerics.spacing"
    std::optional<Dimension> signal;   ///< what the enclosing `type` names: velocity, flow or pressure

    Scope below(std::string_view key) const;
    void mistake(const Node& node, std::string_view sentence) const { mistakes->add(node.place, path, sentence); }
};

/// Accepted values [SI].
struct Range {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    bool without_low = false;   ///< low itself is not accepted

    bool contains(double value) const { return value <= high && (without_low ? value > low : value >= low); }
};
inline Range above(double low) { return {.low = low, .without_low = true}; }
inline Range at_least(double low) { return {.low = low}; }
inline Range between(double low, double high) { return {.low = low, .high = high}; }
inline Range above_up_to(double low, double high) { return {.low = low, .high = high, .without_low = true}; }

/// "where `key` of the same record is one of `words`", or "where there is no `key`"; without a key it always holds.
struct Condition {
    std::string key{};
    std::vector<std::string> words{};
    bool absent = false;
};
inline const Condition always{};

struct Table;

/// What a value looks like in the deck.
struct Form {
    enum class Kind { boolean, integer, number, text, path, word, kept, vector, flags, list, map, record };
    Kind kind = Kind::text;
    Words words{};                       ///< of a word
    std::vector<Form> item{};            ///< one: of a list or a map
    const Table& (*table)() = nullptr;   ///< of a record
};

/// The unit of values whose dimension is that of the enclosing opening's type.
inline constexpr std::string_view signal_unit = "signal";

struct Row {
    std::string key{};
    std::string help{};
    std::string unit{};                  ///< of numbers: the one we write; its dimension is the one needed
    Range range{};                       ///< of numbers, of each in a list or vector
    std::string example{};               ///< as it would stand in a deck; the dimension's own if empty
    std::size_t count = 0;               ///< items of a list; 0: any number but none
    std::optional<Condition> only{};     ///< the key may stand only there
    std::optional<Condition> need{};     ///< the key must stand there
    std::optional<Dimension> signal{};   ///< of what stands below the key, whatever the record's `type` says

    // These follow from the member the row is bound to.
    Form form{};
    std::function<void(const Node&, const Scope&, void* record)> read{};
    std::function<std::optional<Node>(const void* record, const Scope&)> write{};

    /// The table of the records in the value, or nullptr.
    const Table* inner_table() const;
    /// Their path, for documents: a list's items are "probes.N", a map's "openings.NAME".
    std::string inner_path(const std::string& path_of_record) const;
};

/// Keys that exclude each other.
struct Choice {
    std::vector<std::string> keys{};
    bool required = true;   ///< one of them must stand there
    std::optional<Condition> only{};
};

/// The keys of one record.
struct Table {
    std::string help{};
    std::vector<Row> rows{};
    std::vector<Choice> choices{};
    std::function<std::optional<Node>(const Row&, const Scope&)> standard{};   ///< a row's default, if it has one

    const Row* find(std::string_view key) const;
};

/// "500 kg/m^3 to 2000 kg/m^3", "above 0 m", "1.3"; empty if every number is accepted.
std::string range_text(const Row& row);
/// A value of the row as it would stand in a deck.
std::string example_text(const Row& row);
/// "path.key", or the key alone.
std::string joined_path(const std::string& path, std::string_view key);
/// The path of the first key of that name in a record or the records in it; empty if there is none.
std::string find_path(const Table& table, const std::string& path, std::string_view key);
/// Whether a path's keys are those of a record and the records in it; names of a map and numbers of a list are any.
bool has_path(const Table& table, std::span<const std::string> keys);

/// The table of a record of case.h (schema.cpp).
template <class T>
const Table& table_of();

// Reading one value: the result, or nothing and a mistake.
std::optional<bool> read_flag(const Node& node, const Scope& scope);
std::optional<int> read_integer(const Node& node, const Row& row, const Scope& scope);
std::optional<double> read_number(const Node& node, const Row& row, const Scope& scope);
std::optional<std::string> read_text(const Node& node, const Row& row, const Scope& scope);
std::optional<std::filesystem::path> read_path(const Node& node, const Row& row, const Scope& scope);
std::optional<std::size_t> read_word(const Node& node, const Words& words, const Scope& scope);
std::optional<Vec3> read_vector(const Node& node, const Row& row, const Scope& scope);
std::optional<std::array<bool, 3>> read_flags(const Node& node, const Scope& scope);
bool expect_list(const Node& node, const Row& row, const Scope& scope);
bool expect_map(const Node& node, const Row& row, const Scope& scope);
void read_record(const Node& node, const Table& table, void* record, const Scope& scope);

Node write_number(double value, const Row& row, const Scope& scope);
Node write_path(const std::filesystem::path& path, const Scope& scope);
Node write_kept(const Kept& kept);
Node write_record(const Table& table, const void* record, const Scope& scope);

namespace detail {

template <class M>
struct Is {
    static constexpr bool optional = false, list = false, map = false;
};
template <class T>
struct Is<std::optional<T>> {
    static constexpr bool optional = true, list = false, map = false;
};
template <class T>
struct Is<std::vector<T>> {
    static constexpr bool optional = false, list = true, map = false;
};
template <class T>
struct Is<std::map<std::string, T>> {
    static constexpr bool optional = false, list = false, map = true;
};
using Flags = std::array<bool, 3>;

template <class M>
Form form_of() {
    using enum Form::Kind;
    if constexpr (Is<M>::optional)
        return form_of<typename M::value_type>();
    else if constexpr (Is<M>::list)
        return {.kind = list, .item = {form_of<typename M::value_type>()}};
    else if constexpr (Is<M>::map)
        return {.kind = map, .item = {form_of<typename M::mapped_type>()}};
    else if constexpr (std::is_same_v<M, bool>)
        return {.kind = boolean};
    else if constexpr (std::is_same_v<M, int>)
        return {.kind = integer};
    else if constexpr (std::is_same_v<M, double>)
        return {.kind = number};
    else if constexpr (std::is_same_v<M, std::string>)
        return {.kind = text};
    else if constexpr (std::is_same_v<M, std::filesystem::path>)
        return {.kind = path};
    else if constexpr (std::is_same_v<M, Kept>)
        return {.kind = kept};
    else if constexpr (std::is_same_v<M, Vec3>)
        return {.kind = vector};
    else if constexpr (std::is_same_v<M, Flags>)
        return {.kind = flags};
    else if constexpr (std::is_enum_v<M>)
        return {.kind = word, .words = words(M{}), .item = {}};
    else
        return {.kind = record, .table = &table_of<M>};
}

template <class M, class V>
void assign(M& member, const std::optional<V>& value) {
    if (value) member = M(*value);
}

template <class M>
void read_value(const Node& node, const Row& row, const Scope& scope, M& member) {
    if constexpr (Is<M>::optional) {
        read_value(node, row, scope, member.emplace());
    } else if constexpr (Is<M>::list) {
        if (!expect_list(node, row, scope)) return;
        member.assign(node.items.size(), {});
        for (std::size_t i = 0; i < node.items.size(); ++i)
            read_value(node.items[i], row, scope.below(std::to_string(i)), member[i]);
    } else if constexpr (Is<M>::map) {
        if (!expect_map(node, row, scope)) return;
        member.clear();
        for (std::size_t i = 0; i < node.items.size(); ++i)
            read_value(node.items[i], row, scope.below(node.keys[i].text), member[node.keys[i].text]);
    } else if constexpr (std::is_same_v<M, bool>) {
        assign(member, read_flag(node, scope));
    } else if constexpr (std::is_same_v<M, int>) {
        assign(member, read_integer(node, row, scope));
    } else if constexpr (std::is_same_v<M, double>) {
        assign(member, read_number(node, row, scope));
    } else if constexpr (std::is_same_v<M, std::string>) {
        assign(member, read_text(node, row, scope));
    } else if constexpr (std::is_same_v<M, std::filesystem::path>) {
        assign(member, read_path(node, row, scope));
    } else if constexpr (std::is_same_v<M, Kept>) {
        member.yaml = format_flow(node);
    } else if constexpr (std::is_same_v<M, Vec3>) {
        assign(member, read_vector(node, row, scope));
    } else if constexpr (std::is_same_v<M, Flags>) {
        assign(member, read_flags(node, scope));
    } else if constexpr (std::is_enum_v<M>) {
        assign(member, read_word(node, words(M{}), scope));
    } else {
        read_record(node, table_of<M>(), &member, scope);
    }
}

/// What stands in the deck for a member; nothing for what is absent or empty.
template <class M>
std::optional<Node> write_value(const M& member, const Row& row, const Scope& scope) {
    if constexpr (Is<M>::optional) {
        return member ? write_value(*member, row, scope) : std::nullopt;
    } else if constexpr (Is<M>::list) {
        if (member.empty()) return {};
        std::vector<Node> items;
        for (const auto& item : member) items.push_back(*write_value(item, row, scope));
        return make_list(std::move(items));
    } else if constexpr (Is<M>::map) {
        if (member.empty()) return {};
        Node map;
        for (const auto& [key, item] : member) add_entry(map, key, *write_value(item, row, scope));
        return map;
    } else if constexpr (std::is_same_v<M, bool>) {
        return make_scalar(member ? "true" : "false", false);
    } else if constexpr (std::is_same_v<M, int>) {
        return make_scalar(std::to_string(member), false);
    } else if constexpr (std::is_same_v<M, double>) {
        return write_number(member, row, scope);
    } else if constexpr (std::is_same_v<M, std::string>) {
        return member.empty() ? std::nullopt : std::optional(make_scalar(member, true));
    } else if constexpr (std::is_same_v<M, std::filesystem::path>) {
        return write_path(member, scope);
    } else if constexpr (std::is_same_v<M, Kept>) {
        return member.yaml.empty() ? std::nullopt : std::optional(write_kept(member));
    } else if constexpr (std::is_same_v<M, Vec3>) {
        return make_list({write_number(member.x, row, scope), write_number(member.y, row, scope),
                          write_number(member.z, row, scope)});
    } else if constexpr (std::is_same_v<M, Flags>) {
        return make_list({*write_value(member[0], row, scope), *write_value(member[1], row, scope),
                          *write_value(member[2], row, scope)});
    } else if constexpr (std::is_enum_v<M>) {
        return make_scalar(std::string(word_of(member)), false);
    } else {
        return write_record(table_of<M>(), &member, scope);
    }
}

}   // namespace detail

/// Bind a row to the member that holds its value.
template <class T, class M>
Row row(M T::*member, Row said) {
    said.form = detail::form_of<M>();
    const Row bare = said;   // the closures own what they need of the row
    said.read = [member, bare](const Node& node, const Scope& scope, void* record) {
        detail::read_value(node, bare, scope, static_cast<T*>(record)->*member);
    };
    said.write = [member, bare](const void* record, const Scope& scope) {
        return detail::write_value(static_cast<const T*>(record)->*member, bare, scope);
    };
    return said;
}

/// The table of record T. Defaults are what a new T holds, in rows that need not stand in the deck.
template <class T>
Table make_table(std::string help, std::vector<Row> rows, std::vector<Choice> choices = {}) {
    const auto standard = [](const Row& key, const Scope& scope) -> std::optional<Node> {
        const T fresh{};
        return key.need || key.form.kind == Form::Kind::record ? std::nullopt : key.write(&fresh, scope);
    };
    return {std::move(help), std::move(rows), std::move(choices), standard};
}

}   // namespace patency::deck

// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "patency/base/errors.h"
#include "patency/base/text.h"
#include "patency/config/schema.h"
#include "patency/config/table.h"

namespace patency::deck {

namespace {

using Json = nlohmann::ordered_json;

Json record_schema(const Table& table);

// A bare example or default, as JSON.
Json as_json(const Node& node) {
    switch (node.kind) {
        case Node::Kind::null: return nullptr;
        case Node::Kind::list: {
            Json list = Json::array();
            for (const Node& item : node.items) list.push_back(as_json(item));
            return list;
        }
        case Node::Kind::map: {
            Json map = Json::object();
            for (std::size_t i = 0; i < node.items.size(); ++i) map[node.keys[i].text] = as_json(node.items[i]);
            return map;
        }
        case Node::Kind::scalar: break;
    }
    Json value = node.in_quotes ? Json() : Json::parse(node.text, nullptr, false);
    return value.is_number() || value.is_boolean() ? value : Json(node.text);
}

Json number_schema(const Row& row) {
    if (row.unit == signal_unit) {   // the dimension is the opening's, which a schema cannot follow
        return {{"type", "string"},
                {"anyOf",
                 {{{"pattern", quantity_pattern(Dimension::velocity)}},
                  {{"pattern", quantity_pattern(Dimension::flow)}},
                  {{"pattern", quantity_pattern(Dimension::pressure)}}}}};
    }
    if (!row.unit.empty()) return {{"type", "string"}, {"pattern", quantity_pattern(find_unit(row.unit)->dimension)}};
    Json schema{{"type", row.form.kind == Form::Kind::integer ? "integer" : "number"}};
    if (std::isfinite(row.range.low)) schema[row.range.without_low ? "exclusiveMinimum" : "minimum"] = row.range.low;
    if (std::isfinite(row.range.high)) schema["maximum"] = row.range.high;
    return schema;
}

Json form_schema(const Form& form, const Row& row) {
    switch (form.kind) {
        case Form::Kind::boolean: return {{"type", "boolean"}};
        case Form::Kind::integer:
        case Form::Kind::number: return number_schema(row);
        case Form::Kind::text:
        case Form::Kind::path: return {{"type", "string"}, {"minLength", 1}};
        case Form::Kind::word: {
            Json words = Json::array();
            for (const std::string_view word : form.words) words.push_back(std::string(word));
            return {{"enum", words}};
        }
        case Form::Kind::kept: return Json::object();
        case Form::Kind::vector:
        case Form::Kind::flags: {
            Json item = form.kind == Form::Kind::flags ? Json{{"type", "boolean"}} : number_schema(row);
            return {{"type", "array"}, {"items", item}, {"minItems", 3}, {"maxItems", 3}};
        }
        case Form::Kind::list: {
            Json schema{{"type", "array"},
                        {"items", form_schema(form.item[0], row)},
                        {"minItems", std::max<std::size_t>(1, row.count)}};
            if (row.count != 0) schema["maxItems"] = row.count;
            return schema;
        }
        case Form::Kind::map:
            return {{"type", "object"}, {"additionalProperties", form_schema(form.item[0], row)}, {"minProperties", 1}};
        case Form::Kind::record: return record_schema(form.table());
    }
    return Json::object();
}

std::string help_text(const Row& row) {
    const std::string range = range_text(row);
    return row.help + (range.empty() ? "" : " (" + range + ")");
}

// {"if": the condition, "then": consequence}; the consequence alone if the condition always holds.
Json conditional(const std::optional<Condition>& condition, const Table& table, Json consequence) {
    if (!condition || condition->key.empty()) return consequence;
    if (condition->absent)
        return {{"if", {{"not", {{"required", {condition->key}}}}}}, {"then", std::move(consequence)}};
    Json test{{"properties", {{condition->key, {{"enum", condition->words}}}}}};
    const auto standard = table.standard(*table.find(condition->key), {});
    const bool holds_without = standard && std::find(condition->words.begin(), condition->words.end(),
                                                     standard->text) != condition->words.end();
    if (!holds_without) test["required"] = {condition->key};   // an absent key has its default
    return {{"if", test}, {"then", std::move(consequence)}};
}

Json one_of_keys(const Choice& choice) {
    Json ways = Json::array();
    for (const std::string& key : choice.keys) ways.push_back({{"required", {key}}});
    if (!choice.required) {
        Json none = Json::array();
        for (const std::string& key : choice.keys) none.push_back({{"required", {key}}});
        ways.push_back({{"not", {{"anyOf", none}}}});
    }
    return {{"oneOf", ways}};
}

Json record_schema(const Table& table) {
    Json properties = Json::object(), required = Json::array(), rules = Json::array();
    for (const Row& row : table.rows) {
        Json property = form_schema(row.form, row);
        property["description"] = help_text(row);
        if (const auto standard = table.standard(row, {})) property["default"] = as_json(*standard);
        properties[row.key] = std::move(property);
        if (row.need && row.need->key.empty() && !row.only) required.push_back(row.key);
        if (row.need && (row.only || !row.need->key.empty()))
            rules.push_back(conditional(row.only ? row.only : row.need, table, {{"required", {row.key}}}));
        if (row.only) {
            Json absent = conditional(row.only, table, Json::object());
            absent["else"] = {{"not", {{"required", {row.key}}}}};
            rules.push_back(std::move(absent));
        }
    }
    for (const Choice& choice : table.choices) rules.push_back(conditional(choice.only, table, one_of_keys(choice)));
    Json schema{{"type", "object"},
                {"description", table.help},
                {"properties", std::move(properties)},
                {"additionalProperties", false}};
    if (!required.empty()) schema["required"] = std::move(required);
    if (!rules.empty()) schema["allOf"] = std::move(rules);
    return schema;
}

std::string form_text(const Form& form, const Row& row) {
    const auto number_text = [&]() -> std::string {
        if (row.unit == signal_unit) return "velocity, flow or pressure";
        if (row.unit.empty()) return "number";
        return std::string(dimension_name(find_unit(row.unit)->dimension));
    };
    switch (form.kind) {
        case Form::Kind::boolean: return "true or false";
        case Form::Kind::integer: return "whole number";
        case Form::Kind::number: return number_text();
        case Form::Kind::text: return "text";
        case Form::Kind::path: return "file";
        case Form::Kind::word:
            return join(std::vector<std::string>(form.words.begin(), form.words.end()), ", ", " or ");
        case Form::Kind::kept: return "any";
        case Form::Kind::vector: return "three of " + number_text();
        case Form::Kind::flags: return "three of true or false";
        case Form::Kind::list: return "list of " + form_text(form.item[0], row);
        case Form::Kind::map: return "by name: " + form_text(form.item[0], row);
        case Form::Kind::record: return "record";
    }
    return {};
}

std::string condition_text(const Condition& condition) {
    if (condition.absent) return "a deck without " + condition.key;
    return condition.key + " " + join(condition.words, ", ", " or ");
}

// "required", "required for type tube", "default 1.3", "for type box; default false"
std::string presence_text(const Row& row, const Table& table) {
    std::vector<std::string> parts;
    const bool is_needed = row.need.has_value();
    if (is_needed && !row.need->key.empty())
        parts.push_back("required for " + condition_text(*row.need));
    else if (row.only)
        parts.push_back((is_needed ? "required for " : "for ") + condition_text(*row.only));
    else if (is_needed)
        parts.push_back("required");
    if (const auto standard = table.standard(row, {})) parts.push_back("default `" + format_flow(*standard) + "`");
    return join(parts, "; ");
}

std::string in_cell(std::string_view text) { return join(split(text, '|'), "\\|"); }

// The section of a record, then those of the records in it.
void add_section(std::string& text, const std::string& path, const Table& table) {
    text += fmt::format("\n## {}\n\n{}\n", path.empty() ? "The deck" : fmt::format("`{}`", path), table.help);
    for (const Choice& choice : table.choices)
        text +=
            fmt::format("\n{} one of {}{}.\n", choice.required ? "Exactly" : "At most",
                        join(choice.keys, ", ", " and "), choice.only ? " for " + condition_text(*choice.only) : "");
    text += "\n| key | value | accepted | presence | what it is | example |\n|---|---|---|---|---|---|\n";
    for (const Row& row : table.rows) {
        const std::string example = example_text(row);
        text += fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", row.key, in_cell(form_text(row.form, row)),
                            in_cell(range_text(row)), in_cell(presence_text(row, table)), in_cell(row.help),
                            example.empty() ? "" : fmt::format("`{}`", in_cell(example)));
    }
    for (const Row& row : table.rows)
        if (const Table* inner = row.inner_table()) add_section(text, row.inner_path(path), *inner);
}

void write_text(const std::filesystem::path& path, const std::string& text) {
    std::ofstream file(path, std::ios::binary);
    file << text;
    file.close();
    if (!file) throw FileError("cannot write " + path.string());
}

}   // namespace

std::string schema_json() {
    Json schema{{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", "patency deck"}};
    schema.update(record_schema(table_of<Case>()));
    return schema.dump(2) + "\n";
}

std::string schema_markdown() {
    std::string text =
        "# Keys of the deck\n\nGenerated from the program's schema. Every value with a dimension is text with "
        "its unit.\n\n| dimension | units |\n|---|---|\n";
    for (std::size_t i = 1; i <= std::size_t(Dimension::angle); ++i)
        text += fmt::format("| {} | {} |\n", dimension_name(Dimension(i)), join(unit_names(Dimension(i)), ", "));
    add_section(text, "", table_of<Case>());
    return text;
}

void write_json_schema(const std::filesystem::path& path) { write_text(path, schema_json()); }
void write_schema_markdown(const std::filesystem::path& path) { write_text(path, schema_markdown()); }

}   // namespace patency::deck

// SPDX-License-Identifier: Apache-2.0
// The schema as documents: they say the same as the reader does.
#pragma GCC diagnostic ignored "-Wrestrict"   // GCC 12 on valijson: a false alarm (its bug 105651)
#include "patency/config/schema.h"

#include <algorithm>
#include <functional>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "patency/base/errors.h"
#include "patency/config/deck.h"
#include "patency/config/document.h"
#include "patency/config/table.h"
#include "tests/config/decks.h"

namespace patency::deck {
namespace {

using Json = nlohmann::json;

Json as_json(const Node& node) {
    if (node.kind == Node::Kind::null) return nullptr;
    if (node.kind == Node::Kind::scalar) {
        Json value = node.in_quotes ? Json() : Json::parse(node.text, nullptr, false);
        return value.is_number() || value.is_boolean() ? value : Json(node.text);
    }
    Json value = node.kind == Node::Kind::map ? Json::object() : Json::array();
    for (std::size_t i = 0; i < node.items.size(); ++i) {
        if (node.kind == Node::Kind::map)
            value[node.keys[i].text] = as_json(node.items[i]);
        else
            value.push_back(as_json(node.items[i]));
    }
    return value;
}

bool fits_schema(const std::string& deck) {
    const Json text = Json::parse(schema_json());
    valijson::adapters::NlohmannJsonAdapter schema_adapter(text);
    valijson::Schema schema;
    valijson::SchemaParser().populateSchema(schema_adapter, schema);
    Mistakes mistakes;
    const Json json = as_json(parse_yaml(deck, "deck", mistakes));
    valijson::adapters::NlohmannJsonAdapter adapter(json);
    valijson::Validator validator;
    return validator.validate(schema, adapter, nullptr);
}

bool is_accepted(const std::string& deck) {
    try {
        parse_case(deck);
        return true;
    } catch (const DeckError&) {
        return false;
    }
}

TEST(Schema, AcceptsWhatTheReaderAccepts) {
    for (const std::string& deck : valid_decks) {
        EXPECT_TRUE(is_accepted(deck));
        EXPECT_TRUE(fits_schema(deck)) << deck;
        EXPECT_TRUE(fits_schema(format_case(parse_case(deck, "deck", "/"), "/"))) << "resolved:\n" << deck;
    }
}

// One mistake of each kind that a schema can see.
TEST(Schema, RefusesWhatTheReaderRefuses) {
    const std::vector<std::pair<std::string, std::string>> changes{
        {"version: 1", "version: 2"},
        {"version: 1\n", ""},
        {"spacing:", "spacnig:"},
        {"  spacing: \"0.2 mm\"\n", ""},
        {"\"0.2 mm\"", "0.2"},
        {"\"0.2 mm\"", "\"0.2\""},
        {"\"0.2 mm\"", "\"0.2 mmHg\""},
        {"type: tube", "type: tueb"},
        {"type: tube", "type: cone"},
        {"length: \"15 mm\"", "length: \"15 mm\", gap: \"1 mm\""},
        {"  viscosity:", "  law: casson\n  viscosity:"},
        {"velocity: \"0.1 m/s\"", "velocity: \"0.1 m/s\"\n    peak_velocity: \"0.2 m/s\""},
        {"    velocity: \"0.1 m/s\"\n", ""},
        {"name: pipe", "name: pipe, mode: periodic"},
        {"duration: \"1 s\"", "duration: \"1 s\"\n  sound_speed: \"1 m/s\"\n  sound_speed_factor: 10"},
        {"duration: \"1 s\"", "duration: \"1 s\"\n  threads: 1.5"},
        {"duration: \"1 s\"", "duration: \"1 s\"\n  threads: -1"},
        {"duration: \"1 s\"", "duration: \"1 s\"\n  smoothing_ratio: \"1.3\""},
        {"duration: \"1 s\"", "duration: \"1 s\"\noutput: {fields: []}"},
        {"duration: \"1 s\"", "duration: \"1 s\"\nbody_force: [\"1 m/s^2\"]"},
        {"duration: \"1 s\"", "duration: \"1 s\"\nwall: {motion: deformable}"},
    };
    for (const auto& [part, replacement] : changes) {
        const std::string deck = pipe_with(part, replacement);
        EXPECT_FALSE(is_accepted(deck)) << deck;
        EXPECT_FALSE(fits_schema(deck)) << deck;
    }
}

// Every default in the schema satisfies the schema around it, and every key has a sentence.
void expect_sound(const Json& schema, const std::string& path) {
    if (schema.contains("properties")) {
        for (const auto& [key, property] : schema["properties"].items()) {
            EXPECT_TRUE(property.contains("description") && !property["description"].get<std::string>().empty())
                << path << key;
            if (property.contains("default") && property.contains("enum")) {
                const auto& words = property["enum"];
                EXPECT_NE(std::find(words.begin(), words.end(), property["default"]), words.end()) << path << key;
            }
            expect_sound(property, path + key + ".");
        }
    }
    if (schema.contains("items")) expect_sound(schema["items"], path + "N.");
    if (schema.contains("additionalProperties") && schema["additionalProperties"].is_object())
        expect_sound(schema["additionalProperties"], path + "NAME.");
}

TEST(Schema, DescribesEveryKey) { expect_sound(Json::parse(schema_json()), ""); }

// Reading the table as the reader does: an example that a message would show must itself be accepted.
void check_examples(const Table& table, const std::string& path, std::size_t& checked) {
    for (const Row& row : table.rows) {
        EXPECT_TRUE(row.unit == signal_unit || find_unit(row.unit)) << path << row.key;
        for (const auto& condition : {row.only, row.need}) {
            if (!condition || condition->key.empty()) continue;
            const Row* key = table.find(condition->key);
            ASSERT_TRUE(key) << path << row.key << " depends on " << condition->key;
            for (const std::string& word : condition->words)
                EXPECT_NE(std::find(key->form.words.begin(), key->form.words.end(), word), key->form.words.end())
                    << path << word;
        }
        const bool is_number = row.form.kind == Form::Kind::number || row.form.kind == Form::Kind::vector;
        if (is_number && !row.unit.empty() && row.unit != signal_unit) {
            const std::string example =
                row.example.empty() ? std::string(dimension_example(find_unit(row.unit)->dimension)) : row.example;
            const double value = parse_quantity(example, find_unit(row.unit)->dimension);
            EXPECT_TRUE(row.range.contains(value)) << path << row.key << " " << example;
            ++checked;
        }
        if (const Table* inner = row.inner_table()) check_examples(*inner, row.inner_path(path), checked);
    }
    for (const Choice& choice : table.choices)
        for (const std::string& key : choice.keys) EXPECT_TRUE(table.find(key)) << path << key;
}

TEST(Schema, RowsNameKnownUnitsWordsAndKeysAndTheirExamplesAreInRange) {
    std::size_t checked = 0;
    check_examples(table_of<Case>(), "", checked);
    EXPECT_GT(checked, 30u);
}

TEST(Schema, MarkdownHasARowForEveryKey) {
    const std::string text = schema_markdown();
    const std::function<void(const Table&)> expect_rows = [&](const Table& table) {
        for (const Row& row : table.rows) {
            EXPECT_NE(text.find("| `" + row.key + "` |"), std::string::npos) << row.key;
            if (const Table* inner = row.inner_table()) expect_rows(*inner);
        }
    };
    expect_rows(table_of<Case>());
    EXPECT_NE(text.find("required for law carreau_yasuda"), std::string::npos);
    EXPECT_NE(text.find("default `1.3`"), std::string::npos);
}

}   // namespace
}   // namespace patency::deck

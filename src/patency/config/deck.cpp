// SPDX-License-Identifier: Apache-2.0
#include "patency/config/deck.h"

#include <fstream>
#include <iterator>
#include <span>

#include "patency/base/errors.h"
#include "patency/base/text.h"
#include "patency/config/checks.h"
#include "patency/config/table.h"

namespace patency::deck {

namespace {

constexpr std::size_t largest_deck = 1 << 20;   // bytes; YAML parsers need a hundred times that
constexpr std::size_t most_runs = 1000;

std::string read_deck_text(const std::filesystem::path& path) {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) throw FileError("there is no file " + path.string());
    if (std::filesystem::is_directory(status)) throw FileError(path.string() + " is a folder; a deck is a file");
    std::ifstream file(path, std::ios::binary);
    if (!file) throw FileError("cannot read " + path.string());
    std::string text;
    text.reserve(1 << 16);
    for (std::istreambuf_iterator<char> byte(file), end; byte != end; ++byte) {
        if (text.size() == largest_deck)
            throw DeckError(path.string() + ":1:1: larger than 1 MB; put tables into files of their own");
        text.push_back(*byte);
    }
    if (file.bad()) throw FileError("cannot read " + path.string());
    return text;
}

[[noreturn]] void refuse(const Mistakes& mistakes) { throw DeckError(mistakes.report()); }

// The tree of a deck; throws if there is none to go on with.
Node parse_deck(std::string_view text, const std::string& source, Mistakes& mistakes) {
    Node root = parse_yaml(text, source, mistakes);
    if (root.kind == Node::Kind::map) return root;
    if (mistakes.empty())
        mistakes.add(root.place, "",
                     root.kind == Node::Kind::null ? "the deck is empty; it starts with \"version: 1\""
                                                   : "a deck is a record of keys; it starts with \"version: 1\"");
    refuse(mistakes);
}

bool is_key_of_deck(std::span<const std::string> keys) { return has_path(table_of<Case>(), keys); }

Case interpret(Node root, const std::filesystem::path& folder, const Settings& settings,
               const FindOpeningNames& find_names, Mistakes& mistakes) {
    for (const std::string& setting : settings) apply_setting(root, setting, mistakes, is_key_of_deck);
    Case c;
    Scope scope;
    scope.mistakes = &mistakes;
    scope.folder = folder;
    read_record(root, table_of<Case>(), &c, scope);
    check_case(c, root, mistakes);
    check_opening_names(c, root, find_names, mistakes);
    return c;
}

std::filesystem::path folder_of(const std::filesystem::path& path) {
    return std::filesystem::absolute(path).lexically_normal().parent_path();
}

}   // namespace

Case parse_case(std::string_view text, const std::string& source, const std::filesystem::path& folder,
                const Settings& settings) {
    Mistakes mistakes;
    Node root = parse_deck(text, source, mistakes);
    Case c = interpret(std::move(root), folder, settings, {}, mistakes);
    if (!mistakes.empty()) refuse(mistakes);
    return c;
}

std::vector<NamedCase> parse_runs(std::string_view text, const std::string& source, const std::filesystem::path& folder,
                                  const Settings& settings, const FindOpeningNames& find_names) {
    Mistakes mistakes;
    Node root = parse_deck(text, source, mistakes);
    const Node* given = root.find("runs");
    if (!given) {
        Case c = interpret(std::move(root), folder, settings, find_names, mistakes);
        if (!mistakes.empty()) refuse(mistakes);
        return {{c.about.name, std::move(c)}};
    }
    const Node runs_node = *given;
    Case holder;
    Scope scope;
    scope.mistakes = &mistakes;
    table_of<Case>().find("runs")->read(runs_node, scope.below("runs"), &holder);
    check_runs(holder, root, mistakes);
    if (holder.runs.size() > most_runs) mistakes.add(runs_node.place, "runs", "more than 1000 runs; use patency sweep");
    if (!mistakes.empty()) refuse(mistakes);

    Mistakes common;   // what is wrong without any run; of these only what a run has too is reported
    interpret(root, folder, settings, {}, common);
    for (std::size_t i = 0; i < root.keys.size(); ++i) {
        if (root.keys[i].text != "runs") continue;
        root.keys.erase(root.keys.begin() + std::ptrdiff_t(i));
        root.items.erase(root.items.begin() + std::ptrdiff_t(i));
        break;
    }
    std::vector<NamedCase> variants;
    for (std::size_t i = 0; i < holder.runs.size(); ++i) {
        Mistakes own;
        Node variant = root;
        const Node& set = *runs_node.items[i].find("set");
        for (std::size_t k = 0; k < set.items.size(); ++k)
            set_at(variant, set.keys[k].text, set.items[k], own, is_key_of_deck);
        variants.push_back({holder.runs[i].name, interpret(std::move(variant), folder, settings, find_names, own)});
        mistakes.merge(own, " (in run " + double_quoted(holder.runs[i].name) + ")", common);
    }
    if (!mistakes.empty()) refuse(mistakes);
    return variants;
}

Case read_case(const std::filesystem::path& path, const Settings& settings) {
    return parse_case(read_deck_text(path), path.string(), folder_of(path), settings);
}

std::vector<NamedCase> read_runs(const std::filesystem::path& path, const Settings& settings,
                                 const FindOpeningNames& find_names) {
    return parse_runs(read_deck_text(path), path.string(), folder_of(path), settings, find_names);
}

std::string format_case(const Case& c, const std::filesystem::path& folder) {
    Scope scope;
    scope.folder = folder;
    Node deck = write_record(table_of<Case>(), &c, scope);
    if (Node* numerics = deck.find("numerics"); numerics && c.numerics.follows_vessel())
        remove_entry(*numerics, "spacing");   // either or
    return format_yaml(deck);
}

void write_case(const Case& c, const std::filesystem::path& path) {
    std::ofstream file(path, std::ios::binary);
    file << format_case(c, folder_of(path));
    file.close();
    if (!file) throw FileError("cannot write " + path.string());
}

}   // namespace patency::deck

// SPDX-License-Identifier: Apache-2.0
// A deck as text without meaning: a tree of scalars, lists and maps that knows where each part stands, and
// the list of what is wrong with it. What keys mean is schema.h's business.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace patency::deck {

/// A spot in a source: a file (line and column from 1), or a command-line setting (line 0).
struct Place {
    std::shared_ptr<const std::string> source;
    int line = 0, column = 0;
};

struct Node {
    enum class Kind { null, scalar, list, map };
    Kind kind = Kind::null;
    std::string text;         ///< of a scalar
    bool in_quotes = false;   ///< a scalar written in quotes is text, whatever it looks like
    Place place;
    std::vector<Node> keys;    ///< of a map, scalars; keys[i] belongs to items[i]
    std::vector<Node> items;   ///< of a map or a list

    const Node* find(std::string_view key) const;
    Node* find(std::string_view key);
};

Node make_scalar(std::string text, bool in_quotes);
Node make_list(std::vector<Node> items);
/// Append a pair to a map (a null node becomes a map).
void add_entry(Node& map, std::string_view key, Node value);
void remove_entry(Node& map, std::string_view key);   ///< if it is there

/// What is wrong with a deck; collected, so that a user sees all of it at once.
class Mistakes {
public:
    /// "file:line:column: key: sentence"
    void add(const Place& place, std::string_view key, std::string_view sentence);
    /// "file:line:column: key is missing: sentence"
    void add_missing(const Place& place, std::string_view key, std::string_view sentence);
    bool empty() const { return mistakes_.empty(); }
    /// A thousand are enough; more are not taken.
    bool are_full() const { return mistakes_.size() >= 1000; }
    std::size_t size() const { return mistakes_.size(); }
    /// Whether something is already known to be wrong at this key, above it or below it.
    bool touch(std::string_view key) const;
    /// Take those of another list that are not yet here; with a note behind those that `common` has not.
    void merge(const Mistakes& other, std::string_view note, const Mistakes& common);
    /// One a line in the order of the deck, then "N mistakes; nothing was run."
    std::string report() const;

private:
    struct Mistake {
        Place place;
        std::string key, sentence;
        std::string note;
    };
    bool has(const Mistake& mistake) const;
    void take(Mistake mistake);

    std::vector<Mistake> mistakes_;
};

/// Where the value at a path like "numerics.spacing" stands, or the nearest thing above it.
Place place_of(const Node& root, std::string_view path);

/// Parse one YAML document. Syntax errors, repeated keys and what a deck may not have (nesting beyond 32,
/// more than 50 000 values once aliases are followed, a second document) become mistakes; the tree is what
/// was understood. Never throws for what the text contains.
Node parse_yaml(std::string_view text, const std::string& source, Mistakes& mistakes);

/// Whether the keys of a path are those of a deck.
using IsKey = std::function<bool(std::span<const std::string>)>;
/// Apply "key.path=value" (the value is YAML; list items by number: "runs.0.name") to a tree.
void apply_setting(Node& root, std::string_view setting, Mistakes& mistakes, const IsKey& is_key);
/// Put a value at a path like "numerics.spacing", making maps on the way. An empty one takes the key away.
void set_at(Node& root, std::string_view path, const Node& value, Mistakes& mistakes, const IsKey& is_key);

/// The tree as YAML text: maps in blocks, lists of scalars and small maps on one line.
std::string format_yaml(const Node& root);
/// The tree as YAML on one line.
std::string format_flow(const Node& node);

}   // namespace patency::deck

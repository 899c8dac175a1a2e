// SPDX-License-Identifier: Apache-2.0
#include "patency/config/document.h"

#include <algorithm>
#include <charconv>
#include <tuple>
#include <utility>

#include "patency/base/text.h"

namespace patency::deck {

namespace {

std::string shown(const Place& place) {
    std::string source = place.source ? *place.source : "deck";
    if (place.line == 0) return source;
    return source + ":" + std::to_string(place.line) + ":" + std::to_string(place.column);
}

// Whether YAML reads the text as one plain scalar in any context.
bool is_safe_plain(std::string_view text) {
    const auto is_word = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    };
    if (text.empty() || text.back() == ' ' || text.starts_with("---") || text.starts_with("...")) return false;
    if (!is_word(text[0]) &&
        (text.size() < 2 || !is_word(text[1]) || std::string_view("+-._/").find(text[0]) == std::string_view::npos))
        return false;
    return std::all_of(text.begin(), text.end(), [&](char c) {
        return is_word(c) || std::string_view("+-._/ ^").find(c) != std::string_view::npos;
    });
}

// As a key, or as text that must not be taken for null.
std::string formatted_key(const std::string& text) {
    const bool is_null = text == "null" || text == "Null" || text == "NULL";
    return is_safe_plain(text) && !is_null ? text : double_quoted(text);
}

std::string formatted_scalar(const Node& node) {
    if (node.kind == Node::Kind::null) return "~";
    return !node.in_quotes && is_safe_plain(node.text) ? node.text : double_quoted(node.text);
}

bool is_leaf(const Node& node) { return node.kind == Node::Kind::scalar || node.kind == Node::Kind::null; }

void add_block(std::string& text, const Node& node, std::size_t indent) {
    const std::string margin(indent, ' ');
    if (node.kind == Node::Kind::map && !node.items.empty()) {
        for (std::size_t i = 0; i < node.items.size(); ++i) {
            const Node& item = node.items[i];
            text += margin + formatted_key(node.keys[i].text) + ":";
            const bool in_line =
                is_leaf(item) || item.items.empty() ||
                (item.kind == Node::Kind::list && std::all_of(item.items.begin(), item.items.end(), is_leaf));
            if (in_line) {
                text += " " + format_flow(item) + "\n";
            } else {
                text += "\n";
                add_block(text, item, indent + 2);
            }
        }
    } else if (node.kind == Node::Kind::list && !node.items.empty()) {
        for (const Node& item : node.items) text += margin + "- " + format_flow(item) + "\n";
    } else {
        text += margin + format_flow(node) + "\n";
    }
}

}   // namespace

const Node* Node::find(std::string_view key) const {
    for (std::size_t i = 0; i < keys.size(); ++i)
        if (keys[i].text == key) return &items[i];
    return nullptr;
}

Node* Node::find(std::string_view key) { return const_cast<Node*>(std::as_const(*this).find(key)); }

Node make_scalar(std::string text, bool in_quotes) {
    Node node;
    node.kind = Node::Kind::scalar;
    node.text = std::move(text);
    node.in_quotes = in_quotes;
    return node;
}

Node make_list(std::vector<Node> items) {
    Node node;
    node.kind = Node::Kind::list;
    node.items = std::move(items);
    return node;
}

void add_entry(Node& map, std::string_view key, Node value) {
    map.kind = Node::Kind::map;
    Node name = make_scalar(std::string(key), false);
    name.place = value.place;
    map.keys.push_back(std::move(name));
    map.items.push_back(std::move(value));
}

void Mistakes::add(const Place& place, std::string_view key, std::string_view sentence) {
    take({place, std::string(key), (key.empty() ? "" : ": ") + std::string(sentence), ""});
}

void Mistakes::add_missing(const Place& place, std::string_view key, std::string_view sentence) {
    take({place, std::string(key), " is missing: " + std::string(sentence), ""});
}

void Mistakes::take(Mistake mistake) {
    if (!are_full()) mistakes_.push_back(std::move(mistake));
}

bool Mistakes::touch(std::string_view key) const {
    const auto is_above = [](std::string_view a, std::string_view b) {
        return a.empty() || (b.starts_with(a) && (b.size() == a.size() || b[a.size()] == '.'));
    };
    return std::any_of(mistakes_.begin(), mistakes_.end(),
                       [&](const Mistake& m) { return is_above(m.key, key) || is_above(key, m.key); });
}

bool Mistakes::has(const Mistake& mistake) const {
    return std::any_of(mistakes_.begin(), mistakes_.end(), [&](const Mistake& m) {
        return m.key == mistake.key && m.sentence == mistake.sentence && shown(m.place) == shown(mistake.place);
    });
}

void Mistakes::merge(const Mistakes& other, std::string_view note, const Mistakes& common) {
    for (const Mistake& mistake : other.mistakes_) {
        if (has(mistake)) continue;
        Mistake noted = mistake;
        if (!common.has(mistake)) noted.note = note;
        take(std::move(noted));
    }
}

std::string Mistakes::report() const {
    std::vector<const Mistake*> ordered;
    for (const Mistake& mistake : mistakes_) ordered.push_back(&mistake);
    std::stable_sort(ordered.begin(), ordered.end(), [](const Mistake* a, const Mistake* b) {
        return std::tie(a->place.line, a->place.column) < std::tie(b->place.line, b->place.column);
    });
    std::string text;
    for (const Mistake* m : ordered) text += shown(m->place) + ": " + m->key + m->sentence + m->note + "\n";
    return text + std::to_string(size()) + (are_full() ? " or more" : "") + (size() == 1 ? " mistake" : " mistakes") +
           "; nothing was run.";
}

Place place_of(const Node& root, std::string_view path) {
    const Node* node = &root;
    for (const std::string& key : split(path, '.')) {
        const Node* below = node->find(key);
        std::size_t index = 0;
        const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), index);
        if (node->kind == Node::Kind::list && error == std::errc() && index < node->items.size())
            below = &node->items[index];
        if (!below) break;
        node = below;
    }
    return node->place;
}

void remove_entry(Node& map, std::string_view key) {
    for (std::size_t i = map.keys.size(); i-- > 0;)
        if (map.keys[i].text == key) {
            map.keys.erase(map.keys.begin() + std::ptrdiff_t(i));
            map.items.erase(map.items.begin() + std::ptrdiff_t(i));
        }
}

void set_at(Node& root, std::string_view path, const Node& value, Mistakes& mistakes, const IsKey& is_key) {
    Node *node = &root, *above = nullptr;
    const std::vector<std::string> keys = split(path, '.');
    for (const std::string& key : keys) {
        above = node;
        if (key.empty()) return mistakes.add(value.place, path, "is not a path of keys like \"numerics.spacing\"");
        if (node->kind == Node::Kind::list) {
            std::size_t index = 0;
            const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), index);
            if (error != std::errc() || end != key.data() + key.size() || index >= node->items.size())
                return mistakes.add(value.place, path,
                                    double_quoted(key) + " is not the number of one of the " +
                                        std::to_string(node->items.size()) + " items of this list; they count from 0");
            node = &node->items[index];
            continue;
        }
        if (node->kind == Node::Kind::scalar)
            return mistakes.add(value.place, path,
                                double_quoted(key) + " cannot be set: what stands above it is a single value");
        if (!node->find(key)) {
            Node empty;
            empty.place = value.place;
            add_entry(*node, key, std::move(empty));
        }
        node = node->find(key);
    }
    *node = value;
    // What no deck has stays, empty as it is, for the reader to name it.
    if (value.kind == Node::Kind::null && above->kind == Node::Kind::map && is_key(keys))
        remove_entry(*above, keys.back());
}

void apply_setting(Node& root, std::string_view setting, Mistakes& mistakes, const IsKey& is_key) {
    const std::string source = "--set " + std::string(setting);
    const Place place{std::make_shared<const std::string>(source), 0, 0};
    const std::size_t equals = setting.find('=');
    if (equals == std::string_view::npos)
        return mistakes.add(place, "", "has no \"=\"; write key.path=value, for example numerics.spacing=\"0.2 mm\"");
    Mistakes own;
    Node value = parse_yaml(setting.substr(equals + 1), source, own);
    if (!own.empty()) return mistakes.add(place, trimmed(setting.substr(0, equals)), "the value is not valid YAML");
    const auto forget_lines = [&](const auto& self, Node& node) -> void {
        node.place = place;
        for (Node& key : node.keys) key.place = place;
        for (Node& item : node.items) self(self, item);
    };
    forget_lines(forget_lines, value);
    set_at(root, trimmed(setting.substr(0, equals)), value, mistakes, is_key);
}

std::string format_flow(const Node& node) {
    if (is_leaf(node)) return formatted_scalar(node);
    const bool is_map = node.kind == Node::Kind::map;
    std::string text = is_map ? "{" : "[";
    for (std::size_t i = 0; i < node.items.size(); ++i) {
        if (i > 0) text += ", ";
        if (is_map) text += formatted_key(node.keys[i].text) + ": ";
        text += format_flow(node.items[i]);
    }
    return text + (is_map ? "}" : "]");
}

std::string format_yaml(const Node& root) {
    std::string text;
    add_block(text, root, 0);
    return text;
}

}   // namespace patency::deck

// SPDX-License-Identifier: Apache-2.0
// YAML text to a tree, through yaml-cpp's events rather than its nodes: the events still show repeated keys,
// quotes and aliases, and let us stop at the first sign of a bomb.
#include <map>
#include <sstream>

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include "patency/base/text.h"
#include "patency/config/document.h"

namespace patency::deck {

namespace {

constexpr int max_depth = 32;                // a deck needs seven
constexpr std::size_t max_values = 50'000;   // a waveform of 10 000 points has 20 000

struct Refused {
    YAML::Mark mark;
    std::string sentence;
};

class TreeBuilder final : public YAML::EventHandler {
public:
    TreeBuilder(std::shared_ptr<const std::string> source, Mistakes& mistakes)
        : source_(std::move(source)), mistakes_(mistakes) {}

    Node take() { return std::move(root_); }
    int documents() const { return documents_; }
    const Place& second_document() const { return second_document_; }

    void OnDocumentStart(const YAML::Mark& mark) override {
        if (++documents_ == 2) second_document_ = place(mark);
    }
    void OnDocumentEnd() override {}
    void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { leaf(mark, anchor, Node{}); }
    void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  const std::string& value) override {
        leaf(mark, anchor, make_scalar(value, tag != "?"));   // yaml-cpp: "?" is a plain scalar, "!" one in quotes
    }
    void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
        const auto known = anchors_.find(anchor);
        if (known == anchors_.end()) throw Refused{mark, "an alias stands inside what it refers to"};
        count(mark, size_of(known->second));
        add(Node(known->second), mark);
    }
    void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                         YAML::EmitterStyle::value) override {
        open(mark, anchor, Node::Kind::list);
    }
    void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                    YAML::EmitterStyle::value) override {
        open(mark, anchor, Node::Kind::map);
    }
    void OnSequenceEnd() override { close(); }
    void OnMapEnd() override { close(); }

private:
    struct Open {   // a list or map that has not ended
        Node node;
        YAML::Mark mark;
        YAML::anchor_t anchor;
        bool has_key = false;                 // of a map: the next event is the value
        std::map<std::string, int> lines{};   // of a map: where each key stands
    };

    Place place(const YAML::Mark& mark) const { return {source_, mark.line + 1, mark.column + 1}; }

    static std::size_t size_of(const Node& node) {
        std::size_t size = 1;
        for (const Node& item : node.items) size += size_of(item);
        return size;
    }

    void count(const YAML::Mark& mark, std::size_t more) {
        values_ += more;
        if (values_ > max_values)
            throw Refused{mark,
                          "more than 50000 values (aliases counted as often as they are used); put tables into files"};
    }

    void open(const YAML::Mark& mark, YAML::anchor_t anchor, Node::Kind kind) {
        if (open_.size() >= max_depth) throw Refused{mark, "nested more than 32 deep"};
        count(mark, 1);
        Node node;
        node.kind = kind;
        node.place = place(mark);
        open_.push_back({std::move(node), mark, anchor});
    }

    void close() {
        Open done = std::move(open_.back());
        open_.pop_back();
        if (done.anchor) anchors_[done.anchor] = done.node;
        add(std::move(done.node), done.mark);
    }

    void leaf(const YAML::Mark& mark, YAML::anchor_t anchor, Node node) {
        count(mark, 1);
        node.place = place(mark);
        if (anchor) anchors_[anchor] = node;
        add(std::move(node), mark);
    }

    void add(Node node, const YAML::Mark& mark) {
        if (open_.empty()) {
            if (documents_ == 1) root_ = std::move(node);
            return;
        }
        Open& parent = open_.back();
        if (parent.node.kind == Node::Kind::list) {
            parent.node.items.push_back(std::move(node));
        } else if (!parent.has_key) {
            if (node.kind != Node::Kind::scalar) throw Refused{mark, "a key must be a single word"};
            parent.node.keys.push_back(std::move(node));
            parent.has_key = true;
        } else {
            add_value(parent, std::move(node));
        }
    }

    void add_value(Open& parent, Node node) {
        parent.has_key = false;
        const Node key = parent.node.keys.back();
        const auto [first, is_new] = parent.lines.emplace(key.text, key.place.line);
        if (!is_new) {
            mistakes_.add(key.place, path_to(key.text),
                          "repeated; it stands already in line " + std::to_string(first->second));
            parent.node.keys.pop_back();
            return;
        }
        parent.node.items.push_back(std::move(node));
    }

    // The path of a key in the innermost open map. What stands above may be a key itself ("? {a: 1}"), which is
    // refused only when it ends, since yaml-cpp also takes what lacks its closing bracket for a key.
    std::string path_to(const std::string& key) const {
        std::string path;
        for (std::size_t i = 0; i + 1 < open_.size(); ++i) {
            const Open& above = open_[i];
            if (above.node.kind == Node::Kind::list)
                path += std::to_string(above.node.items.size());
            else
                path += above.has_key ? above.node.keys.back().text : "?";
            path += '.';
        }
        return path + key;
    }

    std::shared_ptr<const std::string> source_;
    Mistakes& mistakes_;
    Node root_;
    std::vector<Open> open_;
    std::map<YAML::anchor_t, Node> anchors_;
    std::size_t values_ = 0;
    int documents_ = 0;
    Place second_document_;
};

}   // namespace

Node parse_yaml(std::string_view text, const std::string& source_name, Mistakes& mistakes) {
    const auto source = std::make_shared<const std::string>(source_name);
    const Place start{source, 1, 1};
    if (!is_utf8_text(text)) {
        mistakes.add(start, "", "this is not a text file in UTF-8");
        return {};
    }
    TreeBuilder builder(source, mistakes);
    std::istringstream stream{std::string(text)};
    try {
        YAML::Parser parser(stream);
        while (builder.documents() < 2 && parser.HandleNextDocument(builder)) {}
        if (builder.documents() > 1)
            mistakes.add(builder.second_document(), "", "a second document starts here; a deck is one document");
    } catch (const Refused& refused) {
        mistakes.add({source, refused.mark.line + 1, refused.mark.column + 1}, "", refused.sentence);
    } catch (const YAML::Exception& e) {
        const bool has_mark = !e.mark.is_null();
        mistakes.add(has_mark ? Place{source, e.mark.line + 1, e.mark.column + 1} : start, "",
                     "not valid YAML: " + e.msg);
    }
    Node root = builder.take();
    if (!root.place.source) root.place = start;
    return root;
}

}   // namespace patency::deck

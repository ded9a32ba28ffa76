#include "yaml/yaml_node.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <sstream>
#include <utility>

namespace thimble::scene {

YamlNode YamlNode::empty_map() {
  static const auto tree = [] {
    auto made = std::make_shared<Tree>();
    made->items.push_back({.type = Type::kMap});
    return made;
  }();
  return {tree, 0};
}

std::string_view YamlNode::text() const noexcept {
  if (!is_scalar()) return {};
  return std::string_view(tree_->text).substr(item().text, item().text_length);
}

std::size_t YamlNode::size() const noexcept {
  if (is_list()) return item().count;
  return is_map() ? item().count / 2 : 0;
}

YamlNode YamlNode::operator[](std::size_t i) const {
  if (!is_list()) return {};
  std::uint32_t child = item().first;
  while (i-- > 0 && child != kNone) child = tree_->items[child].next;
  return child == kNone ? YamlNode() : YamlNode(tree_, child);
}

/// Builds the tree of one document from the events of the parser, as YAML::Load does.
class YamlTreeBuilder final : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    add(YamlNode::Type::kNull, mark, anchor);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    YamlNode::Item& item = tree_->items[add(YamlNode::Type::kNull, mark, 0)];
    if (anchor >= anchors_.size() || anchors_[anchor] == YamlNode::kNone) return;
    item.first = anchors_[anchor];
    item.alias = true;
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    YamlNode::Item& item = tree_->items[add(YamlNode::Type::kScalar, mark, anchor)];
    // yaml-cpp gives a scalar in quotes the tag "!".
    item.quoted = tag == "!";
    item.text = static_cast<std::uint32_t>(tree_->text.size());
    item.text_length = static_cast<std::uint32_t>(value.size());
    tree_->text += value;
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open_.push_back({add(YamlNode::Type::kList, mark, anchor), YamlNode::kNone});
  }
  void OnSequenceEnd() override { open_.pop_back(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open_.push_back({add(YamlNode::Type::kMap, mark, anchor), YamlNode::kNone});
  }
  void OnMapEnd() override { open_.pop_back(); }

  YamlNode root() const { return tree_->items.empty() ? YamlNode() : YamlNode(tree_, 0); }

 private:
  struct Open {
    std::uint32_t node;
    std::uint32_t last;  // node in it
  };

  std::uint32_t add(YamlNode::Type type, const YAML::Mark& mark, YAML::anchor_t anchor) {
    const auto node = static_cast<std::uint32_t>(tree_->items.size());
    tree_->items.push_back({.line = mark.is_null() ? 0 : mark.line + 1, .type = type});
    if (anchor != 0) {
      if (anchors_.size() <= anchor) anchors_.resize(anchor + 1, YamlNode::kNone);
      anchors_[anchor] = node;
    }
    if (open_.empty()) return node;
    Open& open = open_.back();
    YamlNode::Item& parent = tree_->items[open.node];
    (open.last == YamlNode::kNone ? parent.first : tree_->items[open.last].next) = node;
    ++parent.count;
    open.last = node;
    return node;
  }

  std::shared_ptr<YamlNode::Tree> tree_ = std::make_shared<YamlNode::Tree>();
  std::vector<Open> open_;
  std::vector<std::uint32_t> anchors_;  // by their numbers, from 1
};

namespace {

/// Event handler that records only the line at which a document begins.
class DocumentStart final : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark& mark) override { line_ = mark.line + 1; }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t,
                const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}

  int line() const { return line_; }

 private:
  int line_ = 0;
};

}  // namespace

// Loading all documents might not terminate: before a comma outside of any list, the parser makes
// no progress and returns one empty document after the other.
YamlDocument read_yaml(const std::string& text) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  YamlTreeBuilder builder;
  if (!parser.HandleNextDocument(builder)) return {};
  DocumentStart second;
  if (!parser.HandleNextDocument(second)) return {.root = builder.root()};
  return {.root = builder.root(), .second_begins_at = second.line()};
}

}  // namespace thimble::scene

#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace thimble::scene {

/// Node of a YAML document that was read: a scalar, a list or a map. The document is kept in a few
/// arrays, so a scene of 100,000 objects takes about 50 MB instead of 580. A node shares the
/// document and is cheap to copy. No exceptions are thrown. Real-time: none of these functions may
/// be called from the servo thread.
class YamlNode {
 public:
  /// Kind of a node.
  enum class Type : std::uint8_t { kNull, kScalar, kList, kMap };

  /// Constructs a node without a value.
  YamlNode() = default;
  /// Returns a map without entries, of unknown line.
  static YamlNode empty_map();

  Type type() const noexcept { return tree_ ? item().type : Type::kNull; }
  bool is_null() const noexcept { return type() == Type::kNull; }
  bool is_scalar() const noexcept { return type() == Type::kScalar; }
  bool is_list() const noexcept { return type() == Type::kList; }
  bool is_map() const noexcept { return type() == Type::kMap; }

  /// Returns the line (from 1); 0 if it is unknown.
  int line() const noexcept { return tree_ ? item().line : 0; }
  /// Returns the text of a scalar; empty for other nodes.
  std::string_view text() const noexcept;
  /// Returns whether a scalar is written in quotes.
  bool is_quoted() const noexcept { return tree_ && item().quoted; }
  /// Returns the number of entries of a list or a map.
  std::size_t size() const noexcept;

  /// Calls `visit` with each entry of a list.
  template <class Visit>
  void each_entry(const Visit& visit) const {
    if (!is_list()) return;
    each_child([&](std::uint32_t child) { visit(YamlNode(tree_, child)); });
  }
  /// Calls `visit` with the key and the value of each entry of a map. A key may occur twice.
  template <class Visit>
  void each_pair(const Visit& visit) const {
    if (!is_map()) return;
    std::uint32_t key = 0;
    bool has_key = false;
    each_child([&](std::uint32_t child) {
      if (has_key) visit(YamlNode(tree_, key), YamlNode(tree_, child));
      key = child;
      has_key = !has_key;
    });
  }
  /// Returns entry `i` of a list, one without a value if there is none. The time grows with `i`.
  YamlNode operator[](std::size_t i) const;

 private:
  friend class YamlTreeBuilder;
  static constexpr std::uint32_t kNone = 0xffffffff;

  struct Item {
    std::uint32_t next = kNone;     // next node of the same list or map
    std::uint32_t first = kNone;    // first node in this one; of an alias its target
    std::uint32_t count = 0;        // nodes in this one
    std::uint32_t text = 0;         // begin in `text`
    std::uint32_t text_length = 0;  // of a scalar
    std::int32_t line = 0;
    Type type = Type::kNull;
    bool quoted = false;
    bool alias = false;
  };
  struct Tree {
    std::vector<Item> items;
    std::string text;
  };

  YamlNode(std::shared_ptr<const Tree> tree, std::uint32_t item)
      : tree_(std::move(tree)), item_(item) {
    // No alias has an anchor, so its target is a value.
    if (tree_->items[item_].alias) item_ = tree_->items[item_].first;
  }

  const Item& item() const noexcept { return tree_->items[item_]; }
  template <class Visit>
  void each_child(const Visit& visit) const {
    for (std::uint32_t child = item().first; child != kNone; child = tree_->items[child].next) {
      visit(child);
    }
  }

  std::shared_ptr<const Tree> tree_;
  std::uint32_t item_ = 0;
};

/// Result of reading the first document of a text.
struct YamlDocument {
  YamlNode root;             ///< Root; without a value if the text has no document.
  int second_begins_at = 0;  ///< Line at which a second document begins; 0 if there is none.
};

/// Reads the first document of a text of less than 4 GB. Throws the exceptions of yaml-cpp.
/// Real-time: never from the servo thread.
YamlDocument read_yaml(const std::string& text);

}  // namespace thimble::scene

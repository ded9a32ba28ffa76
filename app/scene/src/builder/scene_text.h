#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "thimble/scene/scene_builder.h"

namespace thimble::scene {

/// Text of a scene file, written from the values of a SceneBuilder: one key per line, so that each
/// line has one place. Real-time: never from the servo thread.
class SceneText {
 public:
  /// Writes the whole scene.
  explicit SceneText(const SceneMap& scene);

  /// Returns the place of an entry of a list: "object 2 'cube'". `number`: from 1.
  static std::string entry_place(std::string_view list, std::size_t number,
                                 const SceneValue& entry);

  /// Returns the text.
  const std::string& text() const noexcept { return text_; }
  /// Returns the place of each line (from 1): "object 2 'cube': body". Entry 0 is that of the whole
  /// scene.
  const std::vector<std::string>& places() const noexcept { return places_; }

 private:
  void write_map(const SceneValue& map, std::size_t indent, std::string_view begin,
                 const std::string& place);
  void write_value(const std::string& key, const SceneValue& value, std::size_t indent,
                   const std::string& place);
  void add_line(const std::string& line, const std::string& place);

  std::string text_;
  std::vector<std::string> places_;
};

}  // namespace thimble::scene

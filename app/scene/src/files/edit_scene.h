#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::scene {

/// A number of a scene's file as it shall be.
struct SceneNumber {
  std::string object;   ///< Whose it is, by its name.
  std::string group;    ///< Of the effect whose it is ("friction"); empty: the object's own.
  std::string key;      ///< Under which it stands.
  int which = 1;        ///< Of the object's effects of that group with that key, counted from 1.
  double value = 0;     ///< What it shall be.
  bool scales = false;  ///< `value` is a factor of what stands there.
};

/// A scene's text with other numbers.
struct EditedScene {
  std::string text;
  std::vector<std::size_t> absent;  ///< Which of the numbers have no key in it.
};

/// Returns a scene's text with numbers put where they belong; comments, order and all else stay as
/// they are. The error says what is wrong with the text. Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<EditedScene> put_numbers(const std::string& text,
                                                       const std::vector<SceneNumber>& numbers);

/// Returns a scene's text for another folder: what names a file beside the scene, in `folder`,
/// names it by its whole path then. As above.
THIMBLE_EXPORT driver::Result<std::string> with_whole_paths(const std::string& text,
                                                            const std::filesystem::path& folder);

/// Returns whether a scene came with Thimble: it lies in one of the folders where names are looked
/// for (shipped_files.h) other than the user's own. Real-time: never from the servo thread.
THIMBLE_EXPORT bool is_shipped_scene(const std::filesystem::path& file);

}  // namespace thimble::scene

#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::scene {

/// New value of a number in a scene file.
struct SceneNumber {
  std::string object;   ///< Name of the object.
  std::string group;    ///< Group of the effect ("friction"); empty: the object itself.
  std::string key;      ///< Key of the number.
  int which = 1;        ///< Number of the effect among those of that group with that key, from 1.
  double value = 0;     ///< New value.
  bool scales = false;  ///< True if `value` is a factor on the existing value.
};

/// Text of a scene with new numbers.
struct EditedScene {
  std::string text;
  std::vector<std::size_t> absent;  ///< Indices of the numbers without a key in the text.
};

/// Returns the text of a scene with numbers replaced; comments, order and all other text are kept.
/// The error describes the fault of the text. Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<EditedScene> put_numbers(const std::string& text,
                                                       const std::vector<SceneNumber>& numbers);

/// Returns the text of a scene for use in another folder: relative names of files in `folder`
/// become absolute paths. The error describes the fault of the text. Real-time: never from the
/// servo thread.
THIMBLE_EXPORT driver::Result<std::string> with_whole_paths(const std::string& text,
                                                            const std::filesystem::path& folder);

/// Returns whether a scene was shipped with Thimble: it is in one of the search folders
/// (shipped_files.h) other than the user's. Real-time: never from the servo thread.
THIMBLE_EXPORT bool is_shipped_scene(const std::filesystem::path& file);

}  // namespace thimble::scene

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::scene {

// Scenes and arm files are known by name: "elephant" is elephant.yaml in the first folder that has
// it. Folders, in this order: the user's own, $XDG_DATA_HOME/thimble; what came with this program
// or library, found from where it lies, or for another program from where the libraries were
// installed; and thimble/ below each folder of $XDG_DATA_DIRS [XDG Base Directory Specification].
// Each has scenes/ and arms/. Arm files are looked for in own_arm_folder() first. The working
// folder is never searched: a file there is used only if the user names it as a path, with a slash
// or an extension.
//
// Two of these folders count as installed: own_arm_folder(), and arms/ of what came with this
// program. Only arm files there set the limits of a real arm (arm_policy/limits_policy.h).
// Real-time: never from the servo thread.

/// A scene or arm file that is known by name.
struct ShippedFile {
  std::string name;            ///< What it is known by.
  std::filesystem::path path;  ///< The file.
};

/// Returns the scenes that are known by name, each name once, in the order of the alphabet.
THIMBLE_EXPORT std::vector<ShippedFile> shipped_scenes();
/// Returns the arm files that are known by name, as above.
THIMBLE_EXPORT std::vector<ShippedFile> shipped_arms();

/// Returns the installed arm files, each name once; the user's own replace those that came with the
/// program.
THIMBLE_EXPORT std::vector<ShippedFile> installed_arms();
/// Returns whether an arm file is one of `installed_arms`. One that the user's own replaces is not.
THIMBLE_EXPORT bool is_installed_arm(const std::filesystem::path& file);

/// Returns what a scene or arm file says of itself under `description`; empty if it says nothing,
/// or cannot be read.
THIMBLE_EXPORT std::string description_of(const std::filesystem::path& file);

/// Returns the file of the scene that a user means. A word with a / is a path and is returned as it
/// is, whether the file exists or not; a word with an extension is a file of the working folder if
/// that exists; any other word is a name first, and a file of the working folder if none has that
/// name. The error lists the names.
THIMBLE_EXPORT driver::Result<std::filesystem::path> find_scene(const std::string& meant);
/// Returns the arm file that a user means, as above.
THIMBLE_EXPORT driver::Result<std::filesystem::path> find_arm_file(const std::string& meant);

}  // namespace thimble::scene

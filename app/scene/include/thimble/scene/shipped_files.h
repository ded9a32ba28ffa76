#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::scene {

// Scenes and arm files are found by name: "elephant" is elephant.yaml in the first folder that
// contains it. The first folder is the user's, $XDG_DATA_HOME/thimble. The second contains the data
// of this program or library, found relative to its own location. In other programs it is found
// relative to the folder into which the libraries were installed. Last is thimble/ in each folder
// of $XDG_DATA_DIRS [XDG Base Directory Specification]. Each has scenes/ and arms/. Arm files are
// searched in own_arm_folder() first. The working folder is never searched: a file there is used
// only if it is given as a path, with a slash or an extension.
//
// Two of these folders count as installed: own_arm_folder(), and arms/ in the data of this program.
// Only arm files there set the limits of a real arm (arm_policy/limits_policy.h). Real-time: none
// of these functions may be called from the servo thread.

/// A scene or arm file that can be found by name.
struct ShippedFile {
  std::string name;            ///< Name without extension.
  std::filesystem::path path;  ///< Path of the file.
};

/// Returns the scenes that can be found by name, each name once, in alphabetical order.
THIMBLE_EXPORT std::vector<ShippedFile> shipped_scenes();
/// Returns the arm files that can be found by name, each name once, in alphabetical order.
THIMBLE_EXPORT std::vector<ShippedFile> shipped_arms();

/// Returns the installed arm files, each name once. The user's files take precedence over those of
/// the program.
THIMBLE_EXPORT std::vector<ShippedFile> installed_arms();
/// Returns whether an arm file is one of `installed_arms`. A file of the program that a user's file
/// replaces is not.
THIMBLE_EXPORT bool is_installed_arm(const std::filesystem::path& file);

/// Returns the value of `description` in a scene or arm file; empty if it is missing or the file
/// cannot be read.
THIMBLE_EXPORT std::string description_of(const std::filesystem::path& file);

/// Returns the scene file for a name or path. An argument with a / is a path and is returned
/// unchanged, even if no file exists. An argument with an extension is a file of the working folder
/// if that file exists. Any other argument is a name; if no scene has that name, it is a file of
/// the working folder. The error lists the names.
THIMBLE_EXPORT driver::Result<std::filesystem::path> find_scene(const std::string& meant);
/// Returns the arm file for a name or path, by the same rules.
THIMBLE_EXPORT driver::Result<std::filesystem::path> find_arm_file(const std::string& meant);

}  // namespace thimble::scene

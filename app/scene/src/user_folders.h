#pragma once

#include <filesystem>
#include <string>

#include "thimble/driver/export.h"

namespace thimble::scene {

// If HOME is not set, the home folder is that of the system's user database (getpwuid). If that has
// none, the folders below are at a place that is not writable. Relative paths in these variables
// are ignored.

/// Returns the folder of the user's settings: $XDG_CONFIG_HOME/thimble, or ~/.config/thimble [XDG
/// Base Directory Specification].
std::filesystem::path config_folder();

/// Returns the folder of data that Thimble stores for the user: $XDG_STATE_HOME/thimble, or
/// ~/.local/state/thimble [XDG Base Directory Specification].
THIMBLE_EXPORT std::filesystem::path state_folder();

/// Returns the folder of data that can be recreated: $XDG_CACHE_HOME/thimble, or ~/.cache/thimble
/// [XDG Base Directory Specification].
THIMBLE_EXPORT std::filesystem::path cache_folder();

/// Returns the folder of the user's scenes and arm files: $XDG_DATA_HOME/thimble, or
/// ~/.local/share/thimble [XDG Base Directory Specification].
THIMBLE_EXPORT std::filesystem::path data_folder();

/// Returns the folder of arm files installed by the user: config_folder()/arm_files. Like the arm
/// files of the program, they set the limits of a real arm, so only files checked for that arm
/// belong there. Calibrations are in another folder (config_folder()/arms).
std::filesystem::path own_arm_folder();

/// Converts a name into a safe file name: characters other than letters, digits, - and _ become _.
THIMBLE_EXPORT std::string as_file_name(const std::string& name);

}  // namespace thimble::scene

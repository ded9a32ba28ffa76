#pragma once

#include <filesystem>
#include <string>

#include "thimble/driver/export.h"

namespace thimble::scene {

// Where HOME is not set, the system's list of users names the home (getpwuid); where that has none
// either, the folders below lie at a place where nothing can be written. Relative paths in these
// variables are ignored.

/// Returns where a user's settings for Thimble lie: $XDG_CONFIG_HOME/thimble, or
/// ~/.config/thimble [XDG Base Directory Specification].
std::filesystem::path config_folder();

/// Returns where what Thimble keeps on a user's behalf lies: $XDG_STATE_HOME/thimble, or
/// ~/.local/state/thimble [XDG Base Directory Specification].
THIMBLE_EXPORT std::filesystem::path state_folder();

/// Returns where what can be made anew lies: $XDG_CACHE_HOME/thimble, or ~/.cache/thimble [XDG Base
/// Directory Specification].
std::filesystem::path cache_folder();

/// Returns where a user's own scenes and arm files lie: $XDG_DATA_HOME/thimble, or
/// ~/.local/share/thimble [XDG Base Directory Specification].
THIMBLE_EXPORT std::filesystem::path data_folder();

/// Returns the folder of arm files that this user installed: config_folder()/arm_files. As those
/// that come with the program, they set the limits of a real arm, so a file is put there only by
/// whoever checked it for that arm. Calibrations lie elsewhere (config_folder()/arms).
std::filesystem::path own_arm_folder();

/// Turns any name into one that is safe as a file's: other signs than letters, digits, - and _
/// become _.
THIMBLE_EXPORT std::string as_file_name(const std::string& name);

}  // namespace thimble::scene

#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::scene {

// The folder of the mesh cache. All other files in it are left alone. Real-time: never from the
// servo thread.

/// Returns the default folder: cache_folder()/prepared.
THIMBLE_EXPORT std::filesystem::path default_mesh_cache();

/// Returns the folder that THIMBLE_MESH_CACHE in the environment selects: 1 the default one, an
/// absolute path that one. None if it is not set, empty, 0, or something else, which is logged.
THIMBLE_EXPORT std::optional<std::filesystem::path> mesh_cache_of_environment();

/// Returns the folder that is used if the cache is turned on: that of the environment, or the
/// default one.
THIMBLE_EXPORT std::filesystem::path chosen_mesh_cache();

/// Returns the file of an entry by its key.
std::filesystem::path entry_file(const std::filesystem::path& folder, std::string_view key);

/// Creates the folder if it does not exist, for its owner only.
driver::Result<void> make_cache_folder(const std::filesystem::path& folder);

/// Returns an error if the folder exists but cannot be read.
THIMBLE_EXPORT driver::Result<void> check_cache_folder(const std::filesystem::path& folder);

/// One entry of the folder.
struct EntryFile {
  std::filesystem::path file;
  std::uint64_t bytes = 0;
  std::filesystem::file_time_type used;  ///< Time of its last use.
};

/// Returns the entries of the folder, the one used last first. None if there is no folder.
THIMBLE_EXPORT std::vector<EntryFile> cache_entries(const std::filesystem::path& folder);

/// Returns a description of an entry: "elephant.off, 1000000 triangles"; empty if it is damaged or
/// of another version. The name is that of a file of unknown origin.
THIMBLE_EXPORT std::string describe_entry(const std::filesystem::path& file);

/// Removes the entries that were used first until all of them take at most `bytes_max`, and parts
/// that writers left behind. Other processes may use the folder at the same time.
THIMBLE_EXPORT void limit_cache(const std::filesystem::path& folder, std::uint64_t bytes_max);

}  // namespace thimble::scene

#pragma once

#include <filesystem>

#include "yaml/yaml_reader.h"

namespace thimble::scene {

// What a scene's keys mean by a file. `folder` is the scene's own; a file that is not there is a
// mistake of the key's line. Real-time: never from the servo thread.

/// Returns the file that `mesh:` means: a path beside the scene; a file's name that
/// is not there, among the scenes of `data_folders`, so that a copied scene finds its mesh; or
/// `cgal:NAME`, a scan in `mesh_folder`; if that is empty, as `find_scan` finds it.
std::filesystem::path find_mesh_file(YamlMap& map, const std::filesystem::path& folder,
                                     const std::filesystem::path& mesh_folder);

/// Returns the file that `arm:` means: a path beside the scene, or else a name as on the command
/// line.
std::filesystem::path find_own_arm_file(YamlMap& map, const std::filesystem::path& folder);

}  // namespace thimble::scene

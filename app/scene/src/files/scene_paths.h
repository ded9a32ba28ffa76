#pragma once

#include <filesystem>
#include <string>

#include "yaml/yaml_reader.h"

namespace thimble::scene {

// Resolution of file names in scenes. `folder` is that of the scene; a missing file is a mistake in
// the line of the key. Real-time: none of these functions may be called from the servo thread.

/// Returns the file of a name: a path relative to the scene, or, if that does not exist, a file of
/// that name among the scenes of `data_folders`, so that a copied scene finds its files.
std::filesystem::path find_scene_file(const std::filesystem::path& folder, const std::string& name);

/// Returns the file for `mesh:`. It is found as by `find_scene_file`.
/// `cgal:NAME` is a scan in `mesh_folder`, or, if that is empty, found by `find_scan`.
std::filesystem::path find_mesh_file(YamlMap& map, const std::filesystem::path& folder,
                                     const std::filesystem::path& mesh_folder);

/// Returns the file for `arm:`: a path relative to the scene, or a name as on the command line.
std::filesystem::path find_own_arm_file(YamlMap& map, const std::filesystem::path& folder);

}  // namespace thimble::scene

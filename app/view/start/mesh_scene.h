#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "thimble/driver/result.h"

namespace thimble::view {

/// How a mesh is touched. The defaults suit the arm of the scene, the vintage Phantom.
struct MeshTouch {
  double size = 0.1;       ///< Largest side of the mesh, m [chosen: half of the arm's workspace].
  double stiffness = 600;  ///< N/m [chosen: below the arm's limit of 800, as the tin can].
  char up = 'z';           ///< Axis of the file that points up: x, y or z.
  bool operator==(const MeshTouch&) const = default;
};

/// Limits of the fields above, for the start window. [chosen: what the arm reaches; what is felt as
/// soft, and the limit of the arm]
inline constexpr double kMeshSizeMin = 0.02, kMeshSizeMax = 0.15;          // m
inline constexpr double kMeshStiffnessMin = 100, kMeshStiffnessMax = 800;  // N/m

/// A scene in which a hand strokes a mesh.
struct MeshScene {
  std::string name;
  std::string text;                ///< YAML.
  std::vector<std::string> notes;  ///< Repairs and assumptions, one sentence each.
};

/// Returns suitable values for a mesh file: its real size, if the file has a unit and the arm can
/// reach around it; the axis that is up in its format. The error names a file that cannot be read.
/// Real-time: never from the servo thread.
driver::Result<MeshTouch> suggest_touch(const std::filesystem::path& mesh);

/// Returns a scene that touches a mesh. It repairs the mesh, and makes open parts thin bodies, if
/// the mesh needs it. `draft` is a file that is written while the scene is checked, and contains it
/// afterwards. The error says why the mesh cannot be touched. Real-time: never from the servo
/// thread.
driver::Result<MeshScene> make_mesh_scene(const std::filesystem::path& mesh, const MeshTouch& touch,
                                          const std::filesystem::path& draft);

/// Writes a scene into the user's folder of scenes under a name, and returns its path. An existing
/// file is never replaced. The error says what to do: the name is empty, or it exists. Real-time:
/// never from the servo thread.
driver::Result<std::filesystem::path> save_mesh_scene(const MeshScene& scene,
                                                      const std::string& name);

/// Returns the draft of a mesh's scene, in the user's state folder.
std::filesystem::path draft_of(const std::filesystem::path& mesh);

}  // namespace thimble::view

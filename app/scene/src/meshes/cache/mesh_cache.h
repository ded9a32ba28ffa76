#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "meshes/object_mesh.h"
#include "still_surface.h"
#include "thimble/driver/export.h"
#include "thimble/render/build_object_touch.h"
#include "thimble/render/contact_choice.h"
#include "thimble/scene/scene_file.h"
#include "thimble/scene/shared_meshes.h"

namespace thimble::scene {

/// Prepared meshes on disk, for later runs. A mesh is stored as it is after reading, repair and
/// placement, with the tracker that suits it. A surface is stored as packed triangles and a tree,
/// for the tracker `compact`; those of other trackers are prepared again from the stored mesh.
///
/// The key of a mesh consists of this program, the contents of the file and all settings of the
/// object that determine the mesh; that of a surface also has the contact settings. What is read is
/// bit-identical to what was stored. An entry that cannot be used is logged, and the mesh prepared
/// again. If nothing can be written, this is logged once. Not thread-safe. Real-time: never from
/// the servo thread.
class THIMBLE_EXPORT MeshCache {
 public:
  explicit MeshCache(MeshCacheChoice choice) : choice_(std::move(choice)) {}

  /// Mesh of an object as it was stored.
  struct Mesh {
    ObjectMesh mesh;
    render::ChosenTracker tracker;  ///< Of choose_tracker for the mesh alone.
  };

  /// Returns the key of the mesh of an object. Empty if it is not stored: the object is not from a
  /// file, needs maps, or its file cannot be read.
  static std::string key_of(const SceneObject& object);
  /// Returns the key of a surface over the mesh with the key `mesh_key`.
  static std::string key_of(const std::string& mesh_key, const render::ContactChoice& contact);

  /// Returns whether a mesh is stored: it has enough triangles, and its file is one that Thimble
  /// reads by itself and without other files.
  bool stores(const ObjectMesh& mesh) const;

  /// Returns the mesh of an object; none if it is not stored.
  std::optional<Mesh> find_mesh(const SceneObject& object, const std::string& key);
  /// Stores the mesh of an object.
  void keep_mesh(const SceneObject& object, const ObjectMesh& mesh,
                 const render::ChosenTracker& tracker);
  /// Returns a surface over a stored mesh; none if it is not stored.
  std::optional<render::StillSurface> find_surface(const ObjectMesh& mesh,
                                                   const render::ContactChoice& contact);
  /// Stores a surface over a stored mesh, if it can be stored. `mesh_file` is for lists of entries.
  void keep_surface(const std::filesystem::path& mesh_file, const ObjectMesh& mesh,
                    const render::ContactChoice& contact, const render::StillSurface& still);

 private:
  void keep(const std::string& key, std::string_view text,
            std::span<const std::span<const std::byte>> arrays);

  MeshCacheChoice choice_;
  bool writes_ = true;  // false after writing has failed
};

}  // namespace thimble::scene

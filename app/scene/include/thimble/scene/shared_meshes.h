#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/contact_choice.h"
#include "thimble/render/mesh/triangle_mesh.h"
#include "thimble/scene/hand_route.h"

namespace thimble::render {
struct ChosenTracker;
struct StillSurface;
}  // namespace thimble::render

namespace thimble::scene {

struct ObjectMesh;
struct SceneObject;

/// Folder on disk in which meshes are stored as they are when they are ready to be touched, so that
/// later runs start sooner. Runs are bit-identical with and without it. Damaged, foreign and old
/// files in it are never used, and a folder that cannot be written stops no run.
struct MeshCacheChoice {
  std::filesystem::path folder;           ///< Created if it does not exist, for its owner only.
  std::size_t triangles_min = 1'000'000;  ///< Meshes with fewer triangles are not stored.
  /// Largest size of all stored meshes, bytes; those that were used first are removed. [chosen: 20
  /// meshes of 10^6 triangles, at 98 MB]
  std::uint64_t bytes_max = std::uint64_t{2} << 30;
};

/// Store of data that similar scenes share and no run changes: meshes in the world, their
/// acceleration structures, and the paths of hands over them. Each entry is made on first request,
/// once per combination of file, place, size and contact settings. A file whose size or
/// modification time has changed is read again.
///
/// The caller that runs the scenes owns the store (SessionOptions::meshes). The store keeps its
/// entries until it is destroyed or `drop_unused` is called; returned pointers stay valid beyond
/// that. Dents, flow, motion and contact state are never shared. Any thread may call it; a call
/// waits if another thread is making the same entry. Real-time: never from the servo thread.
class THIMBLE_EXPORT SharedMeshes {
 public:
  SharedMeshes();
  /// Also stores large meshes on disk, and reads those that an earlier run has stored.
  explicit SharedMeshes(MeshCacheChoice cache);
  ~SharedMeshes();
  SharedMeshes(const SharedMeshes&) = delete;
  SharedMeshes& operator=(const SharedMeshes&) = delete;

  /// Returns the number of meshes held: of objects, shapes and whole scenes.
  std::size_t meshes() const;
  /// Returns the number of surfaces held that are ready to be touched.
  std::size_t surfaces() const;
  /// Releases entries without other owners.
  void drop_unused();

  // Functions for building scenes (scene_objects.h).

  /// Returns the mesh of an object with a mesh file. The error is that of load_object_mesh.
  driver::Result<std::shared_ptr<const ObjectMesh>> object_mesh(const SceneObject& object);
  /// Returns the tracker that suits a mesh of this store (render::choose_tracker), with no other
  /// setting than its crease angle.
  std::shared_ptr<const render::ChosenTracker> tracker(
      const std::shared_ptr<const ObjectMesh>& mesh);
  /// Returns a shared mesh with the same contents.
  std::shared_ptr<const render::TriangleMesh> mesh_like(const render::TriangleMesh& mesh_W);
  /// Returns several meshes of this store as one, in the given order; a single mesh is returned
  /// itself.
  std::shared_ptr<const render::TriangleMesh> joined(
      const std::vector<std::shared_ptr<const render::TriangleMesh>>& meshes_W);
  /// Returns a mesh of this store ready to be touched. The error is that of prepare_still_surface.
  driver::Result<std::shared_ptr<const render::StillSurface>> surface(
      const std::shared_ptr<const render::TriangleMesh>& mesh_W,
      const render::ContactChoice& contact);
  /// Returns the path of a hand. `objects` are meshes of this store with the names that the
  /// waypoints use. The error is that of plan_hand.
  driver::Result<std::shared_ptr<const HandRoute>> hand_route(
      const std::vector<HandWaypoint>& waypoints,
      const std::vector<std::pair<std::string, std::shared_ptr<const render::TriangleMesh>>>&
          objects);

 private:
  struct Held;

  std::unique_ptr<Held> held_;
};

}  // namespace thimble::scene

#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/contact_choice.h"
#include "thimble/render/mesh/triangle_mesh.h"
#include "thimble/render/page/paging_counters.h"
#include "thimble/render/scene_touch.h"
#include "thimble/scene/scene_file.h"

namespace thimble::render {
class CollisionSurfaces;
struct MapPicture;
class PagedSurface;
class SharedBody;
}  // namespace thimble::render

namespace thimble::scene {

class SharedMeshes;

/// Offsets of an object in a combined mesh.
struct MeshPlace {
  std::size_t vertex = 0;    ///< Index of the first vertex.
  std::size_t triangle = 0;  ///< Index of the first triangle.
};

/// Tracker of an object that is a mesh in memory.
struct ObjectTracker {
  std::size_t object = 0;         ///< Index of the object in the scene.
  render::ContactChoice contact;  ///< Contact settings with which the object is touched.
  /// True if the tracker was chosen; false if it was named, or if the tip has a radius and uses
  /// none.
  bool chosen = false;
  std::string reason;  ///< Reason of the choice in a few words; empty if `chosen` is false.
};

/// Objects of a scene, loaded and ready to be touched.
class THIMBLE_EXPORT SceneObjects {
 public:
  /// Reads the meshes and builds the force law of the scene. `meshes`, if set, provides the meshes
  /// and the acceleration structures that no touch changes; if null, the scene has its own. The
  /// error names the object and the fix. Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<SceneObjects>> build(
      const Scene& scene, const std::shared_ptr<SharedMeshes>& meshes = nullptr);

  ~SceneObjects();
  SceneObjects(const SceneObjects&) = delete;
  SceneObjects& operator=(const SceneObjects&) = delete;

  /// Returns the force law of the whole scene for one arm.
  render::SceneTouch& touch(std::size_t arm = 0) const { return *touches_[arm]; }
  /// Advances the bodies that several arms touch by `step` (s). Does nothing with one arm, whose
  /// force law moves the bodies. Call once per tick, after the force laws of all arms. Real-time:
  /// safe.
  void step_bodies(double step) noexcept;
  /// Returns the bodies that several arms touch: one for each object that moves, in the order of
  /// `moving`, or one for all that may meet; empty with one arm.
  std::span<const std::shared_ptr<render::SharedBody>> shared_bodies() const { return bodies_; }

  // A shape has no mesh until one of the following functions is called: it is touched without.
  // The mesh is then made once. Any thread. Real-time: never from the servo thread.

  /// Returns the initial meshes of all objects as one, in the world, m. Includes touched meshes and
  /// the meshes that represent shapes; excludes objects paged from disk.
  const render::TriangleMesh& mesh_W() const;
  /// Returns the initial mesh of one object, in the world, m; empty for a field and for an object
  /// paged from disk.
  const render::TriangleMesh& mesh_W(std::size_t object) const { return *shared_mesh_W(object); }
  /// Returns the same mesh as a shared pointer, to keep it or to compare it with that of another
  /// scene.
  const std::shared_ptr<const render::TriangleMesh>& shared_mesh_W(std::size_t object) const;
  /// Returns the offsets of an object in `mesh_W`.
  const MeshPlace& place(std::size_t object) const;

  /// Returns the surface of the shape with which an object collides, at the initial place (W, m).
  /// The same pointer as `shared_mesh_W`: it collides with its own shape or mesh. Null: it meets
  /// nothing.
  std::shared_ptr<const render::TriangleMesh> collision_mesh_W(std::size_t object) const;

  /// Returns the map of an object, sampled for drawing; empty if it has none. `scene` is that of
  /// `build`.
  std::optional<render::MapPicture> map_picture(const Scene& scene, std::size_t object) const;

  /// Returns the current mesh of one object, moved and deformed (W, m). If `object` is negative,
  /// returns all objects as one mesh. Not while the servo runs.
  render::TriangleMesh mesh_now(int object = -1) const;
  /// Returns the deformed mesh of one object at its initial place. Apply the object's `pose` to
  /// draw it (B, m). Not while the servo runs.
  render::TriangleMesh mesh_bent(std::size_t object) const;
  /// Returns the number of touchable triangles, in memory and on disk.
  std::size_t triangles() const { return triangles_; }
  /// Returns notes on mesh repairs, omissions and assumptions, one sentence each.
  const std::vector<std::string>& notes() const { return notes_; }
  /// Returns the trackers of all objects that are meshes in memory, in the order of the scene.
  const std::vector<ObjectTracker>& trackers() const { return trackers_; }
  /// Returns a line for each group of objects with the same chosen tracker and reason, such as
  /// "elephant: compact (smooth: ...)". `scene` is that of `build`. Objects that name their tracker
  /// are omitted. Real-time: never from the servo thread.
  std::vector<std::string> tracker_notes(const Scene& scene) const;
  /// Returns the indices of the objects that move.
  std::span<const std::size_t> moving() const { return moving_; }

  /// Starts the threads that load disk pages. Real-time: never from the servo thread.
  void start_loaders();
  /// Loads all requested disk pages on the caller's thread. For virtual time, between two ticks.
  /// Real-time: no.
  void serve_pages() noexcept;
  /// Returns the disk paging counters of all objects; empty if no object is paged.
  std::optional<render::PagingCounters> paging() const;
  /// Fails if pages of a page file could not be read; the error names each such file and the fix.
  /// `scene` is that of `build`. Real-time: never from the servo thread.
  driver::Result<void> check_pages(const Scene& scene) const;

 private:
  using Touches = std::vector<std::vector<std::unique_ptr<render::ObjectTouch>>>;
  SceneObjects();
  driver::Result<void> let_meet(const Scene& scene, Touches& touches);

  std::vector<std::shared_ptr<render::PagedSurface>> pages_;  // Of the objects paged from disk.
  std::vector<std::unique_ptr<render::SceneTouch>> touches_;  // One per arm.
  std::vector<std::shared_ptr<render::SharedBody>> bodies_;
  std::shared_ptr<const render::CollisionSurfaces> collision_surfaces_;  // Null: nothing meets.
  std::vector<int> colliding_;  // Number of each object there; -1: it meets nothing.
  struct Meshes;
  std::unique_ptr<Meshes> meshes_;
  std::vector<std::size_t> moving_;
  std::size_t triangles_ = 0;
  std::vector<std::string> notes_;
  std::vector<ObjectTracker> trackers_;
};

}  // namespace thimble::scene

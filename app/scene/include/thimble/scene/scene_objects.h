#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/mesh/triangle_mesh.h"
#include "thimble/render/page/paging_counters.h"
#include "thimble/render/scene_touch.h"
#include "thimble/scene/scene_file.h"

namespace thimble::render {
class PagedSurface;
class SharedBody;
}  // namespace thimble::render

namespace thimble::scene {

class SharedMeshes;

/// Where an object begins in a mesh of several.
struct MeshPlace {
  std::size_t vertex = 0;    ///< Its first vertex.
  std::size_t triangle = 0;  ///< Its first triangle.
};

/// What stands in a scene, loaded and ready to be touched.
class THIMBLE_EXPORT SceneObjects {
 public:
  /// Reads the meshes and builds the force law that the scene calls for. The error names the object
  /// and what to mend. Meshes, and what is built over them and no touch changes, are those of
  /// `meshes`; without it this scene has its own. Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<SceneObjects>> build(
      const Scene& scene, const std::shared_ptr<SharedMeshes>& meshes = nullptr);

  /// Returns the force law of the whole scene, on one of its arms.
  render::SceneTouch& touch(std::size_t arm = 0) const { return *touches_[arm]; }
  /// Moves on, by `step` s, the bodies that several arms touch; with one arm its force law does
  /// that. Once, after the laws of all arms. Real-time: safe.
  void step_bodies(double step) noexcept;
  /// Returns the bodies that several arms touch, in the order of `moving`; none with one arm.
  std::span<const std::shared_ptr<render::SharedBody>> shared_bodies() const { return bodies_; }
  /// Returns the meshes of all objects in the world as one (m), as they are at first: those that
  /// are touched, and those that stand for shapes; those on the disk are not in it.
  const render::TriangleMesh& mesh_W() const { return *mesh_W_; }
  /// Returns the mesh of one object alone; empty for a field and for one on the disk.
  const render::TriangleMesh& mesh_W(std::size_t object) const { return *meshes_W_[object]; }
  /// Returns the same for who keeps it, or compares it with that of another scene.
  const std::shared_ptr<const render::TriangleMesh>& shared_mesh_W(std::size_t object) const {
    return meshes_W_[object];
  }
  /// Returns where an object begins in `mesh_W`.
  const MeshPlace& place(std::size_t object) const { return places_[object]; }
  /// Returns the mesh of one object, or of all as one if `object` is negative, where it is now:
  /// moved and bent (W, m). Not beside a running servo.
  render::TriangleMesh mesh_now(int object = -1) const;
  /// Returns the mesh of one object as it is bent now, where the object was at first: whoever draws
  /// it moves it to the object's `pose` (B, m). Not beside a running servo.
  render::TriangleMesh mesh_bent(std::size_t object) const;
  /// Returns how many triangles can be touched, in memory and on the disk.
  std::size_t triangles() const { return triangles_; }
  /// Returns what was put right, left out or guessed of the meshes, a sentence each.
  const std::vector<std::string>& notes() const { return notes_; }
  /// Returns the objects that move.
  std::span<const std::size_t> moving() const { return moving_; }

  /// Lets threads load pages from now on. Real-time: never from the servo thread.
  void start_loaders();
  /// Loads every page that is asked for, on the caller's thread: for virtual
  /// time, between two ticks. Real-time: no.
  void serve_pages() noexcept;
  /// Returns what paging did for all objects on the disk; nothing if there are none.
  std::optional<render::PagingCounters> paging() const;

 private:
  SceneObjects() = default;

  std::vector<std::shared_ptr<render::PagedSurface>> pages_;  // of the objects on the disk
  std::vector<std::unique_ptr<render::SceneTouch>> touches_;  // one for each arm
  std::vector<std::shared_ptr<render::SharedBody>> bodies_;
  std::vector<std::shared_ptr<const render::TriangleMesh>> meshes_W_;  // of each object
  std::shared_ptr<const render::TriangleMesh> mesh_W_;                 // of all
  std::vector<MeshPlace> places_;  // of each object in mesh_W_, and of its end
  std::vector<std::size_t> moving_;
  std::size_t triangles_ = 0;
  std::vector<std::string> notes_;
};

}  // namespace thimble::scene

#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/contact_choice.h"
#include "thimble/render/mesh/triangle_mesh.h"
#include "thimble/scene/hand_route.h"

namespace thimble::render {
struct StillSurface;
}

namespace thimble::scene {

struct ObjectMesh;
struct SceneObject;

/// What runs of like scenes have in common and no run changes: meshes as they stand in the world,
/// what is built over them to be touched, and the paths of hands over them. Each is made when it is
/// first asked for, and once for each file, place, size and way to touch it; a file that has
/// changed since, by its size or its time, is read anew.
///
/// It belongs to who runs the scenes (SessionOptions::meshes) and holds what it made until it is
/// destroyed or `drop_unused`; who got something keeps that for itself. What dents, flows, moves or
/// remembers a touch is never in it. Any thread may ask; one that asks for what another is making
/// waits. Real-time: never from the servo thread, all of it.
class THIMBLE_EXPORT SharedMeshes {
 public:
  SharedMeshes();
  ~SharedMeshes();
  SharedMeshes(const SharedMeshes&) = delete;
  SharedMeshes& operator=(const SharedMeshes&) = delete;

  /// Returns how many meshes it holds: of objects, of shapes, and those of whole scenes.
  std::size_t meshes() const;
  /// Returns how many surfaces that were made ready to be touched it holds.
  std::size_t surfaces() const;
  /// Lets go of what nobody else holds.
  void drop_unused();

  // What scenes are built of (scene_objects.h).

  /// Returns the mesh of an object that has a file (load_object_mesh, whose error it has).
  driver::Result<std::shared_ptr<const ObjectMesh>> object_mesh(const SceneObject& object);
  /// Returns a mesh with the content of this one.
  std::shared_ptr<const render::TriangleMesh> mesh_like(const render::TriangleMesh& mesh_W);
  /// Returns several meshes of this store as one, in this order; one alone is itself.
  std::shared_ptr<const render::TriangleMesh> joined(
      const std::vector<std::shared_ptr<const render::TriangleMesh>>& meshes_W);
  /// Returns a mesh of this store ready to be touched (prepare_still_surface, whose error it has).
  driver::Result<std::shared_ptr<const render::StillSurface>> surface(
      const std::shared_ptr<const render::TriangleMesh>& mesh_W,
      const render::ContactChoice& contact);
  /// Returns the path of a hand (plan_hand, whose error it has). `objects` are meshes of this store
  /// by the names that the stations have for them.
  driver::Result<std::shared_ptr<const HandRoute>> hand_route(
      const std::vector<HandWaypoint>& stations,
      const std::vector<std::pair<std::string, std::shared_ptr<const render::TriangleMesh>>>&
          objects);

 private:
  struct Held;

  std::unique_ptr<Held> held_;
};

}  // namespace thimble::scene

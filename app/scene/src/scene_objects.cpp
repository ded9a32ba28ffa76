#include "thimble/scene/scene_objects.h"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "body/motion/move_object.h"
#include "body/motion/shared_body.h"
#include "build_paged_touch.h"
#include "object_mesh.h"
#include "page/paged_surface.h"
#include "place_mesh.h"
#include "thimble/render/build_object_touch.h"
#include "thimble/render/mesh/check_mesh.h"

namespace thimble::scene {
namespace {

/// Reads the mesh of every object and puts it into the world (m); a shape has one to be drawn, a
/// field and a mesh on the disk an empty one.
driver::Result<std::vector<render::TriangleMesh>> load_meshes(const Scene& scene,
                                                              std::vector<std::string>& notes) {
  std::vector<render::TriangleMesh> meshes;
  for (const SceneObject& object : scene.objects) {
    if (object.shape || object.build_field || object.paged) {
      meshes.push_back(object.shape ? object.shape->mesh_W : render::TriangleMesh());
      continue;
    }
    auto loaded = load_object_mesh(object);
    if (!loaded) return loaded.error();
    notes.insert(notes.end(), loaded->notes.begin(), loaded->notes.end());
    meshes.push_back(std::move(loaded->mesh_W));
  }
  return meshes;
}

using Touched = driver::Result<std::unique_ptr<render::ObjectTouch>>;

/// Says which object a sentence is about.
std::string name_of(const SceneObject& object) {
  return object.mesh_file.empty() ? object.name : object.mesh_file.string();
}

/// Returns what a scene can do about a mesh that contact refuses, as a sentence to follow another.
std::string remedy_for(const SceneObject& object, const render::TriangleMesh& mesh_W) {
  if (object.mesh_file.empty() || object.sheet_thickness) return {};
  if (render::check_mesh(mesh_W).touchable()) return {};
  return object.repair
             ? " Set open: {thickness: 0.001} as well, to touch it as a sheet."
             : " Set repair: true, and where that is not enough, open: {thickness: 0.001}; "
               "thimble mesh tells which.";
}

/// Returns what the surface of an object is made of.
render::SurfaceChoice surface_of(const SceneObject& object) {
  return {.spring = {.stiffness = object.stiffness, .damping = object.damping},
          .effects = object.effects,
          .dent = object.body.dent,
          .shape = object.body.shape};
}

/// Returns an error about an object that contact, or a body, refuses.
driver::Error refused(const SceneObject& object, const render::TriangleMesh& mesh_W,
                      const driver::Error& error) {
  return driver::Error{name_of(object) + ": " + error.message + remedy_for(object, mesh_W)};
}

/// Builds the force law of what is touched in memory, as it stands still.
Touched build_still(const SceneObject& object, const render::TriangleMesh& mesh_W) {
  const render::SurfaceChoice surface = surface_of(object);
  return object.shape ? Touched(render::build_primitive_touch(object.shape->shape_W, surface))
                      : render::build_object_touch(mesh_W, object.contact, surface);
}

/// Builds the force law of one object that one arm touches.
Touched build_one(const SceneObject& object, const render::TriangleMesh& mesh_W,
                  std::vector<std::shared_ptr<render::PagedSurface>>& pages) {
  if (object.build_field) return object.build_field();
  if (object.paged) {
    auto opened = render::PagedSurface::open(object.mesh_file);
    if (!opened) return opened.error();
    pages.emplace_back(std::move(opened).value());
    const render::PagedPlace place = place_pages(pages.back()->file(), object);
    return render::build_paged_touch(pages.back(), place, surface_of(object));
  }
  auto touch = build_still(object, mesh_W);
  if (touch && object.body.motion) {
    touch =
        render::move_object(std::move(touch).value(), mesh_W, *object.body.motion, object.coupling);
  }
  if (!touch) return refused(object, mesh_W, touch.error());
  return touch;
}

/// Builds the force law of one object on each of several arms: each has its own contact with it,
/// and all of them the body that moves.
driver::Result<render::SharedObject> build_shared(const SceneObject& object,
                                                  const render::TriangleMesh& mesh_W,
                                                  std::size_t arms) {
  render::SharedObject shared;
  const bool gives_way = object.body.dent || object.body.shape.named();
  if (gives_way || object.paged) {
    return driver::Error{fmt::format(
        "{}: {} can be touched by one arm alone so far, and the scene has {}; {}.", name_of(object),
        gives_way ? "an object whose surface gives way (dent, plastic, snap)" : "a mesh in pages",
        arms, gives_way ? "keep body: {motion: ...}" : "name the mesh itself")};
  }
  for (std::size_t arm = 0; arm < arms; ++arm) {
    if (object.build_field) {
      shared.touches.push_back(object.build_field());
      continue;
    }
    auto touch = build_still(object, mesh_W);
    if (!touch) return refused(object, mesh_W, touch.error());
    shared.touches.push_back(std::move(touch).value());
  }
  if (!object.body.motion) return shared;
  auto moved = render::move_shared_object(std::move(shared.touches), mesh_W, *object.body.motion,
                                          object.coupling);
  if (!moved) return refused(object, mesh_W, moved.error());
  return moved;
}

/// Adds the triangles of one mesh to another.
void append(const render::TriangleMesh& mesh, render::TriangleMesh& whole) {
  const auto first = static_cast<std::int32_t>(whole.vertices.size());
  whole.vertices.insert(whole.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
  for (const auto& [a, b, c] : mesh.triangles) {
    whole.triangles.push_back({first + a, first + b, first + c});
  }
}

/// Cuts one object out of a mesh of several.
render::TriangleMesh part_of(const render::TriangleMesh& mesh, const MeshPlace& begin,
                             const MeshPlace& end) {
  const auto at = [](auto& list, std::size_t i) {
    return list.begin() + static_cast<std::ptrdiff_t>(i);
  };
  render::TriangleMesh part;
  part.vertices.assign(at(mesh.vertices, begin.vertex), at(mesh.vertices, end.vertex));
  part.triangles.assign(at(mesh.triangles, begin.triangle), at(mesh.triangles, end.triangle));
  for (auto& triangle : part.triangles) {
    for (std::int32_t& vertex : triangle) vertex -= static_cast<std::int32_t>(begin.vertex);
  }
  return part;
}

}  // namespace

driver::Result<std::unique_ptr<SceneObjects>> SceneObjects::build(const Scene& scene) {
  std::unique_ptr<SceneObjects> objects(new SceneObjects);
  const auto meshes = load_meshes(scene, objects->notes_);
  if (!meshes) return meshes.error();
  const std::size_t arms = 1 + scene.more_arms.size();
  std::vector<std::vector<std::unique_ptr<render::ObjectTouch>>> touches(arms);
  for (std::size_t i = 0; i < meshes->size(); ++i) {
    const SceneObject& object = scene.objects[i];
    if (arms == 1) {
      auto touch = build_one(object, (*meshes)[i], objects->pages_);
      if (!touch) return touch.error();
      touches[0].push_back(std::move(touch).value());
      continue;
    }
    auto shared = build_shared(object, (*meshes)[i], arms);
    if (!shared) return shared.error();
    for (std::size_t arm = 0; arm < arms; ++arm) {
      touches[arm].push_back(std::move(shared->touches[arm]));
    }
    if (shared->body) objects->bodies_.push_back(std::move(shared->body));
  }
  for (auto& objects_of_arm : touches) {
    objects->touches_.push_back(std::make_unique<render::SceneTouch>(std::move(objects_of_arm)));
  }
  for (std::size_t i = 0; i < meshes->size(); ++i) {
    if (!scene.objects[i].shape) objects->triangles_ += (*meshes)[i].triangles.size();
    objects->places_.push_back(
        {objects->mesh_W_.vertices.size(), objects->mesh_W_.triangles.size()});
    append((*meshes)[i], objects->mesh_W_);
    if (scene.objects[i].body.motion) objects->moving_.push_back(i);
  }
  objects->places_.push_back({objects->mesh_W_.vertices.size(), objects->mesh_W_.triangles.size()});
  for (const auto& pages : objects->pages_) {
    objects->triangles_ += static_cast<std::size_t>(pages->triangle_count());
  }
  return objects;
}

render::TriangleMesh SceneObjects::mesh_W(std::size_t object) const {
  return part_of(mesh_W_, places_[object], places_[object + 1]);
}

render::TriangleMesh SceneObjects::mesh_now(int object) const {
  const auto now = [this](std::size_t i) {
    render::TriangleMesh mesh = mesh_W(i);
    touches_.front()->object(i).mesh_now(mesh.vertices, mesh.triangles);
    return mesh;
  };
  if (object >= 0) return now(static_cast<std::size_t>(object));
  render::TriangleMesh all;
  for (std::size_t i = 0; i < touches_.front()->size(); ++i) append(now(i), all);
  return all;
}

void SceneObjects::step_bodies(double step) noexcept {
  for (const auto& body : bodies_) body->step(step);
}

void SceneObjects::start_loaders() {
  for (const auto& pages : pages_) pages->start_loader();
}

void SceneObjects::serve_pages() noexcept {
  for (const auto& pages : pages_) {
    while (pages->serve() > 0) {
    }
  }
}

std::optional<render::PagingCounters> SceneObjects::paging() const {
  if (pages_.empty()) return {};
  render::PagingCounters sum;
  for (const auto& pages : pages_) {
    const render::PagingCounters one = pages->counters();
    sum.loads += one.loads;
    sum.evictions += one.evictions;
    sum.failures += one.failures;
    sum.misses += one.misses;
    sum.short_of_frames += one.short_of_frames;
  }
  return sum;
}

}  // namespace thimble::scene

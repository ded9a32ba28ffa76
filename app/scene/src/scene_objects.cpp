#include "thimble/scene/scene_objects.h"

#include <string>
#include <utility>

#include "body/motion/move_object.h"
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

/// Builds the force law that the scene calls for.
driver::Result<std::unique_ptr<render::SceneTouch>> build_touch(
    const Scene& scene, const std::vector<render::TriangleMesh>& meshes_W,
    std::vector<std::shared_ptr<render::PagedSurface>>& pages) {
  std::vector<std::unique_ptr<render::ObjectTouch>> objects;
  for (std::size_t i = 0; i < meshes_W.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    const render::SurfaceChoice surface{
        .spring = {.stiffness = object.stiffness, .damping = object.damping},
        .effects = object.effects,
        .dent = object.body.dent,
        .shape = object.body.shape};
    if (object.build_field) {
      objects.push_back(object.build_field());
      continue;
    }
    if (object.paged) {
      auto opened = render::PagedSurface::open(object.mesh_file);
      if (!opened) return opened.error();
      pages.emplace_back(std::move(opened).value());
      const render::PagedPlace place = place_pages(pages.back()->file(), object);
      objects.push_back(render::build_paged_touch(pages.back(), place, surface));
      continue;
    }
    auto touch = object.shape
                     ? Touched(render::build_primitive_touch(object.shape->shape_W, surface))
                     : render::build_object_touch(meshes_W[i], object.contact, surface);
    if (touch && object.body.motion) {
      touch = render::move_object(std::move(touch).value(), meshes_W[i], *object.body.motion,
                                  object.coupling);
    }
    if (!touch) {
      return driver::Error{name_of(object) + ": " + touch.error().message +
                           remedy_for(object, meshes_W[i])};
    }
    objects.push_back(std::move(touch).value());
  }
  return std::make_unique<render::SceneTouch>(std::move(objects));
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
  auto touch = build_touch(scene, *meshes, objects->pages_);
  if (!touch) return touch.error();
  objects->touch_ = std::move(touch).value();
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
    touch_->object(i).mesh_now(mesh.vertices, mesh.triangles);
    return mesh;
  };
  if (object >= 0) return now(static_cast<std::size_t>(object));
  render::TriangleMesh all;
  for (std::size_t i = 0; i < touch_->size(); ++i) append(now(i), all);
  return all;
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

#include "thimble/scene/scene_objects.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <mutex>
#include <string>
#include <utility>
#include <variant>

#include "body/motion/move_object.h"
#include "body/motion/shared_body.h"
#include "build_paged_touch.h"
#include "collision/collide_objects.h"
#include "collision/collision_surfaces.h"
#include "disk_paging/paged_surface.h"
#include "map_picture.h"
#include "meshes/mesh_join.h"
#include "meshes/object_mesh.h"
#include "meshes/object_tracker.h"
#include "still_surface.h"
#include "text/counted.h"
#include "thimble/render/build_object_touch.h"
#include "thimble/render/mesh/check_mesh.h"
#include "thimble/scene/shared_meshes.h"

namespace thimble::scene {
namespace {

using MeshPointer = std::shared_ptr<const render::TriangleMesh>;

using Touched = driver::Result<std::unique_ptr<render::ObjectTouch>>;

/// Returns the name of an object in messages: its file, or its name in the scene.
std::string name_of(const SceneObject& object) {
  return object.mesh_file.empty() ? object.name : object.mesh_file.string();
}

/// Returns a sentence with the remedy for a mesh that contact rejects; empty if there is none.
std::string remedy_for(const SceneObject& object, const MeshPointer& mesh_W) {
  if (object.mesh_file.empty() || object.sheet_thickness) return {};
  if (render::check_mesh(*mesh_W).touchable()) return {};
  return object.repair ? " Set open: {thickness: 0.001} as well, to touch it as a sheet."
                       : " Set repair: true and, if that is not enough, open: {thickness: 0.001}; "
                         "`thimble mesh` "
                         "prints which one is needed.";
}

/// Returns the error for an object that contact or a body rejects.
driver::Error refused(const SceneObject& object, const MeshPointer& mesh_W,
                      const driver::Error& error) {
  return driver::Error{name_of(object) + ": " + error.message + remedy_for(object, mesh_W)};
}

/// Builds the force law of an object in memory that does not move. If the base points of its
/// surface move, it has its own mesh and search.
Touched build_still(const SceneObject& object, const render::ContactChoice& contact,
                    const MeshPointer& mesh_W, SharedMeshes& meshes) {
  render::SurfaceChoice surface = surface_of(object);
  if (object.needs_maps() && !object.shape) {
    // Loaded with the mesh already.
    const auto loaded = meshes.object_mesh(object);
    if (!loaded) return loaded.error();
    surface.maps = (*loaded)->maps;
  }
  if (object.shape) {
    return render::build_primitive_touch(object.shape->shape_W, surface, contact.tip_radius);
  }
  if (surface.shape.named()) return render::build_object_touch(*mesh_W, contact, surface);
  const auto still = meshes.surface(mesh_W, contact);
  if (!still) return still.error();
  return render::build_object_touch(**still, *mesh_W, contact, surface);
}

/// Returns how an object meets bodies.
render::CollisionChoice collision_of(const SceneObject& object) {
  return object.collision ? *object.collision : render::CollisionChoice{};
}

/// Returns whether bodies of a scene may meet something, or are held by joints.
bool bodies_meet(const Scene& scene) {
  if (!scene.joints.empty()) return true;
  bool moves = false;
  int solids = 0;
  for (const SceneObject& object : scene.objects) {
    if (collision_of(object).shape == render::CollisionShape::kNone || object.build_field ||
        object.paged)
      continue;
    ++solids;
    moves = moves || object.body.motion.has_value();
  }
  return moves && solids > 1;
}

/// Returns whether an object of such a scene meets others, or a joint holds it.
bool takes_part(const Scene& scene, std::size_t i) {
  const SceneObject& object = scene.objects[i];
  if (object.build_field || object.paged) return false;
  if (collision_of(object).shape != render::CollisionShape::kNone) return true;
  const auto number = static_cast<int>(i);
  return std::any_of(scene.joints.begin(), scene.joints.end(), [number](const SceneJoint& joint) {
    return joint.a == number || joint.b == number;
  });
}

/// Returns whether a shape at rest collides as a mesh.
bool collides_as_mesh(const SceneObject& object) {
  const auto kind = collision_of(object).shape;
  if (object.shape && std::holds_alternative<render::Torus>(object.shape->shape_W)) return true;
  return kind != render::CollisionShape::kOwn && kind != render::CollisionShape::kNone;
}

/// Returns whether the mesh of an object is needed, of a shape only for its mass or its collisions.
bool needs_mesh(const SceneObject& object, bool meets) {
  return !object.shape || object.body.motion || (meets && collides_as_mesh(object));
}

/// Builds the force law of one object that is touched by one arm.
Touched build_one(const SceneObject& object, const render::ContactChoice& contact,
                  const MeshPointer& mesh_W, SharedMeshes& meshes, double reach, bool meets,
                  std::vector<std::shared_ptr<render::PagedSurface>>& pages) {
  if (object.build_field) return object.build_field();
  if (object.paged) {
    render::PagingSettings paging;
    if (object.page_budget) {
      constexpr std::size_t kMiB = std::size_t{1} << 20;
      paging.frames = *object.page_budget * kMiB / render::kPageBytes;
    }
    auto opened = render::PagedSurface::open(object.mesh_file, paging);
    if (!opened) return opened.error();
    pages.emplace_back(std::move(opened).value());
    const render::PagedPlace place = place_pages(pages.back()->file(), object);
    const auto judged =
        judge_size(object, {.side = side_of_pages(pages.back()->file(), place), .kind = {}}, reach);
    if (!judged) return judged.error();
    return render::build_paged_touch(pages.back(), place, surface_of(object));
  }
  auto touch = build_still(object, contact, mesh_W, meshes);
  if (touch && object.body.motion && !meets) {
    touch = render::move_object(std::move(touch).value(), *mesh_W, *object.body.motion,
                                object.coupling);
  }
  if (!touch) return refused(object, mesh_W, touch.error());
  return touch;
}

/// Builds the force law of one object for each of several arms. Each arm has its own contact with
/// the object, and all share the moving body.
driver::Result<render::SharedObject> build_shared(const SceneObject& object,
                                                  const render::ContactChoice& contact,
                                                  const MeshPointer& mesh_W, SharedMeshes& meshes,
                                                  std::size_t arms, bool meets) {
  render::SharedObject shared;
  const bool deforms = object.body.dent || object.body.shape.named();
  if (deforms || object.paged) {
    return driver::Error{fmt::format(
        "{}: {} can be touched by one arm only, and the scene has {}; {}.", name_of(object),
        deforms ? "an object whose surface deforms (dent, plastic, snap)" : "a page file", arms,
        deforms ? "keep only body: {motion: ...}" : "use a mesh file instead")};
  }
  for (std::size_t arm = 0; arm < arms; ++arm) {
    if (object.build_field) {
      shared.touches.push_back(object.build_field());
      continue;
    }
    auto touch = build_still(object, contact, mesh_W, meshes);
    if (!touch) return refused(object, mesh_W, touch.error());
    shared.touches.push_back(std::move(touch).value());
  }
  if (!object.body.motion || meets) return shared;
  auto moved = render::move_shared_object(std::move(shared.touches), *mesh_W, *object.body.motion,
                                          object.coupling);
  if (!moved) return refused(object, mesh_W, moved.error());
  return moved;
}

}  // namespace

/// Meshes of all objects. Those of shapes, and that of all objects, are made when they are asked
/// for.
struct SceneObjects::Meshes {
  explicit Meshes(std::shared_ptr<SharedMeshes> shared) : store(std::move(shared)) {}

  driver::Result<void> load(const Scene& scene, std::vector<std::string>& notes,
                            std::vector<ObjectTracker>& trackers);
  const MeshPointer& of(std::size_t object);
  void join();

  std::shared_ptr<SharedMeshes> store;
  std::mutex mutex;                // for all below
  std::vector<MeshPointer> own_W;  // null: not made yet
  // Objects that are shapes, in ascending order.
  struct ObjectShape {
    std::size_t object;
    SceneShape shape;
  };
  std::vector<ObjectShape> shapes;
  MeshPointer all_W;              // null: not made yet
  std::vector<MeshPlace> places;  // of each object in `all_W`, plus the end

 private:
  const MeshPointer& made(std::size_t object);
};

/// Reads the mesh files of all objects and places them in the world (m). A shape keeps none; the
/// mesh of a field or of a page file is empty.
driver::Result<void> SceneObjects::Meshes::load(const Scene& scene, std::vector<std::string>& notes,
                                                std::vector<ObjectTracker>& trackers) {
  const double reach = reach_of(scene);
  const auto empty = std::make_shared<const render::TriangleMesh>();
  own_W.reserve(scene.objects.size());
  shapes.reserve(static_cast<std::size_t>(
      std::count_if(scene.objects.begin(), scene.objects.end(),
                    [](const SceneObject& object) { return object.shape.has_value(); })));
  for (const SceneObject& object : scene.objects) {
    if (object.shape) {
      shapes.push_back({own_W.size(), *object.shape});
      own_W.emplace_back();
      continue;
    }
    if (object.build_field || object.paged) {
      own_W.push_back(empty);
      continue;
    }
    const auto loaded = store->object_mesh(object);
    if (!loaded) return loaded.error();
    const ObjectMesh& mesh = **loaded;
    const auto judged = judge_size(object, mesh.size, reach);
    if (!judged) return judged.error();
    if (!judged->empty()) notes.push_back(*judged);
    notes.insert(notes.end(), mesh.notes.begin(), mesh.notes.end());
    ObjectTracker tracker = tracker_of(object, *loaded, *store);
    tracker.object = own_W.size();
    trackers.push_back(std::move(tracker));
    own_W.emplace_back(*loaded, &mesh.mesh_W);
  }
  return {};
}

const MeshPointer& SceneObjects::Meshes::of(std::size_t object) {
  const std::scoped_lock lock(mutex);
  return made(object);
}

const MeshPointer& SceneObjects::Meshes::made(std::size_t object) {
  if (!own_W[object]) {
    const auto own = std::lower_bound(
        shapes.begin(), shapes.end(), object,
        [](const ObjectShape& shape, std::size_t number) { return shape.object < number; });
    own_W[object] = store->mesh_like(own->shape.mesh_W());
  }
  return own_W[object];
}

void SceneObjects::Meshes::join() {
  const std::scoped_lock lock(mutex);
  if (all_W) return;
  places.assign(1, {});
  for (std::size_t i = 0; i < own_W.size(); ++i) {
    const MeshPlace& begin = places.back();
    const render::TriangleMesh& mesh_W = *made(i);
    places.push_back(
        {begin.vertex + mesh_W.vertices.size(), begin.triangle + mesh_W.triangles.size()});
  }
  all_W = store->joined(own_W);
}

SceneObjects::SceneObjects() = default;
SceneObjects::~SceneObjects() = default;

const render::TriangleMesh& SceneObjects::mesh_W() const {
  meshes_->join();
  return *meshes_->all_W;
}

const MeshPointer& SceneObjects::shared_mesh_W(std::size_t object) const {
  return meshes_->of(object);
}

const MeshPlace& SceneObjects::place(std::size_t object) const {
  meshes_->join();
  return meshes_->places[object];
}

std::optional<render::MapPicture> SceneObjects::map_picture(const Scene& scene,
                                                            std::size_t object) const {
  const SceneObject& one = scene.objects[object];
  if (!one.needs_maps() || one.shape || one.paged) return {};
  // Held by `meshes_`, so it is not loaded again.
  const auto loaded = meshes_->store->object_mesh(one);
  if (!loaded) return {};
  render::SurfaceChoice surface = surface_of(one);
  surface.maps = (*loaded)->maps;
  const auto mapped = std::count_if(scene.objects.begin(), scene.objects.end(),
                                    [](const SceneObject& other) { return other.needs_maps(); });
  return render::map_picture(surface, (*loaded)->mesh_W,
                             render::kMapPartsMax / static_cast<std::size_t>(mapped));
}

driver::Result<std::unique_ptr<SceneObjects>> SceneObjects::build(
    const Scene& scene, const std::shared_ptr<SharedMeshes>& meshes) {
  const auto held = meshes ? meshes : std::make_shared<SharedMeshes>();
  std::unique_ptr<SceneObjects> objects(new SceneObjects);
  objects->meshes_ = std::make_unique<Meshes>(held);
  if (auto loaded = objects->meshes_->load(scene, objects->notes_, objects->trackers_); !loaded) {
    return loaded.error();
  }
  auto tracker = objects->trackers_.begin();  // of the next object that has one
  const std::size_t arms = scene.arms.size();
  const double reach = reach_of(scene);
  std::vector<std::vector<std::unique_ptr<render::ObjectTouch>>> touches(arms);
  const bool meets = bodies_meet(scene);
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    const MeshPointer mesh_W = needs_mesh(object, meets) ? objects->shared_mesh_W(i) : nullptr;
    const bool has_tracker = tracker != objects->trackers_.end() && tracker->object == i;
    const render::ContactChoice& contact = has_tracker ? (tracker++)->contact : object.contact;
    if (arms == 1) {
      auto touch = build_one(object, contact, mesh_W, *held, reach, meets && takes_part(scene, i),
                             objects->pages_);
      if (!touch) return touch.error();
      touches[0].push_back(std::move(touch).value());
      continue;
    }
    auto shared = build_shared(object, contact, mesh_W, *held, arms, meets && takes_part(scene, i));
    if (!shared) return shared.error();
    for (std::size_t arm = 0; arm < arms; ++arm) {
      touches[arm].push_back(std::move(shared->touches[arm]));
    }
    if (shared->body) objects->bodies_.push_back(std::move(shared->body));
  }
  if (meets) {
    if (auto met = objects->let_meet(scene, touches); !met) return met.error();
  }
  for (auto& objects_of_arm : touches) {
    objects->touches_.push_back(std::make_unique<render::SceneTouch>(std::move(objects_of_arm)));
  }
  if (scene.tip_radius > 0) {
    objects->notes_.push_back(
        fmt::format("The tip is a ball with a radius of {:g} mm.", 1e3 * scene.tip_radius));
  }
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    if (!scene.objects[i].shape) objects->triangles_ += objects->mesh_W(i).triangles.size();
    if (scene.objects[i].body.motion) objects->moving_.push_back(i);
  }
  for (const auto& pages : objects->pages_) {
    objects->triangles_ += static_cast<std::size_t>(pages->triangle_count());
  }
  return objects;
}

driver::Result<void> SceneObjects::let_meet(const Scene& scene, Touches& touches) {
  std::vector<render::CollidingObject> colliding;
  std::vector<int> number_of(scene.objects.size(), -1);  // in `colliding`
  std::vector<std::size_t> moving;                       // in the scene
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    if (!takes_part(scene, i)) continue;
    number_of[i] = static_cast<int>(colliding.size());
    render::CollidingObject& one = colliding.emplace_back();
    one.name = object.name;
    one.solid = {.mesh_W = needs_mesh(object, true) ? &mesh_W(i) : nullptr,
                 .shape_W = object.shape ? &object.shape->shape_W : nullptr};
    one.collision = collision_of(object);
    if (!object.body.motion) continue;
    one.motion = object.body.motion;
    one.coupling = object.coupling;
    for (auto& of_arm : touches) one.surfaces.push_back(std::move(of_arm[i]));
    moving.push_back(i);
  }
  std::vector<render::ObjectJoint> joints;
  for (const SceneJoint& joint : scene.joints) {
    const auto number = [&](int i) { return i < 0 ? -1 : number_of[static_cast<std::size_t>(i)]; };
    joints.push_back({.choice = joint.choice, .a = number(joint.a), .b = number(joint.b)});
  }
  auto met =
      render::collide_objects(std::move(colliding), joints, scene.collisions, touches.size());
  if (!met) return met.error();
  notes_.insert(notes_.end(), met->notes.begin(), met->notes.end());
  for (std::size_t k = 0; k < moving.size(); ++k) {
    for (std::size_t arm = 0; arm < touches.size(); ++arm) {
      touches[arm][moving[k]] = std::move(met->touches[k][arm]);
    }
  }
  if (touches.size() > 1) bodies_.push_back(std::move(met->bodies));
  collision_surfaces_ = std::move(met->surfaces);
  colliding_ = std::move(number_of);
  return {};
}

MeshPointer SceneObjects::collision_mesh_W(std::size_t object) const {
  if (collision_surfaces_ == nullptr || colliding_[object] < 0) return nullptr;
  auto surface = collision_surfaces_->surface_W(static_cast<std::size_t>(colliding_[object]));
  if (!surface) return shared_mesh_W(object);
  if (surface->triangles.empty()) return nullptr;
  return std::make_shared<const render::TriangleMesh>(std::move(*surface));
}

std::vector<std::string> SceneObjects::tracker_notes(const Scene& scene) const {
  return describe_trackers(scene, trackers_);
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

render::TriangleMesh SceneObjects::mesh_bent(std::size_t object) const {
  render::TriangleMesh mesh = mesh_now(static_cast<int>(object));
  const render::BodyPose pose = touches_.front()->object(object).pose();
  const Eigen::Quaterniond q_BW(pose.q_WB[0], -pose.q_WB[1], -pose.q_WB[2], -pose.q_WB[3]);
  const Eigen::Vector3d p_WB(pose.p_WB[0], pose.p_WB[1], pose.p_WB[2]);
  for (Eigen::Vector3d& p : mesh.vertices) p = q_BW * (p - p_WB);
  return mesh;
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

driver::Result<void> SceneObjects::check_pages(const Scene& scene) const {
  std::string errors;
  auto pages = pages_.begin();
  for (const SceneObject& object : scene.objects) {
    if (!object.paged) continue;
    const std::uint64_t failures = (*pages++)->counters().failures;
    if (failures == 0) continue;
    errors += fmt::format(
        "{}{}: {} could not be read, because the file is damaged or the disk failed. The tip did "
        "not feel the surface there. Write the file again with `thimble mesh page`.",
        errors.empty() ? "" : "\n", object.mesh_file.string(), counted(failures, "page"));
  }
  if (errors.empty()) return {};
  return driver::Error{errors};
}

}  // namespace thimble::scene

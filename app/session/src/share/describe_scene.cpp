#include "share/describe_scene.h"

#include <numbers>
#include <string_view>

#include "body/shape/body_shape.h"
#include "map_picture.h"
#include "share/describe/field_samples.h"

namespace thimble::session {
namespace {

// Default crease angle of viewers, if the scene gives none. Chosen: the largest angle between
// neighbouring triangles in curved meshes of everyday objects.
constexpr double kCreaseDrawn = std::numbers::pi / 4;

}  // namespace

SharedScene::Arm describe_arm(const scene::ArmFile& arm, const std::string& device) {
  return {.name = arm.name,
          .device = device,
          .geometry = arm.model.geometry,
          .R_WB = arm.R_WB,
          .p_WB = arm.p_WB,
          .min_W = arm.workspace.min_W,
          .max_W = arm.workspace.max_W};
}

namespace {

SharedKind kind_of(const scene::SceneObject& object) {
  if (object.build_field) return SharedKind::kField;
  if (object.shape) return SharedKind::kShape;
  return object.paged ? SharedKind::kPaged : SharedKind::kMesh;
}

// Returns the names of an object's effects of one group, as in the scene file.
std::string names_of(const scene::SceneObject& object, std::string_view group) {
  std::string names;
  for (const render::EffectPlan& effect : object.effects) {
    if (effect.kind->group != group) continue;
    if (!names.empty()) names += ", ";
    names += effect.kind->name;
  }
  return names;
}

// Adds the map of an object, if it has one.
void describe_map(const scene::Scene& scene, const scene::SceneObjects& objects, std::size_t i,
                  SharedScene& described) {
  const auto map = objects.map_picture(scene, i);
  if (!map) return;
  described.objects[i].map = {.quantity = std::string(map->quantity),
                              .unit = std::string(map->unit),
                              .min = map->min,
                              .max = map->max,
                              .parts = map->parts,
                              .first_value = described.map_values.size()};
  described.map_values.insert(described.map_values.end(), map->values.begin(), map->values.end());
}

// Adds the shape with which an object collides, if it meets others.
void describe_collider(const scene::SceneObjects& objects, std::size_t i, SharedScene& described) {
  SharedScene::Object& object = described.objects[i];
  const auto shape_W = objects.collision_mesh_W(i);
  if (shape_W == nullptr) return;
  object.collider_first_vertex = object.first_vertex;
  object.collider_vertex_count = object.vertex_count;
  object.collider_first_triangle = object.first_triangle;
  object.collider_triangle_count = object.triangle_count;
  if (shape_W == objects.shared_mesh_W(i)) return;
  object.collider_first_vertex = described.vertices.size();
  object.collider_vertex_count = shape_W->vertices.size();
  object.collider_first_triangle = described.triangles.size();
  object.collider_triangle_count = shape_W->triangles.size();
  const auto first = static_cast<std::uint32_t>(described.vertices.size());
  described.vertices.insert(described.vertices.end(), shape_W->vertices.begin(),
                            shape_W->vertices.end());
  for (const auto& [a, b, c] : shape_W->triangles) {
    described.triangles.push_back({first + static_cast<std::uint32_t>(a),
                                   first + static_cast<std::uint32_t>(b),
                                   first + static_cast<std::uint32_t>(c)});
  }
}

// Returns the largest number of edges of an object that may be split during the run.
std::size_t max_splits(const scene::SceneObject& object, const render::ObjectTouch& touch) {
  return object.body.shape.named() && touch.shape()->refines() ? touch.shape()->splits_left() : 0;
}

}  // namespace

SharedScene describe_scene(const scene::Scene& scene, const scene::SceneObjects& objects,
                           const std::string& device) {
  SharedScene described;
  described.name = scene.name;
  described.force_max = scene.arms.front().arm.limits.force_max;
  described.tip_radius = scene.tip_radius;
  described.arms = {describe_arm(scene.arms.front().arm, device)};
  const render::TriangleMesh& mesh = objects.mesh_W();
  described.vertices = mesh.vertices;
  described.triangles.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    described.triangles.push_back({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b),
                                   static_cast<std::uint32_t>(c)});
  }
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const scene::SceneObject& object = scene.objects[i];
    const scene::MeshPlace& begin = objects.place(i);
    const scene::MeshPlace& end = objects.place(i + 1);
    described.objects.push_back({.name = object.name,
                                 .kind = kind_of(object),
                                 .colour = static_cast<std::uint32_t>(i),
                                 .moves = object.body.motion.has_value(),
                                 .dents = object.body.dent.has_value(),
                                 .shaped = object.body.shape.named(),
                                 .first_vertex = begin.vertex,
                                 .vertex_count = end.vertex - begin.vertex,
                                 .first_triangle = begin.triangle,
                                 .triangle_count = end.triangle - begin.triangle,
                                 .max_splits = max_splits(object, objects.touch().object(i)),
                                 .crease_angle = object.contact.crease_angle.value_or(kCreaseDrawn),
                                 .texture = names_of(object, "texture"),
                                 .friction = names_of(object, "friction")});
    describe_map(scene, objects, i, described);
    describe_collider(objects, i, described);
  }
  described.field = sample_fields(scene);
  return described;
}

SharedScene describe_scene(const scene::Scene& scene, const scene::SceneObjects& objects,
                           const std::vector<std::string>& devices) {
  SharedScene all = describe_scene(scene, objects, devices.front());
  all.arms.clear();
  for (std::size_t i = 0; i < scene.arms.size(); ++i) {
    all.arms.push_back(describe_arm(scene.arms[i].arm, devices[i]));
    all.arms.back().in_scene = scene.arms[i].name;
  }
  return all;
}

}  // namespace thimble::session

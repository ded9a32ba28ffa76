#include "share/shared_scene.h"
#include "share/layout/shared_layout_hash.h"
#include "share/shared_geometry.h"
#include "surface/map/triangle_grid.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string_view>

namespace thimble::session {
namespace {

driver::Error broken(const std::string& what) {
  return driver::Error{"The run's shared memory is damaged (" + what + "); restart the run."};
}

template <std::size_t N>
std::string text_of(const SharedText<N>& text) {
  // Replaces control characters, which could control the terminal.
  std::string result(text.data(), strnlen(text.data(), N - 1));
  for (char& c : result) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  return result;
}

bool within(std::uint64_t first, std::uint64_t count, std::uint64_t all) {
  return first <= all && count <= all - first;
}

/// Returns whether a table with elements of `size` bytes is completely within the memory, after the
/// fixed part.
bool lies_in(const SharedTable& table, std::size_t size, std::uint64_t total) {
  return table.offset % 64 == 0 && table.offset >= kSharedTablesOffset && table.offset <= total &&
         table.count <= (total - table.offset) / size;
}

/// Copies a table. Precondition: it is within the memory.
template <class T>
std::vector<T> copy_of(std::span<const std::byte> memory, const SharedTable& table) {
  std::vector<T> copy(table.count);
  if (!copy.empty()) {
    std::memcpy(copy.data(), memory.data() + table.offset, table.count * sizeof(T));
  }
  return copy;
}

/// Mixes bytes into a hash: FNV-1a, but with eight bytes per step, so that a mesh of a million
/// triangles takes milliseconds [Fowler, Noll, Vo; RFC 9923].
std::uint64_t mix_bytes(std::uint64_t hash, std::span<const std::byte> bytes) noexcept {
  constexpr std::uint64_t kPrime = 0x100000001b3;
  std::size_t i = 0;
  for (; i + 8 <= bytes.size(); i += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + i, 8);
    hash = (hash ^ word) * kPrime;
    hash ^= hash >> 32;  // so that high bits also affect low ones
  }
  for (; i < bytes.size(); ++i) hash = (hash ^ std::to_integer<std::uint64_t>(bytes[i])) * kPrime;
  return hash;
}

bool all_finite(std::span<const double> numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); });
}

Eigen::Vector3d vector_of(const std::array<double, 3>& a) {
  return {a[0], a[1], a[2]};
}

bool take_arm(const SharedArm& shared, SharedScene::Arm& arm) {
  if (!take_geometry(shared, arm.geometry) || !all_finite(shared.R_WB) ||
      !all_finite(shared.p_WB) || !all_finite(shared.min_W) || !all_finite(shared.max_W)) {
    return false;
  }
  arm.name = text_of(shared.name);
  arm.device = text_of(shared.device);
  arm.in_scene = text_of(shared.in_scene);
  arm.R_WB = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(shared.R_WB.data());
  arm.p_WB = vector_of(shared.p_WB);
  arm.min_W = vector_of(shared.min_W);
  arm.max_W = vector_of(shared.max_W);
  return true;
}

/// Validates the map of an object. Precondition: its count of triangles is within the table.
bool take_map(const SharedObject& shared, const SharedHead& head, SharedScene::Map& map) {
  if (shared.map_parts == 0) return true;
  // Written so that NaN is rejected. Neither count can overflow: see kMapSideMax, kSharedBytesMax.
  if (shared.map_parts > kMapSideMax || !(shared.map_min <= shared.map_max) ||
      !std::isfinite(shared.map_max - shared.map_min) ||
      !within(shared.first_map_value, shared.triangle_count * render::grid_points(shared.map_parts),
              head.map_values.count)) {
    return false;
  }
  map = {.quantity = text_of(shared.map_quantity),
         .unit = text_of(shared.map_unit),
         .min = shared.map_min,
         .max = shared.map_max,
         .parts = shared.map_parts,
         .first_value = shared.first_map_value};
  return true;
}

/// Returns whether a range of triangles exists and refers to a range of vertices only.
bool sound_surface(std::uint64_t first_vertex, std::uint64_t vertex_count,
                   std::uint64_t first_triangle, std::uint64_t triangle_count,
                   const SharedHead& head, const std::vector<SharedTriangle>& triangles) {
  if (!within(first_vertex, vertex_count, head.vertices.count) ||
      !within(first_triangle, triangle_count, head.triangles.count)) {
    return false;
  }
  for (std::uint64_t t = 0; t < triangle_count; ++t) {
    for (const std::uint32_t vertex : triangles[first_triangle + t]) {
      if (vertex < first_vertex || vertex - first_vertex >= vertex_count) return false;
    }
  }
  return true;
}

/// Validates an object against the tables to which it refers.
bool take_object(const SharedObject& shared, const SharedHead& head,
                 const std::vector<SharedTriangle>& triangles, SharedScene::Object& object) {
  if (shared.kind > static_cast<std::uint32_t>(SharedKind::kPaged) || shared.moves > 1 ||
      shared.dents > 1 || shared.shaped > 1 || !std::isfinite(shared.crease_angle) ||
      !sound_surface(shared.first_vertex, shared.vertex_count, shared.first_triangle,
                     shared.triangle_count, head, triangles) ||
      !sound_surface(shared.collider_first_vertex, shared.collider_vertex_count,
                     shared.collider_first_triangle, shared.collider_triangle_count, head,
                     triangles)) {
    return false;
  }
  if (!within(shared.first_split, shared.max_splits, head.splits.count)) return false;
  const std::uint64_t room = shared.vertex_count + shared.max_splits;
  if (shared.shaped == 1 ? !within(shared.first_shaped, room, head.shaped.count)
                         : shared.max_splits > 0) {
    return false;
  }
  object = {.name = text_of(shared.name),
            .kind = static_cast<SharedKind>(shared.kind),
            .colour = shared.colour,
            .moves = shared.moves == 1,
            .dents = shared.dents == 1,
            .shaped = shared.shaped == 1,
            .first_vertex = shared.first_vertex,
            .vertex_count = shared.vertex_count,
            .first_triangle = shared.first_triangle,
            .triangle_count = shared.triangle_count,
            .collider_first_vertex = shared.collider_first_vertex,
            .collider_vertex_count = shared.collider_vertex_count,
            .collider_first_triangle = shared.collider_first_triangle,
            .collider_triangle_count = shared.collider_triangle_count,
            .first_shaped = shared.first_shaped,
            .first_split = shared.first_split,
            .max_splits = shared.max_splits,
            .crease_angle = shared.crease_angle,
            .texture = text_of(shared.texture),
            .friction = text_of(shared.friction)};
  return take_map(shared, head, object.map);
}

bool take_knob(const SharedKnob& shared, SharedScene::Knob& knob) {
  // Written so that NaN is rejected.
  if (!(shared.min < shared.max && shared.initial >= shared.min && shared.initial <= shared.max &&
        std::isfinite(shared.max - shared.min))) {
    return false;
  }
  knob = {text_of(shared.name), text_of(shared.unit), shared.min, shared.max, shared.initial};
  return true;
}

/// Copies the bytes of the head, except `ready`, which another process may be writing.
void copy_head(std::span<const std::byte> memory, SharedHead& head) {
  constexpr std::size_t kAfter = sizeof head.ready;
  auto* to = reinterpret_cast<std::byte*>(&head);
  std::memcpy(to + kAfter, memory.data() + kAfter, sizeof head - kAfter);
  head.ready.store(0, std::memory_order_relaxed);
}

}  // namespace

std::uint64_t shared_hash(const SharedHead& head, std::span<const SharedObject> objects,
                          std::span<const SharedKnob> knobs, std::span<const SharedVertex> vertices,
                          std::span<const SharedTriangle> triangles,
                          std::span<const float> map_values) noexcept {
  constexpr std::uint64_t kBegin = 0xcbf29ce484222325;
  SharedHead counted{};
  copy_head(std::as_bytes(std::span(&head, 1)), counted);
  counted.hash = 0;
  std::uint64_t hash = mix_bytes(kBegin, std::as_bytes(std::span(&counted, 1)));
  hash = mix_bytes(hash, std::as_bytes(objects));
  hash = mix_bytes(hash, std::as_bytes(knobs));
  hash = mix_bytes(hash, std::as_bytes(vertices));
  hash = mix_bytes(hash, std::as_bytes(triangles));
  return mix_bytes(hash, std::as_bytes(map_values));
}

driver::Result<SharedScene> read_shared_scene(std::span<const std::byte> memory) {
  static_assert(offsetof(SharedHead, ready) == 0 && offsetof(SharedHead, layout) == 8);
  if (memory.size() < 16) return broken("it is too short");
  const auto& in_memory = *reinterpret_cast<const SharedHead*>(memory.data());
  const std::uint64_t ready = in_memory.ready.load(std::memory_order_acquire);
  if (ready == 0) return driver::Error{"The run is still loading; try again shortly."};
  if (ready != kSharedReady) return broken("its header is invalid");
  // Checked first, because the remaining data may have another layout in another build.
  std::uint64_t layout = 0;
  std::memcpy(&layout, memory.data() + offsetof(SharedHead, layout), sizeof layout);
  if (layout != shared_layout_hash()) {
    return driver::Error{"The run uses memory layout " + std::to_string(layout) +
                         ", this viewer layout " + std::to_string(shared_layout_hash()) +
                         ": they are different builds of thimble. Use the same build for both."};
  }
  if (memory.size() < kSharedTablesOffset) return broken("it is too short");
  SharedHead head{};
  copy_head(memory, head);
  const std::uint64_t total = memory.size();
  if (head.total_bytes != total) return broken("its size is wrong");
  if (!lies_in(head.objects, sizeof(SharedObject), total) ||
      !lies_in(head.knobs, sizeof(SharedKnob), total) ||
      !lies_in(head.vertices, sizeof(SharedVertex), total) ||
      !lies_in(head.triangles, sizeof(SharedTriangle), total) ||
      !lies_in(head.map_values, sizeof(float), total) ||
      !lies_in(head.field, sizeof(SharedFieldSample), total) ||
      !lies_in(head.shaped, sizeof(SharedShaped), total) ||
      !lies_in(head.splits, sizeof(SharedSplit), total) ||
      !lies_in(head.ring, sizeof(SharedRingSlot), total)) {
    return broken("a table is outside of it");
  }
  if (head.objects.count > kObjectsMax || head.knobs.count > kKnobsMax ||
      head.field.count > kFieldSamplesMax || head.ring.count == 0 ||
      head.vertices.count > UINT32_MAX) {
    return broken("a count is out of bounds");
  }
  const auto objects = copy_of<SharedObject>(memory, head.objects);
  const auto knobs = copy_of<SharedKnob>(memory, head.knobs);
  const auto vertices = copy_of<SharedVertex>(memory, head.vertices);
  SharedScene scene;
  scene.triangles = copy_of<SharedTriangle>(memory, head.triangles);
  scene.map_values = copy_of<float>(memory, head.map_values);
  if (shared_hash(head, objects, knobs, vertices, scene.triangles, scene.map_values) != head.hash) {
    return broken("its checksum is wrong");
  }

  // The checksum does not prove that the values are valid.
  if (!(head.period_ns > 0) || !(head.force_max >= 0) || !std::isfinite(head.force_max)) {
    return broken("its period or force limit is invalid");
  }
  if (!(head.tip_radius >= 0) || !std::isfinite(head.tip_radius)) {
    return broken("the radius of the tip is invalid");
  }
  if (head.arm_count < 1 || head.arm_count > kArmsMax)
    return broken("the number of arms is invalid");
  scene.arms.resize(head.arm_count);
  for (std::size_t i = 0; i < scene.arms.size(); ++i) {
    if (!take_arm(head.arms[i], scene.arms[i])) return broken("an arm is invalid");
  }
  for (const SharedTriangle& triangle : scene.triangles) {
    for (const std::uint32_t vertex : triangle) {
      if (vertex >= head.vertices.count) return broken("a triangle has an invalid vertex");
    }
  }
  for (const SharedObject& object : objects) {
    if (!take_object(object, head, scene.triangles, scene.objects.emplace_back())) {
      return broken("an object is invalid");
    }
  }
  for (const float value : scene.map_values) {
    if (!(value >= 0 && value <= 1)) return broken("a value of a map is out of bounds");
  }
  for (const SharedKnob& knob : knobs) {
    if (!take_knob(knob, scene.knobs.emplace_back())) return broken("a knob is invalid");
  }
  scene.vertices.reserve(vertices.size());
  for (const SharedVertex& vertex : vertices) {
    if (!all_finite(vertex)) return broken("a vertex is not finite");
    scene.vertices.push_back(vector_of(vertex));
  }
  for (const auto& sample : copy_of<SharedFieldSample>(memory, head.field)) {
    if (!all_finite(sample.p_W) || !all_finite(sample.f_W))
      return broken("a field sample is not finite");
    scene.field.push_back({vector_of(sample.p_W), vector_of(sample.f_W)});
  }
  scene.name = text_of(head.scene);
  scene.file = text_of(head.scene_file);
  scene.pid = head.pid;
  scene.began_ns = head.began_ns;
  scene.period_ns = head.period_ns;
  scene.force_max = head.force_max;
  scene.tip_radius = head.tip_radius;
  scene.duration = std::isfinite(head.duration) && head.duration > 0 ? head.duration : 0;
  scene.wall_clock = head.wall_clock == 1;
  scene.hand_by_mouse = head.hand_by_mouse == 1;
  scene.hold_by_key = head.hold_by_key == 1;
  scene.paced = head.paced == 1;
  scene.restarts = head.restarts == 1;
  scene.shaped = head.shaped;
  scene.splits = head.splits;
  scene.ring = head.ring;
  return scene;
}

}  // namespace thimble::session

#include "fuzz/shared_run_memory.h"

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "mesh/contact_mesh.h"
#include "share/arm_lines.h"
#include "share/shared_reader.h"
#include "share/shared_run.h"

namespace thimble::fuzz {
namespace {

void check(bool kept, const char* what) {
  if (kept) return;
  std::fprintf(stderr, "Check of a viewer failed: %s\n", what);
  std::abort();
}

/// Returns the memory of a run with an example of each content.
std::vector<std::byte> sound_memory() {
  session::SharedScene scene;
  scene.name = "fuzz";
  scene.period_ns = 1'000'000;
  scene.force_max = 5;
  scene.paced = scene.restarts = true;
  scene.arms.front().device = "sim";
  scene.arms.front().geometry = driver::DeltaArm{.a = 0.05, .b = 0.05, .c = 0.05, .r = 0.05};
  scene.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  scene.triangles = {{0, 1, 2}, {3, 4, 5}, {4, 3, 5}};
  scene.objects.push_back({.name = "a",
                           .moves = true,
                           .vertex_count = 3,
                           .triangle_count = 1,
                           .collider_first_vertex = 3,
                           .collider_vertex_count = 3,
                           .collider_first_triangle = 1,
                           .collider_triangle_count = 2});
  scene.objects.push_back({.name = "b",
                           .dents = true,
                           .shaped = true,
                           .first_vertex = 3,
                           .vertex_count = 3,
                           .first_triangle = 1,
                           .triangle_count = 2,
                           .max_splits = 2});
  scene.knobs.push_back({"a: stiffness", "N/m", 0, 800, 400});
  const auto run = session::SharedRun::create("", scene, 8).value();
  run->set_state(session::RunState::kRunning);
  driver::TickRecord tick;
  for (tick.tick = 0; tick.tick < 12; ++tick.tick) run->store_tick(tick);
  session::ScenePoses poses;
  poses.count = 1;
  run->store_poses(poses);
  render::BodyPatch patch{};
  patch.object = 1;
  patch.point_count = 3;
  patch.triangle_count = 1;
  patch.triangles[0] = {0, 1, 2};
  run->store_patch(patch);
  run->store_vertex(1, {1, 2, 3});
  run->store_split(0, {.vertex = 3, .ends = {0, 1}, .triangles = {0, 1}, .others = {2, 3}});
  run->set_recording_path("x.h5");
  return {run->memory().bytes().begin(), run->memory().bytes().end()};
}

void put_checksum_right(std::span<std::byte> memory) {
  auto& head = *reinterpret_cast<session::SharedHead*>(memory.data());
  const auto table = [&]<class T>(const session::SharedTable& t, T*) {
    const bool lies_in = t.offset % 64 == 0 && t.offset <= memory.size() &&
                         t.count <= (memory.size() - t.offset) / sizeof(T);
    return lies_in ? std::span(reinterpret_cast<const T*>(memory.data() + t.offset), t.count)
                   : std::span<const T>();
  };
  head.hash =
      session::shared_hash(head, table(head.objects, static_cast<session::SharedObject*>(nullptr)),
                           table(head.knobs, static_cast<session::SharedKnob*>(nullptr)),
                           table(head.vertices, static_cast<session::SharedVertex*>(nullptr)),
                           table(head.triangles, static_cast<session::SharedTriangle*>(nullptr)),
                           table(head.map_values, static_cast<float*>(nullptr)));
}

void read_everything(session::SharedReader& reader) {
  const session::SharedScene& scene = reader.scene();
  for (const auto& triangle : scene.triangles) {
    for (const std::uint32_t vertex : triangle) {
      check(vertex < scene.vertices.size(), "a triangle has vertices");
    }
  }
  for (const auto& vertex : scene.vertices)
    check(vertex.allFinite(), "a vertex has valid coordinates");
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const auto& object = scene.objects[i];
    check(object.first_vertex + object.vertex_count <= scene.vertices.size() &&
              object.first_triangle + object.triangle_count <= scene.triangles.size(),
          "an object is within its tables");
    for (std::size_t t = 0; t < object.collider_triangle_count; ++t) {
      for (const std::uint32_t v : scene.triangles[object.collider_first_triangle + t]) {
        check(v >= object.collider_first_vertex &&
                  v - object.collider_first_vertex < object.collider_vertex_count &&
                  v < scene.vertices.size(),
              "a triangle that collides has vertices");
      }
    }
    render::TriangleMesh mesh;
    mesh.vertices.assign(object.vertex_count, Eigen::Vector3d::Zero());
    for (std::size_t t = 0; t < object.triangle_count; ++t) {
      auto& corners = mesh.triangles.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        corners[k] = static_cast<std::int32_t>(scene.triangles[object.first_triangle + t][k] -
                                               object.first_vertex);
      }
    }
    reader.shape(i, mesh);
    for (const auto& vertex : mesh.vertices)
      check(vertex.allFinite(), "a moved vertex has valid coordinates");
    for (const auto& corners : mesh.triangles) {
      for (const std::int32_t vertex : corners) {
        check(vertex >= 0 && static_cast<std::size_t>(vertex) < mesh.vertices.size(),
              "a triangle that was split has vertices");
      }
    }
  }
  for (std::size_t i = 0; i < scene.knobs.size(); ++i) {
    const auto& knob = scene.knobs[i];
    for (const double value : {reader.knob(i), reader.knob_wanted(i)}) {
      check(value >= knob.min && value <= knob.max, "a knob is within its bounds");
    }
    reader.turn_knob(i, 1e9);
  }
  driver::TickRecord tick;
  std::vector<driver::TickRecord> ticks;
  if (reader.newest(tick)) ticks.push_back(tick);
  std::uint64_t serial = 0;
  reader.ticks_since(serial, ticks);
  for (const auto& one : ticks) {
    check(one.object < static_cast<int>(scene.objects.size()), "a tick names an object");
    check(std::isfinite(one.p_WT[0]) && std::isfinite(one.depth), "a tick has valid coordinates");
    static_cast<void>(session::arm_lines(scene.arms.front(), one));
  }
  session::ScenePoses poses;
  if (reader.poses(poses)) {
    check(poses.count <= session::ScenePoses::kMax, "the number of poses is valid");
    for (std::size_t i = 0; i < poses.count; ++i) {
      check(
          poses.object[i] >= 0 && static_cast<std::size_t>(poses.object[i]) < scene.objects.size(),
          "a pose names an object");
    }
  }
  render::BodyPatch patch{};
  if (reader.patch(patch) && patch.triangle_count > 0) {
    const auto& object = scene.objects[static_cast<std::size_t>(patch.object)];
    for (std::size_t t = 0; t < patch.triangle_count; ++t) {
      check(static_cast<std::size_t>(patch.source[t]) < object.triangle_count,
            "a patch refers to existing triangles");
      for (const auto corner : patch.triangles[t]) {
        check(corner < patch.point_count, "a patch has its corners");
      }
    }
  }
  static_cast<void>(reader.state());
  static_cast<void>(reader.counters());
  static_cast<void>(reader.recording_path());
  static_cast<void>(reader.notice());
  check(reader.speed_asked() >= session::kSpeedMin && reader.speed_asked() <= session::kSpeedMax,
        "a speed is within its bounds");
  static_cast<void>(reader.loop_asked());
  static_cast<void>(reader.ask_speed(1e9));
  static_cast<void>(reader.ask_steps(1'000'000));
  static_cast<void>(reader.ask_loop(true));
  static_cast<void>(reader.ask_restart("somewhere"));
  reader.ask_record("somewhere");
  reader.lead_hand({0, 0, 0}, true);
  reader.ask_record_stop();
}

}  // namespace

bool read_shared_memory(std::span<const std::byte> bytes) {
  static const std::vector<std::byte> sound = sound_memory();
  // Aligned like mapped memory.
  struct alignas(64) Line {
    std::byte bytes[64];
  };
  std::vector<Line> lines((sound.size() + 63) / 64);
  const std::span<std::byte> memory(lines.front().bytes, sound.size());
  std::memcpy(memory.data(), sound.data(), sound.size());
  const bool rehash = !bytes.empty() && (std::to_integer<unsigned>(bytes[0]) & 1) != 0;
  std::span<const std::byte> orders = bytes.empty() ? bytes : bytes.subspan(1);
  while (orders.size() > 5) {
    std::uint32_t place = 0;
    std::memcpy(&place, orders.data(), sizeof place);
    std::size_t count = std::to_integer<unsigned>(orders[4]) % 17;
    orders = orders.subspan(5);
    count = std::min(count, orders.size());
    for (std::size_t i = 0; i < count; ++i) {
      memory[(place + i) % memory.size()] = orders[i];
    }
    orders = orders.subspan(count);
  }
  if (rehash) put_checksum_right(memory);
  auto reader = session::SharedReader::over(memory);
  if (!reader) {
    check(!reader.error().message.empty(), "an error has a message");
    return false;
  }
  read_everything(**reader);
  return true;
}

}  // namespace thimble::fuzz

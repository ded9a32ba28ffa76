#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "share/shared_layout.h"
#include "thimble/driver/arm_model.h"
#include "thimble/driver/result.h"

namespace thimble::session {

/// What does not change of a run, copied out of its shared memory and found sound: all counts
/// and numbers of vertices are within bounds, all places finite.
struct SharedScene {
  /// One object: a range of `vertices` and `triangles`.
  struct Object {
    std::string name;
    SharedKind kind = SharedKind::kMesh;
    std::uint32_t colour = 0;
    bool moves = false;   ///< SharedReader::poses tells where it is.
    bool dents = false;   ///< SharedReader::patch tells how it is bent.
    bool shaped = false;  ///< SharedReader::shape tells what it is now.
    std::size_t first_vertex = 0, vertex_count = 0;
    std::size_t first_triangle = 0, triangle_count = 0;
    std::size_t first_shaped = 0;
    std::size_t first_split = 0, splits_most = 0;  ///< Of its edges; 0: its triangles stay.
    double crease_angle = 0;                       ///< Edges sharper than this stay sharp, rad.
    std::string texture{}, friction{};             ///< Their names; empty: it has none.
  };
  /// The force of all fields on a tip that rests at a place, as the scene begins.
  struct FieldSample {
    Eigen::Vector3d p_W{0, 0, 0};  ///< m
    Eigen::Vector3d f_W{0, 0, 0};  ///< N
  };
  /// One setting of the scene that can be changed while it is felt.
  struct Knob {
    std::string name;  ///< "OBJECT: stiffness"
    std::string unit;
    double least = 0, most = 0, initial = 0;
  };
  /// What is needed to draw the arm: see arm_lines.h.
  struct Arm {
    std::string name;
    std::string device;
    std::string in_scene{};                              ///< What the scene calls it, of several.
    std::optional<driver::ArmGeometry> geometry{};       ///< How it is built; none: only its tip.
    Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();  ///< Rotation of its base in the world.
    Eigen::Vector3d p_WB{0, 0, 0};                       ///< Where its base stands, m.
    Eigen::Vector3d min_W{0, 0, 0}, max_W{0, 0, 0};      ///< Box of its workspace, m.
  };

  std::string name;
  std::string file;
  std::int64_t pid = 0;
  std::int64_t began_ns = 0;   ///< When the run was made, on the system's clock.
  std::int64_t period_ns = 0;  ///< Of the loop; > 0.
  double force_max = 0;        ///< N
  bool wall_clock = false;
  bool hand_by_mouse = false;
  bool hold_by_key = false;  ///< A key must be held to have forces (HoldToRun).
  bool paced = false;        ///< Simulated time, at a pace that viewers choose.
  bool restarts = false;     ///< It is begun anew, or with another scene, when a viewer asks.
  std::vector<Arm> arms = std::vector<Arm>(1);  ///< From 1 to kArmsMost.
  std::vector<Object> objects;
  std::vector<Knob> knobs;
  std::vector<FieldSample> field;         ///< At most kFieldSamplesMost; none: no field.
  std::vector<Eigen::Vector3d> vertices;  ///< W, m, as they were before the first tick.
  std::vector<std::array<std::uint32_t, 3>>
      triangles;                     ///< Of all `vertices`; outside is counter-clockwise.
  SharedTable shaped, splits, ring;  ///< Where those tables lie; whole within the memory.
};

/// Reads what does not change out of a run's memory, each byte once, and checks all of it before it
/// is used. `memory` may hold anything; it must begin at a multiple of 64. The error says what to
/// do. Real-time: never from the servo thread.
driver::Result<SharedScene> read_shared_scene(std::span<const std::byte> memory);

/// Finds the hash of what does not change: of the head, whose `ready` and `hash` do not count, and
/// of its tables. It finds accidents, not malice. Real-time: never from the servo thread.
std::uint64_t shared_hash(const SharedHead& head, std::span<const SharedObject> objects,
                          std::span<const SharedKnob> knobs, std::span<const SharedVertex> vertices,
                          std::span<const SharedTriangle> triangles) noexcept;

}  // namespace thimble::session

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

/// Constant data of a run, copied from its shared memory and validated: all counts and vertex
/// indices are within bounds, all positions finite.
struct SharedScene {
  /// Map of a mesh as drawn (render/src/map_picture.h).
  struct Map {
    std::string quantity{};  ///< "stiffness"; empty: no map.
    std::string unit{};
    double min = 0, max = 0;      ///< Values at 0 and 1, in `unit`; min <= max.
    std::uint32_t parts = 0;      ///< Parts of each side of a triangle; 0: no map.
    std::size_t first_value = 0;  ///< Index of its first value in `map_values`.
  };
  /// Object: a range of `vertices` and `triangles`.
  struct Object {
    std::string name;
    SharedKind kind = SharedKind::kMesh;
    std::uint32_t colour = 0;
    bool moves = false;   ///< True if SharedReader::poses returns its pose.
    bool dents = false;   ///< True if SharedReader::patch returns its dent.
    bool shaped = false;  ///< True if SharedReader::shape returns its current mesh.
    std::size_t first_vertex = 0, vertex_count = 0;
    std::size_t first_triangle = 0, triangle_count = 0;
    /// Ranges of the shape with which it collides, at its first place; without triangles: it meets
    /// nothing. They may be its own.
    std::size_t collider_first_vertex = 0, collider_vertex_count = 0;
    std::size_t collider_first_triangle = 0, collider_triangle_count = 0;
    std::size_t first_shaped = 0;
    /// Range of its edge splits; max_splits is 0 if its triangles never change.
    std::size_t first_split = 0, max_splits = 0;
    double crease_angle = 0;  ///< Edges sharper than this stay sharp, rad.
    /// Names of its texture and friction; empty: none.
    std::string texture{}, friction{};
    Map map{};
  };
  /// Total force of the fields on a resting tip at one point, at the start of the scene.
  struct FieldSample {
    Eigen::Vector3d p_W{0, 0, 0};  ///< Position, m.
    Eigen::Vector3d f_W{0, 0, 0};  ///< Force, N.
  };
  /// Setting of the scene that can be changed during contact.
  struct Knob {
    std::string name;  ///< Name, such as "OBJECT: stiffness".
    std::string unit;
    double min = 0, max = 0, initial = 0;
  };
  /// Data for drawing an arm: see arm_lines.h.
  struct Arm {
    std::string name;
    std::string device;
    std::string in_scene{};                              ///< Name in a scene with several arms.
    std::optional<driver::ArmGeometry> geometry{};       ///< Geometry; none: only the tip is drawn.
    Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();  ///< Rotation of its base in the world.
    Eigen::Vector3d p_WB{0, 0, 0};                       ///< Position of its base in the world, m.
    Eigen::Vector3d min_W{0, 0, 0}, max_W{0, 0, 0};      ///< Box of its workspace, m.
  };

  std::string name;
  std::string file;
  std::int64_t pid = 0;
  std::int64_t began_ns = 0;   ///< Time of creation, on the system's clock.
  std::int64_t period_ns = 0;  ///< Period of the loop, ns; > 0.
  double force_max = 0;        ///< Force limit of the gate, N.
  double tip_radius = 0;       ///< Radius of a tip that is a ball, m; 0: a point.
  double duration = 0;         ///< Planned duration, s; 0: unknown.
  bool wall_clock = false;
  bool hand_by_mouse = false;
  /// True if a key must be held to get forces (HoldToRun).
  bool hold_by_key = false;
  /// True if time is simulated, at a pace chosen by viewers.
  bool paced = false;
  /// True if viewers can restart the run, with the same or another scene.
  bool restarts = false;
  std::vector<Arm> arms = std::vector<Arm>(1);  ///< Arms, 1 to kArmsMax.
  std::vector<Object> objects;
  std::vector<Knob> knobs;
  /// Samples of the field, at most kFieldSamplesMax; empty without a field.
  std::vector<FieldSample> field;
  std::vector<Eigen::Vector3d> vertices;  ///< Initial vertices in the world, m.
  /// Triangles as indices into `vertices`, counter-clockwise from outside.
  std::vector<std::array<std::uint32_t, 3>> triangles;
  /// Values of the maps of all objects, 0 to 1: those of the grid of each triangle.
  std::vector<float> map_values;
  SharedTable shaped, splits, ring;  ///< Places of these tables, completely within the memory.
};

/// Reads the constant data from a run's memory, each byte once, and validates all of it. `memory`
/// may contain anything; it must be aligned to 64 bytes. The error says what to do. Real-time:
/// never from the servo thread.
driver::Result<SharedScene> read_shared_scene(std::span<const std::byte> memory);

/// Returns the hash of the constant data: of the head without `ready` and `hash`, and of its
/// tables. It detects accidental damage, not manipulation. Real-time: never from the servo thread.
std::uint64_t shared_hash(const SharedHead& head, std::span<const SharedObject> objects,
                          std::span<const SharedKnob> knobs, std::span<const SharedVertex> vertices,
                          std::span<const SharedTriangle> triangles,
                          std::span<const float> map_values) noexcept;

}  // namespace thimble::session

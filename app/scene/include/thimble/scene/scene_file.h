#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/body/dent_settings.h"
#include "thimble/render/body/joint_choice.h"
#include "thimble/render/body/motion_choice.h"
#include "thimble/render/body/shape_choice.h"
#include "thimble/render/build_object_touch.h"
#include "thimble/render/build_primitive_touch.h"
#include "thimble/render/contact_choice.h"
#include "thimble/render/effect/effect_table.h"
#include "thimble/render/field/field_table.h"
#include "thimble/render/mesh/triangle_mesh.h"
#include "thimble/scene/arm_file.h"
#include "thimble/scene/hand_route.h"
#include "thimble/scene/shipped_files.h"

namespace thimble::scene {

/// An optional value that most objects do not have: absent, it takes the memory of a pointer. A
/// copy has its own value. Used as std::optional, and converts to it.
template <class T>
class RareOptional {
 public:
  RareOptional() = default;                                                 ///< No value.
  RareOptional(T value) : value_(std::make_unique<T>(std::move(value))) {}  ///< Takes a value.
  RareOptional(const RareOptional& other)
      : value_(other ? std::make_unique<T>(*other) : nullptr) {}  ///< Copies the value.
  RareOptional(RareOptional&&) noexcept = default;                ///< Moves the value.
  /// Takes the value of another.
  RareOptional& operator=(RareOptional other) noexcept {
    value_ = std::move(other.value_);
    return *this;
  }
  ~RareOptional() = default;

  /// Makes a value with default members, and returns it.
  T& emplace() { return *(value_ = std::make_unique<T>()); }

  bool has_value() const noexcept { return value_ != nullptr; }    ///< Whether there is a value.
  explicit operator bool() const noexcept { return has_value(); }  ///< The same.
  T& operator*() noexcept { return *value_; }                      ///< Value; there must be one.
  const T& operator*() const noexcept { return *value_; }          ///< The same.
  T* operator->() noexcept { return value_.get(); }                ///< Its members.
  const T* operator->() const noexcept { return value_.get(); }    ///< The same.
  /// Returns a copy.
  operator std::optional<T>() const { return value_ ? std::optional<T>(*value_) : std::nullopt; }

 private:
  std::unique_ptr<T> value_;
};

/// Shape used as an object of a scene instead of a mesh.
struct THIMBLE_EXPORT SceneShape {
  render::Primitive shape_W;  ///< Shape that is touched.
  double drawn_side = 0.1;    ///< Side of the square that is drawn of a plane, m.

  /// Returns the mesh to draw, for the hand's path and for the mass of a moving body, in the world,
  /// m. It cannot be touched. Makes the mesh at each call. Real-time: never from the servo thread.
  render::TriangleMesh mesh_W() const;
};

/// Material of an object. Empty members are not used.
struct SceneBody {
  RareOptional<render::DentSettings> dent;  ///< Denting of the surface under the cursor.
  /// Deformation of the base shape: permanent, or snapping between shapes.
  render::ShapeChoice shape;
  RareOptional<render::MotionChoice> motion;  ///< Motion of the object as a rigid body.
};

/// Object of a scene: a mesh, a shape or a field, with its place and feel.
struct THIMBLE_EXPORT SceneObject {
  std::string name;  ///< Name, unique in the scene.
  /// Mesh file; empty for a shape or a field. Of a mesh in memory its name in messages.
  std::filesystem::path mesh_file;
  /// Mesh in memory, in the unit of `scale`, used instead of a file if set (scene_builder.h).
  RareOptional<std::shared_ptr<const render::TriangleMesh>> mesh;
  bool paged = false;  ///< True if that is a page file, which stays mostly on disk.
  /// Memory for the pages of a page file, MiB; empty: that of render::PagingSettings.
  RareOptional<std::size_t> page_budget;
  std::optional<SceneShape> shape;   ///< Shape, if used instead of a mesh.
  render::FieldBuilder build_field;  ///< Field, if used instead of a mesh; it has no surface.
  std::optional<double> size;        ///< Largest side of the mesh's bounding box, m.
  /// Metres per unit of the mesh file, used if `size` is empty. If both are empty, the unit that
  /// the file declares, else 1.
  std::optional<double> scale;
  /// True if the mesh is repaired on load (repair_mesh).
  bool repair = false;
  std::optional<double> sheet_thickness;               ///< Thickness given to open surfaces, m.
  Eigen::Matrix3d R_WO = Eigen::Matrix3d::Identity();  ///< Rotation of the mesh in the world.
  /// Centre of the bounding box of the rotated mesh, in the world, m.
  Eigen::Vector3d p_WO{0, 0, 0};
  double stiffness = 0;  ///< Stiffness, N/m; with a `stiffness_map` the largest one.
  double damping = 0;    ///< Damping, N s/m.
  /// Factor of `stiffness` over the surface, from 0 to 1.
  RareOptional<render::MapChoice> stiffness_map;
  /// Factor of the coefficients of friction over the surface.
  RareOptional<render::MapChoice> friction_map;
  /// How the surface is found, tracked and rendered. If `tracker_named` is false and `tracker` is
  /// kEdgePlanes, `SceneObjects::build` chooses the tracker from the mesh (render::choose_tracker).
  render::ContactChoice contact;
  /// True if the scene (other than by "auto") or a quality names the tracker.
  bool tracker_named = false;
  /// Effects on the object, in the order of execution.
  std::vector<render::EffectPlan> effects;
  SceneBody body;  ///< Material.
  /// Bounds of the surface response, used if the object moves.
  render::BodyCoupling coupling;
  /// How it meets bodies; empty: with the default settings.
  RareOptional<render::CollisionChoice> collision;

  /// Returns whether texture coordinates or vertex colours of the mesh file are used. Real-time:
  /// never from the servo thread.
  bool needs_maps() const;
};

/// Joint between two objects of a scene, or an object and the world.
struct SceneJoint {
  render::JointChoice choice;  ///< Kind, place and limits.
  int a = -1;                  ///< Index of the object.
  int b = -1;                  ///< Index of the other object; -1: the world.
};

/// Place of one of several arms in a scene: a rotation about the vertical, then a translation.
struct THIMBLE_EXPORT ArmPlace {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();  ///< Rotation by a multiple of 90 degrees.
  Eigen::Vector3d p{0, 0, 0};                       ///< Translation, m.

  /// Returns the arm of an arm file moved to this place. Real-time: never from the servo thread.
  ArmFile put(ArmFile arm) const;
};

/// Arm of a scene, with the hand that moves it if it is simulated.
struct SceneArm {
  /// Name, unique in the scene ("left"); empty if there is only one arm.
  std::string name;
  std::filesystem::path arm_file;  ///< Path of the file from which `arm` was read.
  /// Arm file that the scene itself names. For a real arm only its stricter limits count, and
  /// only if it is not one of the arm files that come with Thimble (see `apply_arm_policy`).
  std::filesystem::path own_arm_file;
  ArmPlace place;                   ///< Place in the scene.
  ArmFile arm;                      ///< Contents of the arm file, moved to `place`.
  std::vector<HandWaypoint> hand;   ///< Path of the simulated hand.
  std::vector<ButtonStep> buttons;  ///< Buttons that the simulated hand holds.
};

/// Effect of a fault of one of several arms on the others.
enum class FaultRule {
  kTogether,  ///< The force of all arms is switched off, and the run ends.
  kApart,     ///< The other arms continue.
};

/// A scene: arms, objects, loop rate, and path of the simulated hand.
struct Scene {
  std::string name;  ///< Name to display.
  /// Description in a few sentences; may be empty.
  std::string description;
  std::filesystem::path file;  ///< Path of the scene file.
  /// Arms that touch the scene; at least one.
  std::vector<SceneArm> arms = std::vector<SceneArm>(1);
  double rate = 1000;  ///< Rate of the servo loop, Hz.
  /// Ratio of `rate` to the rate in the scene file.
  double rate_factor = 1;
  double duration = 0;  ///< Duration, s.
  /// Seed of all random numbers in the simulation.
  std::uint64_t seed = 0;
  /// Energy stage to use instead of the arm's, if set.
  std::optional<driver::EnergyStage> energy;
  /// Line of the energy stage in the scene file; 0: not set.
  int energy_line = 0;
  std::vector<SceneObject> objects;         ///< Objects that can be touched.
  std::vector<SceneJoint> joints;           ///< Joints between them.
  render::CollisionQuality collisions;      ///< Accuracy of collisions and joints.
  FaultRule faults = FaultRule::kTogether;  ///< Effect of a fault with several arms.
  /// Radius of a tip that is a ball, m; 0: a point.
  double tip_radius = 0;
  /// Files that the scene file names, other than arm files: meshes, pictures and bags, each once.
  std::vector<std::filesystem::path> inputs;
};

/// Options for reading a scene.
struct SceneReading {
  /// Arm file, by name or path, to use instead of that of the scene; empty: that of the scene.
  std::filesystem::path arm{};
  /// Folder of the meshes `cgal:NAME`; if empty, the folders that `thimble doctor` lists.
  std::filesystem::path mesh_folder{};
  /// Factor on the loop rate in the file, > 0. Above 1 the simulated board reports at the same
  /// higher rate. Below 1, every setting must be valid at the new rate. Every stiffness must then
  /// be at most half of the limit that latency sets for this arm and hand [PHYSICS 1.1].
  double rate_factor = 1;
  /// True if the caller handles several arms (Scene::arms). If false, a scene with several arms is
  /// an error.
  bool several_arms = false;
};

/// Reads a scene, given by name ("elephant") or path (see `find_scene`). app/scenes/elephant.yaml
/// is an example. Paths in the scene are relative to its file. The arm file is read too, because
/// stability depends on the arm. The error lists the known names, or up to five mistakes of the
/// file, one per line. Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<Scene> load_scene(const std::filesystem::path& scene,
                                                const SceneReading& reading = {});

}  // namespace thimble::scene

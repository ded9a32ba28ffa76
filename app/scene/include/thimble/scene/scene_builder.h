#pragma once

#include <Eigen/Core>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/effect/effect_table.h"
#include "thimble/render/mesh/triangle_mesh.h"
#include "thimble/scene/scene_file.h"

namespace thimble::scene {

// Scenes made in code instead of a file. The keys, units, limits and messages are those of scene
// files (guide, "Keys of scene and arm files"): the functions below only name the most common keys,
// and `set` accepts any. All values are checked by SceneBuilder::build. Real-time: none of these
// functions may be called from the servo thread.

class SceneMap;
class SceneText;

/// Value of a key: a number, a text, true or false, a list or a map.
class THIMBLE_EXPORT SceneValue {
 public:
  SceneValue(double number);  ///< Number, in the unit of the key; NaN is refused by `build`.
  /// Integer.
  template <std::integral T>
  requires(!std::same_as<T, bool>) SceneValue(T number) : text_(std::to_string(number)) {}
  /// true or false.
  template <std::same_as<bool> T>
  SceneValue(T flag) : text_(flag ? "true" : "false") {}
  SceneValue(std::string text);                                                 ///< Text.
  SceneValue(std::string_view text) : SceneValue(std::string(text)) {}          ///< Text.
  SceneValue(const char* text) : SceneValue(std::string(text)) {}               ///< Text.
  SceneValue(const std::filesystem::path& file) : SceneValue(file.string()) {}  ///< File name.
  SceneValue(const Eigen::Vector3d& numbers);  ///< List of three numbers.
  SceneValue(std::vector<SceneValue> list);    ///< List.
  SceneValue(SceneMap map);                    ///< Map.

 private:
  friend class SceneMap;
  friend class SceneBuilder;
  friend class SceneText;
  struct Parts;
  enum class Kind : std::uint8_t { kPlain, kText, kList, kMap };

  Kind kind_ = Kind::kPlain;
  std::string text_;                // Of a scalar.
  std::vector<SceneValue> values_;  // Of a list or a map.
  std::vector<std::string> keys_;   // Of a map.
};

/// Keys with values, in the order in which they were set.
class THIMBLE_EXPORT SceneMap {
 public:
  SceneMap() = default;  ///< No keys.
  /// Keys and values: `SceneMap{{"mass", 0.1}, {"kind", "rigid"}}`.
  SceneMap(std::initializer_list<std::pair<std::string_view, SceneValue>> entries);

  /// Sets a key; replaces its value if it has one.
  SceneMap& set(std::string_view key, SceneValue value);
  /// Returns the value of a key to change it; a list without entries if the key was not set.
  SceneValue& operator[](std::string_view key);
  /// Appends an entry to the list of a key.
  SceneMap& append(std::string_view key, SceneValue entry);
  /// Returns whether no key is set.
  bool empty() const noexcept { return keys_.empty(); }
  /// Calls `visit` with each key and its value, in the order in which they were set.
  template <class Visit>
  void each(const Visit& visit) const {
    for (std::size_t i = 0; i < keys_.size(); ++i) visit(keys_[i], values_[i]);
  }

 private:
  friend class SceneBuilder;
  friend class SceneValue;

  std::vector<std::string> keys_;
  std::vector<SceneValue> values_;
};

/// Object of a scene that is made in code: one shape, mesh or field, with its place and feel.
class THIMBLE_EXPORT ObjectBuilder {
 public:
  /// Sets any key of an object in a scene file, such as `collision`.
  ObjectBuilder& set(std::string_view key, SceneValue value);

  /// Mesh of a file: a path relative to SceneBuilder::folder, or `cgal:NAME`.
  ObjectBuilder& mesh(const std::filesystem::path& file);
  /// Mesh in memory: vertices in m unless `size` or `scale` is set, triangles counter-clockwise
  /// from outside. It is checked as the mesh of a file is, when the scene is loaded to be touched.
  ObjectBuilder& mesh(render::TriangleMesh mesh);
  ObjectBuilder& sphere(double radius);                   ///< Sphere, m.
  ObjectBuilder& box(const Eigen::Vector3d& sides);       ///< Box, m.
  ObjectBuilder& cylinder(double radius, double height);  ///< Cylinder along z, m.
  ObjectBuilder& capsule(double radius, double height);   ///< Capsule along z, m.
  ObjectBuilder& cone(double radius, double height);      ///< Cone along z, m.
  ObjectBuilder& torus(double radius, double tube);       ///< Ring about z, m.
  /// Half-space behind a plane through `position` with a normal (direction; any length).
  ObjectBuilder& plane(const Eigen::Vector3d& normal = Eigen::Vector3d::UnitZ());
  /// Field without a surface, such as "viscous", with its settings.
  ObjectBuilder& field(std::string_view kind, const SceneMap& settings = {});

  ObjectBuilder& size(double side);                      ///< Largest side of a mesh, m.
  ObjectBuilder& scale(double factor);                   ///< Metres per unit of a mesh.
  ObjectBuilder& position(const Eigen::Vector3d& p_WO);  ///< Centre in the world, m.
  /// Rotates by degrees about a fixed axis ('x', 'y' or 'z'), after the rotations set before.
  ObjectBuilder& rotate(char axis, double degrees);
  ObjectBuilder& stiffness(double stiffness);  ///< Stiffness, N/m.
  ObjectBuilder& damping(double damping);      ///< Damping, N s/m.
  ObjectBuilder& contact(SceneMap settings);   ///< Tracker, blending and others.
  ObjectBuilder& body(SceneMap parts);         ///< Material: dent, plastic, snap, motion.
  /// Adds an effect: its group ("friction"), its name ("bristle") and its settings.
  ObjectBuilder& effect(std::string_view group, std::string_view name, SceneMap settings = {});
  /// Adds a friction.
  ObjectBuilder& friction(std::string_view name, SceneMap settings = {}) {
    return effect("friction", name, std::move(settings));
  }
  /// Adds a texture.
  ObjectBuilder& texture(std::string_view name, SceneMap settings = {}) {
    return effect("texture", name, std::move(settings));
  }
  /// Adds an effect of the program (render/effect/effect_table.h); its stage must be real-time
  /// safe. A scene with such effects cannot be written as YAML.
  ObjectBuilder& own_effect(render::EffectPlan plan);

 private:
  friend class SceneBuilder;
  explicit ObjectBuilder(std::string_view name);

  SceneMap map_;
  std::shared_ptr<const render::TriangleMesh> mesh_;
  std::vector<render::EffectPlan> own_effects_;
};

/// Path and grip of a simulated hand. Times are in s from the start, points in the world, m.
class THIMBLE_EXPORT HandBuilder {
 public:
  /// Sets any key of a hand in a scene file, such as `grip` or `bag`.
  HandBuilder& set(std::string_view key, SceneValue value);
  /// Adds a point in free space. `stop`: whether the hand rests there.
  HandBuilder& at(double time, const Eigen::Vector3d& p_W, bool stop = false);
  /// Adds the point of an object's surface that is closest to `near_W`, pressed in by `press` (m).
  HandBuilder& on(double time, std::string_view object, const Eigen::Vector3d& near_W,
                  double press = 0, bool stop = false);
  /// Adds a point with any keys of a point in a scene file.
  HandBuilder& waypoint(SceneMap keys);

 private:
  friend class SceneBuilder;
  friend class ArmBuilder;
  HandBuilder() = default;

  SceneMap map_;
};

/// One of several arms of a scene.
class THIMBLE_EXPORT ArmBuilder {
 public:
  /// Sets any key of an entry of `arms` in a scene file.
  ArmBuilder& set(std::string_view key, SceneValue value);
  /// Places the arm: a position in the world (m) and a rotation about the vertical, a multiple of
  /// 90 degrees.
  ArmBuilder& at(const Eigen::Vector3d& p_W, double turn_degrees = 0);
  /// Returns the hand that moves the arm if it is simulated.
  HandBuilder& hand() noexcept { return hand_; }

 private:
  friend class SceneBuilder;
  ArmBuilder(std::string_view name, std::string_view arm);

  SceneMap map_;
  HandBuilder hand_;
};

/// A scene made in code. References to its objects, hands and arms stay valid while it lives and is
/// not moved. Example: app/examples/13_own_scene.cpp.
class THIMBLE_EXPORT SceneBuilder {
 public:
  /// Constructs a scene without objects. `name`: name to display.
  explicit SceneBuilder(std::string_view name);

  /// Sets any key at the top level of a scene file, such as `gate`.
  SceneBuilder& set(std::string_view key, SceneValue value);
  SceneBuilder& description(std::string_view text);  ///< Description in a few sentences.
  SceneBuilder& arm(std::string_view arm);  ///< The only arm: a name, or a file in `folder`.
  SceneBuilder& rate(double rate);          ///< Rate of the loop, Hz.
  SceneBuilder& duration(double duration);  ///< Duration, s.
  SceneBuilder& seed(std::uint64_t seed);   ///< Seed of all random numbers; at most 2^53.
  SceneBuilder& gravity(const Eigen::Vector3d& g_W);  ///< Gravity of all bodies, m/s^2.
  SceneBuilder& tool_radius(double radius);           ///< Radius of a tip that is a ball, m.
  SceneBuilder& joint(SceneMap keys);                 ///< Adds a joint; keys as in a scene file.
  /// Sets the folder to which file names are relative; the default is the working folder.
  SceneBuilder& folder(std::filesystem::path folder);

  /// Adds an object. `name` must be unique in the scene.
  ObjectBuilder& object(std::string_view name);
  /// Adds one of several arms, by name or file, instead of `arm` and `hand`. `name` must be unique.
  ArmBuilder& add_arm(std::string_view name, std::string_view arm);
  /// Returns the simulated hand of the only arm.
  HandBuilder& hand() noexcept { return hand_; }

  /// Reads the scene as load_scene reads a file. The error has up to five mistakes, one per line:
  /// "object 2 'cube': stiffness: expected a number from 0 to 100000 N/m, found "-1".". A mesh in
  /// memory is checked by SceneObjects::build, as that of a file.
  driver::Result<Scene> build(const SceneReading& reading = {}) const;

  /// Returns the scene as the text of a scene file, from which load_scene reads an equal scene. A
  /// mesh in memory is named as the file that `save` writes. Does not check the values. Fails if an
  /// object has an effect of the program (`own_effect`), or a text is not UTF-8.
  driver::Result<std::string> yaml() const;
  /// Writes the scene file, and each mesh in memory as an OFF file next to it, SCENE_NUMBER.off.
  /// Relative file names become absolute if the file is not in `folder`. Existing files of the same
  /// kind are replaced. The error names the file. Fails also as `yaml`.
  driver::Result<void> save(const std::filesystem::path& file) const;

  /// Returns the path by which messages of a run and recordings name the scene: NAME.yaml in the
  /// folder of the scene. The file need not exist.
  std::filesystem::path file() const;
  /// Returns whether an object has an effect of the program.
  bool has_own_effects() const noexcept;
  /// Returns the text of `yaml` without the effects of the program, for recordings.
  std::string text() const;

 private:
  SceneText write(const std::vector<std::string>& mesh_names,
                  const std::filesystem::path& files_in = {}) const;
  std::vector<std::string> mesh_names(std::string_view stem) const;
  driver::Result<std::string> checked_text(const std::vector<std::string>& mesh_names) const;
  std::filesystem::path folder_now() const;
  std::size_t listed_objects() const;  // Objects that `set` has added.
  std::string place_of(std::size_t object) const;

  std::string name_;
  SceneMap map_;
  std::filesystem::path folder_;  // Empty: the working folder.
  std::deque<ObjectBuilder> objects_;
  std::deque<ArmBuilder> arms_;
  HandBuilder hand_;
};

}  // namespace thimble::scene

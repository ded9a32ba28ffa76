#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "page/paged_contact.h"
#include "thimble/driver/result.h"
#include "thimble/render/contact_choice.h"
#include "thimble/render/effect/effect_table.h"
#include "thimble/render/field/field_table.h"
#include "thimble/render/mesh/triangle_mesh.h"
#include "thimble/scene/arm_file.h"
#include "thimble/scene/hand_route.h"
#include "thimble/scene/scene_body.h"
#include "thimble/scene/scene_shapes.h"

namespace thimble::scene {

/// Is one object of a scene: a mesh, a shape or a field, where it stands, and how it feels.
struct SceneObject {
  std::string name;
  std::filesystem::path mesh_file;   ///< Empty for a shape or a field.
  bool paged = false;                ///< Whether that is a page file, of which little is in memory.
  std::optional<SceneShape> shape;   ///< A shape instead of a mesh.
  render::FieldBuilder build_field;  ///< A field instead of a mesh; it has no surface.
  std::optional<double> size;        ///< Largest side of the mesh's box, m.
  std::optional<double> scale;       ///< Metres per unit of the file, if no size: as the file
                                     ///< says, else 1.
  bool repair = false;               ///< Whether the mesh is repaired first (repair_mesh).
  std::optional<double> sheet_thickness;  ///< Of the sheets that are made of what is open, m.
  Eigen::Matrix3d R_WO = Eigen::Matrix3d::Identity();  ///< Rotation of the mesh in the world.
  Eigen::Vector3d p_WO{0, 0, 0};            ///< Where the centre of the turned mesh's box lies, m.
  double stiffness = 0;                     ///< N/m
  double damping = 0;                       ///< N s/m
  render::ContactChoice contact;            ///< How the surface is found, followed and felt.
  std::vector<render::EffectPlan> effects;  ///< What is put on it, as a tick runs them.
  SceneBody body;                           ///< What its matter does.
  render::BodyCoupling coupling;            ///< How stiff its surface answers, if it moves.
};

/// Is one scene: which arm touches what, how fast the loop runs, and what the simulated hand does.
struct Scene {
  std::string name;
  std::string description;
  std::filesystem::path arm_file;      ///< Whence `arm` comes.
  std::filesystem::path own_arm_file;  ///< What the scene itself names; a wish for the simulation.
  ArmFile arm;
  double rate = 1000;                         ///< Ticks per second, Hz.
  double duration = 0;                        ///< s
  std::uint64_t seed = 0;                     ///< Of everything random in the simulation.
  std::optional<driver::EnergyStage> energy;  ///< In place of the arm's own, if named.
  int energy_line = 0;                        ///< Where in the scene's file; 0 if not named.
  std::vector<SceneObject> objects;
  std::vector<HandWaypoint> hand;
};

/// Reads a scene file (see app/scenes/elephant.yaml for the form). Paths in it are relative to the
/// file; a mesh `cgal:NAME` is looked for in `mesh_folder`. Objects must not share a name. The
/// arm's file is read too, or `other_arm` in its place if named: what is stable depends on the arm.
/// The error tells up to five mistakes,
/// one per line. Real-time: never from the servo thread.
driver::Result<Scene> read_scene(const std::filesystem::path& file,
                                 const std::filesystem::path& mesh_folder,
                                 const std::filesystem::path& other_arm = {});

/// Is how a mesh file stands in the world: p_W = p_WM + scale R_WO p, with p as in the file.
struct MeshPlacement {
  double scale = 1;               ///< m per unit of the file
  Eigen::Vector3d p_WM{0, 0, 0};  ///< m
};

/// Finds how the mesh of an object stands in the world. Precondition: the mesh has a vertex.
/// Real-time: never from the servo thread.
MeshPlacement placement_of(const render::TriangleMesh& mesh, const SceneObject& object);

/// Turns a mesh as its file holds it into the world (m), as `object` says.
/// Precondition: the mesh has a vertex. Real-time: never from the servo thread.
render::TriangleMesh place_mesh(const render::TriangleMesh& mesh, const SceneObject& object);

/// Finds where a mesh on the disk stands in the world, as `object` says; it turns about the centre
/// of its box in the file, for the box of the turned mesh is not known.
/// Real-time: never from the servo thread.
render::PagedPlace place_pages(const render::PageFile& file, const SceneObject& object);

}  // namespace thimble::scene

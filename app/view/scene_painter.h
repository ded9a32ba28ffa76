#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "view/camera.h"
#include "view/drawn_scene.h"
#include "view/gl/canvas.h"
#include "view/gl/coloured_model.h"
#include "view/gl/gl_objects.h"
#include "view/gl/scene_programs.h"
#include "view/gl/shaders.h"
#include "view/gl/shadow_map.h"
#include "view/gl/solids.h"
#include "view/gl/surface_model.h"
#include "view/maps/mapped_surfaces.h"
#include "view/overlays/collider_models.h"
#include "view/overlays/pane_model.h"
#include "view/touch_marks.h"

namespace thimble::view {

/// Whether polygons are outlined.
enum class Edges {
  kAuto,  ///< If they are few enough to be distinguished.
  kOff,
  kOn,
};

/// How dents are drawn.
enum class DentNormals {
  kSplit,  ///< New corners keep the shading of their place (DentSurface).
  kNaive,  ///< As for any mesh: each vertex has the mean normal of its polygons. For comparison.
};

/// Options of drawing.
struct PaintChoice {
  Shading shading = Shading::kPhong;
  Edges edges = Edges::kAuto;
  DentNormals dent_normals = DentNormals::kSplit;
  bool shadows = true;
  /// Smooth edges, and soft shadow edges of 16 samples instead of 4.
  bool fine = true;
  bool grid = true;
  bool fields = false;     ///< Forces of the scene's fields, as arrows.
  bool trail = false;      ///< The tip's path of the last seconds, coloured by force.
  bool surfaces = false;   ///< Marks on textures and friction.
  bool colliders = false;  ///< Shapes with which objects collide.
  Theme theme = Theme::kLight;
  MarkChoice marks;
};

/// Draws one scene with OpenGL, moment by moment; the same for files and for the window.
/// Precondition of all: the context it was made in is current. Real-time: never from the servo
/// thread.
class ScenePainter {
 public:
  ScenePainter(DrawnScene scene, ScenePrograms programs);

  const DrawnScene& scene() const { return scene_; }

  /// Paints the picture onto the canvas, including the pixels. Returns the labels, which are text
  /// and not painted here.
  std::vector<Label> paint(const DrawnMoment& moment, const Camera& camera,
                           const PaintChoice& choice, Canvas& canvas);

 private:
  void set_view(const Camera& camera, Theme theme, const std::vector<Solid>& solids,
                const Canvas& canvas);
  void paint_shadows(const std::vector<Solid>& solids);
  void paint_shadow(std::size_t object);
  void paint_surfaces(const PaintChoice& choice, const Camera& camera, bool gouraud);
  void paint_mapped(std::size_t object, int marks);
  void paint_light(const PaintChoice& choice);
  void paint_pixels(const PaintChoice& choice, Canvas& canvas);
  void set_shadows(const GlProgram& program, const PaintChoice& choice) const;
  void paint_solids(const std::vector<Solid>& solids);
  void paint_translucent(const std::vector<Solid>& solids);
  void paint_edges(const PaintChoice& choice);
  void paint_ground(const PaintChoice& choice, const Canvas& canvas);
  void paint_forces(const DrawnMoment& moment, const PaintChoice& choice, double eye_distance);
  void place_objects(const DrawnMoment& moment, DentNormals normals);
  float shadow_offset() const;
  const SurfaceModel& shown(std::size_t object) const;

  DrawnScene scene_;
  ScenePrograms programs_;
  std::vector<SurfaceModel> models_;
  std::vector<std::shared_ptr<const render::TriangleMesh>> shapes_;  // the shapes in models_
  std::unique_ptr<SurfaceModel> naive_;  // of the bent object, for DentNormals::kNaive
  std::size_t naive_object_ = 0;
  std::unique_ptr<MappedSurfaces> mapped_;  // null: no object has a map
  SolidModels solids_;
  std::vector<Eigen::Matrix4f> places_;  // poses of the objects in this picture
  Eigen::AlignedBox2i ground_shadow_;    // box with all shadows on the ground, pixels
  GlBuffer view_block_;
  GlVertexArray nothing_;
  PaneModel panes_;
  std::unique_ptr<ColliderModels> colliders_;  // null until they are shown
  ColouredModel field_, trail_;
  double field_strongest_ = -1;  // N, end of the scale of the current field's colours
  ShadowMap shadow_map_;
  std::vector<Eigen::Matrix4f> last_places_;  // poses at the last drawing of shadows
  std::vector<bool> changed_;                 // objects bent or shaped since then
  std::vector<bool> kept_;                    // objects in the kept shadow map
  Eigen::Vector3d light_centre_{0, 0, 0};
  double light_radius_ = 0.2;         // m: objects closer to the centre cast shadows
  double ground_height_ = 0;          // m
  std::ptrdiff_t floor_object_ = -1;  // the object drawn as the ground: a level plane
};

}  // namespace thimble::view

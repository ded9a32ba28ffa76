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
#include "view/overlays/pane_model.h"
#include "view/touch_marks.h"

namespace thimble::view {

/// Says whether polygons are outlined.
enum class Edges {
  kAuto,  ///< Where they are few enough to be seen one by one.
  kOff,
  kOn,
};

/// How dents are drawn.
enum class DentNormals {
  kSplit,  ///< New corners keep what was shown at their place (DentSurface).
  kNaive,  ///< As any mesh is: each vertex has the mean of its polygons. To compare.
};

/// How a scene is drawn.
struct PaintChoice {
  Shading shading = Shading::kPhong;
  Edges edges = Edges::kAuto;
  DentNormals dent_normals = DentNormals::kSplit;
  bool shadows = true;
  /// Smooth edges, and soft rims of shadows of 16 samples, else 4.
  bool fine = true;
  bool grid = true;
  bool fields = false;    ///< Forces of the scene's fields, as arrows.
  bool trail = false;     ///< Where the tip was in the last seconds, coloured by force.
  bool surfaces = false;  ///< Marks on what has a texture or friction.
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

  /// Paints the picture onto the canvas, pixels and all. Gives the labels, which are text and not
  /// painted here.
  std::vector<Label> paint(const DrawnMoment& moment, const Camera& camera,
                           const PaintChoice& choice, Canvas& canvas);

 private:
  void set_view(const Camera& camera, Theme theme, const std::vector<Solid>& solids,
                const Canvas& canvas);
  void paint_shadows(const std::vector<Solid>& solids);
  void paint_shadow(std::size_t object);
  void paint_surfaces(const PaintChoice& choice, const Camera& camera, bool gouraud);
  void paint_light(const PaintChoice& choice);
  void paint_pixels(const PaintChoice& choice, Canvas& canvas);
  void set_shadows(const GlProgram& program, const PaintChoice& choice) const;
  void paint_solids(const std::vector<Solid>& solids);
  void paint_what_shines_through(const std::vector<Solid>& solids);
  void paint_edges(const PaintChoice& choice);
  void paint_ground(const PaintChoice& choice, const Canvas& canvas);
  void paint_forces(const DrawnMoment& moment, const PaintChoice& choice, double eye_distance);
  void place_objects(const DrawnMoment& moment, DentNormals normals);
  float shadow_offset() const;
  const SurfaceModel& shown(std::size_t object) const;

  DrawnScene scene_;
  ScenePrograms programs_;
  std::vector<SurfaceModel> models_;
  std::vector<std::shared_ptr<const render::TriangleMesh>> shapes_;  // as they are in models_
  std::unique_ptr<SurfaceModel> naive_;  // of the object that is bent, if it is drawn so
  std::size_t naive_object_ = 0;
  SolidModels solids_;
  std::vector<Eigen::Matrix4f> places_;  // of the objects in this picture
  Eigen::AlignedBox2i ground_shadow_;    // of this picture, pixels: elsewhere the ground has none
  GlBuffer view_block_;
  GlVertexArray nothing_;
  PaneModel panes_;
  ColouredModel field_, trail_;
  double field_strongest_ = -1;  // N, of the scale that the field has been coloured by
  ShadowMap shadow_map_;
  std::vector<Eigen::Matrix4f> last_places_;  // when shadows were drawn last
  std::vector<bool> changed_;                 // of the objects: bent or shaped since then
  std::vector<bool> kept_;                    // those whose shadows are kept
  Eigen::Vector3d light_centre_{0, 0, 0};
  double light_radius_ = 0.2;         // m: what is nearer to the centre casts shadows
  double ground_height_ = 0;          // m
  std::ptrdiff_t floor_object_ = -1;  // the object that is the ground: a level plane
};

}  // namespace thimble::view

#include "view/scene_painter.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "apply_patch.h"
#include "view/gl/picture_parts.h"
#include "view/ground_shadow.h"
#include "view/overlays/force_marks.h"
#include "view/view_block.h"

namespace thimble::view {
namespace {

constexpr std::size_t kFewTriangles = 1500;  // that can be distinguished in a picture
constexpr GLuint kViewBinding = 0;

void set(const GlProgram& program, const char* name, const Eigen::Matrix4f& value) {
  glUniformMatrix4fv(program.at(name), 1, GL_FALSE, value.data());
}

void set(const GlProgram& program, const char* name, const Eigen::Matrix3f& value) {
  glUniformMatrix3fv(program.at(name), 1, GL_FALSE, value.data());
}

/// `more`: opacity, or gloss as a fraction of the mirror image of the light.
void set_paint(const GlProgram& program, const Colour& colour, float more) {
  glUniform4f(program.at("paint"), colour[0], colour[1], colour[2], more);
}

/// Returns the marks of an object: 1 for dots, 2 for lines (gl/shaders.cpp).
int marks_on(const DrawnObject& object) {
  return (object.texture.empty() ? 0 : 1) + (object.friction.empty() ? 0 : 2);
}

/// Returns whether a plane's mesh is horizontal, so that it can be drawn as the ground.
bool is_level(const render::TriangleMesh& mesh) {
  return std::all_of(mesh.vertices.begin(), mesh.vertices.end(), [&](const auto& vertex) {
    return std::abs(vertex.z() - mesh.vertices[0].z()) < 1e-9;
  });
}

}  // namespace

ScenePainter::ScenePainter(DrawnScene scene, ScenePrograms programs)
    : scene_(std::move(scene)), programs_(std::move(programs)) {
  if (auto mapped = MappedSurfaces::make(scene_)) {
    mapped_ = std::move(mapped).value();
  } else {
    for (DrawnObject& object : scene_.objects) object.map = {};  // as without maps
  }
  std::vector<const GlProgram*> all;
  for (const GlProgram* program : programs_.all()) all.push_back(program);
  if (mapped_) all.push_back(&mapped_->program());
  for (const GlProgram* program : all) {
    const GLuint block = glGetUniformBlockIndex(**program, "View");
    if (block != GL_INVALID_INDEX) glUniformBlockBinding(**program, block, kViewBinding);
    // Numbers of the textures that the canvas binds; the shadow map is texture 0.
    glUseProgram(**program);
    glUniform1i(program->at("shadow_texels"), 4);
    glUniform1i(program->at("normals"), 1);
    glUniform1i(program->at("paints"), 2);
    glUniform1i(program->at("depths"), 3);
    glUniform1i(program->at("picture"), 1);
  }
  Eigen::AlignedBox3d box;
  for (const DrawnObject& object : scene_.objects) {
    models_.emplace_back(object.mesh, object.crease_angle);
    if (object.endless && is_level(object.mesh)) {
      floor_object_ = static_cast<std::ptrdiff_t>(models_.size()) - 1;
    }
    for (const Eigen::Vector3d& vertex : object.mesh.vertices) box.extend(vertex);
  }
  if (box.isEmpty())
    box = Eigen::AlignedBox3d(Eigen::Vector3d::Constant(-0.06), Eigen::Vector3d::Constant(0.06));
  light_centre_ = box.center();
  light_radius_ = std::clamp(0.5 * box.diagonal().norm() + 0.05, 0.08, 0.5);
  ground_height_ = box.min().z() - 2e-4;  // so that objects on it do not flicker
  if (floor_object_ >= 0) {
    ground_height_ = scene_.objects[static_cast<std::size_t>(floor_object_)].mesh.vertices[0].z();
  }
}

const SurfaceModel& ScenePainter::shown(std::size_t object) const {
  return naive_ != nullptr && object == naive_object_ ? *naive_ : models_[object];
}

void ScenePainter::place_objects(const DrawnMoment& moment, DentNormals normals) {
  places_.assign(models_.size(), Eigen::Matrix4f::Identity());
  naive_.reset();
  shapes_.resize(models_.size());
  changed_.resize(models_.size(), true);
  for (std::size_t i = 0; i < models_.size(); ++i) {
    if (i < moment.shapes.size() && moment.shapes[i] != nullptr && moment.shapes[i] != shapes_[i]) {
      shapes_[i] = moment.shapes[i];
      models_[i].reshape(*shapes_[i]);
      changed_[i] = true;
    }
    if (i < moment.poses.size()) {
      const render::BodyPose& pose = moment.poses[i];
      const Eigen::Quaterniond q_WB(pose.q_WB[0], pose.q_WB[1], pose.q_WB[2], pose.q_WB[3]);
      places_[i].block<3, 3>(0, 0) = q_WB.toRotationMatrix().cast<float>();
      places_[i].block<3, 1>(0, 3) =
          Eigen::Map<const Eigen::Vector3d>(pose.p_WB.data()).cast<float>();
    }
    const bool bent =
        moment.patch.triangle_count > 0 && moment.patch.object == static_cast<std::int16_t>(i);
    changed_[i] = changed_[i] || bent || models_[i].bent();
    if (!bent) {
      models_[i].unbend();
    } else if (normals == DentNormals::kSplit) {
      models_[i].bend(moment.patch);
    } else {
      naive_ = std::make_unique<SurfaceModel>(
          session::apply_patch(shapes_[i] ? *shapes_[i] : scene_.objects[i].mesh, {}, moment.patch),
          scene_.objects[i].crease_angle, NormalWeights::kEqual);
      naive_object_ = i;
    }
  }
}

void ScenePainter::set_view(const Camera& camera, Theme theme, const std::vector<Solid>& solids,
                            const Canvas& canvas) {
  const LitPlace place{
      .centre = light_centre_, .radius = light_radius_, .ground_height = ground_height_};
  const Eigen::Matrix4f shadow = shadow_from_world(place);
  Eigen::AlignedBox2f casters;
  for (std::size_t i = 0; i < models_.size(); ++i) {
    if (!scene_.objects[i].endless) add_caster(shadow, places_[i], shown(i).box(), casters);
  }
  for (const Solid& solid : solids) {
    if (solid.casts_shadow) {
      add_caster(shadow, solid.model, solids_.model(solid.kind).box(), casters);
    }
  }
  // Plus the reach of a sample in the map: 3.2 pixels, one more for the mean of four, and two for
  // the offset from the surface.
  const Eigen::Vector2f reach = Eigen::Vector2f::Constant(8.0F / ShadowMap::kPixels);
  if (!casters.isEmpty()) {
    casters = Eigen::AlignedBox2f(casters.min() - reach, casters.max() + reach);
  }
  const ViewBlock block = view_block(camera, canvas.aspect(), theme, place, casters);
  ground_shadow_ = ground_shadow(block.view_projection, shadow, block.ground_place.z(), casters,
                                 {canvas.width(), canvas.height() - canvas.strip()});
  glBindBuffer(GL_UNIFORM_BUFFER, *view_block_);
  glBufferData(GL_UNIFORM_BUFFER, sizeof block, &block, GL_STREAM_DRAW);
  glBindBufferBase(GL_UNIFORM_BUFFER, kViewBinding, *view_block_);
}

void ScenePainter::paint_shadows(const std::vector<Solid>& solids) {
  glUseProgram(*programs_.shadow);
  // A depth offset, so that surfaces do not cast shadows on themselves.
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(2.5F, 6.0F);
  std::vector<bool> still(models_.size());
  for (std::size_t i = 0; i < models_.size(); ++i) {
    still[i] = !changed_[i] && i < last_places_.size() && places_[i] == last_places_[i];
  }
  last_places_ = places_;
  changed_.assign(models_.size(), false);
  const bool any_still = std::find(still.begin(), still.end(), true) != still.end();
  // Moving objects were removed at once, so the kept ones are unchanged.
  if (any_still && still != kept_) {
    shadow_map_.begin_kept();
    for (std::size_t i = 0; i < models_.size(); ++i) {
      if (still[i]) paint_shadow(i);
    }
  }
  kept_ = still;
  shadow_map_.begin(any_still);
  for (std::size_t i = 0; i < models_.size(); ++i) {
    if (!still[i]) paint_shadow(i);
  }
  glEnable(GL_CULL_FACE);
  for (const Solid& solid : solids) {
    if (!solid.casts_shadow) continue;
    set(programs_.shadow, "model", solid.model);
    solids_.model(solid.kind).draw_mesh();
  }
  glDisable(GL_CULL_FACE);
  glDisable(GL_POLYGON_OFFSET_FILL);
}

void ScenePainter::paint_shadow(std::size_t object) {
  if (scene_.objects[object].endless) return;
  set(programs_.shadow, "model", places_[object]);
  if (shown(object).closed()) glEnable(GL_CULL_FACE);
  shown(object).draw_mesh();
  shown(object).draw_dent();
  glDisable(GL_CULL_FACE);
}

// Returns twice the size of a pixel of the light's map, m.
float ScenePainter::shadow_offset() const {
  return static_cast<float>(2 * 2 * light_radius_ / ShadowMap::kPixels);
}

void ScenePainter::set_shadows(const GlProgram& program, const PaintChoice& choice) const {
  glUniform1f(program.at("shadow_strength"), choice.shadows ? 1.0F : 0.0F);
  glUniform1f(program.at("shadow_offset"), shadow_offset());
  glUniform1i(program.at("shadow_samples"), choice.fine ? 4 : 2);
}

void ScenePainter::paint_surfaces(const PaintChoice& choice, const Camera& camera, bool gouraud) {
  for (std::size_t i = 0; i < models_.size(); ++i) {
    if (static_cast<std::ptrdiff_t>(i) == floor_object_) continue;
    const int marks = choice.surfaces ? marks_on(scene_.objects[i]) : 0;
    if (mapped_ && mapped_->has(i)) {
      if (!gouraud) paint_mapped(i, marks);
      continue;
    }
    if (gouraud != (choice.shading == Shading::kGouraud && marks == 0)) continue;
    const GlProgram& surface = marks > 0 ? programs_.surface_marked
                               : gouraud ? programs_.surface_gouraud
                                         : programs_.surface;
    const GlProgram& dent = marks > 0 ? programs_.dent_marked
                            : gouraud ? programs_.dent_gouraud
                                      : programs_.dent;
    const Eigen::Vector3f eye = camera.p_WEye().cast<float>() - places_[i].block<3, 1>(0, 3);
    const bool hides_back = shown(i).hides_back(places_[i].block<3, 3>(0, 0).transpose() * eye);
    if (hides_back) glEnable(GL_CULL_FACE);
    for (const GlProgram* program : {&surface, &dent}) {
      glUseProgram(**program);
      if (gouraud) set_shadows(*program, choice);
      set(*program, "model", places_[i]);
      set(*program, "normal_matrix", Eigen::Matrix3f(places_[i].block<3, 3>(0, 0)));
      set_paint(*program, object_colour(i), 0.16F);
      glUniform1i(program->at("marks"), marks);
      if (program == &surface) shown(i).draw_mesh();
      if (program == &dent) shown(i).draw_dent();
    }
    glDisable(GL_CULL_FACE);
  }
}

void ScenePainter::paint_mapped(std::size_t object, int marks) {
  const GlProgram& program = mapped_->program();
  glUseProgram(*program);
  set(program, "model", places_[object]);
  set(program, "normal_matrix", Eigen::Matrix3f(places_[object].block<3, 3>(0, 0)));
  set_paint(program, object_colour(object), 0.16F);
  glUniform1i(program.at("marks"), marks);
  mapped_->draw(object);
}

void ScenePainter::paint_solids(const std::vector<Solid>& solids) {
  glUseProgram(*programs_.surface);
  glEnable(GL_CULL_FACE);
  for (const Solid& solid : solids) {
    set(programs_.surface, "model", solid.model);
    set(programs_.surface, "normal_matrix", solid.normal_matrix);
    set_paint(programs_.surface, solid.colour, 0.2F);
    solids_.model(solid.kind).draw_mesh();
  }
  glDisable(GL_CULL_FACE);
}

void ScenePainter::paint_light(const PaintChoice& choice) {
  glBindVertexArray(*nothing_);
  // The depth test selects the pixels with a surface before a shader runs.
  glDepthMask(GL_FALSE);
  glDepthFunc(GL_EQUAL);
  glUseProgram(*programs_.backdrop);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDepthFunc(GL_GREATER);
  glUseProgram(*programs_.light);
  set_shadows(programs_.light, choice);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
}

void ScenePainter::paint_pixels(const PaintChoice& choice, Canvas& canvas) {
  canvas.begin_pixels();
  if (!choice.fine) return;
  glDisable(GL_BLEND);
  glBindVertexArray(*nothing_);
  const auto go_over = [&canvas](const GlProgram& program) {
    glUseProgram(*program);
    glUniform1i(program.at("lowest"), canvas.strip());
    glDrawArrays(GL_TRIANGLES, 0, 3);
  };
  // The first program marks by depth the pixels that the second one smooths.
  glDepthFunc(GL_ALWAYS);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  go_over(programs_.edges);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthFunc(GL_EQUAL);
  glDepthMask(GL_FALSE);
  go_over(programs_.smooth);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
}

void ScenePainter::paint_translucent(const std::vector<Solid>& solids) {
  glUseProgram(*programs_.plain);
  glUniform1f(programs_.plain.at("nearer"), 0);
  glDepthFunc(GL_GREATER);
  glDepthMask(GL_FALSE);
  for (const Solid& solid : solids) {
    if (!solid.shines_through) continue;
    set(programs_.plain, "model", solid.model);
    set_paint(programs_.plain, solid.colour, 0.55F);
    // Front faces only, so that nothing is blended twice.
    glEnable(GL_CULL_FACE);
    solids_.model(solid.kind).draw_mesh();
    glDisable(GL_CULL_FACE);
  }
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
}

void ScenePainter::paint_edges(const PaintChoice& choice) {
  if (choice.edges == Edges::kOff) return;
  glUseProgram(*programs_.plain);
  glUniform1f(programs_.plain.at("nearer"), 0.0008F);
  glDepthMask(GL_FALSE);
  glEnable(GL_LINE_SMOOTH);
  for (std::size_t i = 0; i < models_.size(); ++i) {
    const bool few = models_[i].triangles() <= kFewTriangles && !scene_.objects[i].is_placeholder;
    if (scene_.objects[i].endless || (choice.edges == Edges::kAuto && !few)) continue;
    set(programs_.plain, "model", places_[i]);
    set_paint(programs_.plain, kTextColour, 0.22F);
    shown(i).draw_edges();
  }
  glDisable(GL_LINE_SMOOTH);
  glDepthMask(GL_TRUE);
}

void ScenePainter::paint_ground(const PaintChoice& choice, const Canvas& canvas) {
  const auto floor = static_cast<std::size_t>(floor_object_);
  const int marks = choice.surfaces && floor_object_ >= 0 ? marks_on(scene_.objects[floor]) : 0;
  const Eigen::Vector3f colour =
      linear(floor_object_ < 0 ? colours_of(choice.theme).ground : object_colour(floor));
  glBindVertexArray(*nothing_);
  const auto paint = [&](const GlProgram& program) {
    glUseProgram(*program);
    glUniform3fv(program.at("colour"), 1, colour.data());
    set_shadows(program, choice);
    glUniform1f(program.at("grid_strength"), choice.grid ? 1.0F : 0.0F);
    glUniform1i(program.at("marks"), marks);
    // Writes depth, so that edges below the ground are not drawn over it.
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  };
  if (marks > 0) return paint(programs_.ground_marked);
  // Shadow lookups are most of its work, so they are limited to the box with shadows.
  paint_apart(
      canvas, choice.shadows ? ground_shadow_ : Eigen::AlignedBox2i(),
      [&] { paint(programs_.ground); }, [&] { paint(programs_.ground_open); });
}

void ScenePainter::paint_forces(const DrawnMoment& moment, const PaintChoice& choice,
                                double eye_distance) {
  if (!choice.fields && !choice.trail) return;
  const double strongest = strongest_force(scene_, moment);
  glUseProgram(*programs_.coloured);
  if (choice.fields) {
    if (strongest != field_strongest_) {
      ColouredMesh arrows;
      add_field(scene_, strongest, arrows);
      field_.set(arrows);
      field_strongest_ = strongest;
    }
    field_.draw();
  }
  if (choice.trail) {
    ColouredMesh tube;
    add_trail(moment.trail, strongest, 0.0016 * eye_distance, tube);
    trail_.set(tube);
    trail_.draw();
  }
}

std::vector<Label> ScenePainter::paint(const DrawnMoment& moment, const Camera& camera,
                                       const PaintChoice& choice, Canvas& canvas) {
  const TouchMarks marks = mark_touch(scene_, moment, camera.distance, choice.marks);
  place_objects(moment, choice.dent_normals);
  set_view(camera, choice.theme, marks.solids, canvas);
  glDisable(GL_BLEND);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_CULL_FACE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  if (choice.shadows) paint_shadows(marks.solids);

  canvas.begin_surfaces();
  paint_surfaces(choice, camera, false);
  paint_solids(marks.solids);
  canvas.begin_light();
  shadow_map_.bind();
  paint_light(choice);
  paint_surfaces(choice, camera, true);
  paint_forces(moment, choice, camera.distance);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  paint_ground(choice, canvas);
  paint_edges(choice);
  if (choice.colliders) {
    if (colliders_ == nullptr) colliders_ = std::make_unique<ColliderModels>(scene_);
    colliders_->draw(places_, choice.theme, programs_.plain);
  }
  panes_.draw(marks.panes, camera, programs_.plain);
  paint_translucent(marks.solids);
  paint_pixels(choice, canvas);
  glBindVertexArray(0);
  return marks.labels;
}

}  // namespace thimble::view

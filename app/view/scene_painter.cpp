#include "view/scene_painter.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "bent_mesh.h"

namespace thimble::app::view {
namespace {

constexpr GLsizei kShadowPixels = 1024;
constexpr std::size_t kFewTriangles = 1500;  // so many can be told from each other in a picture
constexpr GLuint kViewBinding = 0;

/// Turns a colour as on the screen into amounts of light, as the shaders turn it back.
Eigen::Vector3f linear(const Colour& colour) {
  return Eigen::Array3f(colour[0], colour[1], colour[2]).square();
}

Eigen::Vector4f padded(const Eigen::Vector3f& v) {
  return {v.x(), v.y(), v.z(), 0};
}

Eigen::Vector3d towards_light() {
  return Eigen::Vector3d(0.45, -0.55, 1.0).normalized();
}

void set(const GlProgram& program, const char* name, const Eigen::Matrix4f& value) {
  glUniformMatrix4fv(program.at(name), 1, GL_FALSE, value.data());
}

void set(const GlProgram& program, const char* name, const Eigen::Matrix3f& value) {
  glUniformMatrix3fv(program.at(name), 1, GL_FALSE, value.data());
}

void set_colour(const GlProgram& program, const Colour& colour, float gloss) {
  const Eigen::Vector3f light = linear(colour);
  glUniform3fv(program.at("colour"), 1, light.data());
  glUniform1f(program.at("gloss"), gloss);
}

void set_paint(const GlProgram& program, const Colour& colour, float cover) {
  glUniform4f(program.at("paint"), colour[0], colour[1], colour[2], cover);
}

/// Returns whether a plane's mesh is level, so that it can be drawn as the ground.
bool is_level(const render::TriangleMesh& mesh) {
  return std::all_of(mesh.vertices.begin(), mesh.vertices.end(), [&](const auto& vertex) {
    return std::abs(vertex.z() - mesh.vertices[0].z()) < 1e-9;
  });
}

}  // namespace

/// The block of the shaders that all programs read; std140 leaves no gaps between these.
struct ScenePainter::ViewBlock {
  Eigen::Matrix4f view_projection, shadow_from_world;
  Eigen::Vector4f eye, key, sky, ground, grid, ground_place;
};

ScenePainter::ScenePainter(DrawnScene scene, ScenePrograms programs)
    : scene_(std::move(scene)), programs_(std::move(programs)) {
  for (const GlProgram* program : {&programs_.surface, &programs_.dent, &programs_.shadow,
                                   &programs_.plain, &programs_.backdrop, &programs_.ground}) {
    const GLuint block = glGetUniformBlockIndex(**program, "View");
    if (block != GL_INVALID_INDEX) glUniformBlockBinding(**program, block, kViewBinding);
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
  ground_height_ = box.min().z() - 2e-4;  // so that what stands on it does not flicker
  if (floor_object_ >= 0) {
    ground_height_ = scene_.objects[static_cast<std::size_t>(floor_object_)].mesh.vertices[0].z();
  }

  glBindTexture(GL_TEXTURE_2D, *shadow_map_);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, kShadowPixels, kShadowPixels, 0,
               GL_DEPTH_COMPONENT, GL_FLOAT, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glBindFramebuffer(GL_FRAMEBUFFER, *shadow_frame_);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, *shadow_map_, 0);
  glDrawBuffer(GL_NONE);
  glReadBuffer(GL_NONE);

  glBindVertexArray(*pane_array_);
  glBindBuffer(GL_ARRAY_BUFFER, *pane_vertices_);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
  glBindVertexArray(0);
}

const SurfaceModel& ScenePainter::shown(std::size_t object) const {
  return naive_ != nullptr && object == naive_object_ ? *naive_ : models_[object];
}

void ScenePainter::place_objects(const DrawnMoment& moment, DentNormals normals) {
  places_.assign(models_.size(), Eigen::Matrix4f::Identity());
  naive_.reset();
  shapes_.resize(models_.size());
  for (std::size_t i = 0; i < models_.size(); ++i) {
    if (i < moment.shapes.size() && moment.shapes[i] != nullptr && moment.shapes[i] != shapes_[i]) {
      shapes_[i] = moment.shapes[i];
      models_[i].reshape(*shapes_[i]);
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
    if (!bent) {
      models_[i].unbend();
    } else if (normals == DentNormals::kSplit) {
      models_[i].bend(moment.patch);
    } else {
      naive_ = std::make_unique<SurfaceModel>(
          session::bent(shapes_[i] ? *shapes_[i] : scene_.objects[i].mesh, {}, moment.patch),
          scene_.objects[i].crease_angle, NormalWeights::kEqual);
      naive_object_ = i;
    }
  }
}

void ScenePainter::set_view(const Camera& camera, double aspect) {
  // The light looks along -z of its own frame, straight, at a square about the scene.
  Eigen::Matrix4d shadow = Eigen::Matrix4d::Identity();
  const Eigen::Vector3d z = towards_light();
  const Eigen::Vector3d x = Eigen::Vector3d::UnitZ().cross(z).normalized();
  shadow.block<1, 3>(0, 0) = x.transpose() / light_radius_;
  shadow.block<1, 3>(1, 0) = z.cross(x).transpose() / light_radius_;
  shadow.block<1, 3>(2, 0) = -z.transpose() / (2 * light_radius_);
  shadow.block<3, 1>(0, 3) = -shadow.block<3, 3>(0, 0) * light_centre_;
  ViewBlock block;
  block.view_projection = camera.projection(aspect) * camera.view();
  block.shadow_from_world = shadow.cast<float>();
  block.eye = padded(camera.p_WEye().cast<float>());
  block.key = padded(z.cast<float>());
  block.sky = padded(linear(kSkyColour));
  block.ground = padded(linear(kGroundColour));
  block.grid = padded(linear(kGridColour));
  block.ground_place =
      Eigen::Vector4d(light_centre_.x(), light_centre_.y(), ground_height_, 5 * light_radius_)
          .cast<float>();
  glBindBuffer(GL_UNIFORM_BUFFER, *view_block_);
  glBufferData(GL_UNIFORM_BUFFER, sizeof block, &block, GL_STREAM_DRAW);
  glBindBufferBase(GL_UNIFORM_BUFFER, kViewBinding, *view_block_);
}

void ScenePainter::paint_shadows(const std::vector<Solid>& solids) {
  glBindFramebuffer(GL_FRAMEBUFFER, *shadow_frame_);
  glViewport(0, 0, kShadowPixels, kShadowPixels);
  glClear(GL_DEPTH_BUFFER_BIT);
  glUseProgram(*programs_.shadow);
  // Pushed back a little, or surfaces would cast shadows on themselves.
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(2.5F, 6.0F);
  for (std::size_t i = 0; i < models_.size(); ++i) {
    if (scene_.objects[i].endless) continue;
    set(programs_.shadow, "model", places_[i]);
    shown(i).draw_mesh();
    shown(i).draw_dent();
  }
  for (const Solid& solid : solids) {
    if (!solid.casts_shadow) continue;
    set(programs_.shadow, "model", solid.model);
    solids_.model(solid.kind).draw_mesh();
  }
  glDisable(GL_POLYGON_OFFSET_FILL);
}

// Twice what a pixel of the light's map covers, m.
float ScenePainter::shadow_offset() const {
  return static_cast<float>(2 * 2 * light_radius_ / kShadowPixels);
}

void ScenePainter::paint_surfaces(const PaintChoice& choice) {
  for (const GlProgram* program : {&programs_.surface, &programs_.dent}) {
    glUseProgram(**program);
    glUniform1i(program->at("gouraud"), choice.shading == Shading::kGouraud ? 1 : 0);
    glUniform1f(program->at("shadow_strength"), choice.shadows ? 1.0F : 0.0F);
    glUniform1f(program->at("shadow_offset"), shadow_offset());
    glUniform1i(program->at("shadow_samples"), choice.fine ? 4 : 2);
    for (std::size_t i = 0; i < models_.size(); ++i) {
      if (static_cast<std::ptrdiff_t>(i) == floor_object_) continue;
      set(*program, "model", places_[i]);
      set(*program, "normal_matrix", Eigen::Matrix3f(places_[i].block<3, 3>(0, 0)));
      set_colour(*program, object_colour(i), 0.16F);
      if (program == &programs_.surface) shown(i).draw_mesh();
      if (program == &programs_.dent) shown(i).draw_dent();
    }
  }
}

void ScenePainter::paint_solids(const std::vector<Solid>& solids) {
  glUseProgram(*programs_.surface);
  glUniform1i(programs_.surface.at("gouraud"), 0);
  for (const Solid& solid : solids) {
    set(programs_.surface, "model", solid.model);
    set(programs_.surface, "normal_matrix", solid.normal_matrix);
    set_colour(programs_.surface, solid.colour, 0.2F);
    solids_.model(solid.kind).draw_mesh();
  }
}

void ScenePainter::paint_what_shines_through(const std::vector<Solid>& solids) {
  glUseProgram(*programs_.plain);
  glUniform1f(programs_.plain.at("nearer"), 0);
  glDepthFunc(GL_GREATER);
  glDepthMask(GL_FALSE);
  for (const Solid& solid : solids) {
    if (!solid.shines_through) continue;
    set(programs_.plain, "model", solid.model);
    set_paint(programs_.plain, solid.colour, 0.55F);
    // The front only, so that nothing is covered twice.
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
  for (std::size_t i = 0; i < models_.size(); ++i) {
    const bool few = models_[i].triangles() <= kFewTriangles && !scene_.objects[i].stands_for_shape;
    if (scene_.objects[i].endless || (choice.edges == Edges::kAuto && !few)) continue;
    set(programs_.plain, "model", places_[i]);
    set_paint(programs_.plain, kTextColour, 0.22F);
    shown(i).draw_edges();
  }
  glDepthMask(GL_TRUE);
}

void ScenePainter::paint_ground(const PaintChoice& choice) {
  glUseProgram(*programs_.ground);
  const Eigen::Vector3f colour = linear(
      floor_object_ < 0 ? kGroundColour : object_colour(static_cast<std::size_t>(floor_object_)));
  glUniform3fv(programs_.ground.at("colour"), 1, colour.data());
  glUniform1f(programs_.ground.at("shadow_strength"), choice.shadows ? 1.0F : 0.0F);
  glUniform1i(programs_.ground.at("shadow_samples"), choice.fine ? 4 : 2);
  glUniform1f(programs_.ground.at("grid_strength"), choice.grid ? 1.0F : 0.0F);
  glBindVertexArray(*nothing_);
  // Its depth counts, so that what is below it is not outlined above.
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

void ScenePainter::paint_panes(const std::vector<Pane>& panes, const Camera& camera) {
  if (panes.empty()) return;
  // The farthest first, so that each is seen through those before it.
  std::vector<const Pane*> order;
  order.reserve(panes.size());
  for (const Pane& pane : panes) order.push_back(&pane);
  const auto distance = [&](const Pane* pane) {
    const auto& c = pane->corners_W;
    return ((c[0] + c[1] + c[2] + c[3]) / 4 - camera.p_WEye()).squaredNorm();
  };
  std::sort(order.begin(), order.end(),
            [&](const Pane* a, const Pane* b) { return distance(a) > distance(b); });
  glUseProgram(*programs_.plain);
  glUniform1f(programs_.plain.at("nearer"), 0.0005F);
  set(programs_.plain, "model", Eigen::Matrix4f(Eigen::Matrix4f::Identity()));
  glDepthMask(GL_FALSE);
  glBindVertexArray(*pane_array_);
  for (const Pane* pane : order) {
    std::vector<Eigen::Vector3f> corners;
    for (const Eigen::Vector3d& corner : pane->corners_W) corners.push_back(corner.cast<float>());
    glBindBuffer(GL_ARRAY_BUFFER, *pane_vertices_);
    glBufferData(GL_ARRAY_BUFFER, 4 * sizeof(Eigen::Vector3f), corners.data(), GL_STREAM_DRAW);
    set_paint(programs_.plain, pane->colour, 0.38F);
    glDrawArrays(GL_TRIANGLE_FAN, 0, 4);
    set_paint(programs_.plain, pane->colour, 0.9F);
    glDrawArrays(GL_LINE_LOOP, 0, 4);
  }
  glDepthMask(GL_TRUE);
}

std::vector<Label> ScenePainter::paint(const DrawnMoment& moment, const Camera& camera,
                                       const PaintChoice& choice, Canvas& canvas) {
  const TouchMarks marks = mark_touch(scene_, moment, camera.distance, choice.marks);
  place_objects(moment, choice.dent_normals);
  set_view(camera, canvas.aspect());
  glDisable(GL_BLEND);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_CULL_FACE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  if (choice.shadows) paint_shadows(marks.solids);

  canvas.begin();
  glClear(GL_DEPTH_BUFFER_BIT);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, *shadow_map_);
  glDisable(GL_DEPTH_TEST);
  glUseProgram(*programs_.backdrop);
  glBindVertexArray(*nothing_);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glEnable(GL_DEPTH_TEST);
  paint_surfaces(choice);
  paint_solids(marks.solids);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  paint_ground(choice);
  paint_edges(choice);
  paint_panes(marks.panes, camera);
  paint_what_shines_through(marks.solids);
  glBindVertexArray(0);
  canvas.finish();
  return marks.labels;
}

}  // namespace thimble::app::view

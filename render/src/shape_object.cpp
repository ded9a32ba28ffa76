#include "shape_object.h"

#include <fmt/core.h>

#include <cstddef>
#include <string>
#include <utility>

#include "body/shape/body_shape.h"
#include "body/shape/shaped_touch.h"
#include "build_surface_touch.h"
#include "track/blended.h"
#include "track/edge_blending.h"
#include "track/god_object.h"
#include "track/mesh_contact.h"
#include "track/moving_contact.h"
#include "track/path_bounded.h"
#include "world/law_solid.h"

namespace thimble::render {
namespace {

using Built = driver::Result<std::unique_ptr<ObjectTouch>>;

// Margin for vertices near the box's sides, which oblique panels may push out of it slightly.
constexpr double kRoom = 0.25;  // of the longest side [chosen]

template <class Contact>
Built shaped(std::shared_ptr<MovingMesh> mesh, Contact contact, const SurfaceChoice& surface,
             BodyShape shape) {
  using Bounded = PathBounded<Contact>;
  MovingContact<Bounded> moving(std::move(mesh), Bounded(std::move(contact)));
  const auto built = [&shape](auto touch) {
    using Law = decltype(touch);
    auto object = std::make_unique<ShapedTouch<Law>>(std::move(touch), std::move(shape));
    object->set_solid(std::make_unique<LawSolid<Law>>(object->stages()));
    return Built(std::move(object));
  };
  StageList stages = stage_list(surface);
  if (!stages.needs_closest_point())
    return built(ContactForceLaw(std::move(moving), std::move(stages)));
  moving.keep_material();
  return built(ContactForceLaw(std::move(moving), ClosestPointStageList(std::move(stages))));
}

// Returns the maximum number of triangles of a mesh that grows; 0 if it does not grow.
std::size_t triangles_max_of(const ShapeChoice& shape) {
  return shape.clay && shape.clay->edge > 0 ? static_cast<std::size_t>(shape.clay->triangles) : 0;
}

// Returns an error if triangles under a print cannot be split.
driver::Result<void> check_refinement(const TriangleMesh& mesh_W, const SurfaceChoice& surface,
                                      std::size_t triangles_max) {
  if (surface.dent || surface.shape.snap) {
    return driver::Error{
        fmt::format("Clay that splits its triangles (edge) cannot have a {}, which needs the "
                    "triangles that it was "
                    "built with. Remove edge, or use a finer mesh.",
                    surface.dent ? "dent" : "wall that snaps")};
  }
  if (mesh_W.triangles.size() <= triangles_max) return {};
  return driver::Error{fmt::format(
      "The mesh already has {} triangles; clay that splits them may have {}. Raise triangles, "
      "or use a coarser mesh.",
      mesh_W.triangles.size(), triangles_max)};
}

}  // namespace

Built shaped_touch(const TriangleMesh& mesh_W, const ContactChoice& choice,
                   const SurfaceChoice& surface) {
  const bool smooth = choice.tracker == TrackerChoice::kOffset;
  const BlendingChoice blending =
      choice.blending.value_or(smooth ? BlendingChoice::kPhong : BlendingChoice::kFlat);
  const bool god_object = choice.tracker == TrackerChoice::kGodObject;
  const bool known = choice.tracker == TrackerChoice::kEdgePlanes || smooth || god_object;
  const bool compatible = (blending == BlendingChoice::kPhong && !god_object) ||
                          (blending == BlendingChoice::kFlat && !smooth);
  if (!known || !compatible || choice.curved_depth.value_or(false)) {
    return driver::Error{
        "A surface that changes shape needs the tracker \"edge_planes\" (blending flat or phong), "
        "\"offset\" or \"god_object\", without curved_depth. Set one of these in contact."};
  }
  const std::size_t triangles_max = triangles_max_of(surface.shape);
  if (triangles_max > 0) {
    // The other trackers use the cells of faces, which are not usable where they are smaller than
    // the tip is deep.
    if (!god_object) {
      return driver::Error{
          "Clay that splits its triangles (edge) needs the tracker \"god_object\". Set it in "
          "contact."};
    }
    if (auto fits = check_refinement(mesh_W, surface, triangles_max); !fits) return fits.error();
  }
  auto prepared = ContactMesh::build(mesh_W, {.room = kRoom, .triangles_max = triangles_max});
  if (!prepared) return prepared.error();
  auto body = BodyShape::build(*prepared, surface.shape, surface.spring.stiffness);
  if (!body) return body.error();
  MovingMeshOptions options{.search = choice.search};
  // Means of faces by default: fitting them at each move costs seven times as much.
  if (blending == BlendingChoice::kPhong) {
    options.normals = choice.normals.value_or(NormalWeights::kAngle);
  }
  options.crease_angle = choice.crease_angle.value_or(kCreaseAngle);
  if (choice.blending == BlendingChoice::kFixedBand ||
      choice.blending == BlendingChoice::kSizedBand) {
    options.concave_crease_angle = kConcaveCreaseAngleOfBands;
  }
  const auto mesh = std::make_shared<MovingMesh>(std::move(prepared).value(), options);
  if (god_object) {
    return shaped(mesh, GodObjectContact(mesh_of(mesh), search_of(mesh)), surface,
                  std::move(body).value());
  }
  if (smooth) {
    return shaped(mesh, OffsetContact(mesh_of(mesh), search_of(mesh), normals_of(mesh)), surface,
                  std::move(body).value());
  }
  MeshContact flat(mesh_of(mesh), search_of(mesh));
  if (blending == BlendingChoice::kFlat) {
    return shaped(mesh, std::move(flat), surface, std::move(body).value());
  }
  return shaped(mesh, Blended(std::move(flat), Phong(), normals_of(mesh)), surface,
                std::move(body).value());
}

}  // namespace thimble::render

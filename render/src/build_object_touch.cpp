#include "thimble/render/build_object_touch.h"

#include <memory>
#include <string>
#include <type_traits>
#include <utility>

#include "body/dent/bendable_polygon.h"
#include "body/dent/dented_touch.h"
#include "mesh/repair/sound_mesh.h"
#include "mesh/smooth_normals.h"
#include "shape_object.h"
#include "touch_of.h"
#include "track/blended.h"
#include "track/curved_depth.h"
#include "track/edge_blending.h"
#include "track/god_object.h"
#include "track/memory_contact.h"
#include "track/mesh_contact.h"
#include "track/normal_projection_tracker.h"
#include "track/offset_tracker.h"

namespace thimble::render {
namespace {

using Built = driver::Result<std::unique_ptr<ObjectTouch>>;

driver::Error apart(const ContactChoice& choice, const std::string& why) {
  return driver::Error{"The tracker \"" +
                       std::string(kTrackerNames[static_cast<std::size_t>(choice.tracker)]) +
                       "\" " + why};
}

using Normals = std::shared_ptr<const SmoothNormals>;

// Which normal is felt, chosen when the object is built rather than compiled: what it calls stands
// in a source of its own anyway, and each tracker with each shading would be a fifth of the time to
// build this library.
struct ChosenShading {
  BlendingChoice blending = BlendingChoice::kFlat;
  double width = 0;  // m, of a fixed band
  BlendProfile profile = BlendProfile::kLinear;

  Eigen::Vector3d normal(const ContactMesh& mesh, const SmoothNormals& normals,
                         std::int32_t triangle, const Eigen::Vector3d& weights) const noexcept {
    switch (blending) {
      case BlendingChoice::kFlat:
        break;
      case BlendingChoice::kFixedBand:
        return FixedBand{.width = width, .profile = profile}.normal(mesh, normals, triangle,
                                                                    weights);
      case BlendingChoice::kSizedBand:
        return SizedBand{.profile = profile}.normal(mesh, normals, triangle, weights);
      case BlendingChoice::kPhong:
        return Phong().normal(mesh, normals, triangle, weights);
    }
    return Flat().normal(mesh, normals, triangle, weights);
  }
};

/// Wraps a tracked contact into the shading that is asked for, or leaves it bare if none is.
template <class Contact>
Built tracked_touch(Contact contact, const ChosenShading& shading, bool curved,
                    const Normals& normals, const SurfaceChoice& surface) {
  if (curved) {
    return touch_of(
        Blended<Contact, ChosenShading, CurvedDepth>(std::move(contact), shading, normals),
        surface);
  }
  if (shading.blending == BlendingChoice::kFlat) return touch_of(std::move(contact), surface);
  return touch_of(Blended<Contact, ChosenShading, MeshDepth>(std::move(contact), shading, normals),
                  surface);
}

Built packed_touch(const TriangleMesh& mesh_W, const ContactChoice& choice,
                   const SurfaceChoice& surface) {
  if (choice.blending.value_or(BlendingChoice::kPhong) != BlendingChoice::kPhong ||
      !choice.curved_depth.value_or(true)) {
    return apart(choice,
                 "always feels smooth (phong, curved depth): leave blending and curved_depth away, "
                 "or take the tracker \"offset\" or \"edge_planes\".");
  }
  if (choice.normals.value_or(NormalWeights::kAngle) != NormalWeights::kAngle) {
    return apart(choice,
                 "has the mean of the faces by their angles at its corners: leave normals away, or "
                 "take the tracker \"offset\".");
  }
  // Looks at the whole mesh as well, so that faults are told as for every other way.
  auto looked = look_at_mesh_beside(mesh_W, true);
  PackedSurfaceOptions options;
  if (choice.crease_angle) options.crease_angle = *choice.crease_angle;
  auto packed = PackedSurface::build(mesh_W, options);
  const auto sound = looked.get();
  if (!sound) return sound.error();
  if (sound->turned) packed = PackedSurface::build(*sound->turned, options);
  if (!packed) return packed.error();
  return touch_of(MemoryContact(std::move(packed).value(), choice.search), surface);
}

template <class Contact>
Built mesh_touch(const TriangleMesh& mesh_W, const ContactChoice& choice,
                 const SurfaceChoice& surface) {
  // This tracker walks on the normals themselves, and shares them with what is felt.
  constexpr bool kSmooth = std::is_same_v<Contact, OffsetContact>;
  const BlendingChoice blending =
      choice.blending.value_or(kSmooth ? BlendingChoice::kPhong : BlendingChoice::kFlat);
  const bool curved = choice.curved_depth.value_or(kSmooth);
  auto prepared = ContactMesh::build(mesh_W);
  if (!prepared) return prepared.error();
  const auto mesh = std::make_shared<const ContactMesh>(std::move(prepared).value());
  const auto search = make_search(*mesh, choice.search);
  const bool in_bands =
      blending == BlendingChoice::kFixedBand || blending == BlendingChoice::kSizedBand;
  Normals normals;
  if (kSmooth || curved || blending != BlendingChoice::kFlat) {
    normals = std::make_shared<const SmoothNormals>(
        *mesh, choice.crease_angle.value_or(kCreaseAngle),
        choice.normals.value_or(NormalWeights::kFitted),
        in_bands ? kHollowCreaseAngleOfBands : kHollowCreaseAngle);
  }
  const ChosenShading shading{.blending = blending,
                              .width = choice.band,
                              .profile = choice.profile.value_or(BlendProfile::kLinear)};
  if constexpr (kSmooth) {
    return tracked_touch(Contact(mesh, search, normals), shading, curved, normals, surface);
  } else {
    return tracked_touch(Contact(mesh, search), shading, curved, normals, surface);
  }
}

Built stiff_touch(const TriangleMesh& mesh_W, const ContactChoice& choice,
                  const SurfaceChoice& surface) {
  switch (choice.tracker) {
    case TrackerChoice::kEdgePlanes:
      return mesh_touch<MeshContact>(mesh_W, choice, surface);
    case TrackerChoice::kNormalProjection:
      return mesh_touch<TrackedContact<NormalProjectionTracker>>(mesh_W, choice, surface);
    case TrackerChoice::kOffset:
      return mesh_touch<OffsetContact>(mesh_W, choice, surface);
    case TrackerChoice::kGodObject: {
      if (choice.blending.value_or(BlendingChoice::kFlat) != BlendingChoice::kFlat ||
          choice.curved_depth.value_or(false)) {
        return apart(choice, "pushes towards its proxy: it goes with the blending \"flat\" only.");
      }
      if (choice.normals) return apart(choice, "feels no normals of corners: leave normals away.");
      auto contact = GodObjectContact::build(mesh_W, {}, choice.search);
      if (!contact) return contact.error();
      return touch_of(std::move(contact).value(), surface);
    }
    case TrackerChoice::kPacked:
      return packed_touch(mesh_W, choice, surface);
  }
  return apart(choice, "is not known.");
}

}  // namespace

Built build_object_touch(const TriangleMesh& mesh_W, const ContactChoice& choice,
                         const SurfaceChoice& surface) {
  if (choice.profile && choice.blending != BlendingChoice::kFixedBand &&
      choice.blending != BlendingChoice::kSizedBand) {
    return driver::Error{
        "A profile says how the normal turns within a band: it goes with the blending "
        "\"fixed_band\" or \"sized_band\" only."};
  }
  auto touch = surface.shape.named() ? shaped_touch(mesh_W, choice, surface)
                                     : stiff_touch(mesh_W, choice, surface);
  if (!touch || !surface.dent) return touch;
  std::shared_ptr<const ContactMesh> mesh;
  if (const ContactMesh* touched = (*touch)->mesh()) {
    // Belongs to the contact, which lives as long as the dent around it.
    mesh = std::shared_ptr<const ContactMesh>(std::shared_ptr<const ContactMesh>(), touched);
  } else {
    // Contact on packed triangles keeps none; base points are read from here.
    auto own = ContactMesh::build(mesh_W);
    if (!own) return own.error();
    mesh = std::make_shared<const ContactMesh>(std::move(own).value());
  }
  auto dent = BendablePolygon::build(std::move(mesh), *surface.dent);
  if (!dent) return dent.error();
  return Built(std::make_unique<DentedTouch>(std::move(touch).value(), std::move(dent).value()));
}

}  // namespace thimble::render

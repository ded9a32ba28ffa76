#include "thimble/render/build_object_touch.h"

#include <memory>
#include <string>
#include <type_traits>
#include <utility>

#include "ball/ball_contact.h"
#include "ball/mesh_ball.h"
#include "body/dent/bendable_polygon.h"
#include "body/dent/dented_touch.h"
#include "build_surface_touch.h"
#include "mesh/overlapping_parts.h"
#include "mesh/smooth_normals.h"
#include "shape_object.h"
#include "still_surface.h"
#include "surface/map/surface_maps.h"
#include "track/blended.h"
#include "track/curved_depth.h"
#include "track/edge_blending.h"
#include "track/god_object.h"
#include "track/mesh_contact.h"
#include "tracker_table.h"
#include "use_maps.h"
#include "world/parts_touch.h"

namespace thimble::render {
namespace {

using Built = driver::Result<std::unique_ptr<ObjectTouch>>;

constexpr double kTipRadiusMax = 1;  // m

using Normals = std::shared_ptr<const SmoothNormals>;

// The shading, chosen when the object is built, not when compiled. Its functions are in another
// source file anyway, and instantiating each tracker with each shading would be a fifth of the
// build time of this library.
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

/// Wraps a tracked contact in the chosen shading, or leaves it bare if there is none.
template <class Contact>
Built tracked_touch(Contact contact, const ChosenShading& shading, bool curved,
                    const Normals& normals, const SurfaceChoice& surface) {
  if (curved) {
    return build_surface_touch(
        Blended<Contact, ChosenShading, CurvedDepth>(std::move(contact), shading, normals),
        surface);
  }
  if (shading.blending == BlendingChoice::kFlat)
    return build_surface_touch(std::move(contact), surface);
  return build_surface_touch(
      Blended<Contact, ChosenShading, MeshDepth>(std::move(contact), shading, normals), surface);
}

template <class Contact>
Built mesh_touch(const StillSurface& still, const ContactChoice& choice,
                 const SurfaceChoice& surface) {
  // This tracker walks on the normals themselves, and shares them with the shading.
  constexpr bool kSmooth = std::is_same_v<Contact, OffsetContact>;
  const ChosenShading shading{.blending = choice.blending.value_or(kSmooth ? BlendingChoice::kPhong
                                                                           : BlendingChoice::kFlat),
                              .width = choice.band,
                              .profile = choice.profile.value_or(BlendProfile::kLinear)};
  const bool curved = choice.curved_depth.value_or(kSmooth);
  if constexpr (kSmooth) {
    return tracked_touch(Contact(still.mesh, still.search, still.normals), shading, curved,
                         still.normals, surface);
  } else {
    return tracked_touch(Contact(still.mesh, still.search), shading, curved, still.normals,
                         surface);
  }
}

// `mapped`: the surface had maps, which its stages use by now.
Built stiff_touch(const StillSurface& still, const ContactChoice& choice,
                  const SurfaceChoice& surface, bool mapped = false) {
  if (needs_maps(surface)) {
    const auto used = use_maps(surface);
    if (!used) return used.error();
    return stiff_touch(still, choice, *used, true);
  }
  if (choice.tip_radius > 0) {
    return build_surface_touch(
        BallContact(MeshBall(still.triangles, still.search, choice.tip_radius)), surface);
  }
  return with_contact_of(choice.tracker, [&]<class Contact>(std::type_identity<Contact>) -> Built {
    if constexpr (std::is_same_v<Contact, GodObjectContact>) {
      return build_surface_touch(Contact(still.mesh, still.search), surface);
    } else if constexpr (std::is_same_v<Contact, InMemoryContact>) {
      return build_surface_touch(Contact(still.packed, still.search), surface);
    } else {
      if constexpr (std::is_same_v<Contact, MeshContact>) {
        if (mapped) return mesh_touch<MappedMeshContact>(still, choice, surface);
      }
      return mesh_touch<Contact>(still, choice, surface);
    }
  });
}

/// Returns an error if a tip that is a ball cannot touch such a surface. Written so that NaN is
/// refused.
driver::Result<void> check_ball(const ContactChoice& choice, const SurfaceChoice& surface) {
  if (choice.tip_radius == 0) return {};
  if (!(choice.tip_radius > 0 && choice.tip_radius <= kTipRadiusMax)) {
    return driver::Error{"The radius of the tip must be from 0 to 1 m."};
  }
  if (!surface.dent && !surface.shape.named()) return {};
  return driver::Error{
      "A tip with a radius cannot touch a surface that deforms (dent, plastic, clay, snap). Remove "
      "the radius of the tip, or the body's deformation."};
}

/// Adds a dent to an object, if its surface has one.
Built dented(Built touch, const TriangleMesh& mesh_W, const SurfaceChoice& surface) {
  if (!touch || !surface.dent) return touch;
  std::shared_ptr<const ContactMesh> mesh;
  if (const ContactMesh* touched = (*touch)->mesh()) {
    // Owned by the contact, which lives as long as the dent around it.
    mesh = std::shared_ptr<const ContactMesh>(std::shared_ptr<const ContactMesh>(), touched);
  } else {
    // Contact on packed triangles keeps no ContactMesh; base points are read from this one.
    auto own = ContactMesh::build(mesh_W);
    if (!own) return own.error();
    mesh = std::make_shared<const ContactMesh>(std::move(own).value());
  }
  auto dent = BendablePolygon::build(std::move(mesh), *surface.dent);
  if (!dent) return dent.error();
  return Built(std::make_unique<DentedTouch>(std::move(touch).value(), std::move(dent).value()));
}

/// Builds an object of several parts that overlap, each a separate solid.
Built parts_touch(std::vector<MeshPart> parts, const std::shared_ptr<const ContactMesh>& mesh,
                  const ContactChoice& choice, const SurfaceChoice& surface) {
  std::vector<PartsTouch::Part> built;
  for (MeshPart& part : parts) {
    const auto still = prepare_still_surface(part.mesh, choice);
    if (!still) return still.error();
    SurfaceChoice own = surface;
    if (own.maps) {
      own.maps = std::make_shared<const SurfaceMaps>(part_of(*surface.maps, part.triangles));
    }
    auto touch = stiff_touch(*still, choice, own);
    if (!touch) return touch.error();
    built.push_back({std::move(touch).value(), std::move(part.triangles)});
  }
  return Built(std::make_unique<PartsTouch>(std::move(built), mesh));
}

}  // namespace

Built build_object_touch(const StillSurface& still, const TriangleMesh& mesh_W,
                         const ContactChoice& choice, const SurfaceChoice& surface) {
  if (auto fits = check_ball(choice, surface); !fits) return fits.error();
  if (auto fits = check_maps(surface, mesh_W.triangles.size()); !fits) return fits.error();
  if (!surface.dent && !still.connected) {
    auto parts = overlapping_parts(mesh_W);
    if (parts.size() > 1) return parts_touch(std::move(parts), still.mesh, choice, surface);
  }
  return dented(stiff_touch(still, choice, surface), mesh_W, surface);
}

Built build_object_touch(const TriangleMesh& mesh_W, const ContactChoice& choice,
                         const SurfaceChoice& surface) {
  if (auto fits = check_ball(choice, surface); !fits) return fits.error();
  if (auto fits = check_maps(surface, mesh_W.triangles.size()); !fits) return fits.error();
  if (surface.shape.named()) {
    if (auto fits = check_profile(choice); !fits) return fits.error();
    return dented(shaped_touch(mesh_W, choice, surface), mesh_W, surface);
  }
  const auto still = prepare_still_surface(mesh_W, choice);
  if (!still) return still.error();
  return build_object_touch(*still, mesh_W, choice, surface);
}

}  // namespace thimble::render

#include "still_surface.h"

#include <optional>
#include <string>
#include <utility>

#include "mesh/repair/checked_mesh.h"
#include "search/make_search.h"
#include "search/tree_search.h"

namespace thimble::render {
namespace {

driver::Error apart(const ContactChoice& choice, const std::string& why) {
  return driver::Error{"The tracker \"" +
                       std::string(kTrackerNames[static_cast<std::size_t>(choice.tracker)]) +
                       "\" " + why};
}

/// Returns an error if stages of a choice are incompatible.
driver::Result<void> check_choice(const ContactChoice& choice) {
  if (auto fits = check_profile(choice); !fits) return fits;
  if (choice.tracker == TrackerChoice::kGodObject) {
    if (choice.blending.value_or(BlendingChoice::kFlat) != BlendingChoice::kFlat ||
        choice.curved_depth.value_or(false)) {
      return apart(choice, "pushes towards its proxy and supports only the blending \"flat\".");
    }
    if (choice.normals) return apart(choice, "does not use vertex normals. Remove normals.");
  }
  if (choice.tracker != TrackerChoice::kPacked) return {};
  if (choice.blending.value_or(BlendingChoice::kPhong) != BlendingChoice::kPhong ||
      !choice.curved_depth.value_or(true)) {
    return apart(
        choice,
        "is always smooth (phong, curved depth). Remove blending and curved_depth, or use the "
        "tracker \"offset\" or \"edge_planes\".");
  }
  if (choice.normals.value_or(NormalWeights::kAngle) != NormalWeights::kAngle) {
    return apart(choice,
                 "always weights vertex normals by angle. Remove normals, or use the tracker "
                 "\"offset\".");
  }
  return {};
}

driver::Result<StillSurface> prepare_packed(const TriangleMesh& mesh_W, const ContactChoice& choice,
                                            bool is_valid) {
  // Also checks the whole mesh, so that faults are reported as for all other trackers.
  std::future<driver::Result<CheckedMesh>> looked;
  if (!is_valid) looked = check_contact_mesh_async(mesh_W, true);
  PackedSurfaceOptions options;
  if (choice.crease_angle) options.crease_angle = *choice.crease_angle;
  auto packed = PackedSurface::build(mesh_W, options);
  const auto sound = is_valid ? driver::Result<CheckedMesh>(CheckedMesh()) : looked.get();
  if (!sound) return sound.error();
  if (sound->turned) packed = PackedSurface::build(*sound->turned, options);
  if (!packed) return packed.error();
  StillSurface still;
  still.packed = std::make_shared<const PackedSurface>(std::move(packed).value());
  still.search = make_search(*still.packed, choice.search);
  still.connected = is_valid;
  return still;
}

/// Prepares a mesh for a tip that is a ball.
driver::Result<StillSurface> prepare_for_ball(const TriangleMesh& mesh_W,
                                              const ContactChoice& choice) {
  auto prepared = ContactMesh::build(mesh_W, {.edge_planes = false});
  if (!prepared) return prepared.error();
  StillSurface still;
  still.mesh = std::make_shared<const ContactMesh>(std::move(prepared).value());
  still.search = make_search(*still.mesh, choice.search);
  still.triangles = std::make_shared<const TriangleTree>(still.mesh);
  return still;
}

/// Returns whether corner normals are needed, for tracking or for shading.
bool needs_normals(const ContactChoice& choice) {
  if (choice.tracker == TrackerChoice::kGodObject) return false;
  return choice.tracker == TrackerChoice::kOffset || choice.curved_depth.value_or(false) ||
         choice.blending.value_or(BlendingChoice::kFlat) != BlendingChoice::kFlat;
}

// From here on memory matters, 20 MB and more: planes are computed when a triangle is entered,
// which costs 70 to 150 ns each time. [chosen]
constexpr std::size_t kPlanesKeptMax = 100000;

/// Returns whether edge planes are stored: for small meshes, and for trackers that need them in
/// each tick.
bool keeps_planes(const TriangleMesh& mesh_W, const ContactChoice& choice) {
  return mesh_W.triangles.size() <= kPlanesKeptMax || needs_normals(choice);
}

}  // namespace

driver::Result<void> check_profile(const ContactChoice& choice) {
  if (!choice.profile || choice.blending == BlendingChoice::kFixedBand ||
      choice.blending == BlendingChoice::kSizedBand) {
    return {};
  }
  return driver::Error{
      "profile sets how the normal turns within a band. It needs the blending \"fixed_band\" or "
      "\"sized_band\"."};
}

std::optional<StoredSurface> stored_data(const StillSurface& still) noexcept {
  const auto* tree = dynamic_cast<const TreeSearch<PackedSurface>*>(still.search.get());
  if (!still.packed || tree == nullptr) return {};
  return StoredSurface{still.packed->frame(), still.packed->triangles(), tree->nodes().all()};
}

std::optional<StillSurface> restore_surface(const PackedSurface::Frame& frame,
                                            PackedSurface::Triangles triangles,
                                            TreeNodes::Nodes nodes) {
  auto packed = PackedSurface::restore(frame, std::move(triangles));
  TreeNodes tree;
  if (!packed || !tree.restore(packed->triangles().size(), std::move(nodes))) return {};
  StillSurface still;
  still.packed = std::make_shared<const PackedSurface>(*std::move(packed));
  still.search = std::make_shared<const TreeSearch<PackedSurface>>(*still.packed, std::move(tree));
  return still;
}

driver::Result<StillSurface> prepare_still_surface(const TriangleMesh& mesh_W,
                                                   const ContactChoice& choice, bool is_valid) {
  if (auto fits = check_choice(choice); !fits) return fits.error();
  if (choice.tip_radius > 0) return prepare_for_ball(mesh_W, choice);
  if (choice.tracker == TrackerChoice::kPacked) return prepare_packed(mesh_W, choice, is_valid);
  // The god-object does not use edge planes.
  auto prepared =
      ContactMesh::build(mesh_W, {.edge_planes = choice.tracker != TrackerChoice::kGodObject,
                                  .keep_planes = keeps_planes(mesh_W, choice)});
  if (!prepared) return prepared.error();
  StillSurface still;
  still.mesh = std::make_shared<const ContactMesh>(std::move(prepared).value());
  still.search = make_search(*still.mesh, choice.search);
  still.connected = is_valid;
  if (!needs_normals(choice)) return still;
  const bool in_bands = choice.blending == BlendingChoice::kFixedBand ||
                        choice.blending == BlendingChoice::kSizedBand;
  still.normals = std::make_shared<const SmoothNormals>(
      *still.mesh, choice.crease_angle.value_or(kCreaseAngle),
      choice.normals.value_or(NormalWeights::kFitted),
      in_bands ? kConcaveCreaseAngleOfBands : kConcaveCreaseAngle);
  return still;
}

}  // namespace thimble::render

#include "thimble/render/choose_tracker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <string>

#include "mesh/surface_turns.h"

namespace thimble::render {
namespace {

// choose_tracker.md has the tables that the marks refer to.

// A mesh with fewer triangles is faceted. [chosen: prisms of up to 12 sides, dice, brackets; the
// coarsest smooth mesh of the table is a ball of 80 triangles]
constexpr std::size_t kTrianglesMin = 50;

// A mesh is faceted if less than this share of its area curves. [measured: on plates and anchors
// with holes, up to 0.29, the flat parts are felt the same; turned parts have 0.45 and more]
constexpr double kCurvedMin = 0.33;

// A mesh is faceted if half of its curved area turns by more over an edge, rad. [measured: 25
// degrees; the error of a smoothed prism passes that of its facets, taken as a cylinder, at none of
// the sides, but exceeds 2 % of the force below 15 sides]
constexpr double kMedianTurnMax = 0.436;

// Share of the area that may rise because flat triangles have narrow curved neighbours. [measured:
// up to 0.09 on scans, 0.15 and more on parts with fillets]
constexpr double kUnevenMax = 0.1;

// The crease angle is at least this one, rad, and at least this multiple of the turn that 90 % of
// the curved area does not exceed. [measured: 20 degrees keeps every edge of the turned parts and
// of the fan disk; on scans the multiple reaches the default of 43 degrees]
constexpr double kCreaseMin = 0.35;
constexpr double kCreasePerTurn = 3;

// If narrow triangles lower the crease angle, it must clear the curved area by this factor.
// [chosen: else it cuts through what is meant to be smooth]
constexpr double kClear = 1.5;

constexpr std::size_t kNoClass = SurfaceTurns::kClasses;
constexpr double kDegrees = 180 / std::numbers::pi;

ChosenTracker with(ContactChoice contact, TrackerChoice tracker, std::string reason) {
  contact.tracker = tracker;
  return {std::move(contact), std::move(reason)};
}

/// Sums of the classes of turns up to a crease angle.
struct UpTo {
  double curved = 0;  // share of the area
  double uneven = 0;
  double median = 0, high = 0;  // turns of 50 and 90 % of the area at curved edges, rad
};

// Returns the sums over the first `classes` classes.
UpTo sums(const SurfaceTurns& turns, std::size_t classes) {
  UpTo sum;
  double edges = 0;
  for (std::size_t i = 0; i < classes; ++i) {
    sum.curved += turns.curved[i];
    sum.uneven += turns.uneven[i];
    edges += turns.edges[i];
  }
  const auto turn_at = [&](double share) {
    double below = 0;
    for (std::size_t i = 0; i < classes; ++i) {
      below += turns.edges[i];
      if (turns.edges[i] > 0 && below >= share * edges) return SurfaceTurns::turn_of(i);
    }
    return 0.0;
  };
  sum.median = turn_at(0.5);
  sum.high = turn_at(0.9);
  return sum;
}

// Returns the number of classes below the crease angle; kNoClass + 1 if none keeps flat faces flat.
std::size_t classes_below_crease(const SurfaceTurns& turns) {
  const double wanted =
      std::max(kCreaseMin, kCreasePerTurn * sums(turns, SurfaceTurns::kClasses).high);
  std::size_t classes = SurfaceTurns::kClasses;
  while (classes > 1 && SurfaceTurns::turn_of(classes - 2) >= wanted) --classes;
  if (sums(turns, classes).uneven <= kUnevenMax) return classes;
  for (; classes > 0; --classes) {
    const UpTo sum = sums(turns, classes);
    if (sum.uneven > kUnevenMax) continue;
    const double crease = SurfaceTurns::turn_of(classes - 1);
    if (sum.curved >= kCurvedMin && kClear * sum.high <= crease) return classes;
  }
  return kNoClass + 1;
}

ChosenTracker choose_by_shape(const SurfaceTurns& turns, const ContactChoice& contact) {
  const auto faceted = [&](const std::string& why) {
    return with(contact, TrackerChoice::kEdgePlanes, "faceted: " + why);
  };
  if (!turns.closed) return with(contact, TrackerChoice::kEdgePlanes, "not closed");
  if (turns.triangles < kTrianglesMin) {
    return faceted(fmt::format("{} triangles only", turns.triangles));
  }
  const UpTo all = sums(turns, SurfaceTurns::kClasses);
  if (all.curved < kCurvedMin) {
    return faceted(fmt::format("{:.0f} % of the area is flat", 100 * (1 - all.curved)));
  }
  const std::size_t classes = classes_below_crease(turns);
  if (classes > SurfaceTurns::kClasses) {
    return faceted("large triangles next to narrow ones, which would bulge if smoothed");
  }
  const UpTo smooth = sums(turns, classes);
  if (smooth.curved < kCurvedMin) {
    return faceted(fmt::format("{:.0f} % of the area is flat", 100 * (1 - smooth.curved)));
  }
  if (smooth.median > kMedianTurnMax) {
    return faceted(
        fmt::format("its faces turn by {:.0f} degrees over an edge", kDegrees * smooth.median));
  }
  ChosenTracker chosen = with(contact, TrackerChoice::kPacked,
                              fmt::format("smooth: {:.0f} % of the area curves, by {:.1f} degrees "
                                          "over an edge",
                                          100 * smooth.curved, kDegrees * smooth.median));
  // Only named if an edge depends on it.
  if (!contact.crease_angle && turns.classes_used > classes) {
    chosen.contact.crease_angle = SurfaceTurns::turn_of(classes - 1);
  }
  return chosen;
}

}  // namespace

std::optional<ChosenTracker> required_tracker(const ContactChoice& contact,
                                              const SurfaceChoice& surface) {
  if (contact.tip_radius > 0) return ChosenTracker{contact, "the tip has a radius"};
  const auto flat = [&](const char* why) { return with(contact, TrackerChoice::kEdgePlanes, why); };
  if (surface.shape.clay && surface.shape.clay->edge > 0) {
    return with(contact, TrackerChoice::kGodObject, "its triangles are split");
  }
  if (surface.shape.named()) return flat("its shape changes");
  if (surface.dent) return flat("its surface dents");
  if (contact.blending) return flat("blending is set");
  if (contact.normals) return flat("normals is set");
  if (contact.curved_depth) return flat("curved_depth is set");
  if (contact.profile) return flat("profile is set");
  if (contact.band != ContactChoice().band) return flat("band is set");
  return {};
}

ChosenTracker choose_tracker(const TriangleMesh& mesh, const ContactChoice& contact,
                             const SurfaceChoice& surface) {
  if (auto required = required_tracker(contact, surface)) return *std::move(required);
  return choose_by_shape(surface_turns(mesh), contact);
}

}  // namespace thimble::render

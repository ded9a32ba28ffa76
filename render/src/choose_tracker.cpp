#include "thimble/render/build_object_touch.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>

#include "surface_turns.h"

namespace thimble::render {
namespace {

// choose_tracker.md has the tables that the marks refer to.

// A mesh with fewer triangles is faceted. [chosen: prisms of up to 12 sides, dice, brackets; the
// coarsest smooth mesh of the table is a ball of 80 triangles]
constexpr std::size_t kTrianglesMin = 50;

// A mesh is faceted if less than this share of its area curves. [measured: prisms whose sides are
// split have 0.33, plates and anchors with holes up to 0.38; turned parts and scans 0.5 and more]
constexpr double kCurvedMin = 0.4;

// A mesh is faceted if half of its curved area turns by more than this over an edge, rad: 25
// degrees. [measured: a nut of ten sides turns by 36 degrees, and smoothing it makes an error of
// the whole force; a ball of 80 triangles turns by 18 degrees, and its facets make such an error]
constexpr double kMedianTurnMax = 0.436;

// Share of the area that may bulge because large triangles have narrow curved neighbours.
// [measured: up to 0.09 on scans, 0.15 and more on parts with fillets, which smoothing would spoil]
constexpr double kUnevenMax = 0.1;

// Edges are real, not steps of a smooth surface, if they turn by more than kEdgeMin (rad), if
// almost no edge turns by less than that and more than half of it, and if they have less than this
// share of the area at bent edges. [chosen: a tube of 16 sides has half of it at edges of 22.5
// degrees]
constexpr double kEdgeMin = 0.35;
constexpr double kGapRatio = 2;
constexpr double kGapShare = 0.002;
constexpr double kEdgesMax = 0.4;

// If large triangles lower the crease angle, it must clear 90 % of the curved area by this factor.
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
  double edges = 0;             // share of the area at curved edges
  double median = 0, high = 0;  // turns that 50 and 90 % of it do not exceed, rad
};

// Returns the sums over the first `classes` classes.
UpTo sums(const SurfaceTurns& turns, std::size_t classes) {
  UpTo sum;
  for (std::size_t i = 0; i < classes; ++i) {
    sum.curved += turns.curved[i];
    sum.uneven += turns.uneven[i];
    sum.edges += turns.edges[i];
  }
  const auto turn_at = [&](double share) {
    double below = 0;
    for (std::size_t i = 0; i < classes; ++i) {
      below += turns.edges[i];
      if (turns.edges[i] > 0 && below >= share * sum.edges) return SurfaceTurns::turn_of(i);
    }
    return 0.0;
  };
  sum.median = turn_at(0.5);
  sum.high = turn_at(0.9);
  return sum;
}

// Returns the number of classes below the real edges of a mesh; all classes if it has none.
std::size_t classes_below_edges(const SurfaceTurns& turns) {
  const double all = sums(turns, SurfaceTurns::kClasses).edges;
  std::size_t found = SurfaceTurns::kClasses;
  double widest = kGapRatio;
  double above = 0;  // at edges of class `end` and more
  for (std::size_t end = SurfaceTurns::kClasses - 1; end > 0; --end) {
    above += turns.edges[end];
    if (above > kEdgesMax * all) break;
    const double edge = SurfaceTurns::turn_of(end - 1);  // all of these turn by more
    if (turns.edges[end] == 0 || edge < kEdgeMin) continue;
    std::size_t begin = end;
    double inside = 0;
    while (begin > 0 && inside + turns.edges[begin - 1] <= kGapShare * all) {
      inside += turns.edges[--begin];
    }
    if (begin == 0) continue;  // no edge turns by less
    const double step = SurfaceTurns::turn_of(begin - 1);
    if (edge < widest * step) continue;
    widest = edge / step;
    const double crease = std::sqrt(edge * step);
    found = begin;
    while (SurfaceTurns::turn_of(found - 1) < crease) ++found;
  }
  return found;
}

// Returns the number of classes below the crease angle; kNoClass + 1 if faces bulge at any.
std::size_t classes_below_crease(const SurfaceTurns& turns) {
  std::size_t classes = classes_below_edges(turns);
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

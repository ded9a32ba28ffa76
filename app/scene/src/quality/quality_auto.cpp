#include "quality/quality_auto.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>

#include "math/elementary.h"
#include "mesh/repair/orient_mesh.h"
#include "meshes/object_mesh.h"
#include "quality/quality_table.h"
#include "thimble/render/mesh/mesh_file.h"

namespace thimble::scene {
namespace {

using render::BlendingChoice;
using render::TrackerChoice;

constexpr double kTurnMargin =
    1.05;  // relative to the coarsest mesh of the table; beyond it a note is printed

/// One setting of a choice of an object.
struct Candidate {
  double error = 0;  // relative to the limit of perception
  double ns = 0;
  std::string words;
  std::function<void(SceneObject&)> choose;
};

/// One choice of an object, with its settings.
struct Knob {
  std::size_t object = 0;
  std::string where;  // note printed after the setting: what it was judged on
  std::vector<Candidate> candidates;
};

// Interpolates an error or a time between two measured meshes as a power of the turn. Beyond them
// it is that of the nearer mesh.
double interpolate(double x, const ContactPoint& a, const ContactPoint& b, double of_a,
                   double of_b) {
  if (!(of_a > 0 && of_b > 0)) return of_a;
  const double share = std::clamp(math::log(x / a.turn) / math::log(b.turn / a.turn), 0.0, 1.0);
  return math::exp((1 - share) * math::log(of_a) + share * math::log(of_b));
}

std::string words_of(const ContactPoint& point) {
  std::string text(render::kTrackerNames[static_cast<std::size_t>(point.tracker)]);
  if (point.blending) {
    text.append(", ").append(render::kBlendingNames[static_cast<std::size_t>(*point.blending)]);
  }
  if (point.curved_depth.value_or(false)) text.append(", curved depth");
  return text;
}

// Returns the contact settings for this surface, for a mesh whose normals turn by `turn` over an
// edge. The table lists the measured points of each setting together, from coarse to fine.
std::vector<Candidate> contacts_for(const SceneObject& object, double turn) {
  std::vector<Candidate> all;
  const auto points = quality_table().contacts;
  const auto same_way = [](const ContactPoint& a, const ContactPoint& b) {
    return a.tracker == b.tracker && a.blending == b.blending && a.curved_depth == b.curved_depth;
  };
  for (std::size_t begin = 0, end = 0; begin < points.size(); begin = end) {
    end = begin + 1;
    while (end < points.size() && same_way(points[begin], points[end])) ++end;
    const ContactPoint& way = points[begin];
    if (object.tracker_named && way.tracker != object.contact.tracker) continue;
    // A surface that changes its shape supports neither compact triangles nor curved depth.
    if (object.body.shape.named() &&
        (way.tracker != TrackerChoice::kEdgePlanes || way.curved_depth.value_or(false) ||
         way.blending == BlendingChoice::kSizedBand)) {
      continue;
    }
    std::size_t k = begin;
    while (k + 2 < end && turn < points[k + 1].turn) ++k;
    const ContactPoint &a = points[k], &b = points[std::min(k + 1, end - 1)];
    const double error = turn > 0 ? interpolate(turn, a, b, a.error, b.error) : 0;
    const double ns = turn > 0 ? interpolate(turn, a, b, a.ns, b.ns) : points[end - 1].ns;
    all.push_back({error, ns, words_of(way), [&way](SceneObject& chosen) {
                     chosen.contact.tracker = way.tracker;
                     chosen.tracker_named = true;
                     chosen.contact.blending = way.blending;
                     chosen.contact.curved_depth = way.curved_depth;
                   }});
  }
  return all;
}

std::vector<Candidate> dents_for(const SceneObject& object) {
  std::vector<Candidate> all;
  const bool whole = object.body.dent->whole;
  for (const RingsPoint& patch : quality_table().rings) {
    // All vertices of a whole body move, whatever number of rings is set.
    if (whole && patch.rings != quality_table().rings.back().rings) continue;
    for (const StepsPoint& steps : quality_table().steps) {
      std::string words = fmt::format("{} in {} step{} per tick", render::name_of(steps.integrator),
                                      steps.substeps, steps.substeps == 1 ? "" : "s");
      if (!whole) {
        words =
            fmt::format("a dent of {} ring{}, {}", patch.rings, patch.rings == 1 ? "" : "s", words);
      }
      all.push_back({std::max(whole ? 0 : patch.error, steps.error), patch.ns * steps.cost,
                     std::move(words), [patch, steps](SceneObject& chosen) {
                       auto& dent = *chosen.body.dent;
                       if (!dent.whole) dent.rings = patch.rings;
                       dent.integrator = steps.integrator;
                       dent.substeps = steps.substeps;
                     }});
    }
  }
  return all;
}

std::optional<double> turn_of(const SceneObject& object) {
  auto mesh = read_object_mesh(object);
  if (!mesh) return {};
  render::TriangleMesh placed = place_mesh(*mesh, object);
  render::orient_mesh(placed);
  const auto built = render::ContactMesh::build(placed);
  if (!built) return {};
  return typical_turn(*built);
}

std::vector<Knob> knobs_of(const Scene& scene) {
  std::vector<Knob> knobs;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    if (leaves_surface_open(object)) {
      // Objects that cannot be touched are reported when their force law is built.
      if (const auto turn = turn_of(object)) {
        knobs.push_back({i,
                         fmt::format(" (its faces turn by {:.2g} degrees over an edge{})",
                                     *turn * 180 / std::numbers::pi,
                                     *turn > kTurnMargin * quality_table().contacts.front().turn
                                         ? ", more than on any measured mesh"
                                         : ""),
                         contacts_for(object, *turn)});
      }
    }
    if (object.body.dent) knobs.push_back({i, "", dents_for(object)});
  }
  std::erase_if(knobs, [](const Knob& knob) { return knob.candidates.empty(); });
  return knobs;
}

// Returns the cheapest setting with an error of at most `error`; nullptr if there is none.
const Candidate* cheapest(const Knob& knob, double error) {
  const Candidate* found = nullptr;
  for (const Candidate& one : knob.candidates) {
    // Written so that NaN is never chosen.
    if (!(one.error <= error)) continue;
    if (found == nullptr || one.ns < found->ns) found = &one;
  }
  return found;
}

double min_error(const Knob& knob) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const Candidate& one : knob.candidates) smallest = std::min(smallest, one.error);
  return smallest;
}

// Returns the cheapest settings at which the error of no choice exceeds `error`, or its smallest
// possible error.
std::vector<const Candidate*> points_at(const std::vector<Knob>& knobs, double error) {
  std::vector<const Candidate*> points;
  for (const Knob& knob : knobs) {
    points.push_back(cheapest(knob, std::max(error, min_error(knob))));
  }
  return points;
}

double cost_of(const std::vector<const Candidate*>& points) {
  double ns = 0;
  for (const Candidate* point : points) ns += point->ns;
  return ns;
}

// Returns the settings with the smallest largest error within the budget; the cheapest settings if
// none is within it.
std::vector<const Candidate*> best_within(const std::vector<Knob>& knobs, double budget) {
  std::vector<double> errors;
  for (const Knob& knob : knobs) {
    for (const Candidate& one : knob.candidates) errors.push_back(one.error);
  }
  std::sort(errors.begin(), errors.end());
  for (const double error : errors) {
    auto points = points_at(knobs, error);
    if (cost_of(points) <= budget) return points;
  }
  return points_at(knobs, std::numeric_limits<double>::infinity());
}

}  // namespace

bool leaves_surface_open(const SceneObject& object) {
  return !(object.contact.tip_radius > 0) && !object.paged && !object.shape &&
         !object.build_field && !object.body.dent && !object.contact.blending &&
         !object.contact.curved_depth && !object.contact.normals &&
         !(object.tracker_named && (object.contact.tracker == TrackerChoice::kNormalProjection ||
                                    object.contact.tracker == TrackerChoice::kGodObject));
}

std::vector<std::string> choose_quality(Scene& scene, std::optional<double> budget) {
  const std::vector<Knob> knobs = knobs_of(scene);
  const auto points = budget ? best_within(knobs, *budget) : points_at(knobs, 1);
  std::vector<std::string> notes;
  for (std::size_t i = 0; i < knobs.size(); ++i) {
    SceneObject& object = scene.objects[knobs[i].object];
    points[i]->choose(object);
    notes.push_back(fmt::format("{}: {}{}: {:.0f} ns per tick, error {:.2g} % of what can be felt.",
                                object.name, points[i]->words, knobs[i].where, points[i]->ns,
                                100 * points[i]->error));
  }
  const double ns = cost_of(points);
  const std::string machine =
      fmt::format("measured on {}, table {}", quality_table().measured, quality_table().version);
  if (knobs.empty()) {
    notes.emplace_back(
        "Nothing to choose: no object leaves its contact or its dent open; shapes, fields and "
        "frictions stay as in the scene.");
  } else if (!budget) {
    notes.push_back(
        fmt::format("The cheapest settings without an error that can be felt: {:.0f} ns per tick "
                    "in total ({}).",
                    ns, machine));
  } else if (ns <= *budget) {
    notes.push_back(
        fmt::format("The most accurate settings for {:.0f} of the {:.0f} ns per tick ({}).", ns,
                    *budget, machine));
  } else {
    notes.push_back(fmt::format(
        "Nothing fits into {:.0f} ns per tick; the cheapest settings take {:.0f} ns ({}).", *budget,
        ns, machine));
  }
  return notes;
}

}  // namespace thimble::scene

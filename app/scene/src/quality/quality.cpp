#include "thimble/scene/quality.h"

#include <fmt/core.h>

#include <algorithm>

#include "quality/quality_auto.h"

namespace thimble::scene {
namespace {

using render::BlendingChoice;
using render::SpringScheme;
using render::TrackerChoice;

// Number of rings of a dent, and its integration steps. The error of one ring is below the limit of
// perception, as `thimble study accuracy --axis rings` shows. The trapezoid with eight steps is
// below 3.5 % even while a body oscillates (axis deformable).
constexpr int kDraftRings = 1;
constexpr int kReferenceRings = 6;
constexpr int kReferenceSubsteps = 8;
constexpr double kReferenceRemainder = 1e-5;

// Rate of the loop, relative to that of the scene: half the ticks; and a rate at which a wall of
// 800 N/m gives a free arm less energy than can be felt (axis loop_rate).
constexpr double kDraftRate = 0.5;
constexpr double kReferenceRate = 4;

std::string draft(SceneObject& object) {
  std::string text;
  if (leaves_surface_open(object) && !object.tracker_named) {
    object.contact.tracker = TrackerChoice::kEdgePlanes;
    object.tracker_named = true;
    text += " flat triangles with edge planes, the cheapest contact;";
  }
  if (object.body.dent && !object.body.dent->whole && object.body.dent->rings > kDraftRings) {
    object.body.dent->rings = kDraftRings;
    text += " a dent of one ring, which feels the same as more rings;";
  }
  return text;
}

std::string reference(SceneObject& object) {
  std::string text;
  if (leaves_surface_open(object) && object.contact.tracker == TrackerChoice::kEdgePlanes) {
    object.contact.blending = BlendingChoice::kPhong;
    text += " Phong normals (edges sharper than the crease angle stay sharp),";
    if (object.body.shape.named()) {
      text += " without curved depth, because the surface changes its shape;";
    } else {
      object.contact.curved_depth = true;
      text += " and curved depth, so that triangles of a fifth of the radius are no longer felt;";
    }
  }
  if (object.body.dent) {
    auto& dent = *object.body.dent;
    dent.integrator = SpringScheme::kTrapezoid;
    dent.substeps = std::max(dent.substeps, kReferenceSubsteps);
    dent.remainder = kReferenceRemainder;
    dent.rings = std::max(dent.rings, kReferenceRings);
    text += " a dent of six rings, integrated by the trapezoid with eight steps per tick;";
  }
  return text;
}

std::string rate_sentence(Quality quality, const Scene& scene) {
  if (scene.rate_factor == 1) {
    return quality == Quality::kDraft
               ? "The rate of the loop stays that of the scene: the arm is real, or half the rate "
                 "would "
                 "be unstable on these surfaces."
               : "The rate of the loop stays that of the scene: the arm is real.";
  }
  return fmt::format(
      "The loop runs at {:g} Hz, {:g} times the rate of the scene{}; frictions stay as in the "
      "scene.",
      scene.rate, scene.rate_factor,
      scene.rate_factor < 1 ? ", at which these surfaces are stable: half the work per second"
                            : ", and so does the simulated board, so that the period of a tick is "
                              "felt as little as possible");
}

}  // namespace

std::optional<Quality> quality_named(std::string_view name) {
  const auto* at = std::find(kQualityNames.begin(), kQualityNames.end(), name);
  if (at == kQualityNames.end()) return {};
  return static_cast<Quality>(at - kQualityNames.begin());
}

double rate_factor_of(Quality quality) {
  if (quality == Quality::kDraft) return kDraftRate;
  return quality == Quality::kReference ? kReferenceRate : 1;
}

std::vector<std::string> apply_quality(Quality quality, Scene& scene,
                                       std::optional<double> budget) {
  if (quality == Quality::kNormal) return {};
  if (quality == Quality::kAuto) return choose_quality(scene, budget);
  std::vector<std::string> notes;
  for (SceneObject& object : scene.objects) {
    std::string text = quality == Quality::kDraft ? draft(object) : reference(object);
    if (text.empty()) {
      text = " as in the scene;";
    }
    text.back() = '.';
    notes.push_back(object.name + ":" + text);
  }
  notes.push_back(rate_sentence(quality, scene));
  return notes;
}

}  // namespace thimble::scene

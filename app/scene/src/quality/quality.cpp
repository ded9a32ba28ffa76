#include "thimble/scene/quality.h"

#include <algorithm>

namespace thimble::scene {
namespace {

using render::BlendingChoice;
using render::SpringScheme;
using render::TrackerChoice;

// Where dents end and how they are stepped. The force of one ring is off by less than can be felt,
// as `thimble study accuracy --axis rings` shows; the trapezoid with eight steps is below 3.5 %
// even while a body swings (axis deformable).
constexpr int kDraftRings = 1;
constexpr int kReferenceRings = 6;
constexpr int kReferenceSubsteps = 8;
constexpr double kReferenceRemainder = 1e-5;

bool is_mesh(const SceneObject& object) {
  return !object.paged && !object.shape && !object.build_field;
}

// Whether the scene left open how the surface is felt, and the tracker leaves a choice.
bool is_open(const SceneObject& object) {
  return is_mesh(object) && !object.body.dent && !object.contact.blending &&
         !object.contact.curved_depth &&
         (object.contact.tracker == TrackerChoice::kEdgePlanes ||
          object.contact.tracker == TrackerChoice::kOffset);
}

std::string draft(SceneObject& object) {
  std::string text;
  if (is_open(object) && object.contact.tracker != TrackerChoice::kEdgePlanes) {
    object.contact.tracker = TrackerChoice::kEdgePlanes;
    text += " flat triangles followed by edge planes, the cheapest contact;";
  }
  if (object.body.dent && !object.body.dent->whole && object.body.dent->rings > kDraftRings) {
    object.body.dent->rings = kDraftRings;
    text += " a dent of one ring, which the hand cannot tell from more;";
  }
  return text;
}

std::string reference(SceneObject& object) {
  std::string text;
  if (is_open(object)) {
    object.contact.blending = BlendingChoice::kPhong;
    text += " Phong normals (edges sharper than the crease angle stay sharp),";
    if (object.body.shape.named()) {
      text += " without curved depth, for the surface changes its shape;";
    } else {
      object.contact.curved_depth = true;
      text +=
          " and curved depth, with which triangles of a fifth of the radius are no longer felt;";
    }
  }
  if (object.body.dent) {
    auto& dent = *object.body.dent;
    dent.integrator = SpringScheme::kTrapezoid;
    dent.substeps = std::max(dent.substeps, kReferenceSubsteps);
    dent.remainder = kReferenceRemainder;
    dent.rings = std::max(dent.rings, kReferenceRings);
    text += " a dent of six rings stepped by the trapezoid eight times per tick;";
  }
  return text;
}

}  // namespace

Quality quality_named(std::string_view name) {
  if (name == "draft") return Quality::kDraft;
  return name == "reference" ? Quality::kReference : Quality::kNormal;
}

std::vector<std::string> apply_quality(Quality quality, Scene& scene) {
  if (quality == Quality::kNormal) return {};
  std::vector<std::string> said;
  for (SceneObject& object : scene.objects) {
    std::string text = quality == Quality::kDraft ? draft(object) : reference(object);
    if (text.empty()) {
      text = " as the scene says: nothing to choose;";
    }
    text.back() = '.';
    said.push_back(object.name + ":" + text);
  }
  said.push_back(
      "The loop's rate and the frictions stay as the scene says: the rate is the arm's, and a "
      "bristle is below what is felt at the price of the others.");
  return said;
}

}  // namespace thimble::scene

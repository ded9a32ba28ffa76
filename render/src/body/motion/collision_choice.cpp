#include <array>
#include <cmath>
#include <string>

#include "thimble/render/body/joint_choice.h"
#include "thimble/render/body/motion_choice.h"

namespace thimble::render {
namespace {

// Bounds of a scene's numbers, as those of a motion (move_object.cpp).
constexpr double kFrictionMax = 10;
constexpr double kPiecesMax = 64;
constexpr double kPlaceMax = 2;        // m
constexpr double kTravelMax = 3.1;     // rad, m; a hinge with limits turns by less than half a turn
constexpr double kSpeedMax = 100;      // rad/s, m/s
constexpr double kForceMax = 1e4;      // N, N m
constexpr double kStiffnessMax = 1e5;  // N/m
constexpr double kDampingMax = 1e3;    // N s/m

}  // namespace

void CollisionChoice::read(SettingsReader& reader) {
  std::size_t chosen = 0;
  reader.choice("shape", chosen, {"own", "hull", "box", "sphere", "mesh", "pieces", "none"});
  shape = static_cast<CollisionShape>(chosen);
  if (shape == CollisionShape::kNone) {
    for (const char* key : {"friction", "restitution"}) {
      reader.explain_unused(key, "needs a shape other than none");
    }
  } else {
    reader.number("friction", friction, {.unit = "", .min = 0, .max = kFrictionMax});
    reader.number("restitution", restitution, {.unit = "", .min = 0, .max = 1});
  }
  if (shape == CollisionShape::kPieces) {
    auto most = static_cast<double>(pieces);
    reader.number("pieces", most, {.unit = "", .min = 1, .max = kPiecesMax, .whole = true});
    pieces = static_cast<std::size_t>(most);
  } else {
    reader.explain_unused("pieces", "needs shape: pieces");
  }
}

void JointChoice::read(SettingsReader& reader) {
  std::size_t chosen = 0;
  reader.choice("kind", chosen, {"hinge", "slider", "ball", "fixed", "spring"});
  kind = static_cast<JointKind>(chosen);
  const NumberLimits place{.unit = "m", .min = -kPlaceMax, .max = kPlaceMax, .required = true};
  reader.vector("at", p_W, place);
  if (kind == JointKind::kHinge || kind == JointKind::kSlider) {
    read_travel(reader);
  } else {
    for (const char* key : {"axis", "min", "max", "friction", "speed", "motor_max"}) {
      reader.explain_unused(key, "needs kind: hinge or kind: slider");
    }
  }
  if (kind == JointKind::kSpring) {
    reader.vector("to", p_end_W, place);
    reader.number("stiffness", stiffness,
                  {.unit = "N/m", .min = 1e-3, .max = kStiffnessMax, .required = true});
    reader.number("damping", damping, {.unit = "N s/m", .min = 0, .max = kDampingMax});
    if (reader.has("length")) {
      length = 0;
      reader.number("length", *length, {.unit = "m", .min = 0, .max = kPlaceMax});
    }
  } else {
    for (const char* key : {"to", "stiffness", "damping", "length"}) {
      reader.explain_unused(key, "needs kind: spring");
    }
  }
}

// Settings of a hinge (rad, N m) or a slider (m, N).
void JointChoice::read_travel(SettingsReader& reader) {
  reader.vector("axis", axis_W, {.unit = "", .min = -1, .max = 1, .required = true});
  if (!(axis_W.norm() > 1e-6)) reader.reject("axis", "must not be zero");
  if (reader.has("min") || reader.has("max")) {
    const NumberLimits travel{
        .unit = "rad or m", .min = -kTravelMax, .max = kTravelMax, .required = true};
    double least = 0, largest = 0;
    reader.number("min", least, travel);
    reader.number("max", largest, travel);
    if (least > 0 || largest < 0) {
      reader.reject("min", "the first place, 0, must be between min and max");
    }
    limits.emplace(least, largest);
  }
  if (reader.has("speed")) {
    speed = 0;
    reader.number("speed", *speed, {.unit = "rad/s or m/s", .min = -kSpeedMax, .max = kSpeedMax});
    reader.number("motor_max", motor_max,
                  {.unit = "N m or N", .min = 1e-6, .max = kForceMax, .required = true});
    reader.explain_unused("friction", "cannot be combined with speed");
  } else {
    reader.number("friction", friction, {.unit = "N m or N", .min = 0, .max = kForceMax});
    reader.explain_unused("motor_max", "needs speed");
  }
}

}  // namespace thimble::render

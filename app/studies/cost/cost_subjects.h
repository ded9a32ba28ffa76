#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "studies/cost/ring_surface.h"
#include "thimble/driver/result.h"
#include "thimble/render/object_touch.h"
#include "thimble/render/surface/spring_damper.h"

namespace thimble::studies {

/// One thing whose cost per tick is measured: an object of a scene, made of named stages.
struct CostSubject {
  enum class Kind { kContact, kEffect };

  std::string name;  ///< Without spaces: it is an argument of `thimble cost-probe`.
  Kind kind = Kind::kContact;
  std::function<driver::Result<std::unique_ptr<render::ObjectTouch>>()> build;
};

/// The ring that all subjects are measured on, and how finely it is cut: 4,096 triangles.
inline constexpr RingSurface kCostRing{};
inline constexpr int kCostAround = 64, kCostAcross = 32;

/// The spring of all subjects' surface, what scenes give most: the vintage arm's declared
/// stiffness [DEVICES 3].
inline constexpr render::SpringDamper kCostSpring{.stiffness = 800, .damping = 1};

/// The subject that has no effect; effects are measured as what they add to it.
inline constexpr const char* kBareSubject = "bare";

/// Returns every way of contact and every effect that a scene can name, effects with the settings
/// of a plain scene. Real-time: never from the servo thread.
std::vector<CostSubject> cost_subjects();

}  // namespace thimble::studies

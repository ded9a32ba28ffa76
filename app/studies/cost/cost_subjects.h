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

/// A subject whose cost per tick is measured: an object of a scene, built from named stages.
struct CostSubject {
  enum class Kind { kContact, kEffect };

  std::string name;  ///< Without spaces: it is an argument of `thimble cost-probe`.
  Kind kind = Kind::kContact;
  std::function<driver::Result<std::unique_ptr<render::ObjectTouch>>()> build;
};

/// The ring for all subjects, with 4,096 triangles.
inline constexpr RingSurface kCostRing{};
inline constexpr int kCostAround = 64, kCostAcross = 32;

/// The spring of all subjects' surfaces, typical of scenes: the vintage arm's declared stiffness
/// [DEVICES 3].
inline constexpr render::SpringDamper kCostSpring{.stiffness = 800, .damping = 1};

/// The subject without an effect; the cost of an effect is the difference to it.
inline constexpr const char* kBareSubject = "bare";

/// Returns every contact method and every effect that a scene can name, effects with the settings
/// of a simple scene. Real-time: never from the servo thread.
std::vector<CostSubject> cost_subjects();

}  // namespace thimble::studies

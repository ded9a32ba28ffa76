#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "ball/ball_solid.h"
#include "thimble/render/build_object_touch.h"
#include "thimble/render/effect/stage_list.h"
#include "thimble/render/object_touch.h"
#include "track/path_bounded.h"
#include "world/law_solid.h"
#include "world/shape_solid.h"

namespace thimble::render {

/// Builds the stages of a surface: its spring comes after stages that change the depth.
/// Precondition: the surface needs no maps (use_maps.h). Real-time: never from the servo thread.
inline StageList stage_list(const SurfaceChoice& surface) {
  std::vector<std::unique_ptr<AnyStage>> stages;
  const auto spring = [&]() -> std::unique_ptr<AnyStage> {
    if (surface.spring_stage) return surface.spring_stage();
    return std::make_unique<AnyStageOf<SpringDamper>>(surface.spring);
  };
  bool sprung = false;
  for (const EffectPlan& effect : surface.effects) {
    if (!sprung && effect.kind->order > EffectOrder::kDepth) {
      stages.push_back(spring());
      sprung = true;
    }
    stages.push_back(effect.build());
  }
  if (!sprung) stages.push_back(spring());
  return StageList(std::move(stages));
}

/// Wraps a law known at compile time in the interface of ObjectTouch.
template <class Law>
std::unique_ptr<ObjectTouch> adapt_law(Law law) {
  auto adapter = std::make_unique<ObjectTouchAdapter<Law>>(std::move(law));
  if constexpr (BallLaw<Law>) {
    adapter->set_solid(std::make_shared<BallSolid<Law>>(adapter->law()));
  } else if constexpr (SolidLaw<Law>) {
    adapter->set_solid(std::make_shared<LawSolid<Law>>(adapter->law()));
  } else if constexpr (ShapeLaw<Law>) {
    adapter->set_solid(std::make_shared<ShapeSolid<Law>>(adapter->law()));
  }
  return adapter;
}

/// Builds the force law of one object from a contact stage and a surface. Every contact is bounded
/// by the tip's path (path_bounded.h). Real-time: never from the servo thread.
template <class Contact>
std::unique_ptr<ObjectTouch> build_surface_touch(Contact contact, const SurfaceChoice& surface) {
  PathBounded bounded(std::move(contact));
  // A bare surface, by far the most frequent case, is composed entirely at compile time.
  if (surface.effects.empty() && !surface.spring_stage)
    return adapt_law(ContactForceLaw(std::move(bounded), surface.spring));
  StageList stages = stage_list(surface);
  if (!stages.needs_closest_point())
    return adapt_law(ContactForceLaw(std::move(bounded), std::move(stages)));
  return adapt_law(ContactForceLaw(std::move(bounded), ClosestPointStageList(std::move(stages))));
}

}  // namespace thimble::render

#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "thimble/render/build_object_touch.h"
#include "thimble/render/effect/stage_list.h"
#include "thimble/render/touch.h"
#include "track/path_bounded.h"

namespace thimble::render {

/// Builds the stages of a surface: its spring comes after what changes the depth.
/// Real-time: never from the servo thread.
inline StageList stage_list(const SurfaceChoice& surface) {
  std::vector<std::unique_ptr<AnyStage>> stages;
  bool sprung = false;
  for (const EffectPlan& effect : surface.effects) {
    if (!sprung && effect.kind->order > EffectOrder::kDepth) {
      stages.push_back(std::make_unique<AnyStageOf<SpringDamper>>(surface.spring));
      sprung = true;
    }
    stages.push_back(effect.build());
  }
  if (!sprung) stages.push_back(std::make_unique<AnyStageOf<SpringDamper>>(surface.spring));
  return StageList(std::move(stages));
}

template <class Stages>
std::unique_ptr<ObjectTouch> object_of(Stages stages) {
  return std::make_unique<ObjectTouchOf<Stages>>(std::move(stages));
}

/// Builds the force law of one object from a contact stage and a surface. Every contact is bounded
/// by the tip's path (path_bounded.h). Real-time: never from the servo thread.
template <class Contact>
std::unique_ptr<ObjectTouch> touch_of(Contact contact, const SurfaceChoice& surface) {
  PathBounded bounded(std::move(contact));
  // A bare surface, by far the most frequent, is joined wholly at compile time.
  if (surface.effects.empty()) return object_of(Touch(std::move(bounded), surface.spring));
  StageList stages = stage_list(surface);
  if (!stages.needs_foot()) return object_of(Touch(std::move(bounded), std::move(stages)));
  return object_of(Touch(std::move(bounded), FootStageList(std::move(stages))));
}

}  // namespace thimble::render

#include "recording/replay_animation.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace thimble::session {

void ReplayAnimation::begin(const scene::Scene& scene,
                            std::shared_ptr<const scene::SceneObjects> objects) {
  scene_ = scene;
  objects_ = std::move(objects);
  if (!objects_->moving().empty()) {
    bodies_ = std::make_unique<BodyTrace>(objects_->touch(), objects_->moving(), 0);
  }
  const auto dents = [](const scene::SceneObject& object) { return object.body.dent.has_value(); };
  if (std::any_of(scene.objects.begin(), scene.objects.end(), dents)) {
    dent_now_ = std::make_unique<DentRecord>(
        objects_->touch(), static_cast<std::int64_t>(std::llround(1e9 / scene.rate)));
    dents_ = std::make_unique<DentTrace>(dent_now_->drawn());
  }
}

void ReplayAnimation::take(const driver::TickRecord& tick) {
  if (bodies_) bodies_->take(tick);
  if (dent_now_) dent_now_->take(tick);
  if (dents_) dents_->take(tick);
}

std::size_t ReplayAnimation::arm_of(const RecordingInfo& info) const {
  for (std::size_t i = 0; i < scene_.arms.size(); ++i) {
    if (scene_.arms[i].name == info.arm_in_scene) return i;
  }
  return 0;
}

}  // namespace thimble::session

#include "view/playback/shape_animation.h"

#include <algorithm>
#include <utility>

namespace thimble::view {

void ShapeAnimation::begin(const scene::Scene& scene,
                           std::shared_ptr<const scene::SceneObjects> objects) {
  ReplayAnimation::begin(scene, std::move(objects));
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    if (scene.objects[i].body.shape.named()) shaped_.push_back({i, {}});
  }
}

void ShapeAnimation::take(const driver::TickRecord& tick) {
  ReplayAnimation::take(tick);
  if (shaped_.empty() || tick.time_ns < next_ns_) return;
  if (times_ns_.size() == kShapesMax) halve();
  next_ns_ = tick.time_ns + step_ns_;
  times_ns_.push_back(tick.time_ns);
  for (Shaped& shaped : shaped_) {
    auto now = objects().mesh_bent(shaped.object);
    // An object without contact stays a single mesh in memory.
    const bool same = !shaped.meshes.empty() && shaped.meshes.back()->vertices == now.vertices &&
                      shaped.meshes.back()->triangles == now.triangles;
    shaped.meshes.push_back(same ? shaped.meshes.back()
                                 : std::make_shared<const render::TriangleMesh>(std::move(now)));
  }
}

void ShapeAnimation::halve() {
  std::size_t stays = 0;
  for (std::size_t i = 0; i < times_ns_.size(); i += 2, ++stays) {
    times_ns_[stays] = times_ns_[i];
    for (Shaped& shaped : shaped_) shaped.meshes[stays] = shaped.meshes[i];
  }
  times_ns_.resize(stays);
  for (Shaped& shaped : shaped_) shaped.meshes.resize(stays);
  step_ns_ *= 2;
}

ShapeAnimation::Mesh ShapeAnimation::shape_at(std::size_t object, std::int64_t time_ns) const {
  const auto found = std::find_if(shaped_.begin(), shaped_.end(),
                                  [object](const Shaped& one) { return one.object == object; });
  if (found == shaped_.end() || times_ns_.empty()) return nullptr;
  const auto after = std::upper_bound(times_ns_.begin(), times_ns_.end(), time_ns);
  const auto at = std::max<std::ptrdiff_t>(0, after - times_ns_.begin() - 1);
  return found->meshes[static_cast<std::size_t>(at)];
}

}  // namespace thimble::view

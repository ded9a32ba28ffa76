#include "view/input/hand_input.h"

#include <algorithm>

namespace thimble::view {

std::optional<HandSource> hand_source_named(std::string_view name) {
  const auto* const found = std::find(kHandSources.begin(), kHandSources.end(), name);
  if (found == kHandSources.end()) return {};
  return static_cast<HandSource>(found - kHandSources.begin());
}

void HandInput::choose(HandSource source) {
  if (source != source_) let_go();
  source_ = source;
}

void HandInput::change_speed(bool faster) {
  if (faster && speed_ + 1 < kSpeeds.size()) ++speed_;
  if (!faster && speed_ > 0) --speed_;
}

void HandInput::step(const HandPush& push, const Camera& camera, const Eigen::Vector3d& p_WT,
                     const Eigen::AlignedBox3d& reach, double dt) {
  if (push.let_go) let_go();
  if (push.let_go || !push.any() || !push.share.allFinite() || !p_WT.allFinite()) return;
  if (!hand_.holds) hand_ = {p_WT, true};
  const double way = speed() * (push.slow ? kSlow : 1) * std::clamp(dt, 0.0, kFrameMax);
  Eigen::Vector3d p =
      hand_.p_WH + way * (push.share.x() * camera.right() + push.share.y() * camera.up() +
                          push.share.z() * camera.towards_eye());
  const Eigen::Vector3d ahead = p - p_WT;
  if (ahead.norm() > kLeash) p = p_WT + kLeash * ahead.normalized();
  hand_.p_WH = p.cwiseMax(reach.min()).cwiseMin(reach.max());
}

}  // namespace thimble::view

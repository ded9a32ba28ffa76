#include "track/path_bounded.h"

#include <algorithm>
#include <cmath>

namespace thimble::render {

using Eigen::Vector3d;

// Moves the ball and returns the path by which the tip has dragged or widened it, m.
double ProxyFilter::advance(const Vector3d& p_WT, double way_behind) noexcept {
  const Vector3d from_tip = p_WC_ - p_WT;
  const double distance = from_tip.norm();
  const double advanced = std::max(0.0, distance - radius_);
  radius_ = std::min(std::max(radius_, distance), way_behind);
  if (distance > radius_) p_WC_ = p_WT + radius_ / distance * from_tip;
  return advanced;
}

bool ProxyFilter::lag(const Vector3d& p_WT, const Vector3d& path, const Vector3d& goal,
                      const ContactState& found) noexcept {
  const double surface_path = surface_path_;
  surface_path_ = 0;
  p_WT_ = p_WT;
  if (!path.allFinite() || !goal.allFinite() || !std::isfinite(surface_path)) {
    // The path is not known: begin here, without force.
    p_WA_ = p_WT;
    felt_ = found;
    felt_.depth = 0;
    felt_.p_WP = p_WT;
    ++ticks_behind_;
    return false;
  }
  if (!lagging_) {
    lagging_ = true;
    p_WC_ = p_WT - path;
    radius_ = 0;
    credit_ = 0;
  }
  const Vector3d behind = goal - p_WA_;
  const double way_behind = behind.norm();
  const double tip_path = std::min(path.norm(), advance(p_WT, way_behind));
  const double reach = kPathRatio * (tip_path + surface_path);

  bool there = way_behind <= reach;
  Vector3d next = there ? goal : Vector3d(p_WA_ + reach / way_behind * behind);
  credit_ += kGift * found.depth * (tip_path + surface_path);
  const double before = (p_WA_ - p_WT).squaredNorm();
  const double after = (next - p_WT).squaredNorm();
  const double rise = 0.5 * (after - before);
  // Energy that a surface supplies by moving towards the tip.
  const double surface_work = surface_path * (std::sqrt(before) + 0.5 * surface_path);
  if (rise > credit_ + surface_work) {
    // Turns as far as possible and tightens as far as allowed. The filtered proxy is already within
    // this ball around the tip, so moving a point onto the ball does not move it farther away.
    next = p_WT + std::sqrt((before + 2 * (credit_ + surface_work)) / after) * (next - p_WT);
    credit_ = 0;
    there = false;
  } else {
    credit_ -= rise > 0 ? std::max(0.0, rise - surface_work) : rise;
  }
  if (there) {
    lagging_ = false;
    p_WA_ = goal;
    return true;
  }
  p_WA_ = next;
  ++ticks_behind_;
  felt_ = found;
  const Vector3d to_proxy = next - p_WT;
  felt_.depth = to_proxy.norm();
  // A filtered proxy at the tip has no direction: no force, with the tracked normal.
  if (felt_.depth > 0) felt_.n_W = to_proxy / felt_.depth;
  felt_.p_WP = next;
  return false;
}

}  // namespace thimble::render

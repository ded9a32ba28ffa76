#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <utility>

#include "thimble/driver/device_state.h"
#include "thimble/render/contact_state.h"
#include "thimble/render/surface/surface_response.h"

namespace thimble::render {

/// Filter of the proxy of a contact stage: the filtered proxy never moves faster than the tip's
/// path allows. Frame of the surface.
///
/// A contact stage pushes the tip p towards the proxy g = p + depth n. Where cells of a surface
/// meet deep inside, and where contact is found again, g jumps while p hardly moves. A force K (g -
/// p) would jump with it. The filtered proxy a follows g by at most `kPathRatio` times the tip's
/// path, and the felt force is K (a - p). So from one tick to the next, at any depth, |df| <= K (1
/// + kPathRatio) |dp|. A jump of g is recovered over the path that follows, and not at all while
/// the hand rests. While g does not jump, a equals g, and the felt contact is bit-identical to the
/// tracked one.
///
/// While a lags behind g, it gives the hand no energy that the hand has not put in:
///
/// Energy: the filtered proxy may move nearer to the tip freely. A move away from the tip
/// tightens the spring. It is limited by the energy that was lost by earlier moves towards the tip,
/// plus `kGift` of the tracked force over the path. The rest is missing from the depth, never added
/// to it. A surface that moves towards the tip by itself supplies this energy.
///
/// Path: only the tip's path out of a ball that it drags along counts. The radius of the ball is
/// at most the lag and at most the distance that the tip has moved. So a tip that moves back and
/// forth about an edge moves the filtered proxy once; then the proxy rests, as a god-object rests
/// in a crease. Without this, the lagging proxy would push the tip from side to side.
class ProxyFilter {
 public:
  /// Path of the filtered proxy per path of the tip. Over convex surfaces the exact closest point
  /// needs 1, over the smooth cells of a torus 1.2, of a bumpy ball 2.3 (1 + the greatest |dn| L /
  /// |dp| of render/src/track/trackers.md). A ratio of 4 leaves these unchanged. [chosen]
  static constexpr double kPathRatio = 4;
  /// Share of the tracked force, along the filtered proxy's path, that is given to a spring that
  /// has become too short, so that missing depth returns. At 2 N it is 0.04 N, which the dry
  /// friction of a PHANTOM dissipates. [chosen; friction M, app/arms/vintage_phantom.yaml]
  static constexpr double kGift = 0.02;

  /// Receives the tip's position (m, in the frame of the surface) and the tracked contact there.
  /// Returns true if the tracked contact is felt, false if `felt` is. A position that is NaN clears
  /// the path; the next contact then begins without force. Real-time: safe; some ns.
  [[gnu::flatten]] bool follow(const Eigen::Vector3d& p_WT, const ContactState& found) noexcept {
    const Eigen::Vector3d path = p_WT - p_WT_;
    if (!found.touching) {
      lagging_ = false;
      surface_path_ = 0;
      p_WT_ = p_WT;
      p_WA_ = p_WT;
      return true;
    }
    const Eigen::Vector3d goal = p_WT + found.depth * found.n_W;
    const double reach_squared = kPathRatio * kPathRatio * path.squaredNorm();
    const double rounding = kRounding * found.depth;
    // Written so that NaN fails the test.
    if (!lagging_ && (goal - p_WA_).squaredNorm() <= reach_squared + rounding * rounding) {
      surface_path_ = 0;
      p_WT_ = p_WT;
      p_WA_ = goal;
      return true;
    }
    return lag(p_WT, path, goal, found);
  }

  /// Receives that the surface itself has moved near the tip by up to `path` (m) since the last
  /// `follow`. This counts like path of the tip. Real-time: safe.
  void surface_moved(double path) noexcept { surface_path_ += path; }

  /// Scales the distance from the tip to the far end of the spring, for a caller that changes the
  /// unit in which it is measured. Real-time: safe.
  void rescale(double factor) noexcept { p_WA_ = p_WT_ + factor * (p_WA_ - p_WT_); }

  /// Returns the felt contact of a tick in which `follow` returned false. Real-time: safe.
  const ContactState& felt() const noexcept { return felt_; }

  /// Returns the number of ticks in which the filtered proxy lagged. Real-time: safe.
  std::uint64_t ticks_behind() const noexcept { return ticks_behind_; }

 private:
  // Share of the depth by which a place that did not move may differ by rounding.
  static constexpr double kRounding = 1e-10;  // [chosen: 10^5 roundings of a depth, 1e-9 N at 10 N]

  // Rare: inlined, it would burden every tick of `follow`.
  [[gnu::noinline]] bool lag(const Eigen::Vector3d& p_WT, const Eigen::Vector3d& path,
                             const Eigen::Vector3d& goal, const ContactState& found) noexcept;
  double advance(const Eigen::Vector3d& p_WT, double way_behind) noexcept;

  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  Eigen::Vector3d p_WT_ = Eigen::Vector3d::Constant(kUnknown);  // tip at the last tick
  Eigen::Vector3d p_WA_ =
      Eigen::Vector3d::Constant(kUnknown);  // filtered proxy; the tip while free
  double surface_path_ = 0;
  // Valid while the filtered proxy lags.
  bool lagging_ = false;
  Eigen::Vector3d p_WC_{0, 0, 0};  // centre of the ball that the tip drags along
  double radius_ = 0;              // of that ball, m
  double credit_ = 0;              // energy per stiffness available for tightening, m^2
  std::uint64_t ticks_behind_ = 0;
  ContactState felt_;
};

/// A contact stage whose copy costs a few pointers.
template <class Contact>
concept CopiesCheaply = Contact::kCopiesCheaply;

/// Wraps a `Contact` stage of ContactForceLaw of any kind. The felt contact changes by no more than
/// the tip's path implies, at any depth (ProxyFilter). Depth, normal and proxy are the felt ones;
/// triangle and hops are the tracked ones.
///
/// Contact begins and ends with the wrapped stage. It begins without a step of the force, at any
/// depth; where it ends the force is zero at once.
template <class Contact>
class PathBounded {
 public:
  explicit PathBounded(Contact contact) : contact_(std::move(contact)) {}

  /// Finds the contact at `state.p_WT` (W, m) and keeps it until the next call. Real-time: safe if
  /// the wrapped stage is; some ns more.
  const ContactState& update(const driver::DeviceState& state) noexcept {
    const ContactState& found = contact_.update(state);
    as_found_ = filter_.follow(state.p_WT, found);
    return as_found_ ? found : filter_.felt();
  }

  /// Updates a copy of the wrapped stage with the expected tip. The tick then finds its data and
  /// code in the cache, and no state has changed (ForceLaw::prepare). Only for stages whose copy
  /// costs a few pointers (kCopiesCheaply). Real-time: safe.
  void prepare(const driver::DeviceState& expected) const noexcept requires CopiesCheaply<Contact> {
    Contact guess = contact_;
    const ContactState* found = &guess.update(expected);
    // Keeps the compiler from removing the unused result.
    asm volatile("" : : "r"(found) : "memory");
  }

  /// Returns the result of the last `update`. Real-time: safe.
  const ContactState& state() const noexcept {
    return as_found_ ? contact_.state() : filter_.felt();
  }

  /// Forwards that the surface has moved, and which triangle has swept over the free tip
  /// (TrackedContact). `path` is the path of a vertex near the tip, m. Real-time: safe.
  void surface_moved(std::int32_t swept_over, double path) noexcept {
    contact_.surface_moved(swept_over);
    filter_.surface_moved(path);
  }
  /// Returns the start of the free tip's path (TrackedContact). Real-time: safe.
  Eigen::Vector3d free_tip() const noexcept { return contact_.free_tip(); }

  /// Returns the surface point of the tip at `p_WT` (W, m; surface_response.h). While the felt
  /// contact lags, minus the gradient of its depth is its own normal. Real-time: safe.
  ClosestSurfacePoint closest(const Eigen::Vector3d& p_WT) const noexcept {
    ClosestSurfacePoint closest = closest_point_of(contact_, p_WT);
    if (!as_found_) closest.fall_W = filter_.felt().n_W;
    return closest;
  }

  const Contact& contact() const noexcept { return contact_; }
  /// Returns the wrapped stage, for a caller that bounds the felt contact itself.
  Contact& contact() noexcept { return contact_; }
  const ProxyFilter& filter() const noexcept { return filter_; }
  decltype(auto) search() const noexcept { return contact_.search(); }
  decltype(auto) mesh() const noexcept requires requires(const Contact& contact) { contact.mesh(); }
  { return contact_.mesh(); }

 private:
  Contact contact_;
  ProxyFilter filter_;
  bool as_found_ = true;
};

}  // namespace thimble::render

#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "thimble/driver/device_state.h"
#include "thimble/driver/export.h"
#include "thimble/driver/force_law.h"
#include "thimble/render/contact_state.h"
#include "track/path_bounded.h"
#include "world/active_planes.h"
#include "world/box_tree.h"
#include "world_solid.h"

namespace thimble::render {

/// Counts of events in a world.
struct WorldCounters {
  std::uint64_t begun = 0;      ///< Contacts begun.
  std::uint64_t hidden = 0;     ///< Proxies of a tracker that were refused: inside another solid.
  std::uint64_t unsettled = 0;  ///< Ticks that reached the bound; the next tick continues.
  int steps_max = 0;            ///< Maximum number of steps in a tick (WorldSolid::steps).
};

/// Several solids with one proxy: the tip feels the union of all of them. W, m.
///
/// The proxy is the tip while nothing stops it. Contact with a solid begins where the path of the
/// proxy enters it. While solids are active, the proxy is the point nearest to the tip outside of
/// all of them, on the side from which it has come. Each active solid is followed at the tip as
/// pushed out by the others, and gives one plane; the shortest way out of all planes is a
/// combination of their normals, one part for each solid (active_planes.h). When a solid lets go,
/// the proxy first moves over its extended last face, then to its new place. Both ways are searched
/// for other solids, so a seam between flush faces is not felt.
///
/// The sum of the forces changes by at most 5 K per metre of the tip's path, with the largest
/// stiffness K that was active in this contact (ProxyFilter).
class THIMBLE_EXPORT ContactWorld {
 public:
  /// A solid and the number of its object in the scene.
  struct Member {
    WorldSolid* solid = nullptr;
    std::int16_t object = -1;
  };

  /// Keeps the pointers: the solids must outlive the world. Real-time: never from the servo thread.
  explicit ContactWorld(std::vector<Member> members);

  /// Returns the force of all solids on the hand. A tip that is inside a solid on the first tick
  /// does not feel it until it has been outside. A position that is NaN or beyond `kPositionMax`
  /// ends all contacts and makes the next tick a first one. Real-time: safe; a few ns far from all
  /// solids.
  driver::ForceCommand operator()(const driver::DeviceState& state) noexcept;

  /// Prefetches the memory for the contact of a tick with about this state. Real-time: safe.
  void prepare(const driver::DeviceState& expected) const noexcept;

  /// Returns whether `holds(member)` is true for a solid that may contain a point (W, m): one that
  /// moves, or whose box contains it. `member` is its number in the list of the constructor.
  /// Real-time: safe if `holds` is.
  template <class Holds>
  bool any_at(const Eigen::Vector3d& p_W, const Holds& holds) const noexcept {
    return tree_.any_at(p_W, holds) || std::any_of(moving_.begin(), moving_.end(), holds);
  }

  /// Returns the proxy, above the surface by the lift; the tip while it is free. Real-time: safe.
  const Eigen::Vector3d& proxy() const noexcept { return p_WQ_; }
  /// Returns the number of solids that hold the proxy. Real-time: safe.
  std::size_t active_count() const noexcept { return active_count_; }
  /// Returns the distance by which the proxy is kept off the surfaces, so that flush faces do not
  /// stop it, m.
  double lift() const noexcept { return lift_; }
  const WorldCounters& counters() const noexcept { return counters_; }  ///< Returns the counts.

 private:
  struct Active {
    std::int32_t solid = -1;
    ActivePlane plane;                                // of the contact as a whole
    std::array<Eigen::Vector3d, kCornerMax> faces_W;  // normals at a concave edge or corner
    std::size_t face_count = 0;                       // 0: `plane` is the only one
    ContactState found;                               // contact at `at_W`, or at the begin
    Eigen::Vector3d at_W{0, 0, 0};                    // tip as pushed out by the others
    bool fresh = false;                               // begun, and not followed since
    bool ended = false;                               // has let go
    bool closely = false;                             // the tracker's proxy was refused
    Eigen::Vector3d refused_at_W{0, 0, 0};            // tip when the tracker was asked last
    double stiffness = 0;                             // N/m, when it was felt last; 0 before
    bool tried = false;  // whether the tracker was asked again in this tick
  };
  // All planes of the active solids.
  struct Planes {
    std::array<ActivePlane, kPlanesMax> plane;
    std::array<std::size_t, kPlanesMax> owner;  // number in `active_`
    std::size_t count = 0;
    std::span<const ActivePlane> all() const noexcept { return {plane.data(), count}; }
  };
  // The shortest way out of all planes, and the part of each active solid in it.
  struct Push {
    PushOut out;
    std::array<Eigen::Vector3d, kActiveMax> way;
    std::array<double, kActiveMax> lambda{};    // length of `way`
    std::array<Eigen::Vector3d, kActiveMax> n;  // its direction
  };

  // Ball around a solid that moves; W, m.
  struct MovingBall {
    Eigen::Vector3d p_centre{0, 0, 0};
    double radius = std::numeric_limits<double>::infinity();

    // Whether the ball may meet one of `reach` around `p`; also if a number is NaN.
    bool meets(const Eigen::Vector3d& p, double reach) const noexcept {
      const double sum = (1 + 0x1p-20) * (radius + reach);  // covers the rounding of squares
      return !((p - p_centre).squaredNorm() > sum * sum);
    }
  };

  void move(const Eigen::Vector3d& p_WT) noexcept;
  bool settle(const Eigen::Vector3d& p_WT) noexcept;
  bool advance(const Eigen::Vector3d& goal) noexcept;
  void begin(std::int32_t solid, std::int32_t triangle, const Eigen::Vector3d& p_W) noexcept;
  bool follow_active(const Eigen::Vector3d& p_WT, const Eigen::Vector3d& ahead) noexcept;
  const ContactState& follow_one(Active& active) noexcept;
  bool hidden(const Active& active, const ContactState& found) noexcept;
  Eigen::Vector3d shifted(const Eigen::Vector3d& p_WT, const Push& push, std::size_t i,
                          double lift) const noexcept;
  double nearer(const Eigen::Vector3d& p_WT, const Push& push, std::size_t i) const noexcept;
  bool agrees(const Eigen::Vector3d& p_WT, const Push& push) const noexcept;
  void revive_ended() noexcept;
  bool inside_ended() const noexcept;
  bool led_by_tracker(std::int32_t solid) const noexcept;
  bool enters_solid() noexcept;
  void drop_ended() noexcept;
  Planes planes() const noexcept;
  Push push(const Eigen::Vector3d& p_WT) const noexcept;
  Eigen::Vector3d lifted(const Eigen::Vector3d& p_WT) const noexcept;
  void look_around(const Eigen::Vector3d& from, const Eigen::Vector3d& to) noexcept;
  void start(const driver::DeviceState& state) noexcept;
  void carry(const driver::DeviceState& state) noexcept;
  SolidMove begin_tick(std::size_t changing, const driver::DeviceState& state,
                       const Eigen::Vector3d& p_WP, bool touching) noexcept;
  template <class Holds>
  bool any_moving_at(const Eigen::Vector3d& p_W, const Holds& holds) const noexcept {
    for (std::size_t k = 0; k < moving_.size(); ++k) {
      if (balls_[k].meets(p_W, 0) && holds(moving_[k])) return true;
    }
    return false;
  }
  void forget_left() noexcept;
  bool is_ghost(std::int32_t solid) const noexcept;
  bool is_active(std::int32_t solid) const noexcept;
  driver::ForceCommand feel(const driver::DeviceState& state) noexcept;
  driver::ForceCommand feel_one(const driver::DeviceState& state) noexcept;
  driver::ForceCommand feel_several(const driver::DeviceState& state) noexcept;
  void leave_others(std::span<const std::int32_t> felt) noexcept;
  WorldSolid& solid(std::int32_t i) const noexcept {
    return *members_[static_cast<std::size_t>(i)].solid;
  }

  std::vector<Member> members_;
  BoxTree tree_;
  double lift_ = 0;
  double near_min_ = 0;  // least radius of the neighbourhood, m

  Eigen::Vector3d p_WQ_{0, 0, 0};  // proxy of the last tick, lifted
  bool has_proxy_ = false;
  bool has_trackers_ = false;         // whether a solid is not followed closely by its own tracker
  bool closely_ = false;              // whether trackers are refused in this attempt
  int steps_ = 0;                     // of the solids in this tick
  Eigen::Vector3d reached_{0, 0, 0};  // place on the proxy's path of this tick
  Push push_;
  std::array<Active, kActiveMax> active_;
  std::size_t active_count_ = 0;

  // All solids that touch the ball of `near_radius_` around `near_centre_`.
  Eigen::Vector3d near_centre_{0, 0, 0};
  double near_squared_ = -1;
  double near_least_ = 0;  // radius that the steps needed then, m
  std::vector<std::int32_t> near_;
  std::vector<std::int32_t> changing_;  // solids that need begin_tick and end_tick
  std::vector<std::int32_t> moving_;    // solids that may be outside of their box in `tree_`
  std::vector<MovingBall> balls_;       // of `moving_`, in this tick
  std::vector<std::int32_t> ball_of_;   // of `changing_`: number in `balls_`, -1: none
  std::vector<std::int32_t> ghosts_;    // solids in which the tip has been since the first tick

  ProxyFilter filter_;
  double stiffness_ref_ = 0;  // N/m, by which `filter_` measures forces; 0 while free
  std::array<std::int32_t, kActiveMax> felt_;  // solids whose stages are in contact
  std::size_t felt_count_ = 0;
  WorldCounters counters_;
};

}  // namespace thimble::render

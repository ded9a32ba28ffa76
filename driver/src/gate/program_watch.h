#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace thimble::driver {

/// Detects oscillations between a program's force and the tip that feed themselves, and lowers the
/// force until they end.
///
/// A program outside of the scene requests a force whose stored energy is unknown. Its effect on a
/// hand is limited by force, speed and power; an unstable loop adds an oscillation. The watch looks
/// for one along each axis of the world, by the half cycles of the force between turning points.
/// Two half cycles must take between 1/300 s and 1/5 s, and the force must do work on the tip in
/// each cycle. The following are oscillations:
///
/// - A growing spring oscillation: the force answers the tip with one stiffness. In three
///   successive comparisons with the half cycle two before, the force's swing and the tip's way (at
///   least `kWay`) have both grown by a tenth.
/// - A sustained spring oscillation: at 8 Hz or more, for four cycles without growing smaller. No
///   hand moves so fast by itself.
/// - A force beyond the arm's limit in each cycle that does not grow smaller: at the limit, growth
///   is no longer visible.
///
/// A spring is recognized by how a touch begins. After a quiet time the tip moves against the
/// force, by the force's swing over the stiffness. Each later half cycle has the same ratio. A
/// vibration begins with the tip moving along with the force, and its ratio is mass times frequency
/// squared. So constant forces, vibrations of constant or changing size, and decaying springs pass
/// at any frequency.
///
/// On an oscillation, the program's part is switched off for `kMute`. It returns over `kReturn` to
/// `kLess` of its previous share, and this repeats until the loop is stable. A share that was quiet
/// for `kForget` grows again over the same time. All functions are Real-time: safe.
class ProgramWatch {
 public:
  static constexpr double kWay = 3e-4;  ///< Min. way in a half cycle, m [chosen: ten counts].
  /// Min. way if the force is beyond the arm's limit, m [chosen: more than a count].
  static constexpr double kWayAtLimit = 5e-5;
  /// Growth over two half cycles [chosen: a spring of 1.3 times what a hand holds].
  static constexpr double kGrowth = 1.1;
  /// Frequency above which a sustained oscillation is not caused by a hand, Hz [chosen: fingers tap
  /// at up to 7 Hz M].
  static constexpr double kHandMax = 8;
  static constexpr double kMute = 0.15;   ///< s [chosen: some periods of a hand on a spring]
  static constexpr double kReturn = 0.5;  ///< s [chosen: no hand is startled]
  static constexpr double kForget = 10;   ///< s [chosen]
  static constexpr double kLess = 0.4;  ///< A loop at twice its stable share returns to 0.8 of it.
  static constexpr double kShareMin = 1.0 / 64;  ///< Min. share of the force [chosen].
  static constexpr double kShortest = 1.0 / 300, kLongest = 1.0 / 5;  ///< Limits of a cycle, s.

  /// Takes the arm's limit of force, N.
  explicit ProgramWatch(double force_max) noexcept : force_max_(force_max) {}

  /// Clears all history.
  void restart() noexcept;

  /// Processes a tick. Takes the force that the program requests and its part of the force sent in
  /// the previous tick (N in the world), the tip (m), and the time `dt` of the tick (s). Returns
  /// the share of the force that may be requested now.
  double share(const Eigen::Vector3d& f_asked_W, const Eigen::Vector3d& f_sent_W,
               const Eigen::Vector3d& p_WT, double dt) noexcept;

  /// Returns the number of oscillations found.
  std::uint64_t oscillations() const noexcept { return oscillations_; }
  /// Returns the frequency of the last oscillation, Hz; 0 if there was none.
  double frequency() const noexcept { return frequency_; }

 private:
  static constexpr std::size_t kHalves = 8;

  /// A half cycle: from one turning point of the force to the next.
  struct Half {
    double swing = 0;  // of the force, N
    double way = 0;    // of the tip, m
    double time = 0;   // s
    double work = 0;   // done on the tip, J
    bool limited = false;
  };
  /// Extreme of the force along an axis since its last turning point.
  struct Extreme {
    double f = 0, x = 0, time = 0, work = 0;
    bool limited = false;
  };
  /// State of an axis.
  struct Axis {
    std::array<Half, kHalves> halves{};  // the newest first
    Extreme turn, farthest;
    double work = 0;
    double direction = 1;
    double f = 0, since = 0;  // last force, N, and the time of its last change, s
    double stiffness = 0;     // stiffness with which the force answered a touch, N/m; 0: it did not
    std::size_t known = 0;

    bool oscillates(double force_max) const noexcept;
    bool feeds(std::size_t i, double force_max) const noexcept;
    bool springs(std::size_t count) const noexcept;
  };

  bool follow(Axis& axis, double f, double x, bool limited) noexcept;
  void found(const Axis& axis) noexcept;

  double force_max_;
  std::array<Axis, 3> axes_{};
  Eigen::Vector3d p_WT_{0, 0, 0};
  double time_ = 0;  // s
  bool begun_ = false;
  double share_ = 1,
         max_share_ = 1;  // share of the force now, and the share to which it may return
  double muted_ = 0;      // remaining time, s
  double quiet_ = 0;      // time since the last oscillation, s
  std::uint64_t oscillations_ = 0;
  double frequency_ = 0;
};

}  // namespace thimble::driver

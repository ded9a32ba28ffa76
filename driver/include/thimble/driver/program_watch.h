#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace thimble::driver {

/// Finds oscillations between a program's force and the tip that feed themselves, and lowers the
/// force until they end.
///
/// A program outside of the scene asks for a force of which no storage is known. What it may do to
/// a hand is limited by force, speed and power; what an unstable loop adds is an oscillation. It is
/// looked for along each axis of the world, by the half cycles of the force from one turning point
/// to the next, where two of them take between 1/300 s and 1/5 s and the force does work on the tip
/// in each cycle. Then it is one of these:
///
/// - a spring that swings up: the force answers the tip with one stiffness, and in three successive
///   comparisons with the half cycle two before, both the force's swing and the tip's way, of at
///   least `kWay`, have grown by a tenth;
/// - a spring that swings on, at 8 Hz or more, for four cycles without growing smaller: no hand
///   moves so fast by itself;
/// - a force beyond the arm's limit in each cycle that does not grow smaller: nothing more can grow
///   there.
///
/// A spring is known by how a touch begins: after a quiet time the tip moves against the force, by
/// a way that is the force's swing over the stiffness; and by the same ratio in each half cycle
/// since. A vibration begins with the tip moving along with the force, and has a ratio of its own,
/// mass times frequency squared. So constant forces, vibrations of constant or changing size, and
/// springs that die away pass, at any frequency.
///
/// When an oscillation is found the program's part is off for `kMute`, and comes back over
/// `kReturn` to `kLess` of the share that it had, again and again until the loop is stable. A share
/// that stayed quiet for `kForget` grows again over as long a time.
/// All functions are Real-time: safe.
class ProgramWatch {
 public:
  static constexpr double kWay = 3e-4;  ///< Least way in a half cycle, m [chosen: ten counts].
  /// Least way where the force is beyond the arm's limit, m [chosen: more than a count].
  static constexpr double kWayAtLimit = 5e-5;
  /// Growth over two half cycles [chosen: a spring of 1.3 times what a hand holds].
  static constexpr double kGrowth = 1.1;
  /// Frequency above which an oscillation that does not die away is no hand's, Hz [chosen: fingers
  /// tap at up to 7 Hz M].
  static constexpr double kHandMost = 8;
  static constexpr double kMute = 0.15;   ///< s [chosen: some periods of a hand on a spring]
  static constexpr double kReturn = 0.5;  ///< s [chosen: no hand is startled]
  static constexpr double kForget = 10;   ///< s [chosen]
  static constexpr double kLess = 0.4;    ///< Twice what the loop carries becomes 0.8 of it.
  static constexpr double kLeastShare = 1.0 / 64;                     ///< Of the force [chosen].
  static constexpr double kShortest = 1.0 / 300, kLongest = 1.0 / 5;  ///< Of a cycle, s.

  /// Takes the arm's limit of force, N.
  explicit ProgramWatch(double force_max) noexcept : force_max_(force_max) {}

  /// Forgets the past.
  void restart() noexcept;

  /// Takes a tick: what a program asks for, what of it was sent in the tick before (N in the
  /// world), where the tip is (m), and the time since then (s). Returns the share of the force that
  /// may be asked for now.
  double share(const Eigen::Vector3d& f_asked_W, const Eigen::Vector3d& f_sent_W,
               const Eigen::Vector3d& p_WT, double dt) noexcept;

  /// Returns how often an oscillation was found.
  std::uint64_t oscillations() const noexcept { return oscillations_; }
  /// Returns the frequency of the one found last, Hz; 0 if there was none.
  double frequency() const noexcept { return frequency_; }

 private:
  static constexpr std::size_t kHalves = 8;

  /// From one turning point of the force to the next.
  struct Half {
    double swing = 0;  // of the force, N
    double way = 0;    // of the tip, m
    double time = 0;   // s
    double work = 0;   // done on the tip, J
    bool limited = false;
  };
  /// Where the force along an axis was farthest since it turned last.
  struct Extreme {
    double f = 0, x = 0, time = 0, work = 0;
    bool limited = false;
  };
  /// What is known along an axis.
  struct Axis {
    std::array<Half, kHalves> halves{};  // the newest first
    Extreme turn, farthest;
    double work = 0;
    double direction = 1;
    double f = 0, since = 0;  // of the last tick, N, and from which time on, s
    double stiffness = 0;     // with which the force answered a touch, N/m; 0: it did not
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
  double share_ = 1, most_ = 1;  // of the force: now, and as far as it may come back
  double muted_ = 0;             // s that are left
  double quiet_ = 0;             // s since an oscillation was found
  std::uint64_t oscillations_ = 0;
  double frequency_ = 0;
};

}  // namespace thimble::driver

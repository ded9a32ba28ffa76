#pragma once

#include <Eigen/Core>
#include <vector>

#include "thimble/driver/result.h"
#include "thimble/scene/arm_file.h"
#include "twin/start_fit.h"
#include "twin/twin_motion.h"
#include "twin/twin_mover.h"

namespace thimble::twin {

/// A piece of a recording that a twin replays from the recording's own state.
struct TwinWindow {
  std::size_t stretch = 0;      ///< Index of the stretch.
  std::size_t begin = 0;        ///< First tick, in the stretch.
  double time = 0;              ///< Time of the first tick since that of the first window, s.
  TwinStart start{};            ///< Best start of the last twin.
  Eigen::Matrix3Xd motion_B{};  ///< Recorded motion less a straight line, m, tick by tick.
  std::vector<bool> seen{};     ///< Ticks with a report.
};

/// Error of a twin.
struct ReplayError {
  std::vector<Eigen::Matrix3Xd> error_B;  ///< Twin less recorded, m, tick by tick of each window.
  double square = 0;                      ///< Sum of squared errors over ticks with a report, m^2.
  std::size_t count = 0;                  ///< Number of such ticks.

  /// Returns the error of an axis, RMS over all axes, m.
  double rms() const;
};

/// Replays one recording on twins in windows, so that drift does not hide the constants.
///
/// Position and velocity of the tip at the start of a window are known only from encoder steps. So
/// the start of each twin is fitted: position and velocity of each axis by Gauss-Newton, and with
/// them the stretch of the cables (start_fit.h). All remaining differences are due to the
/// constants. Real-time: never from the servo thread.
class Replay {
 public:
  /// Cuts a recording into consecutive windows of `length` (s). Fails if there are none.
  static driver::Result<Replay> make(const TwinMotion& motion, double length);

  /// Replays all windows on the arm of a file. Fails if it cannot be simulated.
  driver::Result<ReplayError> operator()(const scene::ArmFile& file);

  const std::vector<TwinWindow>& windows() const { return windows_; }
  const TwinMotion& motion() const { return *motion_; }
  /// Returns the number of ticks of a window.
  std::size_t ticks() const { return ticks_; }

 private:
  Replay(const TwinMotion& motion, std::size_t ticks) : motion_(&motion), ticks_(ticks) {}
  void add_window(std::size_t stretch, std::size_t begin, double time);
  Eigen::Matrix3Xd replay(TwinMover& mover, TwinWindow& window, Eigen::Vector3d& lowest_square);
  void settle(TwinMover& mover, TwinWindow& window);
  void find_direction(TwinMover& mover, const TwinWindow& window, const Eigen::Matrix3Xd& best,
                      Eigen::Vector3d& share, TwinStart& to);

  const TwinMotion* motion_;
  std::size_t ticks_;
  std::vector<TwinWindow> windows_;
  std::vector<StartFit> soft_;  // for each window, with elastic cables
  std::vector<Eigen::Vector3d> seen_;
  bool settled_ = false;  // the starts were searched over a wide range
};

}  // namespace thimble::twin

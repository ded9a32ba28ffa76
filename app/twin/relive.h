#pragma once

#include <Eigen/Core>
#include <vector>

#include "thimble/driver/result.h"
#include "thimble/scene/arm_file.h"
#include "twin/start_fit.h"
#include "twin/twin_motion.h"
#include "twin/twin_mover.h"

namespace thimble::twin {

/// A piece of a recording that a twin relives from the recording's own state.
struct TwinWindow {
  std::size_t stretch = 0;      ///< Which.
  std::size_t begin = 0;        ///< Its first tick, in the stretch.
  double time = 0;              ///< Of its first tick since that of the first window, s.
  TwinStart start{};            ///< With which the twin was last nearest.
  Eigen::Matrix3Xd motion_B{};  ///< What was recorded less a straight line, m, tick by tick.
  std::vector<bool> seen{};     ///< The ticks that had a report.
};

/// How far a twin was from a recording.
struct Relived {
  std::vector<Eigen::Matrix3Xd> error_B;  ///< Twin less recorded, m, tick by tick of each window.
  double square = 0;      ///< Of the errors at ticks that had a report, summed, m^2.
  std::size_t count = 0;  ///< Such ticks.

  /// Returns the error of an axis, RMS over all axes, m.
  double rms() const;
};

/// Lets twins relive one recording in windows, so that what drifts does not hide the constants.
///
/// Where and how fast the tip was when a window began is known from encoders' steps alone, so each
/// twin begins where it comes nearest: place and velocity of each axis are fitted by Gauss-Newton,
/// and with them how cables are stretched (start_fit.h); every other difference is the constants'.
/// Real-time: never from the servo thread.
class Relive {
 public:
  /// Cuts a recording into windows of `length` (s), one behind the other. Fails if there are none.
  static driver::Result<Relive> make(const TwinMotion& motion, double length);

  /// Lets the arm of a file relive all windows. Fails if it cannot be simulated.
  driver::Result<Relived> operator()(const scene::ArmFile& file);

  const std::vector<TwinWindow>& windows() const { return windows_; }
  const TwinMotion& motion() const { return *motion_; }
  /// Returns the ticks of a window.
  std::size_t ticks() const { return ticks_; }

 private:
  Relive(const TwinMotion& motion, std::size_t ticks) : motion_(&motion), ticks_(ticks) {}
  void add_window(std::size_t stretch, std::size_t begin, double time);
  Eigen::Matrix3Xd relive(TwinMover& mover, TwinWindow& window, Eigen::Vector3d& least);
  void settle(TwinMover& mover, TwinWindow& window);
  void find_direction(TwinMover& mover, const TwinWindow& window, const Eigen::Matrix3Xd& best,
                      Eigen::Vector3d& share, TwinStart& to);

  const TwinMotion* motion_;
  std::size_t ticks_;
  std::vector<TwinWindow> windows_;
  std::vector<StartFit> soft_;  // of each window, where cables stretch
  std::vector<Eigen::Vector3d> seen_;
  bool settled_ = false;  // the starts were sought widely
};

}  // namespace thimble::twin

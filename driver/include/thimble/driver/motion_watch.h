#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "thimble/driver/device_state.h"
#include "thimble/driver/export.h"
#include "thimble/driver/fault.h"

namespace thimble::driver {

/// What the motion watch knows of an arm.
struct MotionWatchSettings {
  /// Least apparent mass at the tip, kg. 0: not known, and the motors' direction is not watched.
  double mass = 0;
  int delay_ticks = 0;  ///< Ticks from sampling to force beyond the hold.
  /// Longest time a force is held while no encoder counts, s, for an arm that does not number its
  /// reports; and, for any arm, while the joint it acts on does not count and the tip moves. Must
  /// be > 0. [chosen: a hand that rests on a surface leaves every count alone for seconds, since
  /// dry friction holds the arm; a tip that stops dead is noticed within 32 ms]
  double hold_most = 10;
};

/// A check of motors and encoders by the motion of the tip: motors that pull the wrong way, an
/// encoder that stands still while it should move, and reports that repeat themselves.
///
/// Positions and forces are averaged over blocks of 4 ms. Five accelerations of neighbouring blocks
/// (20 ms) are compared with the forces that were sent, along the direction in which each joint
/// moves the tip and along the force itself. The tip of an arm with reversed motors gains speed
/// against the force, and the more the larger the force. A hand can do that too, for a moment; it
/// does not keep to the proportion 1 / mass (motion_watch.cpp). Each time the tip answers a force
/// as it should speaks for the motors, and is weighed against what speaks against them.
///
/// What it cannot see: a constant force (a hand may hold it or throw against it), and a surface
/// softer than the hand's grip, for which the reversed arm is stable and slow.
/// All functions are Real-time: safe.
class THIMBLE_EXPORT MotionWatch {
 public:
  explicit MotionWatch(const MotionWatchSettings& settings) noexcept;

  /// Forgets the past; motors have to prove themselves again.
  void restart() noexcept;

  /// Takes a tick, with the force that was sent in the tick before (N, world). Returns whether a
  /// block is full, so that `judge` is due. A tick without a report has no position.
  bool take(const DeviceState& state, const Eigen::Vector3d& f_sent_W) noexcept {
    if (state.fresh) {
      p_sum_ += state.p_WT;
      time_sum_ns_ += state.time_ns - begin_ns_;
      ++reports_;
    }
    f_sum_ += f_sent_W;
    ++ticks_;
    return state.time_ns - begin_ns_ >= kBlock_ns;
  }

  /// Closes the block that `take` has filled, and returns the fault that motion shows, or kNone.
  /// Columns of `J_BT`: how the tip moves with each joint, in the arm's base, m/rad. `numbered`
  /// says that the arm numbers its reports, so that old ones are known by that.
  Fault judge(const DeviceState& state, const Eigen::Matrix3d& R_WB, const Eigen::Matrix3d& J_BT,
              bool numbered) noexcept;

 private:
  static constexpr std::int64_t kBlock_ns = 3'950'000;    // 4 ms, less the jitter of a loop
  static constexpr std::int64_t kLongest_ns = 8'500'000;  // of a block
  static constexpr std::uint32_t kBlocks = 16;            // that are kept
  static constexpr int kAccelerations = 5;

  /// What is known of 4 ms.
  struct Block {
    Eigen::Vector3d p{0, 0, 0};  // mean position, m
    Eigen::Vector3d f{0, 0, 0};  // mean force, N
    double time = 0;             // mean time of the positions, s
    double f_squared = 0;        // N^2
  };
  /// Range of a force, N.
  struct Range {
    double min = 0, max = 0;
    void begin(double f) noexcept { min = max = f; }
    void add(double f) noexcept {
      min = f < min ? f : min;
      max = f > max ? f : max;
    }
    double width() const noexcept { return max - min; }
  };
  /// What is known of a joint since its encoder counted last.
  struct Stillness {
    Range along, across;                  // components of the force
    Eigen::Vector3d leg_begin{0, 0, 0};   // start of the present leg of the tip's path, m
    Eigen::Vector3d leg_before{0, 0, 0};  // leg that was counted last, m
    int legs = 0;                         // legs, each with another direction than the one before
    double way = 0;                       // length of the tip's path, m
    double held = 0;                      // time under force, s
    int blocks = 0;
  };
  /// Accelerations and the forces that belong to them, along one direction.
  struct Pairs {
    std::array<double, kAccelerations> a{}, f{};
  };

  const Block& block(std::uint32_t back) const noexcept {
    return blocks_[(newest_ - back) % kBlocks];
  }
  Eigen::Vector3d late_force(std::uint32_t back) const noexcept;
  bool force_changes() const noexcept;
  bool reversed(const Eigen::Matrix3d& R_WB, const Eigen::Matrix3d& J_BT) noexcept;
  bool believed(const Pairs& pairs, int& proof) const noexcept;
  bool frozen_joint(const Eigen::Matrix3d& R_WB, const Eigen::Matrix3d& J_BT, double time) noexcept;
  bool frozen_reports(double time, bool numbered) noexcept;
  void begin_block(const DeviceState& state) noexcept;

  MotionWatchSettings settings_;
  // The block that is being filled.
  Eigen::Vector3d p_sum_{0, 0, 0}, f_sum_{0, 0, 0};
  std::int64_t begin_ns_ = 0, time_sum_ns_ = 0;
  int reports_ = 0, ticks_ = 0;
  std::array<std::int32_t, 3> counts_{};  // at the end of the last block
  std::array<bool, 3> changed_{};         // since then
  // The full ones.
  std::array<Block, kBlocks> blocks_{};
  std::uint32_t newest_ = 0;
  std::uint32_t full_ = 0;      // blocks since the last gap
  double late_blocks_ = 0;      // delay of the force, in blocks
  std::array<int, 4> proof_{};  // how often each direction answered as it should, less the contrary
  std::array<Stillness, 3> still_{};
  double held_ = 0;          // s since any encoder counted, under force
  double speed_before_ = 0;  // of the tip when it counted last, m/s
};

}  // namespace thimble::driver

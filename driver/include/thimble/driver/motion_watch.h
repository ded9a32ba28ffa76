#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "thimble/driver/device_state.h"
#include "thimble/driver/export.h"
#include "thimble/driver/fault.h"

namespace thimble::driver {

/// Settings of the motion watch.
struct MotionWatchSettings {
  /// Smallest apparent mass at the tip, kg. If it is 0, the mass is unknown and the direction of
  /// the motors is not monitored.
  double mass = 0;
  int delay_ticks = 0;  ///< Delay from sampling to force beyond the zero-order hold, ticks.
  /// Longest time for which a force may be held while no encoder count changes, s. This limit
  /// applies to an arm that does not number its reports. For any arm, it also limits the time for
  /// which a joint under force keeps its count while the tip moves. Must be > 0. [chosen: while a
  /// hand rests on a surface, dry friction may keep every count unchanged for seconds. A tip that
  /// stops abruptly is detected within 32 ms]
  double max_hold = 10;
};

/// Monitor of motors and encoders, based on the motion of the tip. It detects motors that act in
/// the wrong direction, an encoder that does not change although it should, and repeated reports.
///
/// The watch averages positions and forces over blocks of 4 ms. It compares five accelerations of
/// neighbouring blocks (20 ms) with the forces sent. It does so along the direction in which each
/// joint moves the tip, and along the force itself. The tip of an arm with reversed motors gains
/// speed against the force, in proportion to the force. A hand can cause that for a moment, but not
/// with the ratio 1 / mass (motion_watch.cpp). Each correct response of the tip is evidence of
/// correct motors and offsets evidence of reversal.
///
/// The watch detects no faults under a constant force, because a hand may hold that force or throw
/// against it. It also does not detect reversed motors on a surface softer than the hand's grip,
/// where the arm is stable and slow. All functions are Real-time: safe.
class THIMBLE_EXPORT MotionWatch {
 public:
  explicit MotionWatch(const MotionWatchSettings& settings) noexcept;

  /// Clears the history. The motors must then show their direction again.
  void restart() noexcept;

  /// Adds a tick with the force sent in the previous tick (N, world). A tick without a report has
  /// no position. Returns whether the block is full; the caller must then call `judge`.
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

  /// Closes the block that `take` has filled. Returns the fault that the motion shows, or kNone.
  /// The columns of `J_BT` are the motion of the tip per joint, in the arm's base, m/rad.
  /// `numbered` is true if the arm numbers its reports; repeated reports are then detected by their
  /// numbers.
  Fault judge(const DeviceState& state, const Eigen::Matrix3d& R_WB, const Eigen::Matrix3d& J_BT,
              bool numbered) noexcept;

 private:
  static constexpr std::int64_t kBlock_ns = 3'950'000;    // 4 ms, less the jitter of a loop
  static constexpr std::int64_t kLongest_ns = 8'500'000;  // Longest duration of a block.
  static constexpr std::uint32_t kBlocks = 16;            // Number of blocks kept.
  static constexpr int kAccelerations = 5;

  /// Averages over a block of 4 ms.
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
  /// State of a joint since its encoder last counted.
  struct Stillness {
    Range along, across;                  // components of the force
    Eigen::Vector3d leg_begin{0, 0, 0};   // Start of the current leg of the tip's path, m.
    Eigen::Vector3d leg_before{0, 0, 0};  // Leg that was counted last, m.
    // Number of legs, each with another direction than the one before.
    int legs = 0;
    double way = 0;   // Length of the tip's path, m.
    double held = 0;  // Time under force, s.
    int blocks = 0;
  };
  /// Accelerations and the corresponding forces, along one direction.
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
  // Current block.
  Eigen::Vector3d p_sum_{0, 0, 0}, f_sum_{0, 0, 0};
  std::int64_t begin_ns_ = 0, time_sum_ns_ = 0;
  int reports_ = 0, ticks_ = 0;
  std::array<std::int32_t, 3> counts_{};  // At the end of the last block.
  std::array<bool, 3> changed_{};         // Changed in the last block.
  // Full blocks.
  std::array<Block, kBlocks> blocks_{};
  std::uint32_t newest_ = 0;
  std::uint32_t full_ = 0;  // blocks since the last gap
  double late_blocks_ = 0;  // delay of the force, in blocks
  // Weighted evidence of correct responses in each direction, minus that of reversed ones.
  std::array<int, 4> proof_{};
  std::array<Stillness, 3> still_{};
  double held_ = 0;          // Time since any encoder counted, under force, s.
  double speed_before_ = 0;  // Speed of the tip when an encoder last counted, m/s.
};

}  // namespace thimble::driver

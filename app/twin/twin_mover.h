#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "thimble/driver/result.h"
#include "thimble/scene/arm_file.h"
#include "twin/twin_motion.h"

namespace thimble::twin {

/// How an arm moves at a moment.
struct TwinStart {
  Eigen::Vector3d p_BT{0, 0, 0};     ///< Where the encoders say the tip is, in the base, m.
  Eigen::Vector3d v_BT{0, 0, 0};     ///< m/s
  Eigen::Vector3d stretch{0, 0, 0};  ///< By which motors are ahead of links, rad at the joints.
  Eigen::Vector3d stretch_rate{0, 0, 0};  ///< rad/s
};

/// The simulated arm of a file with nobody's hand on it, moved by recorded currents from any state.
/// Real-time: never from the servo thread.
class TwinMover {
 public:
  virtual ~TwinMover() = default;

  /// Moves the arm from `start` at the tick `begin` of a stretch, and tells where its encoders say
  /// the tip is at each tick of `seen`, the first of which is the start. Precondition: kLead comes
  /// before `begin`, and the stretch goes on for as long as `seen`.
  virtual void move(std::size_t stretch, std::size_t begin, const TwinStart& start,
                    std::span<Eigen::Vector3d> seen) = 0;

  /// Returns whether motors and links move apart. If not, a start's stretch is not looked at.
  virtual bool stretches() const noexcept { return false; }

 protected:
  TwinMover() = default;
  TwinMover(const TwinMover&) = default;
  TwinMover& operator=(const TwinMover&) = default;
};

/// Makes the arm of a file. Fails if a constant is out of range. `motion` must outlive it.
driver::Result<std::unique_ptr<TwinMover>> make_twin_mover(const TwinMotion& motion,
                                                           const scene::ArmFile& file);

}  // namespace thimble::twin

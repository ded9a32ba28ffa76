#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "thimble/driver/result.h"
#include "thimble/scene/arm_file.h"
#include "twin/twin_motion.h"

namespace thimble::twin {

/// State of motion of an arm.
struct TwinStart {
  Eigen::Vector3d p_BT{0, 0, 0};          ///< Tip position from the encoders, in the base, m.
  Eigen::Vector3d v_BT{0, 0, 0};          ///< m/s
  Eigen::Vector3d stretch{0, 0, 0};       ///< Lead of the motors over the links, rad at the joints.
  Eigen::Vector3d stretch_rate{0, 0, 0};  ///< rad/s
};

/// The simulated arm of a file without a hand, driven by recorded currents from any state.
/// Real-time: never from the servo thread.
class TwinMover {
 public:
  virtual ~TwinMover() = default;

  /// Moves the arm from `start` at the tick `begin` of a stretch. Writes the tip position from its
  /// encoders at each tick to `seen`; the first is the start. Precondition: kLead precedes `begin`,
  /// and the stretch covers all of `seen`.
  virtual void move(std::size_t stretch, std::size_t begin, const TwinStart& start,
                    std::span<Eigen::Vector3d> seen) = 0;

  /// Returns whether motors and links move separately. If not, a start's stretch is ignored.
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

#pragma once

#include <Eigen/Core>
#include <atomic>
#include <cstdint>
#include <limits>

#include "thimble/driver/arm_link.h"
#include "thimble/driver/clock.h"
#include "vendors/force_box.h"
#include "vendors/newest_slot.h"

namespace thimble::driver {

/// A link to an arm with which a thread of its own speaks, because its vendor's software may wait,
/// lock or allocate: the servo thread takes states out of one slot and puts forces into another.
/// Whoever derives from it stops that thread in its destructor.
class SlotLink : public ArmLink {
 public:
  /// Takes what the arm tells, and the loop's clock, which outlives the link; and the longest force
  /// that the arm may get (N), to which longer ones are cut.
  SlotLink(const ArmTraits& traits, Clock& clock,
           double force_most = std::numeric_limits<double>::infinity())
      : traits_(traits), clock_(clock), force_most_(force_most) {}

  const ArmTraits& traits() const noexcept override { return traits_; }
  LinkRead read(ArmSample& sample, std::int64_t deadline_ns) noexcept override;
  /// Refuses while the force before waits for the other thread; only zero force overtakes it.
  LinkWrite write(const GatedForce& force, const ArmSample& sample,
                  const Eigen::Matrix3d& R_WB) noexcept override;

  /// Answers kNothing while a zero force waits for the other thread.
  LinkStatus settled() noexcept override;

 protected:
  // By the thread that speaks with the arm. None of them waits.
  void publish(const ArmSample& sample) noexcept;  ///< Returns where the arm is.
  void reject() noexcept;                          ///< Notes that it could not be understood.
  void lose() noexcept;                            ///< Notes that it is gone, for good.
  bool is_lost() const noexcept;                   ///< Returns whether it is.
  /// Tells whether the arm takes no forces at the moment: then all but zero are refused.
  void refuse(bool refuses) noexcept { refuses_.store(refuses, std::memory_order_release); }
  /// Takes the force that waits, N in the base; false if none does.
  bool take_force(Eigen::Vector3d& f_T_B) noexcept { return box_.take(f_T_B); }

  /// Called by the servo thread when a force waits. Real-time: safe.
  virtual void ring() noexcept {}

 private:
  struct NumberedSample {
    ArmSample sample;
    std::uint64_t number = 0;
  };

  ArmTraits traits_;
  Clock& clock_;
  double force_most_;
  NewestSlot<NumberedSample> newest_;
  ForceBox box_;
  std::atomic<bool> lost_{false}, refuses_{false};
  std::atomic<std::uint64_t> rejected_{0};
  NumberedSample taken_;             // of the servo thread
  std::uint64_t rejected_seen_ = 0;  // of the servo thread
  std::uint64_t published_ = 0;      // of the other thread
};

}  // namespace thimble::driver

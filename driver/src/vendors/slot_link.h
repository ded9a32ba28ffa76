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

/// A link whose own thread exchanges data with the arm, because the vendor's software may wait,
/// lock or allocate. The servo thread takes states from one slot and puts forces into another. A
/// derived class must stop that thread in its destructor.
class SlotLink : public ArmLink {
 public:
  /// Takes the capabilities of the arm, the loop's clock, which outlives the link, and the arm's
  /// max. force (N), to which larger ones are cut.
  SlotLink(const ArmTraits& traits, Clock& clock,
           double max_force = std::numeric_limits<double>::infinity())
      : traits_(traits), clock_(clock), max_force_(max_force) {}

  const ArmTraits& traits() const noexcept override { return traits_; }
  LinkRead read(ArmSample& sample, std::int64_t deadline_ns) noexcept override;
  /// Refuses while the previous force waits for the other thread; only zero force overtakes it.
  LinkWrite write(const GatedForce& force, const ArmSample& sample,
                  const Eigen::Matrix3d& R_WB) noexcept override;

  /// Returns kNothing while a zero force waits for the other thread.
  LinkStatus settled() noexcept override;

 protected:
  // For the thread that exchanges data with the arm. None of these waits.
  void publish(const ArmSample& sample) noexcept;  ///< Reports the state of the arm.
  void reject() noexcept;         ///< Counts a report that could not be understood.
  void lose() noexcept;           ///< Marks the arm as lost, permanently.
  bool is_lost() const noexcept;  ///< Returns whether the arm is lost.
  /// Sets whether the arm takes no forces at the moment; then all but zero are refused.
  void refuse(bool refuses) noexcept { refuses_.store(refuses, std::memory_order_release); }
  /// Takes the waiting force, N in the base; false if there is none.
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
  double max_force_;
  NewestSlot<NumberedSample> newest_;
  ForceBox box_;
  std::atomic<bool> lost_{false}, refuses_{false};
  std::atomic<std::uint64_t> rejected_{0};
  NumberedSample taken_;             // of the servo thread
  std::uint64_t rejected_seen_ = 0;  // of the servo thread
  std::uint64_t published_ = 0;      // of the other thread
};

}  // namespace thimble::driver

#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "thimble/driver/export.h"
#include "thimble/driver/tick_record.h"
#include "thimble/session/histogram.h"
#include "thimble/session/tick_observer.h"

namespace thimble::session {

/// Statistics of a run, accumulated tick by tick. All memory is allocated by the constructor.
class THIMBLE_EXPORT RunStatistics final : public TickObserver {
 public:
  /// A gap in contact shorter than this counts as an interruption of one touch. A hand that lifts
  /// off and returns takes longer. [chosen: half the fastest finger tap, about 10 Hz]
  static constexpr std::int64_t kInterruption_ns = 20'000'000;

  /// Adds one tick. Real-time: safe.
  void take(const driver::TickRecord& record) noexcept override;

  /// Returns the number of ticks added.
  std::uint64_t ticks() const noexcept { return ticks_; }

  /// Returns the histogram of the times between tick starts.
  const Histogram& period() const noexcept { return period_; }
  /// Returns the histogram of the wall-clock durations of ticks.
  const Histogram& work() const noexcept { return work_; }
  /// Returns the histogram of the delays of tick starts.
  const Histogram& lateness() const noexcept { return lateness_; }

  /// Returns the time from the first to the last tick, s.
  double duration() const noexcept;

  /// Returns the achieved tick rate, Hz; 0 for fewer than two ticks.
  double rate() const noexcept;

  /// Returns the number of contacts.
  std::uint64_t contacts() const noexcept { return contacts_; }

  /// Returns the number of contacts that began within `kInterruption_ns` of the end of the last
  /// one.
  std::uint64_t interruptions() const noexcept { return interruptions_; }

  /// Returns the time in contact, s. A tick in contact counts until the next tick.
  double contact_time() const noexcept { return 1e-9 * static_cast<double>(contact_ns_); }

  /// Returns the largest force sent, N.
  double force_max() const noexcept { return std::sqrt(force_squared_max_); }
  /// Returns the root mean square of the force sent during contact, N.
  double force_rms() const noexcept;
  /// Returns the root mean square of the force sent over all ticks, N.
  double force_rms_of_run() const noexcept;

  /// Returns the largest penetration depth, m.
  double depth_max() const noexcept { return depth_max_; }
  /// Returns the largest number of features crossed in one tick.
  std::uint16_t hops_max() const noexcept { return hops_max_; }

  /// Returns the energy that the arm gave to the hand, J: the sum of f_k . (p_k+1 - p_k). f_k is
  /// the force sent in tick k, which acts until the next tick. A positive value means that the arm
  /// was active. A surface with damping absorbs energy, so the sum over a whole touch is negative.
  double energy_to_hand() const noexcept { return energy_; }

  /// Returns the maximum over time of `energy_to_hand`, J; never below 0.
  double energy_to_hand_max() const noexcept { return energy_max_; }

  /// Returns the number of ticks without a new report.
  std::uint64_t missing_reports() const noexcept { return missing_; }

  /// Returns the number of ticks in which the device was in fault.
  std::uint64_t fault_ticks() const noexcept { return fault_ticks_; }
  /// Returns the first fault.
  driver::Fault first_fault() const noexcept { return first_fault_; }

 private:
  Histogram period_, work_, lateness_;
  // State of the last tick that the next one needs.
  std::array<double, 3> f_last_W_{}, p_last_WT_{};
  std::int64_t last_ns_ = 0;
  bool was_in_contact_ = false;
  std::uint64_t ticks_ = 0;
  std::int64_t first_ns_ = 0;
  std::int64_t contact_ns_ = 0;
  std::int64_t contact_end_ns_ = 0;
  std::uint64_t contacts_ = 0;
  std::uint64_t interruptions_ = 0;
  std::uint64_t contact_ticks_ = 0;
  double force_squared_max_ = 0;
  double force_squared_ = 0;      // of the ticks in contact
  double force_squared_all_ = 0;  // of all ticks
  double depth_max_ = 0;
  double energy_ = 0;
  double energy_max_ = 0;
  std::uint64_t missing_ = 0;
  std::uint64_t fault_ticks_ = 0;
  std::uint16_t hops_max_ = 0;
  driver::Fault first_fault_ = driver::Fault::kNone;
};

}  // namespace thimble::session

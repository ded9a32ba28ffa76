#include "thimble/session/run_statistics.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace thimble::session {
namespace {

double dot(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace

void RunStatistics::take(const driver::TickRecord& record) noexcept {
  work_.add(record.work_ns);
  lateness_.add(record.time_ns - record.due_ns);
  if (!record.fresh) ++missing_;
  if (record.fault != driver::Fault::kNone) {
    if (fault_ticks_++ == 0) first_fault_ = record.fault;
  }
  const double force_squared = dot(record.f_sent_W, record.f_sent_W);
  force_squared_all_ += force_squared;
  force_squared_max_ = std::max(force_squared_max_, force_squared);
  if (record.in_contact) {
    ++contact_ticks_;
    force_squared_ += force_squared;
    depth_max_ = std::max(depth_max_, record.depth);
    hops_max_ = std::max(hops_max_, record.hops);
  }
  if (record.in_contact && !was_in_contact_) {
    if (contacts_ > 0 && record.time_ns - contact_end_ns_ < kInterruption_ns) ++interruptions_;
    ++contacts_;
  }
  if (was_in_contact_ && !record.in_contact) contact_end_ns_ = record.time_ns;
  if (ticks_ == 0) {
    first_ns_ = record.time_ns;
  } else {
    period_.add(record.time_ns - last_ns_);
    if (was_in_contact_) contact_ns_ += record.time_ns - last_ns_;
    energy_ += dot(f_last_W_, record.p_WT) - dot(f_last_W_, p_last_WT_);
    energy_max_ = std::max(energy_max_, energy_);
  }
  f_last_W_ = record.f_sent_W;
  p_last_WT_ = record.p_WT;
  last_ns_ = record.time_ns;
  was_in_contact_ = record.in_contact;
  ++ticks_;
}

double RunStatistics::duration() const noexcept {
  return ticks_ > 0 ? 1e-9 * static_cast<double>(last_ns_ - first_ns_) : 0;
}

double RunStatistics::rate() const noexcept {
  const double time = duration();
  return time > 0 ? static_cast<double>(ticks_ - 1) / time : 0;
}

double RunStatistics::force_rms() const noexcept {
  return contact_ticks_ > 0 ? std::sqrt(force_squared_ / static_cast<double>(contact_ticks_)) : 0;
}

double RunStatistics::force_rms_of_run() const noexcept {
  return ticks_ > 0 ? std::sqrt(force_squared_all_ / static_cast<double>(ticks_)) : 0;
}

}  // namespace thimble::session

#include "simulator_session.h"

#include "thimble_error.h"

namespace thimble::python {

SimulatorSession::SimulatorSession(const std::string& arm, const Eigen::Vector3d& p_WH, double rate,
                                   std::uint64_t seed)
    : device_(named_by(
          scene::SimulatedDevice::open(arm, {{0.0, p_WH}}, {.rate = rate, .seed = seed}))) {
  activate();
  loop_.emplace(
      device_->device(), device_->clock(), driver::ForceLaw(*this), driver::TickSink(*this),
      driver::ServoSettings{.period_ns = device_->period_ns(), .continue_after_faults = true});
}

const driver::TickRecord& SimulatorSession::step(const Eigen::Vector3d& f_T_W) noexcept {
  f_T_W_ = f_T_W;
  loop_->tick(never_);
  return last_;
}

void SimulatorSession::activate() {
  // The counts of a simulated arm never restart.
  if (const auto activated = device_->device().activate(driver::HomeCheck::kPassed); !activated) {
    throw ThimbleError(activated.error().message);
  }
}

}  // namespace thimble::python

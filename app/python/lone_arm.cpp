#include "lone_arm.h"

#include <cmath>
#include <utility>

#include "thimble/scene/energy_choice.h"
#include "thimble/scene/shipped_files.h"
#include "thimble/scene/watch_choice.h"
#include "trouble.h"

namespace thimble::python {
LoneArm::LoneArm(const std::string& arm, const Eigen::Vector3d& p_WH, double rate,
                 std::uint64_t seed)
    : file_(value_of(scene::read_arm_file(value_of(scene::find_arm_file(arm))))) {
  if (!(rate >= 10 && rate <= 1e5)) {
    throw Trouble("rate: expected 10 to 100000 Hz, found " + std::to_string(rate) + ".");
  }
  if (!p_WH.allFinite() || !scene::joint_angles_at(file_, p_WH)) {
    throw Trouble("hand: the arm " + file_.name + " does not reach that point of the world (m).");
  }
  simulation_ = value_of(scene::ArmSimulation::make(file_, {{0.0, p_WH}}, {}, seed));
  device_ =
      value_of(driver::Device::open(simulation_->link(clock_),
                                    {.R_WB = file_.R_WB,
                                     .p_WB = file_.p_WB,
                                     .limits = file_.limits,
                                     .energy = scene::energy_settings(file_, rate, {}),
                                     .motion = scene::motion_settings(file_, rate),
                                     .heat = file_.heat,
                                     .velocity_corner_frequency = file_.velocity_corner_frequency},
                                    clock_.now_ns()));
  activate();
  loop_ = std::make_unique<driver::ServoLoop>(
      *device_, clock_, driver::ForceLaw(*this), driver::TickSink(*this),
      driver::ServoSettings{.period_ns = std::llround(1e9 / rate), .outlive_faults = true});
}

const driver::TickRecord& LoneArm::step(const Eigen::Vector3d& f_T_W) {
  f_T_W_ = f_T_W;
  loop_->tick(never_);
  return last_;
}

void LoneArm::activate() {
  if (const auto activated = device_->activate(); !activated) {
    throw Trouble(activated.error().message);
  }
}

}  // namespace thimble::python

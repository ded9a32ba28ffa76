#include "more_arms.h"

#include <fmt/format.h>

#include "limits_in_force.h"

namespace thimble::session {

LoggedRun logged_run(const Setup& setup, std::size_t arm) {
  const scene::Scene& scene = setup.scene();
  const std::string& name = setup.arm_name(arm);
  LoggedRun run;
  run.name = name.empty() ? scene.name : scene.name + ", " + name;
  run.what = fmt::format("{} ({}) runs {} at {:g} Hz in {} time", setup.arm_file(arm).name,
                         setup.device_name(arm), scene.name, scene.rate,
                         setup.real_time() ? "real" : "virtual");
  run.limits = limits_in_force(setup, arm);
  run.period_ns = setup.period_ns();
  run.now_ns = setup.clock().now_ns();
  run.real_time = setup.real_time();
  for (const scene::SceneObject& object : scene.objects) run.objects.push_back(object.name);
  return run;
}

ArmRun::ArmRun(const Setup& setup, std::size_t arm)
    : records(setup.ticks(), setup.scene().rate, setup.keep()),
      law(setup.objects().touch(arm), setup.arm_file(arm)) {
  records.join(loop);
  loop.add(records.recording);
}

MoreArms::MoreArms(Setup& setup) : setup_(setup) {
  for (std::size_t i = 1; i < setup.arms(); ++i) {
    runs_.push_back(std::make_unique<ArmRun>(setup, i));
  }
}

void MoreArms::share(SharedRun& shared, LiveControl& control) {
  for (std::size_t i = 1; i < setup_.arms(); ++i) {
    control.add_simulation(setup_.simulation(i));
    run(i).law.scene().set_viewers(control, false);
    sharing_.push_back(std::make_unique<OtherArmSharing>(shared, i));
    run(i).loop.add(*sharing_.back());
  }
}

void MoreArms::open(bool log) {
  for (std::size_t i = 1; log && i < setup_.arms(); ++i) {
    run(i).event_log = std::make_unique<EventLog>(logged_run(setup_, i), setup_.device(i));
    run(i).loop.add(*run(i).event_log);
  }
}

void MoreArms::begin(const driver::ServoSettings& settings) noexcept {
  for (std::size_t i = 1; i < setup_.arms(); ++i) {
    ArmRun& arm = run(i);
    arm.law.stop_in_fault(setup_.device(i));
    arm.loop.begin(setup_.device(i), setup_.clock(), arm.law.law(), settings);
  }
}

void MoreArms::remove_forces_on_fault() noexcept {
  if (setup_.scene().faults != scene::FaultRule::kTogether) return;
  bool fault = false;
  for (std::size_t i = 0; i < setup_.arms(); ++i) {
    const driver::Fault own = setup_.device(i).fault();
    fault = fault || (own != driver::Fault::kNone && own != driver::Fault::kOtherArm);
  }
  if (!fault) return;
  for (std::size_t i = 0; i < setup_.arms(); ++i) {
    driver::Device& device = setup_.device(i);
    if (device.fault() != driver::Fault::kNone) continue;
    device.trip(driver::Fault::kOtherArm);
    device.deactivate();  // Its force of this tick may already have been sent.
  }
}

std::optional<driver::ServoEnd> MoreArms::tick(RunLoop& first, std::optional<driver::ServoEnd> end,
                                               const std::atomic<bool>& stop) noexcept {
  if (end_) return end_;
  for (auto& arm : runs_) {
    if (end) break;
    end = arm->loop.tick(stop);
  }
  remove_forces_on_fault();
  if (!end) {
    setup_.objects().step_bodies(1e-9 * static_cast<double>(setup_.period_ns()));
    return end;
  }
  for (std::size_t i = 0; i < setup_.arms(); ++i) setup_.device(i).deactivate();
  static constexpr std::atomic<bool> kStop{true};
  for (std::size_t i = 0; i < setup_.arms(); ++i) {
    RunLoop& loop = i == 0 ? first : run(i).loop;
    if (!loop.end()) loop.tick(kStop);
  }
  return end_ = end;
}

}  // namespace thimble::session

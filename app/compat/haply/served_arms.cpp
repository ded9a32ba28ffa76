#include "compat/haply/served_arms.h"

#include "compat/core/arm_access.h"
#include "compat/haply/haply_frame.h"

namespace thimble::compat::haply {

void ServedArms::open() {
  for (int number = 0; number < arms::count(); ++number) {
    Arm& arm = arms_[static_cast<std::size_t>(number)];
    const bool opened = arms::open(number, "Haply").empty();
    const std::lock_guard lock(arm.mutex);
    arm.open = opened;
  }
}

std::string ServedArms::answer(int session, std::string_view text) {
  const Request request = read_request(text);
  for (const WrongPart& wrong : request.wrong) arms::wrong_call(wrong.command, wrong.what);
  for (const ForceCommand& command : request.forces) {
    bool known = false;
    for (int number = 0; number < kArmsMax; ++number) {
      known = known || (is_open(number) && command.device_id == device_id_of(number));
    }
    if (!known) arms::wrong_call("device_id", "no arm has this name");
  }
  for (int number = 0; number < kArmsMax; ++number) {
    if (!is_open(number)) continue;
    ArmReading before;
    arms::read(number, before);
    if (push(number, session, request.force_of(device_id_of(number)))) {
      arms::wait_until_taken(number);
    } else {
      arms::wait_for_tick(number, before.tick);
    }
  }
  return message(session, request.full);
}

void ServedArms::leave(int session) {
  for (int number = 0; number < kArmsMax; ++number) {
    Arm& arm = arms_[static_cast<std::size_t>(number)];
    const std::lock_guard lock(arm.mutex);
    if (!arm.open || arm.sessions.erase(session) == 0) continue;
    if (arm.sessions.empty()) arms::enable_force(number, false);
    ask_sum(number, arm);
  }
}

void ServedArms::close() {
  for (int number = 0; number < kArmsMax; ++number) {
    Arm& arm = arms_[static_cast<std::size_t>(number)];
    const std::lock_guard lock(arm.mutex);
    if (arm.open) arms::close(number);
    arm.open = false;
  }
}

bool ServedArms::is_open(int number) {
  Arm& arm = arms_[static_cast<std::size_t>(number)];
  const std::lock_guard lock(arm.mutex);
  return arm.open;
}

/// Sets a session's force on an arm; false if the session has never requested a force of it.
bool ServedArms::push(int number, int session, const std::optional<Eigen::Vector3d>& f_B) {
  Arm& arm = arms_[static_cast<std::size_t>(number)];
  const std::lock_guard lock(arm.mutex);
  const auto before = arm.sessions.find(session);
  const bool is_first = before == arm.sessions.end();
  if (!f_B && is_first) return false;
  arm.sessions[session] = {f_B.value_or(Eigen::Vector3d(0, 0, 0)), arms::now_ns()};
  // The first request of a session enables the force, also after a fault of a simulated arm. A
  // force that others have enabled stays as it is.
  ArmReading now;
  const bool off =
      !arms::force_enabled(number) || !arms::read(number, now) || now.fault != driver::Fault::kNone;
  if (is_first && off) arms::enable_force(number, true);
  ask_sum(number, arm);
  return true;
}

void ServedArms::ask_sum(int number, const Arm& arm) const {
  const std::int64_t now_ns = arms::now_ns();
  const std::int64_t kept_ns = arms::facts(number).stall_ns;
  Eigen::Vector3d sum_B(0, 0, 0);
  for (const auto& [session, asked] : arm.sessions) {
    if (now_ns - asked.at_ns <= kept_ns) sum_B += asked.f_B;
  }
  const Eigen::Vector3d f_W = direction_W(sum_B);
  arms::ask_force(number, {.f_W = {f_W.x(), f_W.y(), f_W.z()}});
}

std::string ServedArms::message(int session, bool full) {
  std::vector<ReportedArm> reported;
  for (int number = 0; number < kArmsMax; ++number) {
    Arm& arm = arms_[static_cast<std::size_t>(number)];
    const std::lock_guard lock(arm.mutex);
    if (!arm.open) continue;
    ReportedArm one;
    one.device_id = device_id_of(number);
    one.facts = arms::facts(number);
    arms::read(number, one.reading);
    one.ready = arms::is_running(number) && one.reading.fault == driver::Fault::kNone;
    one.in_use = !arm.sessions.empty();
    reported.push_back(std::move(one));
  }
  return state_message(reported, session, full);
}

}  // namespace thimble::compat::haply

#include "thimble/driver/servo_loop.h"

namespace thimble::driver {
namespace {

std::array<double, 3> plain(const Eigen::Vector3d& v) noexcept {
  return {v.x(), v.y(), v.z()};
}

TickRecord record_of(const DeviceState& state, const ForceCommand& command,
                     const Device& device) noexcept {
  TickRecord record;
  record.tick = state.tick;
  record.time_ns = state.time_ns;
  record.counts = state.counts;
  record.q = plain(state.q);
  record.p_WT = plain(state.p_WT);
  record.v_WT = plain(state.v_WT);
  record.p_WP = plain(command.touch.p_WP);
  record.n_W = plain(command.touch.n_W);
  record.f_wanted_W = plain(command.f_T_W);
  record.f_sent_W = plain(device.f_sent_W());
  record.depth = command.touch.depth;
  record.feature = command.touch.feature;
  record.object = command.touch.object;
  record.hops = command.touch.hops;
  record.buttons = state.buttons;
  record.in_contact = command.touch.in_contact;
  record.fresh = state.fresh;
  record.stage = device.stage();
  record.fault = device.fault();
  return record;
}

}  // namespace

ServoEnd run_servo(Device& device, Clock& clock, ForceLaw law, TickSink sink,
                   const ServoSettings& settings, const std::atomic<bool>& stop) noexcept {
  ServoEnd end = ServoEnd::kDone;
  std::int64_t due_ns = clock.now_ns();
  const std::int64_t end_ns =
      due_ns + static_cast<std::int64_t>(settings.ticks) * settings.period_ns;
  while (settings.ticks == 0 || due_ns < end_ns) {
    clock.sleep_until_ns(due_ns);
    if (stop.load(std::memory_order_relaxed)) {
      end = ServoEnd::kStopped;
      break;
    }
    const std::int64_t now_ns = clock.now_ns();
    const DeviceState& state = device.read(now_ns, now_ns);
    const ForceCommand command = law(state);
    device.write(command);

    TickRecord record = record_of(state, command, device);
    record.due_ns = due_ns;
    record.work_ns = clock.now_ns() - now_ns;
    sink(record);
    if (device.fault() != Fault::kNone && !settings.outlive_faults) {
      end = ServoEnd::kFault;
      break;
    }
    due_ns += settings.period_ns;
    const std::int64_t late_ns = now_ns - due_ns;
    if (late_ns >= 0) due_ns += (late_ns / settings.period_ns + 1) * settings.period_ns;
  }
  device.deactivate();
  return end;
}

}  // namespace thimble::driver

#include "run_loop.h"

namespace thimble {
namespace firmware {

RunLoop::RunLoop() noexcept : controller_(board::config(), board::restarted()) {
  const ArmConfig& config = controller_.config();
  const uint16_t ratio = static_cast<uint16_t>(config.loop_hz / config.report_hz);
  report_every_ = ratio == 0 ? 1 : ratio;
  board::apply(controller_.outputs());
  describe();
}

void RunLoop::describe() noexcept {
  uint8_t bytes[kDescriptionSize];
  controller_.describe(bytes);
  board::describe(bytes);
  described_us_ = board::now_us();
}

bool RunLoop::pass() noexcept {
  const bool tick = board::tick_due();
  const uint32_t begin_us = board::now_us();
  if (tick) {
    Inputs inputs;
    board::sample(inputs);
    controller_.tick(inputs, begin_us);
    board::apply(controller_.outputs());
  }
  if (!board::connected() && controller_.outputs().motors_on) {
    controller_.lose_link();
    board::apply(controller_.outputs());
  }
  uint8_t message[kHidReportSize];
  for (int i = 0; i < kMessagesMax; ++i) {
    const size_t size = board::receive(message);
    if (size == 0) break;
    if (controller_.receive(message, size, board::now_us())) describe();
    board::apply(controller_.outputs());
  }
  if (!tick) {
    // Between two ticks only the watchdog can change the outputs.
    const bool on = controller_.outputs().motors_on;
    controller_.watch(board::now_us());
    if (on != controller_.outputs().motors_on) board::apply(controller_.outputs());
    return false;
  }
  if (--report_in_ == 0) {
    report_in_ = report_every_;
    uint8_t state[kStateSize];
    controller_.report(state);
    board::send(state);
  }
  if (!controller_.outputs().motors_on && begin_us - described_us_ >= UINT32_C(1000000)) {
    describe();
  }
  board::lamp(controller_.lamp(begin_us));
  board::feed_watchdog();
  controller_.loop_took(board::now_us() - begin_us);
  return true;
}

}  // namespace firmware
}  // namespace thimble

#include "boards/hid_link.h"

#include <string.h>

#include "boards/arm.h"
#include "core/board.h"
#include "usb/usb_port.h"

namespace thimble {
namespace firmware {
namespace {

ArmConfig arm;
HidDevice usb(kProduct, arm.serial);
uint32_t period_us, next_us;

}  // namespace

namespace hid_link {

void start(const Board& board) noexcept {
  arm = own_arm(board.name);
  memcpy(arm.serial, board.serial, sizeof arm.serial);
  arm.loop_hz = board.loop_hz;
  arm.report_hz = board.report_hz;
  usb = HidDevice(kProduct, arm.serial);
  usb_port::start(usb);
  period_us = UINT32_C(1000000) / arm.loop_hz;
  next_us = board::now_us();
}

}  // namespace hid_link

namespace board {

ArmConfig config() noexcept {
  return arm;
}

bool tick_due() noexcept {
  usb_port::poll(usb);
  if (static_cast<int32_t>(now_us() - next_us) < 0) return false;
  next_us += period_us;
  return true;
}

bool connected() noexcept {
  return usb.connected();
}

size_t receive(uint8_t* message) noexcept {
  return usb_port::receive(message) ? kHidReportSize : 0;
}

void send(const uint8_t* state) noexcept {
  if (usb.connected()) usb_port::send(state, kStateSize);
}

void describe(const uint8_t* description) noexcept {
  usb.set_feature(description);
}

}  // namespace board
}  // namespace firmware
}  // namespace thimble

#include "usb/hid_gadget.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cstdio>

#include "thimble/device_sim/usb/arm_shelf.h"
#include "thimble/driver/clock.h"
#include "usb/usb_description.h"

namespace thimble::usb_test {
namespace {

constexpr std::int64_t kFrame_ns = 1'000'000;

}  // namespace

int print_report_descriptor(const std::string& arm) {
  const auto made = device_sim::usb::make_usb_arm(arm, {});
  if (!made) return 1;
  const auto& bytes = (*made)->description().interfaces[0].report_descriptor;
  return std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size() ? 0 : 1;
}

int run_gadget(const std::string& arm, const std::string& node) {
  const auto made = device_sim::usb::make_usb_arm(arm, {});
  const int file = ::open(node.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (!made || file < 0) {
    std::printf("FAIL %s as a gadget: %s cannot be opened\n", arm.c_str(), node.c_str());
    return 1;
  }
  device_sim::usb::UsbArm& device = **made;
  // The kernel's gadget has its own endpoints; the board uses those of its first interface.
  const auto& endpoints = device.description().interfaces[0].endpoints;
  const std::uint8_t in = endpoints[0].address, out = endpoints[1].address;
  driver::WallClock clock(0);
  const std::int64_t begin_ns = clock.now_ns();
  std::array<std::byte, device_sim::usb::UsbDevice::kPacketMax> report{}, message{};
  std::size_t size = 0;  // of a report that the host has not read yet
  for (std::int64_t frame = 1;; ++frame) {
    clock.sleep_until_ns(begin_ns + frame * kFrame_ns);
    device.advance_to(clock.now_ns() - begin_ns);
    for (;;) {
      const ssize_t count = read(file, message.data(), message.size());
      if (count <= 0) break;
      device.out(out, std::span<const std::byte>(message).first(static_cast<std::size_t>(count)));
    }
    if (size == 0) {
      const auto result = device.in(in, report);
      size = result.answer == device_sim::usb::Answer::kDone ? result.size : 0;
    }
    if (size > 0 && write(file, report.data(), size) > 0) size = 0;
  }
}

}  // namespace thimble::usb_test

// The USB port of all boards with a USB controller. usb_controller.h is that of the board's folder.
#include "usb/usb_port.h"

#include "usb_controller.h"

namespace thimble {
namespace firmware {
namespace usb_port {
namespace {

UsbController port;

}  // namespace

void start(HidDevice& device) noexcept {
  port.start(device);
}

void poll(HidDevice& device) noexcept {
  port.poll(device);
}

bool receive(uint8_t* report) noexcept {
  return port.receive(report);
}

void send(const uint8_t* report, uint16_t size) noexcept {
  port.send(report, size);
}

}  // namespace usb_port
}  // namespace firmware
}  // namespace thimble

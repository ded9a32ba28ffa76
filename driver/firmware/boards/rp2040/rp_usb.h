#pragma once

#include <stdint.h>
#include <string.h>

#include "boards/rp2040/registers.h"
#include "usb/control_answer.h"
#include "usb/hid_device.h"

namespace thimble {
namespace firmware {

/// USB full-speed device on the controller of the RP2040, polled [S RP2040 datasheet, 4.1].
/// `Access` is as ChipAccess. Its functions are those of usb_port.h.
template <class Access>
class RpUsb {
 public:
  void start(HidDevice& device) noexcept {
    static_cast<void>(device);  // full speed only
    for (uintptr_t at = 0; at < 0x1000; at += 4) Access::write(kUsbRam + at, 0);
    set(kMuxing, 1 << 0 | 1 << 3);  // to the transceiver, connected by software
    set(kPower, 1 << 2 | 1 << 3);   // bus voltage is taken as present
    set(kMainCtrl, 1);
    set(kSieCtrl, 1u << 29 | 1u << 16);  // status for each buffer of endpoint 0; pull-up
  }

  void poll(HidDevice& device) noexcept {
    const uint32_t status = get(kSieStatus);
    if ((status & kBusReset) != 0) {
      set(kSieStatus, kBusReset);
      reset(device);
    }
    if ((status & kSuspended) != 0) {
      set(kSieStatus, kSuspended);
      device.suspend();
    } else if (device.suspended()) {
      device.resume();
    }
    if ((status & kSetupReceived) != 0) {
      set(kSieStatus, kSetupReceived);
      // What the last transfer still reports is void.
      set(kBuffStatus, kIn0Done | kOut0Done);
      take_setup(device);
    }
    take_buffers();
  }

  bool receive(uint8_t* report) noexcept {
    if (!report_ready_) return false;
    report_ready_ = false;
    const uint32_t size = Access::read(kBuffer1Out) & 0x3ff;
    memset(report, 0, HidDevice::kPacketSize);
    for (uint32_t at = 0; at < size && at < HidDevice::kPacketSize; at += 4) {
      const uint32_t word = Access::read(kData1Out + at);
      memcpy(report + at, &word, size - at < 4 ? size - at : 4);
    }
    await_report();
    return true;
  }

  void send(const uint8_t* report, uint16_t size) noexcept {
    // The host has not yet fetched the last one.
    if ((Access::read(kBuffer1In) & kAvailable) != 0) return;
    uint8_t packet[HidDevice::kPacketSize] = {};
    memcpy(packet, report, size < sizeof packet ? size : sizeof packet);
    copy_to(kData1In, packet, sizeof packet);
    give(kBuffer1In, kFull | kLast | (data1_in_ ? kData1Pid : 0) | HidDevice::kPacketSize);
    data1_in_ = !data1_in_;
  }

 private:
  // In the memory of the controller (4.1.2.5): the setup packet at 0, endpoint controls from 8,
  // buffer controls from 0x80 (8 bytes per endpoint: IN, OUT), data from 0x100.
  static constexpr uintptr_t kEndpoint1In = kUsbRam + 0x08, kEndpoint1Out = kUsbRam + 0x0c;
  static constexpr uintptr_t kBuffer0In = kUsbRam + 0x80, kBuffer0Out = kUsbRam + 0x84;
  static constexpr uintptr_t kBuffer1In = kUsbRam + 0x88, kBuffer1Out = kUsbRam + 0x8c;
  static constexpr uintptr_t kData0 = kUsbRam + 0x100, kData1In = kUsbRam + 0x180;
  static constexpr uintptr_t kData1Out = kUsbRam + 0x1c0;
  // Registers (4.1.4).
  static constexpr uintptr_t kAddress = 0x00, kMainCtrl = 0x40, kSieCtrl = 0x4c;
  static constexpr uintptr_t kSieStatus = 0x50, kBuffStatus = 0x58, kStallArm = 0x68;
  static constexpr uintptr_t kMuxing = 0x74, kPower = 0x78;
  static constexpr uint32_t kBusReset = 1u << 19, kSetupReceived = 1u << 17;
  static constexpr uint32_t kSuspended = 1u << 4;
  static constexpr uint32_t kIn0Done = 1u << 0, kOut0Done = 1u << 1, kOut1Done = 1u << 3;
  // Buffer control (4.1.2.5.1).
  static constexpr uint32_t kFull = 1u << 15, kLast = 1u << 14, kData1Pid = 1u << 13;
  static constexpr uint32_t kStallBit = 1u << 11, kAvailable = 1u << 10;

  static uint32_t get(uintptr_t offset) noexcept { return Access::read(kUsb + offset); }
  static void set(uintptr_t offset, uint32_t value) noexcept {
    Access::write(kUsb + offset, value);
  }

  /// Gives a buffer to the controller; the available bit follows later than the others, because the
  /// controller has another clock (4.1.2.5.1).
  static void give(uintptr_t control, uint32_t value) noexcept {
    Access::write(control, value);
    Access::wait_cycles();
    Access::write(control, value | kAvailable);
  }

  static void copy_to(uintptr_t buffer, const uint8_t* bytes, uint16_t size) noexcept {
    for (uint16_t at = 0; at < size; at = static_cast<uint16_t>(at + 4)) {
      uint32_t word = 0;
      memcpy(&word, bytes + at, size - at < 4 ? size - at : 4);
      Access::write(buffer + at, word);
    }
  }

  void reset(HidDevice& device) noexcept {
    set(kAddress, 0);
    set(kBuffStatus, 0xffffffff);
    Access::write(kEndpoint1In, 0);
    Access::write(kEndpoint1Out, 0);
    report_ready_ = false;
    answer_.cancel();
    new_address_ = 0;
    device.reset();
  }

  /// Sends the next packet of an answer; after the last one, awaits the host's acknowledgement.
  void send_part() noexcept {
    const uint8_t* data;
    uint16_t size;
    if (!answer_.next(data, size)) {
      give(kBuffer0Out, kLast | kData1Pid);
      return;
    }
    copy_to(kData0, data, size);
    give(kBuffer0In, kFull | kLast | (data1_ ? kData1Pid : 0) | size);
    data1_ = !data1_;
  }

  void await_report() noexcept {
    give(kBuffer1Out, kLast | (data1_out_ ? kData1Pid : 0) | HidDevice::kPacketSize);
    data1_out_ = !data1_out_;
  }

  void take_setup(HidDevice& device) noexcept {
    const uint32_t words[2] = {Access::read(kUsbRam), Access::read(kUsbRam + 4)};
    uint8_t packet[8];
    memcpy(packet, words, sizeof packet);
    const UsbReply reply = device.setup(packet);
    data1_ = true;
    answer_.cancel();
    new_address_ = 0;
    switch (reply.kind) {
      case UsbReply::kSend:
        answer_.begin(reply);
        send_part();
        return;
      case UsbReply::kSetAddress:
        new_address_ = reply.address;
        break;
      case UsbReply::kOpenEndpoints:
        data1_in_ = data1_out_ = report_ready_ = false;
        // Enabled, status for each buffer, interrupt type, place of the data.
        Access::write(kEndpoint1In, 1u << 31 | 1u << 29 | 3u << 26 | (kData1In - kUsbRam));
        Access::write(kEndpoint1Out, 1u << 31 | 1u << 29 | 3u << 26 | (kData1Out - kUsbRam));
        Access::write(kBuffer1In, 0);
        await_report();
        break;
      case UsbReply::kAcknowledge:
        break;
      case UsbReply::kStall:
        set(kStallArm, 3);
        Access::write(kBuffer0In, kStallBit);
        Access::write(kBuffer0Out, kStallBit);
        return;
    }
    // An empty packet acknowledges.
    give(kBuffer0In, kFull | kLast | kData1Pid);
  }

  void take_buffers() noexcept {
    const uint32_t done = get(kBuffStatus);
    set(kBuffStatus, done);
    if ((done & kIn0Done) != 0) {
      if (answer_.active()) {
        send_part();
      } else if (new_address_ != 0) {
        set(kAddress, new_address_);
        new_address_ = 0;
      }
    }
    if ((done & kOut1Done) != 0) report_ready_ = true;
  }

  ControlAnswer answer_;
  uint8_t new_address_ = 0;
  bool data1_ = false, data1_in_ = false, data1_out_ = false;
  bool report_ready_ = false;
};

}  // namespace firmware
}  // namespace thimble

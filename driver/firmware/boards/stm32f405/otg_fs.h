#pragma once

#include <stdint.h>
#include <string.h>

#include "usb/control_answer.h"
#include "usb/hid_device.h"

namespace thimble {
namespace firmware {

/// USB full-speed device on the OTG_FS core of the STM32F405, polled, without DMA [M ST RM0090
/// revision 19: registers 34.16, programming model 34.17]. Its clock of 48 MHz and its pins are
/// started by the board. `Access` is as ChipAccess. Its functions are those of usb_port.h.
template <class Access>
class OtgFs {
 public:
  void start(HidDevice& device) noexcept {
    static_cast<void>(device);  // full speed only
    while ((get(kResetCtl) & kAhbIdle) == 0) {
    }
    set(kResetCtl, kCoreReset);
    while ((get(kResetCtl) & kCoreReset) != 0) {
    }
    set(kDeviceCtl, kSoftDisconnect);
    // The pins of bus voltage and ID have other functions on this board, so the mode is forced.
    // A forced mode takes effect within 25 ms.
    set(kUsbConfig, kForceDevice | kInternalPhy | kTurnaround);
    while ((get(kStatus) & kHostMode) != 0) {
    }
    set(kCoreConfig, kTransceiverOn | kNoBusVoltageSensing);
    set(kClockGating, 0);
    set(kDeviceConfig, kInternalFullSpeed);
    set(kRxFifoSize, kRxWords);
    set(kTx0FifoSize, kTxWords << 16 | kRxWords);
    set(kTx1FifoSize, kTxWords << 16 | (kRxWords + kTxWords));
    flush(kAllFifos);
    set(kAhbConfig, 0);  // no interrupts
    set(kStatus, kBusReset | kEnumerated | kSuspend | kWakeup);
    report_ready_ = false;
    answer_.cancel();
    set(kDeviceCtl, 0);  // connects
  }

  void poll(HidDevice& device) noexcept {
    const uint32_t events = get(kStatus) & (kBusReset | kEnumerated | kSuspend | kWakeup);
    set(kStatus, events);
    if ((events & kBusReset) != 0) reset(device);
    // Packets of 64 bytes on endpoint 0.
    if ((events & kEnumerated) != 0) set(in(0, kCtl), get(in(0, kCtl)) & ~UINT32_C(3));
    if ((events & kSuspend) != 0) device.suspend();
    if (device.suspended() && (get(kDeviceStatus) & kSuspended) == 0) device.resume();
    while ((get(kStatus) & kRxNotEmpty) != 0) take_packet();
    const uint32_t in0 = take(in(0, kEvents));
    take(out(0, kEvents));
    take(in(1, kEvents));
    if (setup_done_) {
      setup_done_ = false;
      take_setup(device);
    } else if ((in0 & kTransferDone) != 0 && answer_.active()) {
      send_part();
    }
    if ((take(out(1, kEvents)) & kTransferDone) != 0) report_ready_ = device.configured();
  }

  bool receive(uint8_t* report) noexcept {
    if (!report_ready_) return false;
    report_ready_ = false;
    memcpy(report, report_, sizeof report_);
    await_report();
    return true;
  }

  void send(const uint8_t* report, uint16_t size) noexcept {
    if ((get(in(1, kCtl)) & kEnable) != 0) return;  // the host has not yet fetched the last one
    uint8_t packet[HidDevice::kPacketSize] = {};
    memcpy(packet, report, size < sizeof packet ? size : sizeof packet);
    transmit(1, packet, sizeof packet);
  }

 private:
  static constexpr uintptr_t kBase = 0x50000000;  // 2.3, table 1
  // Global registers (34.16.2).
  static constexpr uintptr_t kAhbConfig = 0x008, kUsbConfig = 0x00c, kResetCtl = 0x010;
  static constexpr uintptr_t kStatus = 0x014, kRxStatusPop = 0x020, kRxFifoSize = 0x024;
  static constexpr uintptr_t kTx0FifoSize = 0x028, kCoreConfig = 0x038, kTx1FifoSize = 0x104;
  static constexpr uint32_t kForceDevice = 1u << 30, kInternalPhy = 1u << 6;
  static constexpr uint32_t kTurnaround = 6u << 10;  // for a bus clock of 32 MHz or more
  static constexpr uint32_t kCoreReset = 1u << 0, kTxFlush = 1u << 5, kAhbIdle = 1u << 31;
  static constexpr uint32_t kAllFifos = 0x10;
  static constexpr uint32_t kHostMode = 1u << 0, kRxNotEmpty = 1u << 4, kSuspend = 1u << 11;
  static constexpr uint32_t kBusReset = 1u << 12, kEnumerated = 1u << 13, kWakeup = 1u << 31;
  static constexpr uint32_t kTransceiverOn = 1u << 16, kNoBusVoltageSensing = 1u << 21;
  // Registers of the device (34.16.4), and of endpoints at 0x20 each.
  static constexpr uintptr_t kDeviceConfig = 0x800, kDeviceCtl = 0x804, kDeviceStatus = 0x808;
  static constexpr uintptr_t kClockGating = 0xe00;  // 34.16.5
  static constexpr uintptr_t kCtl = 0x00, kEvents = 0x08, kSize = 0x10;
  static constexpr uint32_t kInternalFullSpeed = 3, kSoftDisconnect = 1u << 1, kSuspended = 1;
  static constexpr uint32_t kActive = 1u << 15, kInterruptType = 3u << 18, kStallBit = 1u << 21;
  static constexpr uint32_t kTxFifo1 = 1u << 22, kClearNak = 1u << 26, kSetNak = 1u << 27;
  static constexpr uint32_t kSetData0 = 1u << 28, kDisable = 1u << 30, kEnable = 1u << 31;
  static constexpr uint32_t kTransferDone = 1u << 0, kDisabled = 1u << 1;
  static constexpr uint32_t kNakEffective = 1u << 6;
  static constexpr uint32_t kOnePacket = 1u << 19, kThreeSetups = 3u << 29;
  // Kinds of received packets.
  static constexpr uint32_t kOutData = 2, kSetupDone = 4, kSetupData = 6;
  // Of 320 words (34.11). The receiving one holds three setup packets, two packets of 64 bytes
  // with their status, and 10 words more. [C: 10 + 2 * 17 + 10; the rest is reserve]
  static constexpr uint32_t kRxWords = 128, kTxWords = 64;

  static uintptr_t in(uintptr_t endpoint, uintptr_t offset) noexcept {
    return 0x900 + 0x20 * endpoint + offset;
  }
  static uintptr_t out(uintptr_t endpoint, uintptr_t offset) noexcept {
    return 0xb00 + 0x20 * endpoint + offset;
  }
  static uintptr_t fifo(uintptr_t endpoint) noexcept { return 0x1000 + 0x1000 * endpoint; }
  static uint32_t get(uintptr_t offset) noexcept { return Access::read(kBase + offset); }
  static void set(uintptr_t offset, uint32_t value) noexcept {
    Access::write(kBase + offset, value);
  }
  /// Returns the events of an endpoint, and clears them.
  static uint32_t take(uintptr_t offset) noexcept {
    const uint32_t events = get(offset);
    set(offset, events);
    return events;
  }

  /// Waits for a bit that the core changes within some cycles.
  static void wait(uintptr_t offset, uint32_t bit, bool value) noexcept {
    // [chosen: far more than the cycles of a FIFO; ends also if the core hangs]
    for (int i = 0; i < 1000 && ((get(offset) & bit) != 0) != value; ++i) {
    }
  }

  static void flush(uint32_t number) noexcept {
    set(kResetCtl, kTxFlush | number << 6);
    wait(kResetCtl, kTxFlush, false);
  }

  /// Ends a transfer to the host that has not been fetched, and removes its data.
  static void cancel(uintptr_t endpoint) noexcept {
    const uint32_t ctl = get(in(endpoint, kCtl));
    if ((ctl & kEnable) != 0) {
      set(in(endpoint, kEvents), kNakEffective);
      set(in(endpoint, kCtl), ctl | kSetNak);
      wait(in(endpoint, kEvents), kNakEffective, true);
      set(in(endpoint, kCtl), ctl | kSetNak | kDisable);
      wait(in(endpoint, kEvents), kDisabled, true);
      set(in(endpoint, kEvents), kDisabled | kTransferDone);
    }
    flush(static_cast<uint32_t>(endpoint));
  }

  static void transmit(uintptr_t endpoint, const uint8_t* data, uint16_t size) noexcept {
    set(in(endpoint, kSize), kOnePacket | size);
    set(in(endpoint, kCtl), get(in(endpoint, kCtl)) | kClearNak | kEnable);
    for (uint16_t at = 0; at < size; at = static_cast<uint16_t>(at + 4)) {
      uint32_t word = 0;
      memcpy(&word, data + at, size - at < 4 ? size - at : 4);
      set(fifo(endpoint), word);
    }
  }

  /// Opens endpoint `number` for one packet, endpoint 0 also for setup packets.
  static void await_packet(uintptr_t endpoint) noexcept {
    const uint32_t setups = endpoint == 0 ? kThreeSetups : 0;
    set(out(endpoint, kSize), setups | kOnePacket | HidDevice::kPacketSize);
    set(out(endpoint, kCtl), get(out(endpoint, kCtl)) | kClearNak | kEnable);
  }
  static void await_report() noexcept { await_packet(1); }
  static void await_setup() noexcept { set(out(0, kSize), kThreeSetups | kOnePacket); }

  void reset(HidDevice& device) noexcept {
    set(out(0, kCtl), get(out(0, kCtl)) | kSetNak);
    set(out(1, kCtl), get(out(1, kCtl)) | kSetNak);
    cancel(0);
    cancel(1);
    set(kDeviceConfig, kInternalFullSpeed);  // address 0
    await_setup();
    answer_.cancel();
    setup_done_ = report_ready_ = false;
    device.reset();
  }

  /// Takes the next packet from the FIFO.
  void take_packet() noexcept {
    const uint32_t status = get(kRxStatusPop);
    const uint32_t kind = status >> 17 & 15, endpoint = status & 15;
    const uint16_t size = static_cast<uint16_t>(status >> 4 & 0x7ff);
    // A setup packet counts when its stage is done, unless another one follows.
    if (kind == kSetupDone || kind == kSetupData) setup_done_ = kind == kSetupDone;
    uint8_t* to = nullptr;
    size_t room = 0;
    if (kind == kSetupData) {
      to = setup_;
      room = sizeof setup_;
      answer_.cancel();  // what the last request still sends is void
    } else if (kind == kOutData && endpoint == 1) {
      to = report_;
      room = sizeof report_;
      memset(report_, 0, sizeof report_);
    }
    for (size_t at = 0; at < size; at += 4) {
      const uint32_t word = get(fifo(0));
      if (at >= room) continue;
      const size_t left = size - at < 4 ? size - at : 4;
      memcpy(to + at, &word, left < room - at ? left : room - at);
    }
  }

  /// Sends the next packet of an answer; after the last one, awaits the host's acknowledgement.
  void send_part() noexcept {
    const uint8_t* data;
    uint16_t size;
    if (answer_.next(data, size)) {
      transmit(0, data, size);
    } else {
      await_packet(0);
    }
  }

  void take_setup(HidDevice& device) noexcept {
    cancel(0);
    await_setup();
    const UsbReply reply = device.setup(setup_);
    answer_.cancel();
    switch (reply.kind) {
      case UsbReply::kSend:
        answer_.begin(reply);
        send_part();
        return;
      case UsbReply::kSetAddress:
        // The core uses it after the acknowledgement (34.17, initialization on SetAddress).
        set(kDeviceConfig, kInternalFullSpeed | static_cast<uint32_t>(reply.address) << 4);
        break;
      case UsbReply::kOpenEndpoints:
        open_endpoints();
        break;
      case UsbReply::kAcknowledge:
        break;
      case UsbReply::kStall:
        set(in(0, kCtl), get(in(0, kCtl)) | kStallBit);
        set(out(0, kCtl), get(out(0, kCtl)) | kStallBit);
        return;
    }
    transmit(0, nullptr, 0);  // an empty packet acknowledges
  }

  void open_endpoints() noexcept {
    constexpr uint32_t kOpen = kActive | kInterruptType | kSetData0 | HidDevice::kPacketSize;
    cancel(1);
    set(in(1, kCtl), kOpen | kTxFifo1 | kSetNak);
    // One that already awaits a report keeps its size.
    const bool enabled = (get(out(1, kCtl)) & kEnable) != 0;
    set(out(1, kCtl), kOpen | (enabled ? kClearNak : kSetNak));
    report_ready_ = false;
    if (!enabled) await_report();
  }

  ControlAnswer answer_;
  uint8_t setup_[8] = {};
  uint8_t report_[HidDevice::kPacketSize] = {};
  bool setup_done_ = false, report_ready_ = false;
};

}  // namespace firmware
}  // namespace thimble

#pragma once

#include <stdint.h>
#include <string.h>

#include "usb/hid_device.h"

namespace thimble {
namespace firmware {

/// USB device on the controller USB1 of the i.MX RT1062, at high or full speed, polled: queue heads
/// and transfer descriptors in memory [M NXP IMXRT1060RM revision 3: chapter 42, registers and
/// "device data structures", "device operational model"; chapter 43, transceiver; 14.8, PLL]. The
/// data cache must be off. `Access` is as ChipAccess. Its functions are those of usb_port.h.
template <class Access>
class ImxUsb {
 public:
  void start(HidDevice& device) noexcept {
    static_assert(sizeof(ImxUsb) <= 2048, "no data cross a page of 4 kB");
    device.offer_high_speed();
    // Supply of the transceiver, PLL of 480 MHz, transceiver.
    Access::write(kSupplySet, 1);
    Access::write(kPllSet, kPllPower | kPllEnable | kPllUsbClocks);
    while ((Access::read(kPll) & kPllLock) == 0) {
    }
    Access::write(kPllClear, kPllBypass);
    Access::write(kPhyCtlClear, kPhyReset | kPhyClockGate);
    Access::write(kPhyPower, 0);

    set(kCommand, kControllerReset);
    while ((get(kCommand) & kControllerReset) != 0) {
    }
    set(kMode, kDeviceMode | kSetupLockoutsOff);
    for (QueueHead& queue : queues_) {
      // Empty packets are sent only by separate descriptors.
      queue.capabilities = HidDevice::kPacketSize << 16 | kNoZeroTermination | kInterruptOnSetup;
      queue.next = kEndOfList;
      queue.token = 0;
    }
    forget_transfers();
    Access::complete_writes();
    set(kListAddress, Access::bus_address(queues_));
    set(kInterrupts, 0);
    set(kCommand, kRun);  // connects
  }

  void poll(HidDevice& device) noexcept {
    const uint32_t events = get(kStatus) & (kPortChange | kBusReset | kSuspend);
    set(kStatus, events);
    if ((events & kBusReset) != 0) reset(device);
    const uint32_t port = get(kPort);
    if ((events & kPortChange) != 0) device.set_high_speed((port & kHighSpeed) != 0);
    if ((events & kSuspend) != 0) device.suspend();
    if (device.suspended() && (port & kSuspended) == 0) device.resume();
    if ((get(kSetupStatus) & 1) != 0) take_setup(device);
    const uint32_t complete = get(kComplete);
    set(kComplete, complete);
    if ((complete & bit(kOut1)) != 0) report_ready_ = true;
  }

  bool receive(uint8_t* report) noexcept {
    if (!report_ready_) return false;
    report_ready_ = false;
    const uint32_t left = transfers_[kOut1].token >> 16 & 0x7fff;
    const size_t size = left < sizeof report_ ? sizeof report_ - left : 0;
    memset(report, 0, HidDevice::kPacketSize);
    for (size_t i = 0; i < size; ++i) report[i] = report_[i];
    await_report();
    return true;
  }

  void send(const uint8_t* report, uint16_t size) noexcept {
    // The host has not yet fetched the last one.
    if ((transfers_[kIn1].token & kActive) != 0) return;
    for (size_t i = 0; i < sizeof sent_; ++i) sent_[i] = i < size ? report[i] : uint8_t(0);
    prime(kIn1, sent_, sizeof sent_);
  }

 private:
  // Registers of the controller.
  static constexpr uintptr_t kBase = 0x402e0000;
  static constexpr uintptr_t kCommand = 0x140, kStatus = 0x144, kInterrupts = 0x148;
  static constexpr uintptr_t kAddress = 0x154, kListAddress = 0x158, kPort = 0x184, kMode = 0x1a8;
  static constexpr uintptr_t kSetupStatus = 0x1ac, kPrime = 0x1b0, kFlush = 0x1b4, kReady = 0x1b8;
  static constexpr uintptr_t kComplete = 0x1bc, kEndpoint0 = 0x1c0, kEndpoint1 = 0x1c4;
  static constexpr uint32_t kRun = 1u << 0, kControllerReset = 1u << 1, kTripwire = 1u << 13;
  static constexpr uint32_t kPortChange = 1u << 2, kBusReset = 1u << 6, kSuspend = 1u << 8;
  static constexpr uint32_t kAddressLater = 1u << 24;
  static constexpr uint32_t kSuspended = 1u << 7, kHighSpeed = 1u << 9;
  static constexpr uint32_t kDeviceMode = 2, kSetupLockoutsOff = 1u << 3;
  static constexpr uint32_t kStallBoth = 1u << 16 | 1u << 0;
  // Both directions: enabled, interrupt type, DATA0.
  static constexpr uint32_t kOpenBoth = 1u << 23 | 1u << 22 | 3u << 18 | 1u << 7 | 1u << 6 | 3 << 2;
  // PLL (14.8), supply of the transceiver (PMU), transceiver.
  static constexpr uintptr_t kPll = 0x400d8010, kPllSet = 0x400d8014, kPllClear = 0x400d8018;
  static constexpr uint32_t kPllLock = 1u << 31, kPllBypass = 1u << 16, kPllEnable = 1u << 13;
  static constexpr uint32_t kPllPower = 1u << 12, kPllUsbClocks = 1u << 6;
  static constexpr uintptr_t kSupplySet = 0x400d8124;
  static constexpr uintptr_t kPhyPower = 0x400d9000, kPhyCtlClear = 0x400d9038;
  static constexpr uint32_t kPhyReset = 1u << 31, kPhyClockGate = 1u << 30;
  // Queue heads, in the order of the controller; descriptors; their tokens.
  enum Queue : uint32_t { kOut0, kIn0, kOut1, kIn1, kQueues };
  static constexpr uint32_t kInterruptOnSetup = 1u << 15, kNoZeroTermination = 1u << 29;
  static constexpr uint32_t kEndOfList = 1, kActive = 1u << 7, kReportCompletion = 1u << 15;

  struct alignas(64) QueueHead {
    volatile uint32_t capabilities, current, next, token, pages[5], reserved, setup[2], unused[4];
  };
  struct alignas(32) Transfer {
    volatile uint32_t next, token, pages[5], unused;
  };
  static_assert(sizeof(QueueHead) == 64 && sizeof(Transfer) == 32, "the layout of the manual");

  static uint32_t get(uintptr_t offset) noexcept { return Access::read(kBase + offset); }
  static void set(uintptr_t offset, uint32_t value) noexcept {
    Access::write(kBase + offset, value);
  }
  /// Bit of a queue in the registers of transfers: receiving from 0, transmitting from 16.
  static constexpr uint32_t bit(uint32_t queue) noexcept {
    return 1u << (queue / 2 + queue % 2 * 16);
  }
  /// Waits until the controller has cleared bits.
  static void wait(uintptr_t offset, uint32_t bits) noexcept {
    // [chosen: longer than a packet at full speed, 47 us; ends also if the controller hangs]
    for (int i = 0; i < 10000 && (get(offset) & bits) != 0; ++i) {
    }
  }

  /// Cancels the transfers of queues.
  static void flush(uint32_t bits) noexcept {
    wait(kPrime, bits);
    set(kFlush, bits);
    wait(kFlush, bits);
    set(kComplete, bits);
  }

  static void fill(Transfer& transfer, const volatile uint8_t* data, size_t size) noexcept {
    transfer.next = kEndOfList;
    transfer.token = static_cast<uint32_t>(size) << 16 | kReportCompletion | kActive;
    transfer.pages[0] = Access::bus_address(data);
  }

  /// Gives a filled descriptor to the controller.
  void start_transfer(uint32_t queue) noexcept {
    queues_[queue].next = Access::bus_address(&transfers_[queue]);
    queues_[queue].token = 0;
    Access::complete_writes();
    set(kPrime, bit(queue));
  }

  void prime(uint32_t queue, const volatile uint8_t* data, size_t size) noexcept {
    fill(transfers_[queue], data, size);
    start_transfer(queue);
  }

  void await_report() noexcept { prime(kOut1, report_, sizeof report_); }

  void forget_transfers() noexcept {
    for (Transfer& transfer : transfers_) transfer.token = 0;
    report_ready_ = false;
  }

  void reset(HidDevice& device) noexcept {
    set(kSetupStatus, get(kSetupStatus));
    set(kComplete, get(kComplete));
    flush(0xffffffff);
    set(kAddress, 0);
    set(kEndpoint1, 0);
    forget_transfers();
    device.reset();
  }

  void take_setup(HidDevice& device) noexcept {
    uint32_t words[2];
    set(kSetupStatus, 1);
    // The controller removes the tripwire if another packet arrives while this one is copied.
    do {
      set(kCommand, get(kCommand) | kTripwire);
      words[0] = queues_[kOut0].setup[0];
      words[1] = queues_[kOut0].setup[1];
    } while ((get(kCommand) & kTripwire) == 0);
    set(kCommand, get(kCommand) & ~kTripwire);
    flush(bit(kOut0) | bit(kIn0));
    uint8_t packet[8];
    memcpy(packet, words, sizeof packet);
    const UsbReply reply = device.setup(packet);
    const uint32_t address = reply.address;
    switch (reply.kind) {
      case UsbReply::kSend:
        answer(reply);
        return;
      case UsbReply::kSetAddress:
        // After the acknowledgement.
        set(kAddress, address << 25 | kAddressLater);
        break;
      case UsbReply::kOpenEndpoints:
        flush(bit(kOut1) | bit(kIn1));
        forget_transfers();
        set(kEndpoint1, kOpenBoth);
        await_report();
        break;
      case UsbReply::kAcknowledge:
        break;
      case UsbReply::kStall:
        set(kEndpoint0, get(kEndpoint0) | kStallBoth);
        return;
    }
    prime(kIn0, control_, 0);  // an empty packet acknowledges
  }

  void answer(const UsbReply& reply) noexcept {
    // From memory that the controller reaches, which the flash need not be.
    const uint16_t size = reply.size < sizeof control_ ? reply.size : sizeof control_;
    for (size_t i = 0; i < size; ++i) control_[i] = reply.data[i];
    fill(transfers_[kIn0], control_, size);
    if (reply.ends_empty) {
      fill(empty_, control_, 0);
      transfers_[kIn0].next = Access::bus_address(&empty_);
    }
    start_transfer(kIn0);
    prime(kOut0, control_, 0);  // the acknowledgement of the host
  }

  alignas(2048) QueueHead queues_[kQueues];
  Transfer transfers_[kQueues], empty_;
  // Longest answer: a string descriptor.
  volatile uint8_t control_[2 + 2 * HidDevice::kTextMax];
  volatile uint8_t report_[HidDevice::kPacketSize], sent_[HidDevice::kPacketSize];
  bool report_ready_ = false;
};

}  // namespace firmware
}  // namespace thimble

#include "transports/ftdi_transport.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "thimble/driver/arm.h"
#include "transports/ftdi_packet.h"
#include "transports/stream_transport.h"

namespace thimble::driver {
namespace {

/// Reads and writes by transfers that are made once. Two reads are always under way, so that the
/// converter never waits for the host; two writes, so that one that hangs does not stop the next.
class FtdiTransport final : public StreamTransport {
 public:
  FtdiTransport(FtdiUsb usb, const Framing& framing, const Clock& clock)
      : StreamTransport(clock, framing), usb_(std::move(usb)) {}

  ~FtdiTransport() override {
    // The last message is the zero force: give it 20 frames to leave.
    for (int i = 0; i < 20 && !lost_ && any_under_way(out_); ++i) handle_events(1'000'000);
    for (Slot& slot : in_) cancel(slot);
    for (Slot& slot : out_) cancel(slot);
    closing_ = true;
    for (int i = 0; i < 500 && (any_under_way(in_) || any_under_way(out_)); ++i) {
      handle_events(1'000'000);
    }
    for (Slot& slot : in_) libusb_free_transfer(slot.transfer);
    for (Slot& slot : out_) libusb_free_transfer(slot.transfer);
  }

  bool start() {
    for (Slot& slot : in_) {
      slot.owner = this;
      slot.transfer = libusb_alloc_transfer(0);
      if (slot.transfer == nullptr) return false;
      libusb_fill_bulk_transfer(slot.transfer, usb_.handle.get(), kFtdiEndpointIn,
                                slot.bytes.data(), static_cast<int>(slot.bytes.size()), &came,
                                &slot, 0);
      if (!submit(slot)) return false;
    }
    for (Slot& slot : out_) {
      slot.owner = this;
      slot.transfer = libusb_alloc_transfer(0);
      if (slot.transfer == nullptr) return false;
      libusb_fill_bulk_transfer(slot.transfer, usb_.handle.get(), kFtdiEndpointOut,
                                slot.bytes.data(), 0, &went, &slot, 0);
    }
    return true;
  }

 private:
  // Room for the longest message and for whole packets of the converter.
  static constexpr std::size_t kTransferSize = 4 * kFtdiPacketSize;
  static_assert(kTransferSize >= kReportCapacity);
  static constexpr int kErrorsMax = 8;  // reads that failed in a row, until the wire counts as lost

  struct Slot {
    FtdiTransport* owner = nullptr;
    libusb_transfer* transfer = nullptr;
    std::array<unsigned char, kTransferSize> bytes{};
    bool under_way = false;
  };

  static bool any_under_way(const std::array<Slot, 2>& slots) noexcept {
    return slots[0].under_way || slots[1].under_way;
  }

  static void cancel(Slot& slot) noexcept {
    if (slot.under_way) libusb_cancel_transfer(slot.transfer);
  }

  bool submit(Slot& slot) noexcept {
    slot.under_way = libusb_submit_transfer(slot.transfer) == 0;
    return slot.under_way;
  }

  void handle_events(std::int64_t wait_ns) noexcept {
    timeval time{.tv_sec = wait_ns / 1'000'000'000, .tv_usec = (wait_ns / 1'000) % 1'000'000};
    libusb_handle_events_timeout_completed(usb_.context.get(), &time, nullptr);
  }

  static void LIBUSB_CALL came(libusb_transfer* transfer) noexcept {
    Slot& slot = *static_cast<Slot*>(transfer->user_data);
    FtdiTransport& self = *slot.owner;
    slot.under_way = false;
    if (self.closing_) return;
    switch (transfer->status) {
      case LIBUSB_TRANSFER_COMPLETED:
      case LIBUSB_TRANSFER_TIMED_OUT:
        self.errors_ = 0;
        for_each_ftdi_packet(
            std::span<const std::byte>(reinterpret_cast<const std::byte*>(transfer->buffer),
                                       static_cast<std::size_t>(transfer->actual_length)),
            [&self](std::span<const std::byte> content) { self.finder().push(content); });
        break;
      case LIBUSB_TRANSFER_NO_DEVICE:
      case LIBUSB_TRANSFER_CANCELLED:
        self.lost_ = true;
        return;
      default:  // stall, overflow, error: the next read may go well
        if (++self.errors_ > kErrorsMax) self.lost_ = true;
    }
    if (!self.lost_ && !self.submit(slot)) self.lost_ = true;
  }

  static void LIBUSB_CALL went(libusb_transfer* transfer) noexcept {
    Slot& slot = *static_cast<Slot*>(transfer->user_data);
    slot.under_way = false;
    slot.owner->refused_ = transfer->status != LIBUSB_TRANSFER_COMPLETED;
    if (transfer->status == LIBUSB_TRANSFER_NO_DEVICE) slot.owner->lost_ = true;
  }

  TransportStatus pump(std::int64_t wait_ns) noexcept override {
    handle_events(wait_ns);
    return lost_ ? TransportStatus::kLost : TransportStatus::kOk;
  }

  TransportStatus put(std::span<const std::byte> bytes) noexcept override {
    handle_events(0);
    if (lost_) return TransportStatus::kLost;
    const auto free =
        std::find_if(out_.begin(), out_.end(), [](const Slot& slot) { return !slot.under_way; });
    if (free == out_.end()) return TransportStatus::kRefused;
    const std::size_t size = std::min(bytes.size(), free->bytes.size());
    std::copy_n(reinterpret_cast<const unsigned char*>(bytes.data()), size, free->bytes.begin());
    free->transfer->length = static_cast<int>(size);
    const int code = libusb_submit_transfer(free->transfer);
    free->under_way = code == 0;
    if (code == LIBUSB_ERROR_NO_DEVICE) {
      lost_ = true;
      return TransportStatus::kLost;
    }
    // The outcome of a write is known later; that of an earlier one is told now.
    const bool refused = refused_ || code != 0;
    refused_ = false;
    return refused ? TransportStatus::kRefused : TransportStatus::kOk;
  }

  FtdiUsb usb_;
  std::array<Slot, 2> in_, out_;
  int errors_ = 0;
  bool refused_ = false;
  bool lost_ = false;
  bool closing_ = false;
};

}  // namespace

Result<std::unique_ptr<Transport>> start_ftdi_transport(FtdiUsb usb, const Framing& framing,
                                                        const Clock& clock) {
  auto transport = std::make_unique<FtdiTransport>(std::move(usb), framing, clock);
  if (!transport->start()) {
    return Error{"The arm's USB converter cannot be read. Unplug the arm and plug it in again."};
  }
  return std::unique_ptr<Transport>(std::move(transport));
}

}  // namespace thimble::driver

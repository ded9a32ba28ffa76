#include "transports/ftdi_transport.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "thimble/driver/arm.h"
#include "transports/ftdi_packet.h"
#include "transports/stream_transport.h"

namespace thimble::driver {
namespace {

/// Reads and writes with transfers that are allocated once. Two reads are always in flight, so that
/// the converter never waits for the host; two writes, so that a hanging one does not block the
/// next.
class FtdiTransport final : public StreamTransport {
 public:
  FtdiTransport(FtdiUsb usb, const Framing& framing, const Clock& clock, const BulkEnds& ends)
      : StreamTransport(clock, framing), usb_(std::move(usb)), ends_(ends) {}

  ~FtdiTransport() override {
    // The last message is the zero force: wait up to 20 frames for it to leave.
    for (int i = 0; i < 20 && !lost_ && any_under_way(out_); ++i) wait_a_frame();
    for (Slot& slot : in_) cancel(slot);
    for (Slot& slot : out_) cancel(slot);
    closing_ = true;
    for (int i = 0; i < 500 && (any_under_way(in_) || any_under_way(out_)); ++i) wait_a_frame();
    for (Slot& slot : in_) libusb_free_transfer(slot.transfer);
    for (Slot& slot : out_) libusb_free_transfer(slot.transfer);
  }

  bool start() {
    for (Slot& slot : in_) {
      slot.owner = this;
      slot.transfer = libusb_alloc_transfer(0);
      if (slot.transfer == nullptr) return false;
      libusb_fill_bulk_transfer(slot.transfer, usb_.handle.get(), ends_.in, slot.bytes.data(),
                                static_cast<int>(slot.bytes.size()), &came, &slot, 0);
      if (!submit(slot)) return false;
    }
    for (Slot& slot : out_) {
      slot.owner = this;
      slot.transfer = libusb_alloc_transfer(0);
      if (slot.transfer == nullptr) return false;
      libusb_fill_bulk_transfer(slot.transfer, usb_.handle.get(), ends_.out, slot.bytes.data(), 0,
                                &went, &slot, 0);
    }
    return true;
  }

 private:
  // Room for the longest message and for whole packets of the converter.
  static constexpr std::size_t kTransferSize = 4 * kFtdiPacketSize;
  static_assert(kTransferSize >= kReportCapacity);
  static constexpr int kErrorsMax = 8;  // failed reads in a row after which the wire is lost
  // Max. number of signals that may interrupt one call in a row. [chosen: more than a timer sends
  // in a tick]
  static constexpr int kInterruptionsMax = 16;

  struct Slot {
    FtdiTransport* owner = nullptr;
    libusb_transfer* transfer = nullptr;
    std::array<unsigned char, kTransferSize> bytes{};
    bool under_way = false;
    bool failed = false;  // result of its last transfer
  };

  static bool any_under_way(const std::array<Slot, 2>& slots) noexcept {
    return slots[0].under_way || slots[1].under_way;
  }

  static void cancel(Slot& slot) noexcept {
    if (slot.under_way) libusb_cancel_transfer(slot.transfer);
  }

  int submit_code(Slot& slot) noexcept {
    int code = LIBUSB_ERROR_INTERRUPTED;
    for (int i = 0; i < kInterruptionsMax && code == LIBUSB_ERROR_INTERRUPTED; ++i) {
      code = libusb_submit_transfer(slot.transfer);
    }
    slot.under_way = code == 0;
    return code;
  }

  bool submit(Slot& slot) noexcept { return submit_code(slot) == 0; }

  /// Returns false if a signal interrupted it.
  bool handle_events(std::int64_t wait_ns) noexcept {
    timeval time{.tv_sec = wait_ns / 1'000'000'000, .tv_usec = (wait_ns / 1'000) % 1'000'000};
    return libusb_handle_events_timeout_completed(usb_.context.get(), &time, nullptr) !=
           LIBUSB_ERROR_INTERRUPTED;
  }

  void handle_what_came() noexcept {
    for (int i = 0; i < kInterruptionsMax && !handle_events(0); ++i) {
    }
  }

  void wait_a_frame() noexcept {
    for (int i = 0; i < kInterruptionsMax && !handle_events(1'000'000); ++i) {
    }
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
        self.take(std::span<const std::byte>(reinterpret_cast<const std::byte*>(transfer->buffer),
                                             static_cast<std::size_t>(transfer->actual_length)));
        break;
      case LIBUSB_TRANSFER_NO_DEVICE:
      case LIBUSB_TRANSFER_CANCELLED:
        self.lost_ = true;
        return;
      default:  // stall, overflow, error: the next read may succeed
        if (++self.errors_ > kErrorsMax) self.lost_ = true;
    }
    if (!self.lost_ && !self.submit(slot)) self.lost_ = true;
  }

  void take(std::span<const std::byte> bytes) noexcept {
    if (!ends_.ftdi) return finder().push(bytes);
    for_each_ftdi_packet(bytes,
                         [this](std::span<const std::byte> content) { finder().push(content); });
  }

  static void LIBUSB_CALL went(libusb_transfer* transfer) noexcept {
    Slot& slot = *static_cast<Slot*>(transfer->user_data);
    slot.under_way = false;
    slot.failed = transfer->status != LIBUSB_TRANSFER_COMPLETED;
    if (slot.failed) slot.owner->refused_ = true;
    if (transfer->status == LIBUSB_TRANSFER_NO_DEVICE) slot.owner->lost_ = true;
  }

  // The caller, which has the deadline, resumes a wait that a signal interrupted.
  TransportStatus pump(std::int64_t wait_ns) noexcept override {
    if (wait_ns > 0) {
      handle_events(wait_ns);
    } else {
      handle_what_came();
    }
    return lost_ ? TransportStatus::kLost : TransportStatus::kOk;
  }

  TransportStatus put(std::span<const std::byte> bytes) noexcept override {
    handle_what_came();
    if (lost_) return TransportStatus::kLost;
    const auto free =
        std::find_if(out_.begin(), out_.end(), [](const Slot& slot) { return !slot.under_way; });
    if (free == out_.end()) return TransportStatus::kRefused;
    const std::size_t size = std::min(bytes.size(), free->bytes.size());
    std::copy_n(reinterpret_cast<const unsigned char*>(bytes.data()), size, free->bytes.begin());
    free->transfer->length = static_cast<int>(size);
    const int code = submit_code(*free);
    if (code == LIBUSB_ERROR_NO_DEVICE) {
      lost_ = true;
      return TransportStatus::kLost;
    }
    if (code == 0) newest_ = &*free;
    // The result of a write is known later; that of an earlier one is reported now. After a failure
    // it is unknown whether the arm takes this message, although it was submitted.
    const bool refused = refused_ || code != 0;
    refused_ = false;
    return refused ? TransportStatus::kRefused : TransportStatus::kOk;
  }

  TransportStatus settled() noexcept override {
    if (newest_ == nullptr) return TransportStatus::kOk;
    if (newest_->under_way && !lost_) handle_what_came();
    if (newest_->under_way) return lost_ ? TransportStatus::kLost : TransportStatus::kNothing;
    if (!newest_->failed) return TransportStatus::kOk;
    return lost_ ? TransportStatus::kLost : TransportStatus::kRefused;
  }

  FtdiUsb usb_;
  BulkEnds ends_;
  std::array<Slot, 2> in_, out_;
  const Slot* newest_ = nullptr;  // slot of the last submitted message
  int errors_ = 0;
  bool refused_ = false;
  bool lost_ = false;
  bool closing_ = false;
};

}  // namespace

Result<std::unique_ptr<Transport>> start_ftdi_transport(FtdiUsb usb, const Framing& framing,
                                                        const Clock& clock, const BulkEnds& ends) {
  auto transport = std::make_unique<FtdiTransport>(std::move(usb), framing, clock, ends);
  if (!transport->start()) {
    return Error{ends.ftdi
                     ? "Cannot read the arm's USB converter. Unplug the arm and plug it in again."
                     : "Cannot read the board on USB. Check endpoint_in in its arm file, and plug "
                       "it in again."};
  }
  return std::unique_ptr<Transport>(std::move(transport));
}

}  // namespace thimble::driver

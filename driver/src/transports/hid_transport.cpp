#include <hidapi.h>
#include <linux/hidraw.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <optional>
#include <utility>

#include "thimble/driver/arm.h"
#include "thimble/driver/transports.h"
#include "transports/hid_descriptor.h"
#include "transports/node_lock.h"

namespace thimble::driver {
namespace {

class HidTransport final : public Transport {
 public:
  HidTransport(hid_device* device, NodeLock lock, std::size_t message_size, std::size_t out_bytes,
               const Clock& clock) noexcept
      : clock_(clock),
        device_(device),
        lock_(std::move(lock)),
        message_size_(message_size),
        out_bytes_(out_bytes) {}
  ~HidTransport() override { hid_close(device_); }

  TransportRead read_latest(std::span<std::byte> buffer,
                            std::int64_t deadline_ns) noexcept override {
    TransportRead read;
    if (lost_) return {.status = TransportStatus::kLost};
    // The kernel keeps 63 reports per reader (a ring of HIDRAW_BUFFER_SIZE, 64,
    // linux/drivers/hid/hidraw.c) and drops later ones. After 63 ms without a read the kept reports
    // are old, and the tip may be anywhere. Then the next report is awaited, for at most two
    // frames. An arm that sends faster than it is read is abandoned after two rounds.
    constexpr std::uint32_t kReportsKept = 63, kReportsMax = 128;
    constexpr int kNext_ms = 2;
    std::uint32_t reports = 0;
    int wait_ms = 0;
    bool waited_for_next = false;
    int interruptions = 0;
    std::int64_t until_ns = deadline_ns;  // end of a wait
    while (reports < kReportsMax) {
      errno = 0;
      const int count = hid_read_timeout(device_, reinterpret_cast<unsigned char*>(buffer.data()),
                                         buffer.size(), wait_ms);
      // A signal is not a fault of the arm. (hidapi would then allocate an error text.)
      if (count < 0 && errno == EINTR) {
        if (++interruptions > kInterruptionsMax) break;
        if (wait_ms > 0) wait_ms = whole_ms_until(until_ns);
        continue;
      }
      if (count < 0) {
        lost_ = true;
        return {.status = TransportStatus::kLost};
      }
      if (count > 0) {
        read.size = static_cast<std::size_t>(count);
        ++reports;
        wait_ms = 0;
        continue;
      }
      if (reports >= kReportsKept && !waited_for_next) {
        waited_for_next = true;
        until_ns = clock_.now_ns() + 1'000'000 * kNext_ms;
        wait_ms = kNext_ms;
        continue;
      }
      if (reports > 0 || wait_ms > 0) break;
      wait_ms = whole_ms_until(deadline_ns);
      if (wait_ms == 0) break;
    }
    if (reports > 0) {
      read.status = TransportStatus::kOk;
      read.skipped = reports - 1;
    }
    return read;
  }

  TransportStatus write(std::span<const std::byte> report) noexcept override {
    if (lost_) return TransportStatus::kLost;
    std::array<unsigned char, kReportCapacity + 1> message{};  // report id 0 in front
    const std::size_t used = std::min(report.size(), kReportCapacity);
    std::memcpy(message.data() + 1, report.data(), used);
    const std::size_t size = 1 + std::max(used, message_size_);
    // The kernel would send a message of another length, but the arm would discard it silently.
    if (size != 1 + out_bytes_) return TransportStatus::kRefused;
    for (int i = 0; i <= kInterruptionsMax; ++i) {
      errno = 0;
      if (hid_write(device_, message.data(), size) >= 0) return TransportStatus::kOk;
      if (errno != EINTR) break;
    }
    // A stalled or silent endpoint means that the arm refuses; only a missing device is lost.
    if (errno != ENODEV && errno != EIO && errno != ESHUTDOWN && errno != EBADF) {
      return TransportStatus::kRefused;
    }
    lost_ = true;
    return TransportStatus::kLost;
  }

 private:
  // Max. number of signals that may interrupt one read or write. [chosen: more than a timer sends
  // in a tick]
  static constexpr int kInterruptionsMax = 16;

  /// hidapi waits in whole milliseconds: rounded down, to keep the deadline.
  int whole_ms_until(std::int64_t deadline_ns) const noexcept {
    return static_cast<int>(
        std::clamp<std::int64_t>((deadline_ns - clock_.now_ns()) / 1'000'000, 0, 60'000));
  }

  const Clock& clock_;
  hid_device* device_;
  NodeLock lock_;
  std::size_t message_size_;
  std::size_t out_bytes_;  // length of a message in the arm's descriptor
  bool lost_ = false;
};

/// Reads the report descriptor of an open node; empty if it is not a HID device.
std::optional<HidReports> query_reports(int file) {
  int size = 0;
  hidraw_report_descriptor descriptor{};
  if (ioctl(file, HIDIOCGRDESCSIZE, &size) < 0 || size <= 0) return std::nullopt;
  descriptor.size = std::min<__u32>(static_cast<__u32>(size), HID_MAX_DESCRIPTOR_SIZE);
  if (ioctl(file, HIDIOCGRDESC, &descriptor) < 0) return std::nullopt;
  return read_hid_descriptor(
      std::as_bytes(std::span(descriptor.value)
                        .first(std::min<std::size_t>(descriptor.size, HID_MAX_DESCRIPTOR_SIZE))));
}

}  // namespace

Result<std::unique_ptr<Transport>> open_hid_transport(const std::string& node,
                                                      std::size_t message_size,
                                                      const Clock& clock) {
  auto lock = NodeLock::take(node);
  if (!lock) return lock.error();
  const auto reports = query_reports(lock->file());
  if (!reports)
    return Error{node + " is not a usable HID device. Check the node with `thimble devices`."};
  if (message_size > 0 && reports->out_bytes != message_size) {
    return Error{node + " takes messages of " + std::to_string(reports->out_bytes) +
                 " bytes, but this arm's are " + std::to_string(message_size) +
                 " long, so the board would discard them. The board differs from the one in the "
                 "arm file; see `thimble devices`."};
  }
  hid_device* device = hid_open_path(node.c_str());
  if (device == nullptr)
    return Error{node + " is not a usable HID device. Check the node with `thimble devices`."};
  return std::unique_ptr<Transport>(std::make_unique<HidTransport>(
      device, std::move(lock).value(), std::min(message_size, kReportCapacity), reports->out_bytes,
      clock));
}

}  // namespace thimble::driver

#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <optional>
#include <utility>

#include "thimble/driver/arm.h"
#include "thimble/driver/transports.h"
#include "transports/node_lock.h"
#include "transports/stream_transport.h"

namespace thimble::driver {
namespace {

class SerialTransport final : public StreamTransport {
 public:
  SerialTransport(NodeLock lock, const Framing& framing, const Clock& clock) noexcept
      : StreamTransport(clock, framing), lock_(std::move(lock)), file_(lock_.file()) {}
  ~SerialTransport() override {
    // The last message is the zero force. It must leave before the port closes, but an arm that
    // accepts nothing must not block (tcdrain would, and so would close).
    int waiting = 0;
    for (int ms = 0; ms < 100 && ioctl(file_, TIOCOUTQ, &waiting) == 0 && waiting > 0; ++ms) {
      timespec time{.tv_sec = 0, .tv_nsec = 1'000'000};
      while (nanosleep(&time, &time) != 0 && errno == EINTR) {
      }
    }
    tcflush(file_, TCOFLUSH);
  }

 private:
  TransportStatus pump(std::int64_t wait_ns) noexcept override {
    if (wait_ns > 0) {
      pollfd port{.fd = file_, .events = POLLIN, .revents = 0};
      const timespec time{.tv_sec = wait_ns / 1'000'000'000, .tv_nsec = wait_ns % 1'000'000'000};
      // The caller, which has the deadline, resumes a wait that a signal interrupted.
      if (ppoll(&port, 1, &time, nullptr) <= 0) return TransportStatus::kOk;
    }
    // A full port holds 4 kB (a page per tty buffer); with more than that per call it is not a
    // serial port.
    constexpr int kReadsMax = 16;
    std::array<std::byte, 256> bytes;
    for (int i = 0; i < kReadsMax; ++i) {
      const ssize_t count = read(file_, bytes.data(), bytes.size());
      if (count > 0) {
        finder().push(std::span<const std::byte>(bytes).first(static_cast<std::size_t>(count)));
        continue;
      }
      if (count < 0 && errno == EINTR) continue;
      if (count < 0 && errno == EAGAIN) return TransportStatus::kOk;
      return TransportStatus::kLost;  // end of file or an error: the port is gone
    }
    return TransportStatus::kOk;
  }

  TransportStatus put(std::span<const std::byte> bytes) noexcept override {
    // A partly sent message is completed first: the arm would read the part and the next message as
    // one, and take neither.
    if (rest_size_ > 0) {
      const auto rest = std::span<const std::byte>(rest_).first(rest_size_);
      const std::size_t size = put_some(rest);
      std::copy(rest.begin() + static_cast<std::ptrdiff_t>(size), rest.end(), rest_.begin());
      rest_size_ -= size;
      if (rest_size_ > 0) return gone_ ? TransportStatus::kLost : TransportStatus::kRefused;
    }
    const std::size_t size = put_some(bytes);
    if (size == bytes.size()) return TransportStatus::kOk;
    if (gone_) return TransportStatus::kLost;
    if (size > 0) {
      rest_size_ = std::min(bytes.size() - size, rest_.size());
      std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(size), rest_size_, rest_.begin());
    }
    return TransportStatus::kRefused;
  }

  TransportStatus settled() noexcept override {
    if (rest_size_ > 0) return gone_ ? TransportStatus::kLost : TransportStatus::kRefused;
    int waiting = 0;
    const bool answered = ioctl(file_, TIOCOUTQ, &waiting) == 0;
    if (!answered) return TransportStatus::kLost;
    return waiting > 0 ? TransportStatus::kNothing : TransportStatus::kOk;
  }

  /// Writes as many bytes as the port accepts now; returns their number.
  std::size_t put_some(std::span<const std::byte> bytes) noexcept {
    // Max. number of signals that may interrupt the write. [chosen: more than a timer sends in a
    // tick]
    constexpr int kInterruptionsMax = 16;
    for (int i = 0; i <= kInterruptionsMax; ++i) {
      const ssize_t count = ::write(file_, bytes.data(), bytes.size());
      if (count >= 0) return static_cast<std::size_t>(count);
      if (errno == EAGAIN) return 0;
      if (errno != EINTR) {
        gone_ = true;
        return 0;
      }
    }
    return 0;
  }

  NodeLock lock_;  // holds and closes the port itself
  int file_;
  std::array<std::byte, kReportCapacity> rest_{};  // rest of a partly sent message
  std::size_t rest_size_ = 0;
  bool gone_ = false;  // a write failed permanently
};

/// Returns the setting of a bit rate; empty if the kernel has none.
std::optional<speed_t> speed_of(int baud) {
  constexpr std::pair<int, speed_t> kSpeeds[] = {
      {1200, B1200},       {2400, B2400},       {4800, B4800},       {9600, B9600},
      {19200, B19200},     {38400, B38400},     {57600, B57600},     {115200, B115200},
      {230400, B230400},   {460800, B460800},   {500000, B500000},   {921600, B921600},
      {1000000, B1000000}, {1500000, B1500000}, {2000000, B2000000}, {3000000, B3000000},
      {4000000, B4000000}};
  for (const auto& [rate, speed] : kSpeeds) {
    if (rate == baud) return speed;
  }
  return std::nullopt;
}

}  // namespace

Result<std::unique_ptr<Transport>> open_serial_transport(const std::string& node,
                                                         const Framing& framing, const Clock& clock,
                                                         int baud) {
  const auto speed = speed_of(baud);
  if (!speed) {
    return Error{node + ": serial ports have no bit rate of " + std::to_string(baud) +
                 ". Use a usual one, for example 115200 or 1000000."};
  }
  // The lock excludes programs that check it, TIOCEXCL those that do not (unless root runs them).
  auto lock = NodeLock::take(node);
  if (!lock) return lock.error();
  const int file = lock->file();
  termios settings{};
  if (tcgetattr(file, &settings) != 0)
    return Error{node + " is not a serial port. Check the node with `thimble devices`."};
  cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  cfsetspeed(&settings, *speed);  // USB serial boards ignore it [S woodenhaptics firmware]
  if (tcsetattr(file, TCSANOW, &settings) != 0 || ioctl(file, TIOCEXCL) != 0) {
    return Error{node + " cannot be set up (" + std::strerror(errno) +
                 "). Check that the arm is plugged in."};
  }
  tcflush(file, TCIOFLUSH);
  return std::unique_ptr<Transport>(
      std::make_unique<SerialTransport>(std::move(lock).value(), framing, clock));
}

}  // namespace thimble::driver

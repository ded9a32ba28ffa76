#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <utility>

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
    // The last message is the zero force: let it out before the port closes, but do not hang on an
    // arm that takes nothing (tcdrain would, and so would close).
    int waiting = 0;
    for (int ms = 0; ms < 100 && ioctl(file_, TIOCOUTQ, &waiting) == 0 && waiting > 0; ++ms) {
      const timespec time{.tv_sec = 0, .tv_nsec = 1'000'000};
      nanosleep(&time, nullptr);
    }
    tcflush(file_, TCOFLUSH);
  }

 private:
  TransportStatus pump(std::int64_t wait_ns) noexcept override {
    if (wait_ns > 0) {
      pollfd port{.fd = file_, .events = POLLIN, .revents = 0};
      const timespec time{.tv_sec = wait_ns / 1'000'000'000, .tv_nsec = wait_ns % 1'000'000'000};
      if (ppoll(&port, 1, &time, nullptr) <= 0) return TransportStatus::kOk;
    }
    // A full port holds 4 kB (a page per tty buffer); more than that per call is not a port.
    constexpr int kReadsMax = 16;
    std::array<std::byte, 256> bytes;
    for (int i = 0; i < kReadsMax; ++i) {
      const ssize_t count = read(file_, bytes.data(), bytes.size());
      if (count > 0) {
        finder().push(std::span<const std::byte>(bytes).first(static_cast<std::size_t>(count)));
        continue;
      }
      if (count < 0 && (errno == EAGAIN || errno == EINTR)) return TransportStatus::kOk;
      return TransportStatus::kLost;  // end of file or an error: the port is gone
    }
    return TransportStatus::kOk;
  }

  TransportStatus put(std::span<const std::byte> bytes) noexcept override {
    const ssize_t count = ::write(file_, bytes.data(), bytes.size());
    if (count == static_cast<ssize_t>(bytes.size())) return TransportStatus::kOk;
    // A part of a message is a torn one at the other end, which answers with an error.
    if (count >= 0 || errno == EAGAIN || errno == EINTR) return TransportStatus::kRefused;
    return TransportStatus::kLost;
  }

  NodeLock lock_;  // the port itself, which it closes
  int file_;
};

}  // namespace

Result<std::unique_ptr<Transport>> open_serial_transport(const std::string& node,
                                                         const Framing& framing,
                                                         const Clock& clock) {
  // The lock keeps out programs that look for it, TIOCEXCL those that do not (unless root runs
  // them).
  auto lock = NodeLock::take(node);
  if (!lock) return lock.error();
  const int file = lock->file();
  termios settings{};
  if (tcgetattr(file, &settings) != 0) return Error{node + " is no serial port."};
  cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  cfsetspeed(&settings, B115200);  // USB serial boards ignore it [S woodenhaptics firmware]
  if (tcsetattr(file, TCSANOW, &settings) != 0 || ioctl(file, TIOCEXCL) != 0) {
    return Error{node + " cannot be set up (" + std::strerror(errno) +
                 "). Check that the arm is plugged in."};
  }
  tcflush(file, TCIOFLUSH);
  return std::unique_ptr<Transport>(
      std::make_unique<SerialTransport>(std::move(lock).value(), framing, clock));
}

}  // namespace thimble::driver

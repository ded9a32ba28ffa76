#pragma once

#include <fcntl.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>

#include "board/port_board.h"
#include "simulated_arm.h"
#include "thimble/driver/clock.h"

namespace thimble::support {

/// Returns the text of a file.
inline std::string text_of_file(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// Returns the vintage PHANTOM's arm file with another wire: `wire` replaces its lines `protocol`,
/// `board` and `board_model`.
inline std::string phantom_with_wire(const std::string& wire) {
  std::istringstream lines(
      text_of_file(std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/arms/vintage_phantom.yaml"));
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("protocol:") || line.starts_with("board:") ||
        line.starts_with("board_model:")) {
      continue;
    }
    text += line + '\n';
  }
  return text + wire;
}

/// Replaces the only occurrence of a text.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  return at == std::string::npos ? std::string() : text.replace(at, from.size(), to);
}

/// Pseudo-terminal with one end for a test.
class PortEnd {
 public:
  PortEnd() : file_(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK)) {
    if (file_ < 0 || grantpt(file_) != 0 || unlockpt(file_) != 0) return;
    node_ = ptsname(file_);
    // Otherwise the terminal echoes what the board says until the program opens it.
    termios settings{};
    if (tcgetattr(file_, &settings) != 0) return;
    cfmakeraw(&settings);
    tcsetattr(file_, TCSANOW, &settings);
  }
  PortEnd(const PortEnd&) = delete;
  PortEnd& operator=(const PortEnd&) = delete;
  ~PortEnd() { close(file_); }

  int file() const noexcept { return file_; }
  const std::string& node() const noexcept { return node_; }

  /// Returns the bytes that the program has sent.
  std::string hear() const {
    std::string text(4096, '\0');
    const ssize_t count = ::read(file_, text.data(), text.size());
    text.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
    return text;
  }
  void say(const std::string& text) const { (void)!::write(file_, text.data(), text.size()); }

 private:
  int file_;
  std::string node_;
};

/// A simulated board that runs in real time behind a pseudo-terminal, on its own thread.
class PortServer {
 public:
  PortServer(device_sim::SimulatedArm& arm, std::shared_ptr<const driver::WireTable> wire)
      : board_(arm, std::move(wire)), thread_([this] { run(); }) {}
  ~PortServer() {
    stop_.store(true);
    thread_.join();
  }
  PortServer(const PortServer&) = delete;
  PortServer& operator=(const PortServer&) = delete;

  const std::string& node() const noexcept { return end_.node(); }
  /// Ends the server and returns its board.
  const device_sim::PortBoard& board() const noexcept { return board_; }

 private:
  void run() {
    driver::WallClock clock;
    const std::int64_t begin_ns = clock.now_ns();
    while (!stop_.load()) {
      std::array<std::byte, 512> bytes;
      board_.advance_to(clock.now_ns() - begin_ns);
      const ssize_t heard = ::read(end_.file(), bytes.data(), bytes.size());
      if (heard > 0) board_.hear(std::span(bytes).first(static_cast<std::size_t>(heard)));
      if (const std::size_t size = board_.say(bytes); size > 0) {
        (void)!::write(end_.file(), bytes.data(), size);
      }
      clock.sleep_until_ns(clock.now_ns() + 200'000);
    }
  }

  PortEnd end_;
  device_sim::PortBoard board_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace thimble::support

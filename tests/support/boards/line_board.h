#pragma once

#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <string>
#include <thread>

namespace thimble::support {

/// A board that exchanges text lines, at the far end of a pseudo-terminal. It answers every message
/// with the same counters. It never moves, so it is for tests of what happens before and after a
/// run.
class LineBoard {
 public:
  /// Starts to answer as `model`, with all counters at zero.
  explicit LineBoard(int model)
      : far_(posix_openpt(O_RDWR | O_NOCTTY)),
        answer_("[" + std::to_string(model) + ",0,0,0,0,0,0,0]\n") {
    if (far_ < 0 || grantpt(far_) != 0 || unlockpt(far_) != 0) return;
    node_ = ptsname(far_);
    thread_ = std::thread([this] { answer(); });
  }
  ~LineBoard() {
    stop_.store(true);
    if (thread_.joinable()) thread_.join();
    if (far_ >= 0) close(far_);
  }
  LineBoard(const LineBoard&) = delete;
  LineBoard& operator=(const LineBoard&) = delete;

  /// Returns the device file for a program to open; empty if this machine has no pseudo-terminals.
  const std::string& node() const { return node_; }
  /// Returns the number of received messages.
  int messages() const { return messages_.load(); }

 private:
  void answer() {
    constexpr int kWait_ms = 20;
    while (!stop_.load()) {
      pollfd waiting{far_, POLLIN, 0};
      if (poll(&waiting, 1, kWait_ms) <= 0) continue;
      std::array<char, 256> text{};
      const ssize_t size = ::read(far_, text.data(), text.size());
      if (size <= 0) {  // no program has the near end open
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        continue;
      }
      const auto lines = std::count(text.begin(), text.begin() + size, '\n');
      messages_ += static_cast<int>(lines);
      for (auto i = lines; i > 0; --i) {
        if (::write(far_, answer_.data(), answer_.size()) < 0) return;
      }
    }
  }

  int far_;
  std::string node_;
  std::string answer_;
  std::atomic<bool> stop_{false};
  std::atomic<int> messages_{0};
  std::thread thread_;
};

}  // namespace thimble::support

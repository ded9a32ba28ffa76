#pragma once

#include <algorithm>
#include <deque>
#include <vector>

#include "thimble/driver/transport.h"

namespace thimble::support {

/// Messages of a ScriptedTransport, stored outside so that they outlive the device.
struct Wire {
  std::deque<std::vector<std::byte>> to_host;  ///< Reports that are not read yet, oldest first.
  std::vector<std::vector<std::byte>> to_arm;  ///< Everything written, oldest first.
  bool lost = false;
  int refusals = 0;  ///< Number of following messages that are rejected.
  driver::TransportStatus settled = driver::TransportStatus::kOk;  ///< Result of the last message.
};

/// A wire whose far side is scripted by the test.
class ScriptedTransport final : public driver::Transport {
 public:
  explicit ScriptedTransport(Wire& wire) : wire_(wire) {}

  driver::TransportRead read_latest(std::span<std::byte> buffer, std::int64_t) noexcept override {
    if (wire_.lost) return {.status = driver::TransportStatus::kLost};
    if (wire_.to_host.empty()) return {};
    const auto newest = wire_.to_host.back();
    const auto skipped = static_cast<std::uint32_t>(wire_.to_host.size() - 1);
    wire_.to_host.clear();
    const std::size_t size = std::min(newest.size(), buffer.size());
    std::copy_n(newest.begin(), size, buffer.begin());
    return {.status = driver::TransportStatus::kOk, .size = size, .skipped = skipped};
  }

  driver::TransportStatus write(std::span<const std::byte> report) noexcept override {
    if (wire_.lost) return driver::TransportStatus::kLost;
    if (wire_.refusals > 0) {
      --wire_.refusals;
      return driver::TransportStatus::kRefused;
    }
    wire_.to_arm.emplace_back(report.begin(), report.end());
    return driver::TransportStatus::kOk;
  }

  driver::TransportStatus settled() noexcept override { return wire_.settled; }

 private:
  Wire& wire_;
};

}  // namespace thimble::support

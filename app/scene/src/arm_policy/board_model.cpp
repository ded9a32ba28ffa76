#include "arm_policy/board_model.h"

#include <array>
#include <string>

#include "arms/hfab/hfab_line.h"
#include "arms/hfab/hfab_wire.h"
#include "thimble/driver/clock.h"
#include "thimble/driver/transports.h"

namespace thimble::scene {
namespace hfab = driver::hfab;

driver::Result<int> ask_board_model(const driver::FoundArm& arm) {
  if (arm.certainty != driver::Certainty::kKnown) {
    return driver::Error{"The board " + arm.name() + " identifies itself as \"" + arm.product +
                         "\", which may be any device, so it is not asked for its model."};
  }
  driver::WallClock clock;
  auto wire = driver::open_serial_transport(arm.node, hfab::kLineFraming, clock);
  if (!wire) return wire.error();
  constexpr int kAttempts = 20;
  constexpr std::int64_t kWait_ns =
      100'000'000;  // period of the requests of the published library [S]
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    std::array<std::byte, hfab::kLineCapacity> message{};
    const std::size_t size = hfab::encode_host_line({}, message);
    (*wire)->write(std::span<const std::byte>(message).first(size));
    std::array<std::byte, driver::kReportCapacity> buffer{};
    const auto read = (*wire)->read_latest(buffer, clock.now_ns() + kWait_ns);
    if (read.status == driver::TransportStatus::kLost) break;
    const auto line = hfab::decode_arm_line(std::span<const std::byte>(buffer).first(read.size));
    if (line) return static_cast<int>(line->model);
  }
  return driver::Error{"The board " + arm.name() + " on " + arm.node +
                       " does not answer. Check its power."};
}

}  // namespace thimble::scene

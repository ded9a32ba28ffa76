#include "terms/board_model.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <string_view>

#include "thimble/driver/arms/hfab/hfab_line.h"
#include "thimble/driver/arms/hfab/hfab_wire.h"
#include "thimble/driver/clock.h"
#include "thimble/driver/transports.h"

namespace thimble::app {
namespace {

namespace hfab = driver::hfab;

/// Returns whether a product string names an arm that speaks the text lines. The published firmware
/// sets none [S forsslund/woodenhaptics], so this is for makers who do.
bool names_our_arm(std::string product) {
  std::transform(product.begin(), product.end(), product.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  constexpr std::array<std::string_view, 4> kNames = {"haptikfabriken", "hfab", "polhem",
                                                      "woodenhaptics"};
  return std::any_of(kNames.begin(), kNames.end(), [&](std::string_view name) {
    return product.find(name) != std::string::npos;
  });
}

}  // namespace

driver::Result<int> ask_board_model(const driver::FoundArm& arm) {
  const std::string product = driver::read_line(arm.sysfs / "product");
  if (!names_our_arm(product)) {
    return driver::Error{"The board " + arm.name() + " calls itself \"" + product +
                         "\", which may be anything, so it is not asked which arm it is."};
  }
  driver::WallClock clock;
  auto wire = driver::open_serial_transport(arm.node, hfab::kLineFraming, clock);
  if (!wire) return wire.error();
  constexpr int kAttempts = 20;
  constexpr std::int64_t kWait_ns = 100'000'000;  // as often as the published library asks [S]
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

}  // namespace thimble::app

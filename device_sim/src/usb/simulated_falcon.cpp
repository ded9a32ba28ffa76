#include "usb/simulated_falcon.h"

#include <algorithm>
#include <utility>

#include "arms/falcon/falcon_arm.h"
#include "arms/falcon/falcon_boot.h"
#include "usb/board_descriptions.h"
#include "usb/ftdi_bus.h"

namespace thimble::device_sim::usb {
namespace {

// The hand pulls the grip out and pushes it in; the legs pass their homes within 15 mm of the
// middle, for any rest of the path.
constexpr double kHomingReach = 0.020;  // m
constexpr double kHomingStroke = 0.5;   // s from one end to the other
// A pinch grip [M DEVICES 3].
constexpr HandSettings kHomingHand{.mass = 0.025, .stiffness = 300, .damping = 3};
constexpr std::int64_t kRest_ns = 500'000'000;  // until the grip is at rest again

// These points are finite, and their times increase.
HandPath resting_at(const Eigen::Vector3d& p_BH) {
  return HandPath::make({{0, p_BH}}).value();
}

HandPath homing_path(const Eigen::Vector3d& p_BH) {
  const Eigen::Vector3d p_BM = driver::falcon::falcon_geometry().p_BM;
  const Eigen::Vector3d out = p_BM + kHomingReach * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d in = p_BM - kHomingReach * Eigen::Vector3d::UnitZ();
  return HandPath::make({{0, p_BH},
                         {kHomingStroke, out},
                         {2 * kHomingStroke, in},
                         {3 * kHomingStroke, out},
                         {4 * kHomingStroke, p_BH}})
      .value();
}

}  // namespace

driver::Result<std::unique_ptr<SimulatedFalcon>> SimulatedFalcon::make(
    const driver::JointModel<driver::DeltaArm>& model, const SimulatedArmSettings& settings,
    HandPath path, std::vector<std::byte> firmware, std::uint64_t seed) {
  const Eigen::Vector3d p_BH = path.points().front().p_BH;
  const bool needs_homing_hand = settings.hand.stiffness == 0;
  SimulatedArmSettings homed = settings;
  if (needs_homing_hand) homed.hand = kHomingHand;
  auto falcon =
      FalconOnUsb::make(falcon_description("SIM0001"), model, homed, resting_at(p_BH), {}, seed);
  if (!falcon) return falcon.error();
  std::unique_ptr<SimulatedFalcon> arm(new SimulatedFalcon(std::move(falcon).value()));
  if (auto up = arm->bring_up(std::move(firmware), p_BH); !up) {
    return up.error();
  }
  if (needs_homing_hand) {
    if (auto taken = arm->falcon_->take_hand(settings.hand); !taken) {
      return taken.error();
    }
  }
  arm->falcon_->lead(std::move(path));
  return arm;
}

driver::Result<void> SimulatedFalcon::bring_up(std::vector<std::byte> firmware,
                                               const Eigen::Vector3d& p_BH) {
  namespace falcon = driver::falcon;
  if (firmware.empty()) firmware.assign(2 * falcon::kBlockSize, std::byte{0x5a});
  FtdiBus bus(*falcon_, 0);
  FtdiBusLine line(bus);
  const falcon::BootSettings quick{.settle_ms = 0};  // its pauses would be real time
  if (auto loaded = falcon::upload_firmware(line, firmware, quick); !loaded) {
    return loaded.error();
  }
  const std::int64_t homing_ns = bus.time_ns();
  const HandPath way = homing_path(p_BH);
  falcon_->lead(way);
  const std::int64_t end_ns =
      homing_ns + static_cast<std::int64_t>(way.points().back().time * 1e9) + kRest_ns;
  falcon::HomingState state;
  while (!state.done() && bus.time_ns() < end_ns) {
    state = falcon::home_once(line, state.homed, quick);
  }
  if (!state.done()) {
    return driver::Error{
        "The simulated Falcon was not homed. Start its hand inside the workspace."};
  }
  // The arm's frames continue from here; the hand's path begins with one of them.
  begin_ns_ = (std::max(bus.time_ns(), end_ns) / FtdiBus::kFrame_ns + 1) * FtdiBus::kFrame_ns;
  while (bus.time_ns() < begin_ns_) bus.frame([](std::span<const std::byte>) {});
  return {};
}

std::unique_ptr<driver::Transport> SimulatedFalcon::wire(driver::Clock& clock) {
  return std::make_unique<FtdiBusTransport>(*falcon_, clock, driver::falcon::kPacketFraming,
                                            begin_ns_);
}

}  // namespace thimble::device_sim::usb

#include "thimble/device_sim/usb/arm_shelf.h"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "arms/falcon/falcon_arm.h"
#include "arms/hfab/hfab_models.h"
#include "arms/hfab/hfab_report.h"
#include "arms/woody/woody_report.h"
#include "math/elementary.h"
#include "usb/board_descriptions.h"
#include "usb/falcon_on_usb.h"
#include "usb/hid_arm.h"
#include "usb/usb_description.h"

namespace thimble::device_sim::usb {
namespace {

constexpr double kMotionTime = 600;     // s
constexpr double kMotionStep = 0.02;    // s between two points of the hand's path
constexpr double kReach = 0.015;        // m
constexpr double kFalconReach = 0.020;  // m
constexpr double kPolhemMass = 0.1;     // kg at the tip [guess]
constexpr double kQuiet = 1.0;          // s at rest before the hand begins
constexpr double kTwoPi = 2 * std::numbers::pi;

/// The middle of the Polhem's workspace, m [S forsslund/hfabapi].
Eigen::Vector3d polhem_middle() {
  return {0.2045, 0, 0.0325};
}

Eigen::Vector3d offset(HandMotion motion, double reach, double time) {
  if (time <= 0) return {0, 0, 0};
  switch (motion) {
    case HandMotion::kRest:
      break;
    case HandMotion::kTap:
      return {0, 0, -reach * math::sin(kTwoPi * time)};
    case HandMotion::kStroke:
      return {0, reach * math::sin(kTwoPi * time / 2), kReach * (math::cos(kTwoPi * time / 2) - 1)};
  }
  return {0, 0, 0};
}

// Its points are finite, and their times grow.
HandPath hand_path(const Eigen::Vector3d& p_BT, HandMotion motion, double reach = kReach) {
  std::vector<HandPath::Point> points{{0, p_BT}};
  if (motion == HandMotion::kRest) return HandPath::make(points).value();
  for (int i = 0; i * kMotionStep <= kMotionTime; ++i) {
    const double time = i * kMotionStep;
    points.push_back({kQuiet + time, p_BT + offset(motion, reach, time)});
  }
  return HandPath::make(points).value();
}

// A hand in pinch grip on a PHANTOM-like arm [M DEVICES 3]; the free-running board sends a report
// in the frame after it sampled it, because it waits until the host took the last one [S
// woody-experimental main.cpp: send, then sample again].
SimulatedArmSettings settings_of_board(double tip_mass, double current_max) {
  SimulatedArmSettings settings;
  settings.plant = {.mass = tip_mass, .viscous = 0.005, .coulomb = 0.04};
  settings.hand.mass = 0.025;
  settings.hand.stiffness = 300;
  settings.hand.damping = 3;
  settings.motors.current_max = current_max;
  settings.firmware.watchdog_ns = 500'000'000;     // [S woody-experimental main.cpp: 0.5 s]
  settings.firmware.current_range_mA = INT16_MAX;  // the board clamps, it does not refuse [S]
  settings.wire.delay_in_ns = 1'000'000;
  return settings;
}

template <class AnyArm>
driver::Result<std::unique_ptr<UsbArm>> plugged(driver::Result<std::unique_ptr<AnyArm>> arm) {
  if (!arm) return arm.error();
  return {std::move(arm).value()};
}

}  // namespace

driver::Result<std::unique_ptr<UsbArm>> make_usb_arm(std::string_view name,
                                                     const ShelfOptions& options) {
  if (name == "woodenhaptics") {
    const auto model = driver::hfab::woody_model();
    const Eigen::Vector3d p_BT = model.geometry.forward(model.joint_angles({}));
    // 0.2 kg is about what links of 170 and 110 g weigh at the tip [guess].
    return plugged(HidArm::make(
        kWoodenHapticsBoard, mbed_hid_description(driver::woody::kReportSize, options.serial),
        model, settings_of_board(0.2, 3), hand_path(p_BT, options.motion), options.seed));
  }
  const auto polhem = [&](const HidBoard& board, UsbDescription description) {
    // Its home is where it is parked; the hand works in the middle of its room.
    return plugged(HidArm::make(board, std::move(description), driver::hfab::polhem_model(),
                                settings_of_board(kPolhemMass, 3),
                                hand_path(polhem_middle(), options.motion), options.seed));
  };
  if (name == "polhem") {
    return polhem(kMbed14Board, mbed_hid_description(driver::hfab::kReportSize, options.serial));
  }
  if (name == "polhem-64") {
    return polhem(kTeensy64Board, teensy_raw_hid_description(options.serial));
  }
  if (name == "falcon") {
    const Eigen::Vector3d p_BM = driver::falcon::falcon_geometry().p_BM;
    // Tip mass and friction of a Falcon are not known [DEVICES 3]; those of the PHANTOM stand in.
    const SimulatedArmSettings grip = settings_of_board(0.15, 1);
    auto falcon =
        FalconOnUsb::make(falcon_description(options.serial), grip.plant, grip.hand,
                          hand_path(p_BM, options.motion, kFalconReach), options.firmware);
    if (falcon) (*falcon)->home_when_asked();
    return plugged(std::move(falcon));
  }
  std::string names;
  for (const ShelfEntry& entry : kShelf) {
    names += (names.empty() ? "" : ", ") + std::string(entry.name);
  }
  return driver::Error{"There is no simulated USB arm '" + std::string(name) +
                       "'; there are: " + names + "."};
}

}  // namespace thimble::device_sim::usb

#include "thimble/device_sim/usb/arm_shelf.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include "thimble/device_sim/usb/falcon_on_usb.h"
#include "thimble/device_sim/usb/hid_arm.h"
#include "thimble/driver/arms/falcon/falcon_arm.h"
#include "thimble/driver/arms/hfab/hfab_models.h"

namespace thimble::device_sim::usb {
namespace {

constexpr double kMotionTime = 600;     // s
constexpr double kMotionStep = 0.02;    // s between two points of the hand's path
constexpr double kReach = 0.015;        // m
constexpr double kFalconReach = 0.020;  // m; the legs pass their homes at 15 mm
constexpr double kPolhemMass = 0.1;     // kg at the tip [guess]
constexpr double kQuiet = 1.0;          // s at rest before the hand begins
constexpr double kTwoPi = 2 * std::numbers::pi;

// Vendor-defined page and usage of the raw HID examples of mbed and Teensy, from which both boards'
// firmware grew [S mbed USBHID.cpp, Teensy usb_rawhid].
constexpr std::uint16_t kRawHidPage = 0xffab;
constexpr std::uint16_t kRawHidUsage = 0x0200;

/// Is the middle of the Polhem's workspace, m [S forsslund/hfabapi].
Eigen::Vector3d polhem_middle() {
  return {0.2045, 0, 0.0325};
}

Eigen::Vector3d offset(HandMotion motion, double reach, double time) {
  if (time <= 0) return {0, 0, 0};
  switch (motion) {
    case HandMotion::kRest:
      break;
    case HandMotion::kTap:
      return {0, 0, -reach * std::sin(kTwoPi * time)};
    case HandMotion::kStroke:
      return {0, reach * std::sin(kTwoPi * time / 2), kReach * (std::cos(kTwoPi * time / 2) - 1)};
  }
  return {0, 0, 0};
}

HandPath hand_path(const Eigen::Vector3d& p_BT, HandMotion motion, double reach = kReach) {
  std::vector<HandPath::Point> points{{0, p_BT}};
  if (motion == HandMotion::kRest) return HandPath(points);
  for (int i = 0; i * kMotionStep <= kMotionTime; ++i) {
    const double time = i * kMotionStep;
    points.push_back({kQuiet + time, p_BT + offset(motion, reach, time)});
  }
  return HandPath(points);
}

UsbDescription hid_description(std::uint16_t vendor, std::uint16_t product, std::string maker,
                               std::string name, std::string serial, std::uint8_t report_size) {
  UsbDescription d;
  d.vendor_id = vendor;
  d.product_id = product;
  d.manufacturer = std::move(maker);
  d.product = std::move(name);
  d.serial = std::move(serial);
  d.interface_class = 3;
  d.report_descriptor =
      build_raw_report_descriptor(kRawHidPage, kRawHidUsage, report_size, report_size);
  d.endpoints = {{0x81, TransferKind::kInterrupt, 64, 1}, {0x01, TransferKind::kInterrupt, 64, 1}};
  return d;
}

// A hand in pinch grip on a PHANTOM-like arm [M DEVICES 3]; the boards send a report in the frame
// after they sampled it, because they wait until the host took the last one [S woody-experimental
// main.cpp: send, then sample again].
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

}  // namespace

UsbDescription falcon_description(std::string serial) {
  UsbDescription d;
  d.vendor_id = 0x0403;
  d.product_id = 0xcb48;
  d.release = 0x0400;  // FT232BM [S libftdi tells chips apart by it]
  d.manufacturer = "FTDI";
  d.product = "FALCON HAPTIC";
  d.serial = std::move(serial);
  d.endpoints = {{FtdiChip::kInEndpoint, TransferKind::kBulk, 64, 0},
                 {FtdiChip::kOutEndpoint, TransferKind::kBulk, 64, 0}};
  return d;
}

driver::Result<std::unique_ptr<UsbArm>> make_usb_arm(std::string_view name,
                                                     const ShelfOptions& options) {
  if (name == "woodenhaptics") {
    const auto arm = driver::hfab::woody_model();
    driver::hfab::HfabModel model;
    model.geometry = arm.geometry;
    model.drives = arm.drives;
    model.encoders = arm.encoders;
    const Eigen::Vector3d p_BT = model.geometry.forward(model.joint_angles({}));
    // 0.2 kg is about what links of 170 and 110 g weigh at the tip [guess].
    return {std::make_unique<HidArm>(
        HidLayout::kWoodenHaptics,
        hid_description(0x1234, 0x0006, "mbed.org", "HID DEVICE", options.serial, 8), model,
        settings_of_board(0.2, 3), hand_path(p_BT, options.motion), options.seed)};
  }
  const auto polhem = [&](HidLayout layout, UsbDescription description) {
    // Its home is where it is parked; the hand works in the middle of its room.
    return std::make_unique<HidArm>(layout, std::move(description), driver::hfab::polhem_model(),
                                    settings_of_board(kPolhemMass, 3),
                                    hand_path(polhem_middle(), options.motion), options.seed);
  };
  if (name == "polhem") {
    return {polhem(HidLayout::kPolhem, hid_description(0x16c0, 0x0486, "Haptikfabriken", "Polhem",
                                                       options.serial, driver::hfab::kReportSize))};
  }
  if (name == "polhem-64") {
    return {polhem(HidLayout::kPolhemPadded,
                   hid_description(0x16c0, 0x0486, "Teensyduino", "Teensyduino RawHID",
                                   options.serial, driver::hfab::kPaddedReportSize))};
  }
  if (name == "falcon") {
    const Eigen::Vector3d p_BM = driver::falcon::falcon_geometry().p_BM;
    // Tip mass and friction of a Falcon are not known [DEVICES 3]; those of the PHANTOM stand in.
    const SimulatedArmSettings grip = settings_of_board(0.15, 1);
    return {std::make_unique<FalconOnUsb>(falcon_description(options.serial), grip.plant, grip.hand,
                                          hand_path(p_BM, options.motion, kFalconReach),
                                          options.firmware)};
  }
  std::string names;
  for (const ShelfEntry& entry : kShelf) {
    names += (names.empty() ? "" : ", ") + std::string(entry.name);
  }
  return driver::Error{"There is no simulated USB arm '" + std::string(name) +
                       "'; there are: " + names + "."};
}

}  // namespace thimble::device_sim::usb

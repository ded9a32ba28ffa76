#include "thimble/device_sim/usb/arm_shelf.h"

#include <cmath>
#include <numbers>
#include <utility>
#include <variant>
#include <vector>

#include "arms/falcon/falcon_arm.h"
#include "arms/hfab/hfab_models.h"
#include "arms/hfab/hfab_report.h"
#include "arms/woody/woody_report.h"
#include "math/elementary.h"
#include "usb/board_descriptions.h"
#include "usb/falcon_on_usb.h"
#include "usb/hid_arm.h"
#include "usb/hid_board.h"
#include "usb/usb_description.h"
#include "wires/wire_table.h"

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
    case HandMotion::kNone:
      break;
    case HandMotion::kTap:
      return {0, 0, -reach * math::sin(kTwoPi * time)};
    case HandMotion::kStroke:
      return {0, reach * math::sin(kTwoPi * time / 2), kReach * (math::cos(kTwoPi * time / 2) - 1)};
  }
  return {0, 0, 0};
}

/// Returns the same for an arm with one or two motors, along the axes of its tip. Away from the
/// motors, because its home pose may be folded.
Eigen::Vector3d short_offset(HandMotion motion, int motors, double time) {
  if (time <= 0) return {0, 0, 0};
  const double out = kReach * (1 - math::cos(kTwoPi * time)) / 2;
  if (motors == 1) return {out, 0, 0};
  const double aside = motion == HandMotion::kStroke ? kReach * math::sin(kTwoPi * time / 2) : 0.0;
  return {aside, out, 0};
}

// Its points are finite, and their times increase.
HandPath short_hand_path(const Eigen::Vector3d& p_BT, HandMotion motion, int motors) {
  std::vector<HandPath::Point> points{{0, p_BT}};
  const bool moves = motion == HandMotion::kTap || motion == HandMotion::kStroke;
  for (int i = 0; moves && i * kMotionStep <= kMotionTime; ++i) {
    const double time = i * kMotionStep;
    points.push_back({kQuiet + time, p_BT + short_offset(motion, motors, time)});
  }
  return HandPath::make(points).value();
}

// Its points are finite, and their times increase.
HandPath hand_path(const Eigen::Vector3d& p_BT, HandMotion motion, double reach = kReach) {
  std::vector<HandPath::Point> points{{0, p_BT}};
  if (motion == HandMotion::kRest || motion == HandMotion::kNone) {
    return HandPath::make(points).value();
  }
  for (int i = 0; i * kMotionStep <= kMotionTime; ++i) {
    const double time = i * kMotionStep;
    points.push_back({kQuiet + time, p_BT + offset(motion, reach, time)});
  }
  return HandPath::make(points).value();
}

// A hand in pinch grip on a PHANTOM-like arm [M DEVICES 3]. The free-running board sends a report
// in the frame after it sampled it, because it waits until the host has taken the last one [S
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

/// Copies the constants of another arm into a board's settings. The board keeps its delays and
/// protocol.
SimulatedArmSettings with_arm(SimulatedArmSettings board, const ShelfArm& arm) {
  const SimulatedArmSettings& own = arm.settings;
  board.plant = own.plant;
  board.hand = own.hand;
  board.motors = own.motors;
  board.drive_train = own.drive_train;
  board.weight_B = own.weight_B;
  board.gimbal = own.gimbal;
  board.firmware.wiring = own.firmware.wiring;
  board.firmware.watchdog_ns = own.firmware.watchdog_ns;
  board.firmware.missed_edges = own.firmware.missed_edges;
  return board;
}

driver::Error wrong_geometry(std::string_view name) {
  return driver::Error{"The board '" + std::string(name) +
                       "' does not match the geometry of the arm file."};
}

template <class AnyArm>
driver::Result<std::unique_ptr<UsbArm>> plugged(driver::Result<std::unique_ptr<AnyArm>> arm,
                                                HandMotion motion) {
  if (!arm) return arm.error();
  if (motion == HandMotion::kNone) (*arm)->hold_tip(false);
  return {std::move(arm).value()};
}

/// An entry of the shelf: a HID board and its arm.
struct OnBoard {
  const HidBoard& board;
  UsbDescription description;
  SimulatedArmSettings settings;
  Eigen::Vector3d p_BT;  // start of the hand's path, m
};

template <class Geometry>
driver::Result<std::unique_ptr<UsbArm>> hid_arm(OnBoard what,
                                                const driver::JointModel<Geometry>& model,
                                                const ShelfOptions& options) {
  if (options.arm && !std::holds_alternative<Geometry>(options.arm->model.geometry)) {
    return wrong_geometry(what.board.layout == HidLayout::kWoodenHaptics ? "woodenhaptics"
                                                                         : "polhem");
  }
  return plugged(HidArm::make(what.board, std::move(what.description),
                              options.arm ? driver::model_as<Geometry>(options.arm->model) : model,
                              options.arm ? with_arm(what.settings, *options.arm) : what.settings,
                              hand_path(what.p_BT, options.motion), options.seed),
                 options.motion);
}

/// Returns whether an arm is one of those with one to three motors that any board with 14-byte
/// reports can drive: its unused motors and encoders are not connected.
bool is_short(const driver::ArmModel& model) {
  return std::holds_alternative<driver::PaddleArm>(model.geometry) ||
         std::holds_alternative<driver::FiveBarArm>(model.geometry) ||
         std::holds_alternative<driver::CartesianArm>(model.geometry);
}

/// Makes such an arm; it begins in its home pose.
driver::Result<std::unique_ptr<UsbArm>> short_arm(const HidBoard& board, UsbDescription description,
                                                  const ShelfOptions& options) {
  const driver::ArmModel& model = options.arm->model;
  Eigen::Vector3d p_BT;
  Eigen::Matrix3d J_BT;
  std::visit([&](const auto& build) { build.forward(model.joint_angles({}), p_BT, J_BT); },
             model.geometry);
  if (!driver::inverse(model.geometry, p_BT)) {
    return driver::Error{
        "The home pose of the arm file is no pose of the arm. Correct home_counts."};
  }
  return plugged(
      HidArm::make(board, std::move(description), model,
                   with_arm(settings_of_board(options.arm->settings.plant.mass, 3), *options.arm),
                   short_hand_path(p_BT, options.motion, driver::motor_count(model.geometry)),
                   options.seed),
      options.motion);
}

driver::Result<std::unique_ptr<UsbArm>> falcon_arm(const ShelfOptions& options) {
  if (options.arm && !std::holds_alternative<driver::DeltaArm>(options.arm->model.geometry)) {
    return wrong_geometry("falcon");
  }
  const auto model = options.arm ? driver::model_as<driver::DeltaArm>(options.arm->model)
                                 : driver::falcon::falcon_model();
  // Tip mass and friction of a Falcon are unknown [DEVICES 3]; those of the PHANTOM are used
  // instead.
  SimulatedArmSettings settings = settings_of_board(0.15, 1);
  if (options.arm) settings = with_arm(settings, *options.arm);
  auto falcon = FalconOnUsb::make(falcon_description(options.serial), model, settings,
                                  hand_path(model.geometry.p_BM, options.motion, kFalconReach),
                                  options.firmware);
  if (falcon) (*falcon)->home_when_asked();
  return plugged(std::move(falcon), options.motion);
}

/// Makes the arm of an arm file with a described wire on HID.
driver::Result<std::unique_ptr<UsbArm>> described_arm(const ShelfOptions& options) {
  const auto wire = options.arm ? options.arm->settings.firmware.described : nullptr;
  if (!wire || wire->text.transport != driver::WireTransport::kHid || wire->report.padded > 64 ||
      wire->command.padded > 64) {
    return driver::Error{
        "The board 'described' needs an arm file with a described wire on HID, with reports of at "
        "most 64 bytes. Name it with --arm; serial boards are simulated by `thimble wire serve`."};
  }
  const HidBoard& board = wire->text.streams ? kDescribedStreamBoard : kDescribedAskBoard;
  SimulatedArmSettings settings = with_arm(settings_of_board(0.15, 1), *options.arm);
  settings.firmware.described = wire;
  const auto make =
      [&]<class Geometry>(
          const driver::JointModel<Geometry>& model) -> driver::Result<std::unique_ptr<UsbArm>> {
    Eigen::Vector3d p_BT;
    Eigen::Matrix3d J_BT;
    model.geometry.forward(model.joint_angles({}), p_BT, J_BT);
    return plugged(HidArm::make(board, described_hid_description(*wire, options.serial), model,
                                settings, hand_path(p_BT, options.motion), options.seed),
                   options.motion);
  };
  const driver::ArmModel& model = options.arm->model;
  if (std::holds_alternative<driver::SerialArm>(model.geometry)) {
    return make(driver::model_as<driver::SerialArm>(model));
  }
  if (std::holds_alternative<driver::LinkageArm>(model.geometry)) {
    return make(driver::model_as<driver::LinkageArm>(model));
  }
  return wrong_geometry("described");
}

}  // namespace

driver::Result<std::unique_ptr<UsbArm>> make_usb_arm(std::string_view name,
                                                     const ShelfOptions& options) {
  if (name == "woodenhaptics") {
    const auto model = driver::hfab::woody_model();
    // 0.2 kg is about the weight of links of 170 and 110 g at the tip [guess].
    return hid_arm({.board = kWoodenHapticsBoard,
                    .description = mbed_hid_description(driver::woody::kReportSize, options.serial),
                    .settings = settings_of_board(0.2, 3),
                    .p_BT = model.geometry.forward(model.joint_angles({}))},
                   model, options);
  }
  const auto polhem = [&](const HidBoard& board, UsbDescription description) {
    if (options.arm && is_short(options.arm->model)) {
      return short_arm(board, std::move(description), options);
    }
    // The home pose is the parking pose; the hand works in the middle of the workspace.
    return hid_arm({.board = board,
                    .description = std::move(description),
                    .settings = settings_of_board(kPolhemMass, 3),
                    .p_BT = polhem_middle()},
                   driver::hfab::polhem_model(), options);
  };
  if (name == "polhem") {
    return polhem(kMbed14Board, mbed_hid_description(driver::hfab::kReportSize, options.serial));
  }
  if (name == "polhem-64") {
    return polhem(kTeensy64Board, teensy_raw_hid_description(options.serial));
  }
  if (name == "falcon") return falcon_arm(options);
  if (name == kDescribedName) return described_arm(options);
  std::string names;
  for (const ShelfEntry& entry : kShelf) {
    names += (names.empty() ? "" : ", ") + std::string(entry.name);
  }
  return driver::Error{"Unknown simulated USB arm '" + std::string(name) +
                       "'; known arms: " + names + "."};
}

}  // namespace thimble::device_sim::usb

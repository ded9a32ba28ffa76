#include "sim/fault_rig.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <numbers>
#include <tuple>
#include <vector>

#include "arm/wire_section.h"
#include "arm_table.h"
#include "arms/falcon/falcon_packet.h"
#include "arms/hfab/hfab_models.h"
#include "arms/hfab/hfab_report.h"
#include "arms/woody/woody_report.h"
#include "support/boards/described_board.h"
#include "support/boards/line_arm.h"
#include "support/scratch.h"
#include "thimble/driver/device.h"
#include "thimble/driver/wire_link.h"
#include "thimble/scene/arm_file.h"
#include "thimble/scene/real_arm.h"
#include "thimble/scene/scene_file.h"
#include "thimble/session/recording.h"
#include "usb/ftdi_chip.h"
#include "usb/hid_arm.h"
#include "usb/usb_description.h"

namespace thimble::fault_test {
namespace {

namespace usb = device_sim::usb;
using Eigen::Vector3d;

// Soft enough for every arm, so that all get the same surface.
constexpr std::string_view kPlane =
    "  - {name: plate, plane: {normal: [0, 0, 1]}, stiffness: 300, damping: 1,\n"
    "     effects: [{friction: bristle, coefficient: 0.5}]}\n";
// The lowest of the declared max. stiffnesses of the arms.
constexpr std::string_view kStiffPlane =
    "  - {name: plate, plane: {normal: [0, 0, 1]}, stiffness: 800, damping: 1,\n"
    "     effects: [{friction: bristle, coefficient: 0.5}]}\n";
constexpr std::string_view kDent =
    "  - {name: ball, mesh: soft_coarse.off, position: [0, 0, -0.04], stiffness: 60, damping: "
    "0.5,\n"
    "     contact: {tracker: offset},\n"
    "     body: {dent: {mass: 0.002, stiffness: 30, neighbour_stiffness: 15, damping: 0.1,\n"
    "                   region: whole, pull: 0.5}}}\n";

scene::Scene read(const TestedArm& tested, Phase phase, bool stiff) {
  const auto folder = support::scratch_folder();
  const auto source = std::filesystem::path(THIMBLE_SOURCE_DIR) / "app";
  std::filesystem::copy_file(source / "scenes/soft_coarse.off", folder / "soft_coarse.off",
                             std::filesystem::copy_options::skip_existing);
  const auto arm = source / "arms" / (std::string(tested.file) + ".yaml");
  std::ofstream(folder / "fault.yaml")
      << "name: fault\narm: " << std::filesystem::relative(arm, folder).string()
      << "\nduration: 1\nobjects:\n"
      << (phase == Phase::kDeforming ? kDent
          : stiff                    ? kStiffPlane
                                     : kPlane)
      << "hand: {path: [{t: 0, at: [0, 0, 0]}]}\n";
  auto scene = scene::load_scene(folder / "fault.yaml");
  if (!scene) {
    ADD_FAILURE() << scene.error().message;
    return {};
  }
  return std::move(scene).value();
}

/// Plans the hand's path in the world: down in 0.15 s, unless it stays free, and back and forth at
/// 0.2 m/s from 0.2 s on, unless it rests.
std::vector<device_sim::HandPath::Point> hand_way(Phase phase, const scene::ArmFile& file) {
  constexpr double kStep = 0.005, kEnd = 2;  // s
  std::vector<device_sim::HandPath::Point> points;
  for (int i = 0; i * kStep <= kEnd; ++i) {
    const double time = i * kStep;
    const double share = std::min(time / 0.15, 1.0);
    const bool down = phase != Phase::kFree;
    Vector3d p_WH(0, 0, 0.02 - (down ? 0.028 : 0.0) * share * share * (3 - 2 * share));
    if (phase != Phase::kContact && time > 0.2) {
      p_WH.y() = 0.015 * std::sin(2 * std::numbers::pi * 2 * (time - 0.2));
    }
    points.push_back({time, file.R_WB.transpose() * (p_WH - file.p_WB)});
  }
  return points;
}

}  // namespace

FaultRig::FaultRig(const TestedArm& tested, Phase phase, const device_sim::WiringSettings& wiring)
    : tested_(tested), phase_(phase) {
  // Scenes are cached because reading one takes longer than running it.
  static std::map<std::tuple<std::string_view, bool, bool>, scene::Scene> read_before;
  const bool stiff = wiring.motor_gain == Vector3d(-1, -1, -1);
  const std::tuple key(tested.file, phase == Phase::kDeforming, stiff);
  if (!read_before.contains(key)) read_before.emplace(key, read(tested, phase, stiff));
  scene::Scene& scene = read_before.at(key);
  file_ = scene.arms.front().arm;
  file_.simulated.firmware.wiring = wiring;
  if (tested.kind == driver::ArmKind::kDescribed) {
    auto wire = scene::load_wire(std::filesystem::path(THIMBLE_SOURCE_DIR) /
                                 "tests/data/wires/checked_serial.yaml");
    if (!wire) {
      ADD_FAILURE() << wire.error().message;
      return;
    }
    file_.wire = *wire;
  }
  file_.limits.soft_start = 0.05;  // the tests concern the time after the soft start
  auto objects = scene::SceneObjects::build(scene);
  if (!objects) {
    ADD_FAILURE() << objects.error().message;
    return;
  }
  objects_ = std::move(objects).value();
  build_arm();
  watch_.emplace(*arm_);
  cable_.emplace(*watch_, 7);
}

FaultRig::~FaultRig() = default;

void FaultRig::build_arm() {
  device_sim::HandPath path = device_sim::HandPath::make(hand_way(phase_, file_)).value();
  const auto serial = [&] { return driver::model_as<driver::SerialArm>(file_.model); };
  if (tested_.kind == driver::ArmKind::kFalcon) {
    auto falcon = usb::SimulatedFalcon::make(driver::model_as<driver::DeltaArm>(file_.model),
                                             file_.simulated, std::move(path), {});
    ASSERT_TRUE(falcon) << falcon.error().message;
    falcon_ = std::move(falcon).value();
    falcon_->home_when_asked();
    falcon_->set_watchdog(0);  // none is known, so no promise may depend on one
    arm_ = &falcon_->on_bus();
    return;
  }
  if (tested_.kind == driver::ArmKind::kHfabLine) {
    device_sim::SimulatedArmSettings settings = file_.simulated;
    settings.firmware.protocol = tested_.kind;
    settings.firmware.line_model = file_.board_model;
    own_arm_ = std::make_unique<support::LineArm>(
        device_sim::SimulatedArm::make(serial(), settings, std::move(path)).value());
  } else if (tested_.kind == driver::ArmKind::kDescribed) {
    device_sim::SimulatedArmSettings settings = file_.simulated;
    settings.firmware.protocol = tested_.kind;
    settings.firmware.described = file_.wire;
    own_arm_ = std::make_unique<support::DescribedBoard>(
        device_sim::SimulatedArm::make(serial(), settings, std::move(path)).value(), file_.wire);
  } else if (file_.is<driver::LinkageArm>()) {
    own_arm_ = usb::HidArm::make(usb::kMbed14Board, usb::UsbDescription(),
                                 driver::model_as<driver::LinkageArm>(file_.model), file_.simulated,
                                 std::move(path))
                   .value();
  } else {
    const auto& board =
        tested_.kind == driver::ArmKind::kWoody ? usb::kWoodenHapticsBoard : usb::kMbed14Board;
    own_arm_ =
        usb::HidArm::make(board, usb::UsbDescription(), serial(), file_.simulated, std::move(path))
            .value();
  }
  arm_ = own_arm_.get();
}

support::BusWire::Way FaultRig::way() const {
  support::BusWire::Way way;
  switch (tested_.kind) {
    case driver::ArmKind::kFalcon:
      way.in = usb::FtdiChip::kInEndpoint;
      way.out = usb::FtdiChip::kOutEndpoint;
      way.framing = driver::falcon::kPacketFraming;
      way.ftdi = true;
      way.begin_ns = falcon_->begin_ns();
      break;
    case driver::ArmKind::kHfabLine:
      way.out = support::LineArm::kOut;
      way.framing = driver::hfab::kLineFraming;
      break;
    case driver::ArmKind::kDescribed:
      way.out = support::DescribedBoard::kOut;
      way.framing = driver::Framing{.described = &file_.wire->report};
      break;
    case driver::ArmKind::kWoody:
      way.report_size = driver::woody::kReportSize;
      break;
    default:
      way.report_size = driver::hfab::kReportSize;
  }
  return way;
}

driver::Result<void> FaultRig::open() {
  // A Falcon that lost its home by a fault is homed by its hand, which takes up to two seconds.
  const std::int64_t timeout_ns = falcon_ ? 4'000'000'000 : 1'000'000'000;
  auto device =
      driver::Device::open(std::make_unique<driver::WireLink>(
                               std::make_unique<support::BusWire>(*cable_, clock_, way()),
                               driver::make_arm(tested_.kind, file_.model, file_.wire.get())),
                           scene::device_settings(file_, 1000), clock_.now_ns(), timeout_ns);
  if (!device) return device.error();
  device_ = std::move(device).value();
  return device_->activate();
}

void FaultRig::record(const std::filesystem::path& path) {
  session::RecordingInfo info;
  info.scene = "fault";
  info.rate = 1000;
  auto recorder = session::Recorder::open(path, info, 10'000, true);
  ASSERT_TRUE(recorder) << recorder.error().message;
  recorder_ = std::move(recorder).value();
  recording_ = path;
}

std::uint64_t FaultRig::recorded() {
  if (!recorder_) return 0;
  EXPECT_TRUE(recorder_->finish());
  recorder_.reset();
  const auto recording = session::read_recording(recording_);
  EXPECT_TRUE(recording) << recording.error().message;
  return recording ? recording->ticks.size() : 0;
}

void FaultRig::tick(bool law_broken) {
  clock_.sleep_until_ns((clock_.now_ns() / kPeriod_ns + 1) * kPeriod_ns);
  const std::int64_t now_ns = clock_.now_ns() - stepped_back_ns_;
  const driver::DeviceState& state = device_->read(now_ns, now_ns);
  // A lost link is not read any more, so the frames pass here.
  if (device_->lost()) let_frames_pass();
  driver::ForceCommand command = objects_->touch()(state);
  depth_ = command.touch.in_contact ? command.touch.depth : 0;
  if (law_broken) command.f_T_W.y() = std::numeric_limits<double>::quiet_NaN();
  device_->write(command);
  ++ticks_;
  const double force = device_->f_sent_W().norm();
  within_limit_ = within_limit_ && force <= file_.limits.force_max + 1e-9;  // false for NaN
  if (recorder_) {
    driver::TickRecord record;
    record.tick = state.tick;
    record.time_ns = state.time_ns;
    record.stage = device_->stage();
    record.fault = device_->fault();
    record.link = device_->link_state();
    record.home_needed = device_->home_needed();
    (*recorder_)(record);
  }
}

void FaultRig::restart_board(int frames) {
  arm_->restart_board();
  const std::string silent = " for=" + std::to_string(frames);
  cable_->order(*usb::parse_fault("silence in" + silent));
  cable_->order(*usb::parse_fault("lost out" + silent));
}

void FaultRig::end() {
  device_->deactivate();
  if (!device_->zero_assured()) device_->insist_on_zero(clock_);
}

void FaultRig::pass_frame() {
  clock_.sleep_until_ns((clock_.now_ns() / kPeriod_ns + 1) * kPeriod_ns);
  let_frames_pass();
}

void FaultRig::let_frames_pass() {
  const std::int64_t begin_ns = falcon_ ? falcon_->begin_ns() : 0;
  cable_->advance_to(begin_ns + clock_.now_ns());
}

}  // namespace thimble::fault_test

#include "thimble/scene/arm_simulation.h"

#include <fmt/format.h>

#include "arm_table.h"
#include "arms/falcon/falcon_boot.h"
#include "board/sim_transport.h"
#include "hand/place_text.h"
#include "thimble/driver/wire_link.h"
#include "usb/simulated_falcon.h"

namespace thimble::scene {
namespace {

/// Returns the point of the arm's workspace closest to a point in the world.
Eigen::Vector3d in_workspace(const ArmFile& file, const Eigen::Vector3d& p_W) {
  return p_W.cwiseMax(file.workspace.min_W).cwiseMin(file.workspace.max_W);
}

Eigen::Vector3d in_base(const ArmFile& file, const Eigen::Vector3d& p_W) {
  return file.R_WB.transpose() * (p_W - file.p_WB);
}

/// Converts the path of the hand from the world into the frame of the base.
driver::Result<device_sim::HandPath> path_in_base(const HandRoute& hand_W, const ArmFile& file) {
  std::vector<device_sim::HandPath::Point> points;
  points.reserve(hand_W.size());
  for (const auto& [time, p_WH] : hand_W) {
    points.push_back({.time = time, .p_BH = in_base(file, p_WH)});
  }
  return device_sim::HandPath::make(std::move(points));
}

/// Returns the simulation settings of an arm file, with protocol and model number of its board.
device_sim::SimulatedArmSettings settings_of(const ArmFile& file) {
  device_sim::SimulatedArmSettings settings = file.simulated;
  settings.firmware.protocol = file.protocol;
  settings.firmware.line_model = file.board_model;
  return settings;
}

}  // namespace

ArmSimulation::ArmSimulation(const ArmFile& file, const device_sim::HandPath& path,
                             const std::filesystem::path& firmware)
    : file_(file), firmware_(firmware), path_(std::make_unique<const device_sim::HandPath>(path)) {}
ArmSimulation::~ArmSimulation() = default;

std::optional<Eigen::Vector3d> joint_angles_at(const ArmFile& file, const Eigen::Vector3d& p_WT) {
  return driver::inverse(file.model.geometry, in_base(file, p_WT));
}

driver::Result<void> check_reach(const ArmFile& file, const HandRoute& hand_W) {
  for (const auto& [time, p_WH] : hand_W) {
    if (!file.workspace.holds(p_WH) || !joint_angles_at(file, p_WH)) {
      return driver::Error{
          fmt::format("At {:.3f} s the hand would be at {} m, which the arm does not reach "
                      "within its workspace; move that waypoint or the object.",
                      time, place_text(p_WH, 3))};
    }
  }
  return {};
}

driver::Result<std::unique_ptr<ArmSimulation>> ArmSimulation::make(
    const ArmFile& file, const HandRoute& hand_W, const std::filesystem::path& firmware,
    std::uint64_t seed) {
  if (file.is<driver::VendorPoseArm>()) {
    return driver::Error{"The arm " + file.name +
                         " is driven by its vendor's software, so it cannot be simulated. Start "
                         "that software and name the arm with --device (thimble devices), or name "
                         "another arm with --arm."};
  }
  if (!file.can_simulate) {
    return driver::Error{"The arm file " + file.name +
                         " has no section 'simulation', so the arm cannot be simulated. Add one "
                         "(see app/arms/vintage_phantom.yaml), or plug the arm in."};
  }
  const auto path = path_in_base(hand_W, file);
  if (!path) return driver::Error{file.name + ": " + path.error().message};
  return build(file, *path, firmware, seed);
}

driver::Result<std::unique_ptr<ArmSimulation>> ArmSimulation::another(std::uint64_t seed) const {
  return build(file_, *path_, firmware_, seed);
}

driver::Result<std::unique_ptr<ArmSimulation>> ArmSimulation::build(
    const ArmFile& file, const device_sim::HandPath& path, const std::filesystem::path& firmware,
    std::uint64_t seed) {
  std::unique_ptr<ArmSimulation> simulation(new ArmSimulation(file, path, firmware));
  const auto wrong = [&file](const driver::Error& error) {
    return driver::Error{file.name + ": " + error.message};
  };
  if (file.is<driver::DeltaArm>()) {
    std::vector<std::byte> image;
    if (!firmware.empty()) {
      auto read = driver::falcon::read_firmware(firmware);
      if (!read) return read.error();
      image = std::move(read).value();
    }
    auto falcon =
        device_sim::usb::SimulatedFalcon::make(driver::model_as<driver::DeltaArm>(file.model),
                                               file.simulated, path, std::move(image), seed);
    if (!falcon) return wrong(falcon.error());
    simulation->falcon_ = std::move(falcon).value();
    simulation->falcon_->set_watchdog(file.simulated.firmware.watchdog_ns);
    return simulation;
  }
  const device_sim::SimulatedArmSettings settings = settings_of(file);
  auto arm = file.is<driver::LinkageArm>()
                 ? device_sim::SimulatedArm::make(driver::model_as<driver::LinkageArm>(file.model),
                                                  settings, path, seed)
                 : device_sim::SimulatedArm::make(driver::model_as<driver::SerialArm>(file.model),
                                                  settings, path, seed);
  if (!arm) return wrong(arm.error());
  simulation->board_arm_ = std::make_unique<device_sim::SimulatedArm>(std::move(arm).value());
  return simulation;
}

std::unique_ptr<driver::ArmLink> ArmSimulation::link(driver::Clock& clock) {
  std::unique_ptr<driver::Transport> wire;
  if (falcon_) {
    wire = falcon_->wire(clock);
  } else {
    wire = std::make_unique<device_sim::SimTransport>(clock, *board_arm_);
  }
  auto arm = file_.simulated.firmware.ideal_encoders && !falcon_
                 ? driver::make_ideal_arm(file_.model)
                 : driver::make_arm(file_.protocol, file_.model);
  return std::make_unique<driver::WireLink>(std::move(wire), std::move(arm));
}

device_sim::Hand& ArmSimulation::hand() noexcept {
  return falcon_ ? falcon_->hand() : board_arm_->hand();
}

void ArmSimulation::hold(bool still) noexcept {
  hand().hold(still);
}

void ArmSimulation::settle(std::int64_t now_ns) noexcept {
  constexpr std::int64_t kFrames_ns = 2'000'000;  // one frame to the converter, and one on its line
  if (falcon_) {
    falcon_->advance_to(now_ns + kFrames_ns);
  } else {
    board_arm_->advance_to(now_ns + file_.simulated.wire.delay_out_ns);
  }
}

bool ArmSimulation::lead(const Eigen::Vector3d& p_WH) noexcept {
  if (!reaches(p_WH)) return false;
  hand().lead(in_base(file_, in_workspace(file_, p_WH)));
  return true;
}

bool ArmSimulation::reaches(const Eigen::Vector3d& p_WH) const noexcept {
  return p_WH.allFinite() && joint_angles_at(file_, in_workspace(file_, p_WH));
}

Eigen::Vector3d ArmSimulation::currents() const {
  return falcon_ ? falcon_->arm().truth().currents : board_arm_->firmware().currents();
}

Eigen::Vector3d ArmSimulation::f_T_W() const {
  return file_.R_WB * (falcon_ ? falcon_->arm().plant().f_T_B() : board_arm_->plant().f_T_B());
}

std::optional<Eigen::Vector3d> ArmSimulation::winding_rise() const {
  if (!board_arm_ || !file_.simulated.drive_train.heat.named()) return std::nullopt;
  return board_arm_->plant().winding_rise();
}

}  // namespace thimble::scene

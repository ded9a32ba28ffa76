#include "thimble/scene/arm_simulation.h"

#include <stdexcept>

#include "thimble/driver/arm_table.h"
#include "thimble/driver/arms/falcon/falcon_boot.h"
#include "thimble/driver/wire_link.h"

namespace thimble::scene {
namespace {

Eigen::Vector3d in_base(const ArmFile& file, const Eigen::Vector3d& p_W) {
  return file.R_WB.transpose() * (p_W - file.p_WB);
}

/// Turns the hand's way from the world into the arm's base. Throws what HandPath throws.
device_sim::HandPath path_in_base(const std::vector<std::pair<double, Eigen::Vector3d>>& hand_W,
                                  const ArmFile& file) {
  std::vector<device_sim::HandPath::Point> points;
  points.reserve(hand_W.size());
  for (const auto& [time, p_WH] : hand_W) {
    points.push_back({.time = time, .p_BH = in_base(file, p_WH)});
  }
  return device_sim::HandPath(std::move(points));
}

/// Sets what the board of a file's arm speaks.
device_sim::SimulatedArmSettings settings_of(const ArmFile& file) {
  device_sim::SimulatedArmSettings settings = file.simulated;
  settings.firmware.speaks = file.protocol;
  settings.firmware.line_model = file.board_model;
  return settings;
}

}  // namespace

std::optional<Eigen::Vector3d> joint_angles_at(const ArmFile& file, const Eigen::Vector3d& p_WT) {
  return driver::inverse(file.model.geometry, in_base(file, p_WT));
}

driver::Result<std::unique_ptr<ArmSimulation>> ArmSimulation::make(
    const ArmFile& file, const std::vector<std::pair<double, Eigen::Vector3d>>& hand_W,
    const std::filesystem::path& firmware, std::uint64_t seed) {
  if (!file.can_simulate) {
    return driver::Error{"The arm file " + file.name +
                         " has no section 'simulation', so the arm cannot be simulated. Add one "
                         "(app/arms/vintage_phantom.yaml shows it), or plug the arm in."};
  }
  std::unique_ptr<ArmSimulation> simulation(new ArmSimulation(file));
  try {
    device_sim::HandPath path = path_in_base(hand_W, file);
    if (file.is<driver::SerialArm>()) {
      simulation->board_arm_.emplace(driver::model_as<driver::SerialArm>(file.model),
                                     settings_of(file), std::move(path), seed);
    } else if (file.is<driver::LinkageArm>()) {
      simulation->board_arm_.emplace(driver::model_as<driver::LinkageArm>(file.model),
                                     settings_of(file), std::move(path), seed);
    } else {
      std::vector<std::byte> image;
      if (!firmware.empty()) {
        auto read = driver::falcon::read_firmware(firmware);
        if (!read) return read.error();
        image = std::move(read).value();
      }
      auto falcon = device_sim::usb::SimulatedFalcon::make(file.simulated, std::move(path),
                                                           std::move(image), seed);
      if (!falcon) return falcon.error();
      simulation->falcon_ = std::move(falcon).value();
    }
  } catch (const std::invalid_argument& wrong) {
    return driver::Error{file.name + ": " + wrong.what()};
  }
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

void ArmSimulation::settle(std::int64_t now_ns) noexcept {
  constexpr std::int64_t kFrames_ns = 2'000'000;  // a frame to the converter, one on its line
  if (falcon_) {
    falcon_->advance_to(now_ns + kFrames_ns);
  } else {
    board_arm_->advance_to(now_ns + file_.simulated.wire.delay_out_ns);
  }
}

bool ArmSimulation::lead(const Eigen::Vector3d& p_WH) noexcept {
  if (!p_WH.allFinite()) return false;
  const Eigen::Vector3d p = p_WH.cwiseMax(file_.workspace.min_W).cwiseMin(file_.workspace.max_W);
  if (!joint_angles_at(file_, p)) return false;
  hand().lead(in_base(file_, p));
  return true;
}

Eigen::Vector3d ArmSimulation::currents() const {
  return falcon_ ? falcon_->arm().truth().currents : board_arm_->firmware().currents();
}

Eigen::Vector3d ArmSimulation::f_T_W() const {
  return file_.R_WB * (falcon_ ? falcon_->arm().plant().f_T_B() : board_arm_->plant().f_T_B());
}

}  // namespace thimble::scene

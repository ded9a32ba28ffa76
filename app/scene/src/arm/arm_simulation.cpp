#include "thimble/scene/arm_simulation.h"

#include <fmt/format.h>

#include "arm_table.h"
#include "arms/falcon/falcon_boot.h"
#include "board/sim_transport.h"
#include "hand/button_plan.h"
#include "hand/place_text.h"
#include "thimble/driver/joint_model.h"
#include "thimble/driver/wire_link.h"
#include "usb/simulated_falcon.h"

namespace thimble::scene {
namespace {

constexpr double kBorder = 1e-9;  // m [chosen: far less than an encoder count]

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
    points.push_back({.time = time, .p_BH = in_base(file, file.on_axes(p_WH))});
  }
  return device_sim::HandPath::make(std::move(points));
}

/// Returns the simulation settings of an arm file, with protocol and model number of its board.
device_sim::SimulatedArmSettings settings_of(const ArmFile& file) {
  device_sim::SimulatedArmSettings settings = file.simulated;
  settings.firmware.protocol = file.protocol;
  settings.firmware.line_model = file.board_model;
  settings.firmware.described = file.wire;
  return settings;
}

/// A link to a simulated arm, with the buttons that the hand holds.
class ButtonLink final : public driver::ArmLink {
 public:
  ButtonLink(std::unique_ptr<driver::WireLink> link, const driver::Clock& clock,
             std::vector<ButtonStep> steps, const std::atomic<std::uint16_t>& held)
      : link_(std::move(link)), clock_(clock), plan_(std::move(steps)), held_(held) {}

  const driver::ArmTraits& traits() const noexcept override { return link_->traits(); }
  driver::LinkRead read(driver::ArmSample& sample, std::int64_t deadline_ns) noexcept override {
    const driver::LinkRead read = link_->read(sample, deadline_ns);
    if (read.status == driver::LinkStatus::kOk) {
      sample.buttons = static_cast<std::uint16_t>(sample.buttons | planned() |
                                                  held_.load(std::memory_order_relaxed));
    }
    return read;
  }
  driver::LinkWrite write(const driver::GatedForce& force, const driver::ArmSample& sample,
                          const Eigen::Matrix3d& R_WB) noexcept override {
    return link_->write(force, sample, R_WB);
  }
  driver::LinkStatus settled() noexcept override { return link_->settled(); }
  bool numbers_reports() const noexcept override { return link_->numbers_reports(); }
  driver::MotorCurrents currents() const noexcept override { return link_->currents(); }
  void limit_currents(const std::array<driver::MotorDrive, 3>& limits) noexcept override {
    link_->limit_currents(limits);
  }

 private:
  unsigned planned() noexcept {
    return plan_.empty() ? 0U : plan_.at(1e-9 * static_cast<double>(clock_.now_ns()));
  }

  std::unique_ptr<driver::WireLink> link_;
  const driver::Clock& clock_;
  ButtonPlan plan_;
  const std::atomic<std::uint16_t>& held_;
};

}  // namespace

ArmSimulation::ArmSimulation(const ArmFile& file, const device_sim::HandPath& path,
                             const std::filesystem::path& firmware)
    : file_(file), firmware_(firmware), path_(std::make_unique<const device_sim::HandPath>(path)) {}
ArmSimulation::~ArmSimulation() = default;

std::optional<Eigen::Vector3d> joint_angles_at(const ArmFile& file, const Eigen::Vector3d& p_WT) {
  return driver::inverse(file.model.geometry, in_base(file, p_WT));
}

driver::Result<void> check_reach(const ArmFile& file, const HandRoute& hand_W) {
  for (const auto& [time, p_wanted] : hand_W) {
    const Eigen::Vector3d p_WH = file.on_axes(p_wanted);
    // A path along the border may leave the box by rounding.
    const bool inside = (in_workspace(file, p_WH) - p_WH).norm() < kBorder;
    if (!inside || !joint_angles_at(file, p_WH)) {
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
  auto built = build(file_, *path_, firmware_, seed);
  if (built) {
    (*built)->plan_buttons(buttons_);
    (*built)->buttons_allowed_ = buttons_allowed_;
  }
  return built;
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
  auto arm = device_sim::SimulatedArm::make(file.model, settings, path, seed);
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
                 : driver::make_arm(file_.protocol, file_.model, file_.wire.get());
  link_memory_.clear();
  if (!falcon_) {
    const auto add = [&](const void* begin, std::size_t size) {
      link_memory_.emplace_back(static_cast<const std::byte*>(begin), size);
    };
    add(wire.get(), sizeof(device_sim::SimTransport));
    // An arm is the model of its geometry and a pointer.
    std::visit(
        [&]<class Geometry>(const Geometry&) {
          add(arm.get(), sizeof(driver::JointModel<Geometry>) + sizeof(void*));
        },
        file_.model.geometry);
  }
  auto link = std::make_unique<driver::WireLink>(std::move(wire), std::move(arm));
  if (!falcon_) link_memory_.push_back(std::as_bytes(std::span(link.get(), 1)));
  if (buttons_.empty() && !buttons_allowed_) return link;
  return std::make_unique<ButtonLink>(std::move(link), clock, buttons_, held_buttons_);
}

device_sim::Hand& ArmSimulation::hand() noexcept {
  return falcon_ ? falcon_->hand() : board_arm_->hand();
}

void ArmSimulation::hold(bool still) noexcept {
  hand().hold(still);
}

void ArmSimulation::list_memory(std::vector<std::span<const std::byte>>& memory) const {
  if (!board_arm_) return;
  board_arm_->list_memory(memory);
  memory.insert(memory.end(), link_memory_.begin(), link_memory_.end());
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
  hand().lead(in_base(file_, in_workspace(file_, file_.on_axes(p_WH))));
  return true;
}

bool ArmSimulation::reaches(const Eigen::Vector3d& p_WH) const noexcept {
  return p_WH.allFinite() && joint_angles_at(file_, in_workspace(file_, file_.on_axes(p_WH)));
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

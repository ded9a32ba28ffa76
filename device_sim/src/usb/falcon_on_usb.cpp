#include "usb/falcon_on_usb.h"

#include <algorithm>
#include <utility>

#include "arms/falcon/falcon_arm.h"
#include "usb/setup_packet.h"
#include "usb/usb_description.h"
#include "usb/usbip_session.h"

namespace thimble::device_sim::usb {
namespace {

constexpr double kMotorValuesPerAmpere = 1000;  // as in driver::falcon::FalconArm
constexpr double kMotorValueMax = 4096;  // limit to which programs based on libnifalcon clamp [S]

}  // namespace

driver::Result<std::unique_ptr<FalconOnUsb>> FalconOnUsb::make(
    UsbDescription description, const driver::JointModel<driver::DeltaArm>& model,
    const SimulatedArmSettings& settings, HandPath path, std::vector<std::byte> image,
    std::uint64_t seed) {
  if (auto wired = settings.firmware.wiring.check(); !wired) return wired.error();
  if (!settings.weight_B.allFinite()) {
    return driver::Error{"The simulated arm's weight must be finite (N)."};
  }
  const auto tremor = Tremor::make(settings.hand, seed);
  if (!tremor) return tremor.error();
  const Eigen::Vector3d p_BT = path.points().front().p_BH;
  auto mechanics =
      DeltaPlant::make(model, settings.plant, settings.hand,
                       {.current_max = kMotorValueMax / kMotorValuesPerAmpere}, p_BT, p_BT);
  if (!mechanics) return mechanics.error();
  mechanics->set_pull(settings.weight_B);
  const auto tip = LoadedTip::make(settings.plant, settings.hand, settings.weight_B);
  if (!tip) return tip.error();
  return std::unique_ptr<FalconOnUsb>(new FalconOnUsb(std::move(description), settings, *tremor,
                                                      std::move(path), *mechanics, *tip,
                                                      std::move(image)));
}

FalconOnUsb::FalconOnUsb(UsbDescription description, const SimulatedArmSettings& settings,
                         const Tremor& tremor, HandPath path, const DeltaPlant& plant,
                         const LoadedTip& tip, std::vector<std::byte> image)
    : description_(std::move(description)),
      tremor_(tremor),
      hand_(std::move(path), tremor),
      homing_hand_(driver::falcon::falcon_geometry().p_BM),
      tip_(tip),
      wiring_(settings.firmware.wiring),
      plant_(plant),
      board_(std::move(image)),
      chip_(board_) {}

void FalconOnUsb::lead(HandPath path) {
  hand_ = Hand(std::move(path), tremor_, time_ns_);
}

driver::Result<void> FalconOnUsb::take_hand(const HandSettings& hand) {
  if (auto taken = tip_.take_hand(hand); !taken) return taken;
  plant_.take_tip(tip_.dynamics(held_));
  return {};
}

driver::Result<void> FalconOnUsb::fix_mass(double mass, const Eigen::Vector3d& gravity_B) {
  if (auto fixed = tip_.fix_mass(mass, gravity_B); !fixed) return fixed;
  plant_.take_tip(tip_.dynamics(held_));
  plant_.set_pull(tip_.pull_B());
  return {};
}

void FalconOnUsb::hold_tip(bool held) noexcept {
  wanted_held_ = held;
  put_tip();
}

void FalconOnUsb::put_tip() noexcept {
  const bool held = wanted_held_ || homing_hand_.busy();
  if (held == held_) return;
  held_ = held;
  plant_.take_tip(tip_.dynamics(held));
}

void FalconOnUsb::move_to(std::int64_t time_ns) noexcept {
  if (time_ns <= time_ns_) return;
  Eigen::Vector3d p_BH = hand_.at(time_ns);
  if (homes_) {
    p_BH = homing_hand_.at(p_BH, time_ns, board_.wants_homing());
    hand_.hold(homing_hand_.busy());
    put_tip();
  }
  plant_.step(p_BH, time_ns - time_ns_);
  time_ns_ = time_ns;
}

void FalconOnUsb::hear_line(std::int64_t dt_ns) noexcept {
  const Eigen::Vector3d exact = wiring_.inputs(plant_.exact_counts());
  board_.set_encoders({exact[0], exact[1], exact[2]});
  board_.watch(time_ns_);
  board_.host_rate(chip_.rate());
  chip_.deliver(dt_ns);
  if (board_.counters().packets != packets_) {
    truth_.messages += board_.counters().packets - packets_;
    truth_.reports = truth_.messages;  // each packet is answered
    packets_ = board_.counters().packets;
    truth_.message_ns = truth_.report_ns = time_ns_;
    truth_.exact_counts = exact;
    for (std::size_t i = 0; i < 3; ++i) {
      truth_.motor_values[i] = board_.asked().motors[i];
      truth_.counts[i] = board_.answered().counts[i];
    }
  }
  Eigen::Vector3d amperes(0, 0, 0);
  if (board_.running() && board_.motors_on()) {
    for (int i = 0; i < 3; ++i) {
      amperes[i] = board_.asked().motors[static_cast<std::size_t>(i)] / kMotorValuesPerAmpere;
    }
  }
  plant_.set_currents(wiring_.motors(amperes));
}

void FalconOnUsb::advance_to(std::int64_t time_ns) noexcept {
  while (time_ns_ < time_ns) {
    const std::int64_t dt_ns = std::min(time_ns - time_ns_, UsbDevice::kFrame_ns);
    const std::int64_t end_ns = time_ns_ + dt_ns;
    move_to(time_ns_ + chip_.line_time_ns(dt_ns));
    hear_line(dt_ns);
    move_to(end_ns);
  }
}

PacketResult FalconOnUsb::control(const SetupPacket& setup, std::span<std::byte> data) noexcept {
  return chip_.control(setup, data);
}

PacketResult FalconOnUsb::in(std::uint8_t address, std::span<std::byte> packet) noexcept {
  if (address != FtdiChip::kInEndpoint) return {Answer::kStall, 0};
  return chip_.in(time_ns_, packet);
}

PacketResult FalconOnUsb::out(std::uint8_t address, std::span<const std::byte> packet) noexcept {
  if (address != FtdiChip::kOutEndpoint) return {Answer::kStall, 0};
  return chip_.out(packet);
}

ArmTruth FalconOnUsb::truth() const noexcept {
  ArmTruth truth = truth_;
  truth.currents = plant_.currents();
  truth.p_BT = plant_.p_BT();
  truth.motors_on = board_.motors_on();
  return truth;
}

}  // namespace thimble::device_sim::usb

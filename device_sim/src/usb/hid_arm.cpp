#include "usb/hid_arm.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "arms/hfab/hfab_report.h"
#include "little_endian.h"
#include "usb/setup_packet.h"
#include "usb/usb_description.h"
#include "usb/usbip_session.h"

namespace thimble::device_sim::usb {
namespace {

using driver::get_word;
using driver::put_word;

// Requests of the HID class that a board may accept [HID 1.11, 7.2].
enum HidRequest : std::uint8_t {
  kSetReport = 0x09,
  kSetIdle = 0x0a,
};

/// Sets the protocol of the board, and encoders that the board can have.
SimulatedArmSettings on_board(SimulatedArmSettings settings, const HidBoard& board) {
  settings.firmware.protocol = board.layout == HidLayout::kDescribed ? driver::ArmKind::kDescribed
                               : board.layout == HidLayout::kWoodenHaptics
                                   ? driver::ArmKind::kWoody
                                   : driver::ArmKind::kPolhem;
  if (board.layout != HidLayout::kDescribed) settings.firmware.described = nullptr;
  settings.firmware.ideal_encoders = false;
  return settings;
}

}  // namespace

driver::Result<std::unique_ptr<HidArm>> HidArm::make(
    const HidBoard& board, UsbDescription description,
    const driver::JointModel<driver::SerialArm>& model, const SimulatedArmSettings& settings,
    HandPath path, std::uint64_t seed) {
  return make(board, std::move(description), arm_model(model), settings, std::move(path), seed);
}

driver::Result<std::unique_ptr<HidArm>> HidArm::make(
    const HidBoard& board, UsbDescription description,
    const driver::JointModel<driver::LinkageArm>& model, const SimulatedArmSettings& settings,
    HandPath path, std::uint64_t seed) {
  return make(board, std::move(description), arm_model(model), settings, std::move(path), seed);
}

driver::Result<std::unique_ptr<HidArm>> HidArm::make(const HidBoard& board,
                                                     UsbDescription description,
                                                     const driver::ArmModel& model,
                                                     const SimulatedArmSettings& settings,
                                                     HandPath path, std::uint64_t seed) {
  auto arm = SimulatedArm::make(model, on_board(settings, board), std::move(path), seed);
  if (!arm) return arm.error();
  return std::unique_ptr<HidArm>(
      new HidArm(board, std::move(description), model, settings, std::move(arm).value()));
}

HidArm::HidArm(const HidBoard& board, UsbDescription description, const driver::ArmModel& model,
               const SimulatedArmSettings& settings, SimulatedArm arm) noexcept
    : board_(board),
      wire_(board.layout == HidLayout::kDescribed ? settings.firmware.described : nullptr),
      description_(std::move(description)),
      model_(model),
      report_age_ns_(settings.wire.delay_in_ns),
      arm_(std::move(arm)) {
  keep_sample();
  if (board_.report_mode == HidReportMode::kAnswers) offer();
}

HidArm::Sample HidArm::sample_now() const noexcept {
  return {arm_.time_ns(), model_.exact_counts(arm_.plant().q())};
}

void HidArm::keep_sample() noexcept {
  const auto slot = static_cast<std::size_t>(arm_.time_ns() / UsbDevice::kFrame_ns) % kSamples;
  samples_[slot] = sample_now();
}

void HidArm::advance_to(std::int64_t time_ns) noexcept {
  // Frame by frame, so that the true encoder positions of each frame are recorded.
  while (arm_.time_ns() < time_ns) {
    const std::int64_t frame_ns =
        (arm_.time_ns() / UsbDevice::kFrame_ns + 1) * UsbDevice::kFrame_ns;
    arm_.advance_to(std::min(time_ns, frame_ns));
    if (arm_.time_ns() == frame_ns) keep_sample();
  }
}

std::size_t HidArm::lay_out(std::span<const std::byte> report,
                            std::span<std::byte> packet) noexcept {
  const std::size_t size = report_size();
  std::fill_n(packet.begin(), size, std::byte{0});
  std::copy(report.begin(), report.end(), packet.begin());
  // The board numbers the reports it sends [S], not those for which the bus had no room.
  if (board_.layout == HidLayout::kWoodenHaptics) {
    put_word(packet, 3, static_cast<std::int16_t>(counter_));
  }
  return size;
}

// A free-running board gives its last sample.
bool HidArm::newest(BoardBytes& report) noexcept {
  std::uint32_t skipped = 0;
  report.size = arm_.take_report(report.bytes, skipped);
  if (report.size == 0) return false;
  truth_.report_ns = arm_.time_ns() - report_age_ns_;
  for (const Sample& sample : samples_) {
    if (sample.time_ns == truth_.report_ns) truth_.exact_counts = sample.exact_counts;
  }
  return true;
}

// Samples the encoders; the report then waits for the host.
void HidArm::offer() noexcept {
  report_ = arm_.sample_now();
  report_sample_ = sample_now();
  offers_ = true;
}

// A board that answers gives the waiting report, then reads the message that arrived meanwhile.
bool HidArm::offered(BoardBytes& report) noexcept {
  if (!offers_) return false;
  report = report_;
  truth_.report_ns = report_sample_.time_ns;
  truth_.exact_counts = report_sample_.exact_counts;
  offers_ = false;
  if (message_waits_) {
    message_waits_ = false;
    use_message(std::span<const std::byte>(message_).first(message_size_));
    offer();
  }
  return true;
}

PacketResult HidArm::in(std::uint8_t address, std::span<std::byte> packet) noexcept {
  if (address != board_.in) {
    // An interface for debug output sends nothing.
    return {description_.endpoint(address) != nullptr ? Answer::kNak : Answer::kStall, 0};
  }
  BoardBytes report{};
  const bool any =
      board_.report_mode == HidReportMode::kFreeRunning ? newest(report) : offered(report);
  if (!any) return {Answer::kNak, 0};
  ++counter_;
  ++truth_.reports;
  note_counts(report);
  return {Answer::kDone, lay_out(report, packet)};
}

// A message of another length has no effect and does not keep the motors on.
void HidArm::use_message(std::span<const std::byte> bytes) noexcept {
  if (bytes.size() != message_size()) {
    ++malformed_;
    return;
  }
  arm_.put_message(bytes);
  ++truth_.messages;
  truth_.message_ns = arm_.time_ns();
  if (wire_) {
    driver::WireValues values;
    if (!wire_->command.read(bytes, values)) return;
    for (std::size_t i = 0; i < 3; ++i) {
      truth_.motor_values[i] = static_cast<int>(std::lround(1e3 * values.motors[i]));
    }
    return;
  }
  for (std::size_t i = 0; i < 3; ++i) truth_.motor_values[i] = get_word(bytes, i);
}

void HidArm::note_counts(std::span<const std::byte> report) noexcept {
  if (wire_) {
    driver::WireValues values;
    if (!wire_->report.read(report, values)) return;
    for (std::size_t i = 0; i < 3; ++i) truth_.counts[i] = values.encoders[i];
    return;
  }
  for (std::size_t i = 0; i < 3; ++i) truth_.counts[i] = get_word(report, i);
}

PacketResult HidArm::out(std::uint8_t address, std::span<const std::byte> packet) noexcept {
  if (address != board_.out) {
    const bool known = description_.endpoint(address) != nullptr;
    return {known ? Answer::kDone : Answer::kStall, known ? packet.size() : 0};
  }
  const PacketResult taken{Answer::kDone, packet.size()};
  if (board_.report_mode == HidReportMode::kFreeRunning) {
    use_message(packet);
    return taken;
  }
  if (!offers_) {
    use_message(packet);
    offer();
    return taken;
  }
  if (message_waits_) return {Answer::kNak, 0};
  message_size_ = std::min(packet.size(), message_.size());
  std::copy_n(packet.begin(), message_size_, message_.begin());
  message_waits_ = true;
  return taken;
}

PacketResult HidArm::control(const SetupPacket& setup, std::span<std::byte> data) noexcept {
  const bool for_hid = (setup.request_type & kKindMask) == kKindClass &&
                       (setup.request_type & 0x1fU) == kRecipientInterface && !setup.to_host();
  if (!for_hid || !board_.takes_set_idle) return {Answer::kStall, 0};
  // A Teensy accepts both without effect [S teensy3/usb_dev.c].
  if (setup.request == kSetIdle) return {Answer::kDone, 0};
  if (setup.request == kSetReport) return {Answer::kDone, data.size()};
  return {Answer::kStall, 0};
}

void HidArm::restart_board() noexcept {
  arm_.restart_board();
  offers_ = message_waits_ = false;
}

ArmTruth HidArm::truth() const noexcept {
  ArmTruth truth = truth_;
  truth.currents = arm_.plant().currents();
  truth.p_BT = arm_.plant().p_BT();
  truth.motors_on = arm_.firmware().motors_on();
  return truth;
}

}  // namespace thimble::device_sim::usb

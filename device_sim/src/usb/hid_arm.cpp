#include "thimble/device_sim/usb/hid_arm.h"

#include <algorithm>
#include <utility>

#include "thimble/device_sim/usb/usbip_session.h"
#include "thimble/driver/arms/hfab/hfab_report.h"
#include "thimble/driver/arms/woody/woody_report.h"
#include "thimble/driver/little_endian.h"

namespace thimble::device_sim::usb {
namespace {

using driver::get_word;
using driver::put_word;

constexpr std::uint8_t kInEndpoint = 0x81;

// Requests of the HID class [HID 1.11, 7.2].
enum HidRequest : std::uint8_t {
  kGetReport = 0x01,
  kGetIdle = 0x02,
  kSetReport = 0x09,
  kSetIdle = 0x0a,
};
constexpr std::uint8_t kInputReport = 1;
constexpr std::uint8_t kOutputReport = 2;

}  // namespace

HidArm::HidArm(HidLayout layout, UsbDescription description, const driver::hfab::HfabModel& model,
               const SimulatedArmSettings& settings, HandPath path, std::uint64_t seed)
    : layout_(layout),
      description_(std::move(description)),
      model_(model),
      report_age_ns_(settings.wire.delay_in_ns),
      arm_(model, settings, std::move(path), seed) {
  keep_sample();
}

HidArm::HidArm(HidLayout layout, UsbDescription description,
               const driver::JointModel<driver::LinkageArm>& model,
               const SimulatedArmSettings& settings, HandPath path, std::uint64_t seed)
    : layout_(layout),
      description_(std::move(description)),
      report_age_ns_(settings.wire.delay_in_ns),
      arm_(model, settings, std::move(path), seed) {
  model_.drives = model.drives;
  model_.encoders = model.encoders;
  keep_sample();
}

std::size_t HidArm::report_size() const noexcept {
  switch (layout_) {
    case HidLayout::kWoodenHaptics:
      return driver::woody::kReportSize;
    case HidLayout::kPolhem:
      return driver::hfab::kReportSize;
    case HidLayout::kPolhemPadded:
      return driver::hfab::kPaddedReportSize;
  }
  return 0;
}

void HidArm::keep_sample() noexcept {
  const auto slot = static_cast<std::size_t>(arm_.time_ns() / UsbipSession::kFrame_ns) % kSamples;
  samples_[slot] = {arm_.time_ns(), model_.exact_counts(arm_.plant().q())};
}

void HidArm::advance_to(std::int64_t time_ns) noexcept {
  // Frame by frame, so that what the encoders really saw is known for each.
  while (arm_.time_ns() < time_ns) {
    const std::int64_t frame_ns =
        (arm_.time_ns() / UsbipSession::kFrame_ns + 1) * UsbipSession::kFrame_ns;
    arm_.advance_to(std::min(time_ns, frame_ns));
    if (arm_.time_ns() == frame_ns) keep_sample();
  }
}

std::size_t HidArm::lay_out(std::span<const std::byte> report,
                            std::span<std::byte> packet) noexcept {
  const std::size_t size = report_size();
  std::fill_n(packet.begin(), size, std::byte{0});
  if (layout_ == HidLayout::kWoodenHaptics) {
    for (std::size_t i = 0; i < 3; ++i) put_word(packet, i, get_word(report, i));
    put_word(packet, 3, static_cast<std::int16_t>(counter_));
  } else {
    std::copy(report.begin(), report.end(), packet.begin());
  }
  return size;
}

PacketResult HidArm::in(std::uint8_t address, std::span<std::byte> packet) noexcept {
  if (address != kInEndpoint) return {Answer::kStall, 0};
  std::array<std::byte, driver::hfab::kReportSize> report{};
  std::uint32_t skipped = 0;
  if (arm_.take_report(report, skipped) == 0) return {Answer::kNak, 0};
  ++counter_;  // the board counts what it sends [S woody-experimental main.cpp]
  const std::size_t size = lay_out(report, packet);
  std::copy_n(packet.begin(), size, last_report_.begin());
  ++truth_.reports;
  truth_.report_ns = arm_.time_ns() - report_age_ns_;
  for (std::size_t i = 0; i < 3; ++i) truth_.counts[i] = get_word(report, i);
  for (const Sample& sample : samples_) {
    if (sample.time_ns == truth_.report_ns) truth_.exact_counts = sample.exact_counts;
  }
  return {Answer::kDone, size};
}

bool HidArm::message(std::span<const std::byte> bytes) noexcept {
  if (bytes.size() != report_size()) {
    ++malformed_;
    return false;
  }
  std::array<std::byte, driver::hfab::kReportSize> message{};
  if (layout_ == HidLayout::kWoodenHaptics) {
    driver::hfab::OutputReport output;
    for (std::size_t i = 0; i < 3; ++i) output.current_mA[i] = get_word(bytes, i);
    message = driver::hfab::encode_output(output);
  } else {
    std::copy_n(bytes.begin(), message.size(), message.begin());
  }
  arm_.put_message(message);
  ++truth_.messages;
  truth_.message_ns = arm_.time_ns();
  for (std::size_t i = 0; i < 3; ++i) truth_.motor_values[i] = get_word(message, i);
  return true;
}

PacketResult HidArm::out(std::uint8_t address, std::span<const std::byte> packet) noexcept {
  if (address == kInEndpoint) return {Answer::kStall, 0};
  message(packet);
  return {Answer::kDone, packet.size()};
}

PacketResult HidArm::control(const SetupPacket& setup, std::span<std::byte> data) noexcept {
  const bool for_hid = (setup.request_type & kKindMask) == kKindClass &&
                       (setup.request_type & 0x1fU) == kRecipientInterface && setup.index == 0;
  if (!for_hid) return {Answer::kStall, 0};
  const auto kind = static_cast<std::uint8_t>(setup.value >> 8);
  switch (setup.request) {
    case kGetReport: {
      if (!setup.to_host() || kind != kInputReport) return {Answer::kStall, 0};
      const std::size_t size = std::min(report_size(), data.size());
      std::copy_n(last_report_.begin(), size, data.begin());
      return {Answer::kDone, size};
    }
    case kSetReport:
      if (setup.to_host() || kind != kOutputReport) return {Answer::kStall, 0};
      return {message(data) ? Answer::kDone : Answer::kStall, data.size()};
    case kSetIdle:
      idle_ = static_cast<std::uint8_t>(setup.value >> 8);
      return {Answer::kDone, 0};
    case kGetIdle:
      if (data.empty()) return {Answer::kStall, 0};
      data[0] = std::byte{idle_};
      return {Answer::kDone, 1};
    default:
      return {Answer::kStall, 0};
  }
}

ArmTruth HidArm::truth() const noexcept {
  ArmTruth truth = truth_;
  truth.currents = arm_.plant().currents();
  truth.p_BT = arm_.plant().p_BT();
  truth.motors_on = arm_.firmware().motors_on();
  return truth;
}

}  // namespace thimble::device_sim::usb

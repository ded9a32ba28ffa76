#include "board_wire.h"

#include <algorithm>

#include "arms/hfab/hfab_line.h"
#include "arms/hfab/hfab_report.h"
#include "arms/woody/woody_report.h"

namespace thimble::device_sim {
namespace {

namespace hfab = driver::hfab;
namespace woody = driver::woody;
using driver::ArmKind;

// Counters wrap as those of the boards do.
std::int16_t low_word(std::int64_t value) noexcept {
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(value & 0xffff));
}

std::int32_t low_half(std::int64_t value) noexcept {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(value & 0xffffffff));
}

template <std::size_t N, std::size_t M>
std::size_t place(const std::array<std::byte, N>& report, std::span<std::byte, M> bytes) noexcept {
  static_assert(N <= M);
  std::copy(report.begin(), report.end(), bytes.begin());
  return N;
}

hfab::InputReport hfab_report(const BoardReport& report, bool ideal_encoders) noexcept {
  hfab::InputReport input;
  for (std::size_t i = 0; i < 3; ++i) {
    input.counts[i] = low_word(ideal_encoders ? report.counts[i] >> 16 : report.counts[i]);
    input.counts[3 + i] = low_word(ideal_encoders ? report.counts[i] : report.gimbal[i]);
  }
  input.info = report.button ? 1 : 0;
  return input;
}

hfab::ArmLine hfab_line(const BoardReport& report, std::int32_t model) noexcept {
  hfab::ArmLine line{.model = model, .counts = {}, .error = 0};
  for (std::size_t i = 0; i < 3; ++i) {
    line.counts[i] = low_half(report.counts[i]);
    line.counts[3 + i] = low_half(report.gimbal[i]);
  }
  return line;
}

woody::InputReport woody_report(const BoardReport& report) noexcept {
  woody::InputReport input;
  for (std::size_t i = 0; i < 3; ++i) input.counts[i] = low_word(report.counts[i]);
  input.counter = report.number;
  return input;
}

void take(const hfab::OutputReport& output, BoardMessage& message) noexcept {
  if (output.command == static_cast<std::int16_t>(hfab::Command::kPreset)) {
    auto& counters = message.counters.emplace();
    std::copy_n(output.attributes.begin(), 3, counters.begin());
    std::copy_n(output.current_mA.begin(), 3, counters.begin() + 3);
  } else {
    std::copy_n(output.current_mA.begin(), 3, message.current_mA.begin());
  }
}

}  // namespace

std::size_t encode_report(const BoardReport& report, const FirmwareSettings& settings,
                          std::span<std::byte, driver::kReportCapacity> bytes) noexcept {
  if (!settings.ideal_encoders && settings.speaks == ArmKind::kWoody) {
    return place(woody::encode_input(woody_report(report)), bytes);
  }
  if (!settings.ideal_encoders && settings.speaks == ArmKind::kHfabLine) {
    return hfab::encode_arm_line(hfab_line(report, settings.line_model),
                                 bytes.first<hfab::kLineCapacity>());
  }
  hfab::write_input(hfab_report(report, settings.ideal_encoders), bytes.first<hfab::kReportSize>());
  return hfab::kReportSize;
}

bool decode_message(std::span<const std::byte> bytes, const FirmwareSettings& settings,
                    BoardMessage& message) noexcept {
  if (!settings.ideal_encoders && settings.speaks == ArmKind::kWoody) {
    const auto output = woody::decode_output(bytes);
    if (!output) return false;
    std::copy_n(output->current_mA.begin(), 3, message.current_mA.begin());
    return true;
  }
  if (!settings.ideal_encoders && settings.speaks == ArmKind::kHfabLine) {
    const auto line = hfab::decode_host_line(bytes);
    if (!line) return false;
    message.current_mA = line->current_mA;
    return true;
  }
  if (!hfab::is_report_size(bytes.size())) return false;
  take(hfab::read_output(bytes), message);
  return true;
}

}  // namespace thimble::device_sim

#include "board/board_wire.h"

#include <algorithm>

#include "arms/hfab/hfab_line.h"
#include "arms/hfab/hfab_report.h"
#include "arms/woody/woody_report.h"

namespace thimble::device_sim {
namespace {

namespace hfab = driver::hfab;
namespace woody = driver::woody;
using driver::ArmKind;

// Counters wrap like those of the boards.
std::int16_t low_word(std::int64_t value) noexcept {
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(value & 0xffff));
}

std::int32_t low_half(std::int64_t value) noexcept {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(value & 0xffffffff));
}

hfab::InputReport hfab_report(const BoardReport& report) noexcept {
  const auto& [a, b, c] = report.counts;
  const auto& [d, e, f] = report.gimbal;
  return {.counts = {low_word(a), low_word(b), low_word(c), low_word(d), low_word(e), low_word(f)},
          .info = static_cast<std::int16_t>(report.button)};
}

hfab::InputReport fine_hfab_report(const BoardReport& report) noexcept {
  const auto& [a, b, c] = report.counts;
  return {.counts = {low_word(a >> 16), low_word(b >> 16), low_word(c >> 16), low_word(a),
                     low_word(b), low_word(c)},
          .info = static_cast<std::int16_t>(report.button)};
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
  const auto hfab_bytes = bytes.first<hfab::kReportSize>();
  if (settings.ideal_encoders) {
    hfab::write_input(fine_hfab_report(report), hfab_bytes);
    return hfab_bytes.size();
  }
  if (settings.protocol == ArmKind::kWoody) {
    const auto words = woody::encode_input(woody_report(report));
    std::copy(words.begin(), words.end(), bytes.begin());
    return words.size();
  }
  if (settings.protocol == ArmKind::kHfabLine) {
    return hfab::encode_arm_line(hfab_line(report, settings.line_model),
                                 bytes.first<hfab::kLineCapacity>());
  }
  hfab::write_input(hfab_report(report), hfab_bytes);
  return hfab_bytes.size();
}

bool decode_message(std::span<const std::byte> bytes, const FirmwareSettings& settings,
                    BoardMessage& message) noexcept {
  if (!settings.ideal_encoders && settings.protocol == ArmKind::kWoody) {
    const auto output = woody::decode_output(bytes);
    if (!output) return false;
    std::copy_n(output->current_mA.begin(), 3, message.current_mA.begin());
    return true;
  }
  if (!settings.ideal_encoders && settings.protocol == ArmKind::kHfabLine) {
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

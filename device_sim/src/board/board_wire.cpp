#include "board/board_wire.h"

#include <algorithm>
#include <cstring>

#include "arms/hfab/hfab_line.h"
#include "arms/hfab/hfab_report.h"
#include "arms/woody/woody_report.h"
#include "thimble/driver/wire_arm.h"
#include "wires/wire_table.h"

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

driver::WireValues described_report(const BoardReport& report, std::int32_t model) noexcept {
  driver::WireValues values;
  for (std::size_t i = 0; i < 3; ++i) {
    values.encoders[i] = low_half(report.counts[i]);
    values.gimbal[i] = low_half(report.gimbal[i]);
  }
  values.buttons = report.button ? 1 : 0;
  values.sequence = report.number;
  values.time = report.number;
  values.model = model;
  return values;
}

/// Largest current of a described message, mA [chosen: far beyond any range].
constexpr double kCurrentMax_mA = 1e6;

void take(const hfab::OutputReport& output, BoardMessage& message) noexcept {
  if (output.command == static_cast<std::int16_t>(hfab::Command::kPreset)) {
    auto& counters = message.counters.emplace();
    std::copy_n(output.attributes.begin(), 3, counters.begin());
    std::copy_n(output.current_mA.begin(), 3, counters.begin() + 3);
  } else {
    std::copy_n(output.current_mA.begin(), 3, message.current_mA.begin());
  }
}

/// Values of the counters on their way to the reference firmware, which encodes its own report.
struct MeasuredValues {
  std::array<std::int32_t, 3> counts{};
  std::array<std::int16_t, 3> gimbal{};
  std::uint8_t buttons = 0;
};

std::size_t pack_inputs(const BoardReport& report,
                        std::span<std::byte, driver::kReportCapacity> bytes) noexcept {
  MeasuredValues values;
  for (std::size_t i = 0; i < 3; ++i) {
    values.counts[i] = low_half(report.counts[i]);
    values.gimbal[i] = low_word(report.gimbal[i]);
  }
  values.buttons = report.button ? 1 : 0;
  std::memcpy(bytes.data(), &values, sizeof values);
  return sizeof values;
}

}  // namespace

void unpack_inputs(std::span<const std::byte> bytes, firmware::Inputs& inputs) noexcept {
  MeasuredValues values;
  if (bytes.size() != sizeof values) return;
  std::memcpy(&values, bytes.data(), sizeof values);
  std::copy(values.counts.begin(), values.counts.end(), inputs.counts);
  std::copy(values.gimbal.begin(), values.gimbal.end(), inputs.gimbal);
  inputs.buttons = values.buttons;
}

std::size_t encode_report(const BoardReport& report, const FirmwareSettings& settings,
                          std::span<std::byte, driver::kReportCapacity> bytes) noexcept {
  if (settings.reference) return pack_inputs(report, bytes);
  const auto hfab_bytes = bytes.first<hfab::kReportSize>();
  if (settings.ideal_encoders) {
    hfab::write_input(fine_hfab_report(report), hfab_bytes);
    return hfab_bytes.size();
  }
  if (settings.protocol == ArmKind::kDescribed) {
    return settings.described->report.write(described_report(report, settings.line_model), bytes);
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
  if (!settings.ideal_encoders && settings.protocol == ArmKind::kDescribed) {
    driver::WireValues values;
    if (!settings.described->command.read(bytes, values)) return false;
    for (std::size_t i = 0; i < 3; ++i) {
      message.current_mA[i] = driver::round_half_away(
          std::clamp(1e3 * values.motors[i], -kCurrentMax_mA, kCurrentMax_mA));
    }
    return true;
  }
  if (!hfab::is_report_size(bytes.size())) return false;
  take(hfab::read_output(bytes), message);
  return true;
}

}  // namespace thimble::device_sim

#include "arms/hfab/hfab_wire.h"

#include <algorithm>

namespace thimble::driver::hfab {

bool LineWire::decode(std::span<const std::byte> bytes, ArmReading& reading) noexcept {
  const auto line = decode_arm_line(bytes);
  if (!line || (line->error & kErrorStale) != 0) return false;
  std::copy_n(line->counts.begin(), 3, reading.counts.begin());
  std::copy_n(line->counts.begin() + 3, 3, reading.auxiliary.begin());
  reading.buttons = 0;
  return true;
}

std::size_t LineWire::encode(const std::array<std::int16_t, 3>& mA,
                             std::span<std::byte, kReportCapacity> bytes) noexcept {
  return encode_host_line({.current_mA = {mA[0], mA[1], mA[2]}}, bytes.first<kLineCapacity>());
}

bool ReportWire::decode(std::span<const std::byte> bytes, ArmReading& reading) noexcept {
  if (!is_report_size(bytes.size())) return false;
  const InputReport report = read_input(bytes);
  std::copy_n(report.counts.begin(), 3, reading.counts.begin());
  std::copy_n(report.counts.begin() + 3, 3, reading.auxiliary.begin());
  reading.buttons = static_cast<std::uint16_t>(report.info & 1);
  return true;
}

bool FineReportWire::decode(std::span<const std::byte> bytes, ArmReading& reading) noexcept {
  if (!is_report_size(bytes.size())) return false;
  const InputReport report = read_input(bytes);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto low = static_cast<std::uint16_t>(report.counts[3 + i]);
    reading.counts[i] = report.counts[i] * 65536 + low;
  }
  reading.auxiliary = {};
  reading.buttons = static_cast<std::uint16_t>(report.info & 1);
  return true;
}

}  // namespace thimble::driver::hfab

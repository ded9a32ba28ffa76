#include "arms/woody/woody_wire.h"

#include <algorithm>

namespace thimble::driver::woody {

bool ReportWire::decode(std::span<const std::byte> bytes, ArmReading& reading) noexcept {
  const auto report = decode_input(bytes);
  if (!report) return false;
  std::copy(report->counts.begin(), report->counts.end(), reading.counts.begin());
  reading.auxiliary = {report->counter, 0, 0};
  reading.buttons = 0;
  reading.number = report->counter;
  return true;
}

std::size_t ReportWire::encode(const std::array<std::int16_t, 3>& mA,
                               std::span<std::byte, kReportCapacity> bytes) noexcept {
  const auto report = encode_output({.current_mA = mA});
  std::copy(report.begin(), report.end(), bytes.begin());
  return report.size();
}

}  // namespace thimble::driver::woody

#include "board/reference_program.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <variant>

namespace thimble::device_sim {
namespace {

std::uint16_t word(double value) noexcept {
  return static_cast<std::uint16_t>(std::clamp(value, 0.0, 65535.0));
}

/// Returns the geometry as the self-description of a board names it.
firmware::Geometry geometry_of(const driver::ArmGeometry& geometry) noexcept {
  if (std::holds_alternative<driver::LinkageArm>(geometry)) return firmware::Geometry::kLinkage;
  if (std::holds_alternative<driver::DeltaArm>(geometry)) return firmware::Geometry::kDelta;
  if (std::holds_alternative<driver::PaddleArm>(geometry)) return firmware::Geometry::kPaddle;
  if (std::holds_alternative<driver::FiveBarArm>(geometry)) return firmware::Geometry::kFiveBar;
  if (std::holds_alternative<driver::CartesianArm>(geometry)) return firmware::Geometry::kCartesian;
  return firmware::Geometry::kSerial;
}

}  // namespace

firmware::ArmConfig reference_config(const driver::ArmModel& model,
                                     const FirmwareSettings& settings) {
  firmware::ArmConfig config;
  config.motors = static_cast<std::uint8_t>(driver::motor_count(model.geometry));
  config.geometry = geometry_of(model.geometry);
  constexpr std::string_view kSerial = "SIMULATE", kBoard = "host";
  std::copy(kSerial.begin(), kSerial.end(), config.serial);
  std::copy(kBoard.begin(), kBoard.end(), config.board);
  config.watchdog_ms = word(static_cast<double>(settings.watchdog_ns) * 1e-6);
  config.loop_hz = word(std::round(1e9 / static_cast<double>(settings.report_period_ns)));
  config.report_hz = config.loop_hz;
  config.current_max_mA = word(settings.current_range_mA);
  config.supply_min_mV = kReferenceSupplyMin_mV;
  for (std::size_t i = 0; i < firmware::kMotorsMax; ++i) {
    if (i >= config.motors) {
      config.counts_per_turn[i] = 0;
      continue;
    }
    config.counts_per_turn[i] =
        static_cast<std::uint32_t>(std::clamp(model.encoders[i].counts_per_motor_turn, 0.0, 4e9));
    config.ratio[i] = static_cast<float>(model.drives[i].ratio);
  }
  return config;
}

void HostProgram::tick(const firmware::Inputs& inputs, std::uint32_t time_us,
                       std::span<std::uint8_t, firmware::kHidReportSize> report) noexcept {
  controller_.tick(inputs, time_us);
  controller_.report(report.data());
}

void HostProgram::receive(std::span<const std::uint8_t> message, std::uint32_t time_us) noexcept {
  controller_.receive(message.data(), message.size(), time_us);
}

void HostProgram::watch(std::uint32_t time_us) noexcept {
  controller_.watch(time_us);
}

void HostProgram::restart() noexcept {
  controller_ = firmware::Controller(firmware::ArmConfig(controller_.config()));
}

}  // namespace thimble::device_sim

#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "firmware/core/controller.h"
#include "thimble/device_sim/settings.h"
#include "thimble/driver/arm_model.h"
#include "thimble/driver/export.h"

namespace thimble::device_sim {

/// Program of a simulated board: the reference firmware, compiled for this computer or running on
/// another processor. Times are those of the simulation, us, modulo 2^32.
class ReferenceProgram {
 public:
  ReferenceProgram() = default;
  ReferenceProgram(const ReferenceProgram&) = default;
  ReferenceProgram& operator=(const ReferenceProgram&) = default;
  virtual ~ReferenceProgram() = default;

  /// Begins a loop with these inputs. Writes the report that the board sends into `report`.
  virtual void tick(const firmware::Inputs& inputs, std::uint32_t time_us,
                    std::span<std::uint8_t, firmware::kHidReportSize> report) noexcept = 0;
  /// Takes a message of the host.
  virtual void receive(std::span<const std::uint8_t> message, std::uint32_t time_us) noexcept = 0;
  /// Lets time pass without a loop or a message.
  virtual void watch(std::uint32_t time_us) noexcept = 0;
  /// Restarts the board.
  virtual void restart() noexcept = 0;
  /// Returns the outputs of the board.
  virtual const firmware::Outputs& outputs() const noexcept = 0;
};

/// Returns the data of a model's arm for the reference firmware. Real-time: never from the servo
/// thread.
firmware::ArmConfig reference_config(const driver::ArmModel& model,
                                     const FirmwareSettings& settings);

/// The reference firmware, compiled for this computer.
class THIMBLE_EXPORT HostProgram final : public ReferenceProgram {
 public:
  explicit HostProgram(const firmware::ArmConfig& config) noexcept : controller_(config) {}

  void tick(const firmware::Inputs& inputs, std::uint32_t time_us,
            std::span<std::uint8_t, firmware::kHidReportSize> report) noexcept override;
  void receive(std::span<const std::uint8_t> message, std::uint32_t time_us) noexcept override;
  void watch(std::uint32_t time_us) noexcept override;
  void restart() noexcept override;
  const firmware::Outputs& outputs() const noexcept override { return controller_.outputs(); }

  /// Returns the logic of the firmware.
  const firmware::Controller& controller() const noexcept { return controller_; }

 private:
  firmware::Controller controller_;
};

}  // namespace thimble::device_sim

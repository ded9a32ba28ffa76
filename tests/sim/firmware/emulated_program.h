#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "board/reference_program.h"
#include "firmware/core/cobs.h"

namespace thimble::firmware_test {

/// The reference firmware on an emulated Cortex-M3: QEMU's machine mps2-an385 in another process.
/// UART0 carries the messages of host and board, UART1 those of
/// driver/firmware/boards/plant_link.h. The emulated board waits for each message, so that runs are
/// repeatable.
class EmulatedProgram final : public device_sim::ReferenceProgram {
 public:
  /// Starts the image for an arm. Empty if QEMU does not start or the firmware does not answer.
  static std::unique_ptr<EmulatedProgram> start(const std::filesystem::path& image,
                                                const firmware::ArmConfig& config);
  ~EmulatedProgram() override;
  EmulatedProgram(const EmulatedProgram&) = delete;
  EmulatedProgram& operator=(const EmulatedProgram&) = delete;

  void tick(const firmware::Inputs& inputs, std::uint32_t time_us,
            std::span<std::uint8_t, firmware::kHidReportSize> report) noexcept override;
  void receive(std::span<const std::uint8_t> message, std::uint32_t time_us) noexcept override;
  void watch(std::uint32_t time_us) noexcept override;
  void restart() noexcept override;
  const firmware::Outputs& outputs() const noexcept override { return outputs_; }

  /// Lets the firmware stop in a pass, without feeding its hardware watchdog. Returns the first
  /// self-description after the restart; empty if none came.
  std::vector<std::uint8_t> hang();

  /// Returns the self-description that the firmware sent last.
  const std::vector<std::uint8_t>& description() const { return description_; }
  /// Returns whether a message was not answered in time, or was damaged.
  bool failed() const { return failed_; }
  /// Returns the longest duration of a pass with a tick, s of the emulated processor.
  double pass_max() const { return pass_max_; }

 private:
  struct Port {
    int listener = -1, fd = -1;
    firmware::FrameReader reader;
  };

  EmulatedProgram() = default;
  bool launch(const std::filesystem::path& image);
  void stop() noexcept;
  bool configure();
  void send(Port& port, std::vector<std::uint8_t> content);
  std::vector<std::uint8_t> next(Port& port);
  void send_sensors(bool tick, std::uint32_t time_us);
  void take_motors(bool tick);

  std::filesystem::path image_, folder_;
  firmware::ArmConfig config_;
  pid_t qemu_ = -1;
  Port host_, plant_;
  firmware::Inputs inputs_;
  std::optional<std::vector<std::uint8_t>> health_;
  std::vector<std::uint8_t> description_;
  firmware::Outputs outputs_;
  std::uint32_t time_us_ = 0;
  double pass_max_ = 0;
  bool failed_ = false;
};

}  // namespace thimble::firmware_test

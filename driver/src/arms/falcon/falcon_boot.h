#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "arms/falcon/falcon_packet.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "transports/serial_line.h"

namespace thimble::driver::falcon {

// The steps from power-on to a usable Falcon [S libnifalcon FalconCommLibUSB.cpp,
// FalconFirmware.cpp]. They use a SerialLine and no USB. The arm loses its firmware when it loses
// power. The image belongs to the vendor, so the user names a file that holds it. Real-time: never
// from the servo thread.

// FTDI divisor words: 9600, 140,000 and 1.5 million baud [S]. The last is 3 MHz / 2; the fraction
// bits of 9600 are 0x4000.
inline constexpr std::uint16_t kBootDivisor = 0x4138;
inline constexpr std::uint16_t kUploadDivisor = 0x0015;
inline constexpr std::uint16_t kRunDivisor = 0x0002;

/// Bytes of firmware per block: an FTDI packet of 64 less its 2 status bytes, so that the echo of a
/// block returns in one packet [S].
inline constexpr std::size_t kBlockSize = 62;

/// Limits and times of the boot.
struct BootSettings {
  int greetings_max = 100;      ///< Max. number of greetings without the right answer [S].
  int answer_timeout_ms = 100;  ///< Wait for each answer (chosen: six latency timers of 16 ms).
  int block_attempts_max = 5;   ///< Max. number of uploads from the start (chosen).
  int upload_latency_ms = 16;   ///< Latency timer while uploading [S].
  int settle_ms = 10;           ///< Pause after each change of DTR (chosen).
};

/// Result of an upload.
struct UploadReport {
  std::size_t size = 0;        ///< Bytes of firmware.
  int attempts = 0;            ///< Number of uploads started; 1 if the first succeeded.
  std::size_t resumed_at = 0;  ///< Bytes sent when the last failed upload ended; 0 if none failed.
};

/// Reads a firmware image. Fails if the file cannot be read, is empty, or is larger than any such
/// image (64 kB).
THIMBLE_EXPORT Result<std::vector<std::byte>> read_firmware(const std::filesystem::path& file);

/// Sets the line for running: latency timer 1 ms (16 ms would cost 33 times the stable stiffness
/// [C PHYSICS 5]), 1.5 Mbaud, empty buffers.
Result<void> enter_run_mode(SerialLine& line);

/// Checks whether firmware runs: sends zero force and waits for a packet. Precondition: run mode.
bool firmware_answers(SerialLine& line, const BootSettings& settings = {});

/// Resets the arm into its boot loader: 9600 8N1, RTS low, DTR low then high. Greets it (0A 43 0D)
/// until it answers 0A 44 2C 0D. Then DTR low, 140 kbaud, and 'A' must be echoed.
Result<void> enter_boot_loader(SerialLine& line, const BootSettings& settings = {});

/// Uploads firmware in blocks and compares each echo. A wrong or missing echo means that the boot
/// loader may hold a wrong image. The loader is then reset and the upload restarts, up to
/// `block_attempts_max` times. The open driver gives up instead, and its users report that it
/// "works day 1, fails day 2". Ends in run mode with the firmware answering.
THIMBLE_EXPORT Result<UploadReport> upload_firmware(SerialLine& line,
                                                    std::span<const std::byte> firmware,
                                                    const BootSettings& settings = {});

/// Performs all steps: run mode and, if no firmware answers, boot loader and upload of
/// `firmware_file`. If the path is empty and the arm has no firmware, the error states what to do.
THIMBLE_EXPORT Result<UploadReport> prepare(SerialLine& line,
                                            const std::filesystem::path& firmware_file,
                                            const BootSettings& settings = {});

/// State of homing.
struct HomingState {
  bool answered = false;                 ///< A packet arrived.
  std::uint8_t homed = 0;                ///< One bit per leg.
  std::array<std::int16_t, 3> counts{};  ///< Encoder counts of the last packet.
  /// Returns whether all legs are homed.
  bool done() const { return homed == kAllHomed; }
};

/// Exchanges one packet in homing mode with zero force: red light while a leg is not homed, green
/// when all are. The user pulls the grip all the way out and pushes it in. Call this until `done`.
THIMBLE_EXPORT HomingState home_once(SerialLine& line, std::uint8_t homed_before,
                                     const BootSettings& settings = {});

}  // namespace thimble::driver::falcon

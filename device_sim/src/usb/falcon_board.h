#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "arms/falcon/falcon_packet.h"
#include "thimble/driver/export.h"
#include "usb/ftdi_chip.h"

namespace thimble::device_sim::usb {

/// Event counters of the board.
struct FalconCounters {
  std::uint64_t packets = 0;    ///< Packets understood and answered.
  std::uint64_t malformed = 0;  ///< Frames of 16 bytes that are not packets; not answered.
  std::uint64_t stray = 0;      ///< Bytes outside of any packet.
  std::uint64_t resets = 0;     ///< Restarts of the boot loader.
};

/// Behaviour of a Falcon on a packet without the homing bit. libnifalcon's header comments the
/// flags of the homed legs with "if homing mode on". Programs that need the encoders keep the bit
/// in every packet [S FalconFirmwareNovintSDK.h; "keep track of encoders" in programs on top of
/// it]. The effect on the counts is unknown.
enum class FalconHoming : std::uint8_t {
  kForgets,     ///< Flags and homes are lost; the arm must be homed again. The hardest case for a
                ///< driver.
  kHidesFlags,  ///< No leg counts as homed in the answer; the homes are kept.
  kKeeps,       ///< No effect.
};

/// The processor of a Novint Falcon, as seen by a host [S libnifalcon FalconCommLibUSB.cpp,
/// FalconFirmware.cpp]. A rising DTR resets its boot loader; firmware is then lost. The boot loader
/// answers a greeting at 9600 baud and echoes the firmware at 140 kbaud. The firmware then answers
/// each packet at 1.5 Mbaud with one packet. Encoders count from an arbitrary value until their leg
/// has passed its home in homing mode.
class THIMBLE_EXPORT FalconBoard final : public SerialBoard {
 public:
  /// State of the boot loader.
  enum class Stage : std::uint8_t {
    kBoot,    ///< Waits for the greeting at 9600 baud.
    kReady,   ///< Greeted; waits for 'A' at 140 kbaud.
    kUpload,  ///< Echoes firmware.
  };

  /// `image` is the firmware that this board can run; empty: any. Real-time: never from the servo
  /// thread.
  explicit FalconBoard(std::vector<std::byte> image, FalconHoming homing = FalconHoming::kForgets);

  // All functions below are Real-time: safe.

  double rate() const noexcept override;
  void hear(std::byte byte, ByteQueue& says) noexcept override;
  void wires(bool dtr, bool rts) noexcept override;
  /// Restarts the boot loader, as a rising DTR does: firmware and homes are lost.
  void restart() noexcept;
  /// Sets the baud rate of the host: uploaded firmware starts when the host switches to the running
  /// rate.
  void host_rate(double baud) noexcept;

  /// Sets the true encoder positions, counts. Must be called before `hear`.
  void set_encoders(const std::array<double, 3>& exact_counts) noexcept;

  /// Switches the motors off if no packet came within the watchdog's time.
  void watch(std::int64_t time_ns) noexcept;
  /// Sets the watchdog's time, ns; 0: no watchdog. It is unknown whether a real Falcon has one, so
  /// nothing may be promised that depends on it.
  void set_watchdog(std::int64_t time_ns) noexcept { watchdog_ns_ = time_ns; }

  Stage stage() const noexcept { return stage_; }  ///< Returns the state of the boot loader.
  /// Returns whether firmware runs.
  bool running() const noexcept { return running_; }
  /// Returns the number of bytes of firmware received.
  std::size_t uploaded() const noexcept { return uploaded_; }
  /// Returns the last message of the host.
  const driver::falcon::HostPacket& asked() const noexcept { return asked_; }
  /// Returns the last message to the host.
  const driver::falcon::ArmPacket& answered() const noexcept { return answered_; }
  bool motors_on() const noexcept { return motors_on_; }  ///< Returns whether the motors are on.
  /// Returns whether a host requests homing now and some leg has not passed its home.
  bool wants_homing() const noexcept;
  const FalconCounters& counters() const noexcept { return counters_; }

 private:
  void run(std::byte byte, ByteQueue& says) noexcept;
  void answer(ByteQueue& says) noexcept;
  void forget_homes() noexcept;

  std::vector<std::byte> image_;
  FalconHoming homing_;
  Stage stage_ = Stage::kBoot;
  bool running_ = false, image_right_ = true;
  bool dtr_ = false;
  std::size_t greeted_ = 0;  // number of bytes of the greeting received so far
  std::size_t uploaded_ = 0;
  std::array<std::byte, driver::falcon::kPacketSize> frame_{};
  std::size_t frame_size_ = 0;
  std::array<double, 3> exact_{}, before_{};
  std::array<std::int32_t, 3> offset_{};  // error of each encoder count before it is homed
  std::uint8_t homed_ = 0;
  bool seen_ = false;  // encoder positions have been set
  driver::falcon::HostPacket asked_;
  driver::falcon::ArmPacket answered_;
  bool motors_on_ = false;
  std::int64_t watchdog_ns_ = 100'000'000;  // a guess: a real one may have none
  std::int64_t now_ns_ = 0, last_packet_ns_ = 0;
  FalconCounters counters_;
};

}  // namespace thimble::device_sim::usb

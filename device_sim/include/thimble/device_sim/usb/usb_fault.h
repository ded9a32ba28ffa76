#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <random>
#include <string_view>

#include "thimble/device_sim/usb/usb_device.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::device_sim::usb {

/// Kind of fault on the cable or in the board.
enum class FaultKind : std::uint8_t {
  kStall,      ///< The endpoint stalls and stays halted until the host clears the halt.
  kShort,      ///< Only half of the packet is sent.
  kLong,       ///< The packet is eight bytes too long.
  kTorn,       ///< The second half is from the previous packet.
  kStale,      ///< The last good packet is repeated.
  kDuplicate,  ///< Every packet is sent twice.
  kSilence,    ///< The endpoint sends nothing and makes the host wait.
  kBitErrors,  ///< Bits flip, with the probability `FaultOrder::rate`.
  kUnplug,     ///< The device leaves the bus.
  kLost,       ///< The packet is accepted but ignored.
};
inline constexpr std::size_t kFaultKinds = 10;

/// Returns the name of a fault in scripts ("bit_errors"). Real-time: safe.
THIMBLE_EXPORT std::string_view name(FaultKind kind) noexcept;

/// A scheduled fault.
struct FaultOrder {
  /// Duration of a fault without an end, frames.
  static constexpr std::int64_t kForever = INT64_MAX / 2;

  FaultKind kind = FaultKind::kSilence;  ///< Kind of fault.
  /// True for packets to the host; an unplug affects both directions.
  bool to_host = true;
  std::int64_t after = 0;          ///< Delay until the fault begins, frames.
  std::int64_t frames = kForever;  ///< Duration of the fault, frames.
  double rate = 0.001;             ///< Probability of each bit to flip; for kBitErrors.
};

/// Parses one line of a fault script:
///
///     KIND [in|out] [after=FRAMES] [for=FRAMES] [rate=CHANCE]
///
/// with the defaults of FaultOrder. The error names the wrong word and the syntax. Real-time: never
/// from the servo thread.
THIMBLE_EXPORT driver::Result<FaultOrder> parse_fault(std::string_view line);

/// Wraps a device and injects faults into its packets. Control requests are not changed. Only one
/// fault is active per direction: the one scheduled last.
class THIMBLE_EXPORT FaultyDevice final : public UsbDevice {
 public:
  /// Largest number of scheduled faults; further ones replace the oldest.
  static constexpr std::size_t kOrders = 16;

  /// Keeps a reference to the device, which must outlive it. `seed` determines the bits that flip.
  explicit FaultyDevice(UsbDevice& device, std::uint64_t seed = 0) noexcept
      : device_(device), random_(seed) {}

  /// Schedules a fault. Real-time: safe.
  void order(const FaultOrder& order) noexcept;
  /// Removes all faults and reconnects an unplugged device. Real-time: safe.
  void heal() noexcept;

  /// Returns whether the device is on the bus. Real-time: safe.
  bool plugged() const noexcept { return active(true, FaultKind::kUnplug) == nullptr; }
  /// Returns the number of packets affected by a kind of fault. Real-time: safe.
  std::uint64_t hits(FaultKind kind) const noexcept { return hits_[index(kind)]; }

  const UsbDescription& description() const noexcept override { return device_.description(); }
  void advance_to(std::int64_t time_ns) noexcept override;
  PacketResult control(const SetupPacket& setup, std::span<std::byte> data) noexcept override;
  PacketResult in(std::uint8_t address, std::span<std::byte> packet) noexcept override;
  PacketResult out(std::uint8_t address, std::span<const std::byte> packet) noexcept override;

 private:
  /// A previous packet.
  struct Kept {
    std::array<std::byte, kPacketMax> bytes{};
    std::size_t size = 0;
  };
  struct OpenOrder {
    FaultOrder order;
    std::int64_t begin = 0, end = 0;  // frames
  };

  static std::size_t index(FaultKind kind) noexcept { return static_cast<std::size_t>(kind); }
  const OpenOrder* active(bool to_host, std::optional<FaultKind> kind = {}) const noexcept;
  const OpenOrder* hit(bool to_host) noexcept;
  void corrupt(const FaultOrder& order, std::span<std::byte> packet, std::size_t& size,
               const Kept& before) noexcept;

  UsbDevice& device_;
  std::mt19937_64 random_;
  std::int64_t frame_ = 0;
  std::array<OpenOrder, kOrders> orders_{};
  std::size_t order_count_ = 0;
  std::array<std::uint64_t, kFaultKinds> hits_{};
  Kept last_in_, last_out_;
  bool repeat_in_ = false;
};

}  // namespace thimble::device_sim::usb

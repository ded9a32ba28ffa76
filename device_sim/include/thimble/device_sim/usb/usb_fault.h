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

/// Names what can go wrong on the cable or in the board.
enum class FaultKind : std::uint8_t {
  kStall,      ///< The endpoint refuses; it stays halted until the host clears it.
  kShort,      ///< Half of the packet.
  kLong,       ///< Eight bytes too many.
  kTorn,       ///< The first half is new, the second half is of the packet before.
  kStale,      ///< The last good packet comes again and again.
  kDuplicate,  ///< Every packet comes twice.
  kSilence,    ///< Nothing: the endpoint asks the host to wait.
  kBitErrors,  ///< Bits flip, each with the fault's rate.
  kUnplug,     ///< The device leaves the bus.
  kLost,       ///< The packet is taken, and nothing comes of it.
};
inline constexpr std::size_t kFaultKinds = 10;

/// Returns the name of a fault in scripts ("bit_errors"). Real-time: safe.
THIMBLE_EXPORT std::string_view name(FaultKind kind) noexcept;

/// Orders one fault for some frames.
struct FaultOrder {
  static constexpr std::int64_t kForever = INT64_MAX / 2;  ///< A duration, ns, without an end.

  FaultKind kind = FaultKind::kSilence;  ///< What goes wrong.
  bool to_host = true;                   ///< Which direction it hits; an unplug hits both.
  std::int64_t after = 0;                ///< Begins so many frames from now.
  std::int64_t frames = kForever;        ///< Lasts so long.
  double rate = 0.001;                   ///< For kBitErrors: chance of each bit to flip.
};

/// Reads one line of a fault script:
///
///     KIND [in|out] [after=FRAMES] [for=FRAMES] [rate=CHANCE]
///
/// with the defaults of FaultOrder. Fails with a sentence that says what is wrong.
/// Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<FaultOrder> parse_fault(std::string_view line);

/// A device whose packets go wrong on demand. Control requests pass untouched. Faults of one
/// direction exclude each other: the one ordered last counts.
class THIMBLE_EXPORT FaultyDevice final : public UsbDevice {
 public:
  /// How many orders may be open; more push out the oldest.
  static constexpr std::size_t kOrders = 16;

  /// Keeps a reference to the device, which must live longer. `seed` chooses the bits that flip.
  explicit FaultyDevice(UsbDevice& device, std::uint64_t seed = 0) noexcept
      : device_(device), random_(seed) {}

  /// Orders a fault. Real-time: safe.
  void order(const FaultOrder& order) noexcept;
  /// Forgets all orders; an unplugged device is plugged in again. Real-time: safe.
  void heal() noexcept;

  /// Returns whether the device is on the bus. Real-time: safe.
  bool plugged() const noexcept { return active(true, FaultKind::kUnplug) == nullptr; }
  /// Returns how many packets a kind of fault has hit. Real-time: safe.
  std::uint64_t hits(FaultKind kind) const noexcept { return hits_[index(kind)]; }

  const UsbDescription& description() const noexcept override { return device_.description(); }
  void advance_to(std::int64_t time_ns) noexcept override;
  PacketResult control(const SetupPacket& setup, std::span<std::byte> data) noexcept override;
  PacketResult in(std::uint8_t address, std::span<std::byte> packet) noexcept override;
  PacketResult out(std::uint8_t address, std::span<const std::byte> packet) noexcept override;

 private:
  /// A packet that went by.
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
  void spoil(const FaultOrder& order, std::span<std::byte> packet, std::size_t& size,
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

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "thimble/driver/arm.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "wires/wire_checksum.h"
#include "wires/wire_description.h"

namespace thimble::driver {

// Tables that decode and encode the messages of a described wire, in both directions: the driver
// reads reports and writes commands, the simulated board the reverse. Functions of WireLayout and
// WireTable are Real-time: safe unless stated otherwise; decoding is total.

/// Contents of a message, in the units of the driver.
struct WireValues {
  std::array<std::int32_t, 3> encoders{};  ///< Motor encoders, counts.
  std::array<std::int32_t, 3> gimbal{};    ///< Gimbal encoders, or other values.
  std::array<double, 3> motors{};          ///< Motor currents, A.
  std::uint32_t buttons = 0;               ///< Buttons, one bit each.
  std::uint32_t errors = 0;                ///< Error flags.
  std::int64_t sequence = 0;               ///< Number of the report.
  std::int64_t time = 0;                   ///< Time of the board, in its own unit.
  std::int32_t model = 0;                  ///< Model number.
  std::array<float, 3> temperature{};      ///< Temperatures, in the unit of the field.
  float voltage = 0;                       ///< Supply voltage, V.
};

/// Reason why bytes are not a valid message.
enum class WireFlaw : std::uint8_t {
  kNone,      ///< Valid.
  kSize,      ///< Wrong length.
  kMark,      ///< Wrong first or last bytes, or separator.
  kCheck,     ///< Wrong check value.
  kStuffing,  ///< Not valid COBS or SLIP.
  kConstant,  ///< Another value than the constant.
  kDigit,     ///< Not a number of the field's representation.
  kErrors,    ///< The error flags make the report unusable.
};

/// Result of reading a message.
struct WireVerdict {
  WireFlaw flaw = WireFlaw::kNone;  ///< Reason; kNone if the message is valid.
  std::uint8_t byte = 0;            ///< Byte at which it was found.
  std::uint8_t field = 0;           ///< Field, for kConstant, kDigit and kErrors.

  /// Returns whether the message is valid.
  explicit operator bool() const noexcept { return flaw == WireFlaw::kNone; }
};

/// Returns a flaw as words ("wrong check value").
THIMBLE_EXPORT const char* describe(WireFlaw flaw) noexcept;

/// One field of the table.
struct WireOp {
  WireItem item = WireItem::kIgnored;
  WireType type = WireType::kUnsigned;
  std::uint8_t axis = 0;
  std::uint8_t at = 0, bytes = 1;
  std::uint8_t bit_first = 0, bit_count = 8;
  std::uint8_t decimals = 0;
  std::uint8_t wrap = 0;  ///< As in WireFieldText.
  bool big_endian = false;
  /// Shows bits that another field already describes; never written.
  bool shown_only = false;
  bool exact = true;        ///< The value is the raw value.
  std::uint64_t flip = 0;   ///< Bits that are inverted.
  std::uint64_t minus = 0;  ///< Subtracted from the raw bytes.
  double scale = 1, offset = 0;
  double to_raw = 1;                ///< 1 / scale.
  double raw_min = 0, raw_max = 0;  ///< Bounds of a written raw value.
  std::int64_t value = 0;
  std::uint32_t reject = 0;
  WireUnit unit = WireUnit::kAmpere;
  double gain = 1;  ///< Motor value per ampere, from `use_motors`; for duty cycles, torque share.
  double full = 0;  ///< Torque at full duty cycle, N m.
};

/// Largest number of fields of a message. [chosen: twice those of the largest known report]
inline constexpr std::size_t kWireFieldsMax = 32;
/// Largest number of bytes of a mark.
inline constexpr std::size_t kWireMarkMax = 8;
/// Longest message, bytes. [chosen: so that COBS has one group and the packet fits a buffer]
inline constexpr std::size_t kWireSizeMax = 120;
/// Longest message with SLIP, bytes, whose packet is up to twice as long.
inline constexpr std::size_t kWireSlipSizeMax = (kReportCapacity - 1) / 2;

/// A short sequence of bytes.
struct WireMark {
  std::array<std::byte, kWireMarkMax> bytes{};
  std::uint8_t size = 0;

  /// Returns the bytes.
  std::span<const std::byte> span() const noexcept {
    return std::span<const std::byte>(bytes).first(size);
  }
};

/// Returns whether bytes begin with a mark. Real-time: safe.
inline bool starts_with(std::span<const std::byte> bytes,
                        std::span<const std::byte> mark) noexcept {
  if (bytes.size() < mark.size()) return false;
  for (std::size_t i = 0; i < mark.size(); ++i) {
    if (bytes[i] != mark[i]) return false;
  }
  return true;
}

/// Table of the messages of one direction.
class THIMBLE_EXPORT WireLayout {
 public:
  /// Decodes a message. If the result is not valid, `values` is unchanged; with kErrors it is set.
  WireVerdict read(std::span<const std::byte> frame, WireValues& values) const noexcept;

  /// Encodes a message; returns its length.
  std::size_t write(const WireValues& values,
                    std::span<std::byte, kReportCapacity> bytes) const noexcept;

  /// Returns whether marks and check value of a complete message are right, for framings with a
  /// fixed size and for kLength.
  bool is_sound(std::span<const std::byte> frame) const noexcept;

  /// Returns the length of a message that begins with these bytes, for kLength; 0 if the byte with
  /// the length is missing, or if it cannot be right.
  std::size_t length_of(std::span<const std::byte> bytes) const noexcept;

  /// Returns the bytes that end a text: those of `end` without the end of the line, unless there
  /// are no others.
  std::span<const std::byte> end_of_text() const noexcept;

  /// Returns whether the messages have a field of this kind.
  bool has(WireItem item) const noexcept;

  /// Returns the raw and the converted value of each field of a valid message, for display.
  /// Real-time: never from the servo thread.
  std::vector<double> values_of(std::span<const std::byte> frame) const;

  WireFraming framing = WireFraming::kFixed;       ///< How messages are delimited.
  WireMark begin{}, end{}, separator{}, ignore{};  ///< Marks.
  /// Length with marks and check value, before stuffing; longest text; with kLength, the shortest
  /// message that is read, and the length of those that are written.
  std::size_t size = 0;
  std::size_t padded = 0;  ///< Length with padding; equal to `size` if there is none.
  std::size_t check_from = 0, check_at = 0, check_bytes = 0;  ///< Place of the check value.
  bool check_big_endian = false;                              ///< Byte order of the check value.
  std::size_t length_at = 0, length_adds = 0;                 ///< As in WireLayoutText.
  WireChecksum checksum{};                                    ///< Check value.
  std::array<WireOp, kWireFieldsMax> ops{};                   ///< Fields.
  std::size_t op_count = 0;                                   ///< Number of fields.
  std::array<std::byte, kReportCapacity> blank{};  ///< A message of zeros with marks, constants.

 private:
  WireVerdict read_block(std::span<const std::byte> body, WireValues& values) const noexcept;
  WireVerdict read_text(std::span<const std::byte> line, WireValues& values) const noexcept;
  std::size_t write_text(const WireValues& values,
                         std::span<std::byte, kReportCapacity> bytes) const noexcept;
};

/// Tables of a wire.
struct THIMBLE_EXPORT WireTable {
  WireDescription text;                ///< The description.
  WireLayout report, command;          ///< Messages from and to the board.
  bool numbered = false;               ///< Reports have a sequence number.
  bool timed = false;                  ///< Reports have no number but the time of the board.
  bool wraps = false;                  ///< An encoder counter wraps around.
  std::array<std::uint8_t, 3> wrap{};  ///< Bits of each encoder counter that wraps; else 0.

  /// Sets the motors, for units other than amperes: the torque constants convert currents into
  /// torques.
  void use_motors(const std::array<MotorDrive, 3>& drives) noexcept;

  /// Decodes a report for an Arm; returns false, and leaves `reading` unchanged, if it is invalid.
  /// Counters that wrap are as they were sent (CountUnwrap).
  bool decode(std::span<const std::byte> frame, ArmReading& reading) const noexcept;

  /// Encodes a command from motor currents, A. `number`: number of the command, if it has a field
  /// for it.
  std::size_t encode(const std::array<double, 3>& amperes,
                     std::span<std::byte, kReportCapacity> bytes,
                     std::uint32_t number = 0) const noexcept;

  /// Returns the number of bits, at most 16, in which the sequence number counts.
  unsigned sequence_bits() const noexcept;

  /// Returns the number of axes with a motor.
  std::size_t axes() const noexcept;
};

/// A mistake in a description.
struct WireMistake {
  WireLine line{};       ///< Line of the file.
  std::string sentence;  ///< What is wrong, with field and byte, and what to do.
};

/// Result of compile_wire.
struct WireCompiled {
  std::shared_ptr<const WireTable> table;  ///< Null if there are mistakes.
  std::vector<WireMistake> mistakes;       ///< All mistakes, in the order of the description.
};

/// Checks a description and makes its tables. Real-time: never from the servo thread.
THIMBLE_EXPORT WireCompiled compile_wire(WireDescription description);

}  // namespace thimble::driver

#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace thimble::driver {

// A wire format as data: what the section `wire` of an arm file says. compile_wire (wire_table.h)
// checks it and makes the table that the servo path uses.

/// Line of a file, for messages; 0: unknown. Two descriptions that differ in lines only are equal.
struct WireLine {
  int number = 0;  ///< Line, from 1.

  friend constexpr bool operator==(const WireLine&, const WireLine&) noexcept { return true; }
};

/// Connection of a described board.
enum class WireTransport : std::uint8_t {
  kHid,     ///< USB HID; each report is one message.
  kSerial,  ///< Serial port, also USB CDC.
  kBulk,    ///< USB bulk transfers on the first interface of the device.
};

/// How messages are delimited.
enum class WireFraming : std::uint8_t {
  kFixed,   ///< A fixed number of bytes, without marks.
  kHeader,  ///< First bytes that identify a message, and a fixed number of bytes.
  kText,    ///< A line of decimal numbers.
  kCobs,    ///< Consistent overhead byte stuffing; a zero byte ends each message.
  kSlip,    ///< Byte stuffing of SLIP; a byte c0 ends each message.
  kLength,  ///< First bytes that identify a message, and a byte with its length.
};

/// Meaning of a field. The driver uses the first group and checks the second; the third is only
/// shown.
enum class WireItem : std::uint8_t {
  kEncoder,      ///< Count of the encoder of an axis.
  kGimbal,       ///< Count of a gimbal encoder, or another value of the same kind.
  kButtons,      ///< Buttons, one bit each.
  kSequence,     ///< Number of the report.
  kMotor,        ///< Requested current, torque or duty cycle of the motor of an axis.
  kConstant,     ///< Always the same value; another one makes the message invalid.
  kErrors,       ///< Error flags of the board.
  kModel,        ///< Model number of the arm.
  kTime,         ///< Time of the board's clock.
  kTemperature,  ///< Temperature of the motor of an axis.
  kVoltage,      ///< Supply voltage.
  kIgnored,      ///< Not used.
};

/// Representation of a field.
enum class WireType : std::uint8_t {
  kUnsigned,  ///< Unsigned integer.
  kSigned,    ///< Integer in two's complement.
  kFloat,     ///< IEEE 754, 4 bytes.
  kNibbles,   ///< A byte for each four bits, the lowest first, in two's complement.
  kNumber,    ///< Decimal integer as text.
  kDecimal,   ///< Decimal number with a fraction as text.
};

/// Unit of a motor value.
enum class WireUnit : std::uint8_t {
  kAmpere,       ///< Current, A.
  kNewtonMetre,  ///< Torque at the motor, N m.
  kDuty,         ///< Duty cycle, -1 to 1, proportional to the torque.
  kDutyRoot,     ///< Duty cycle, -1 to 1, whose square is proportional to the torque.
};

/// A field of a message. In the units of the driver, value = scale * raw + offset.
struct WireFieldText {
  std::string name;                      ///< Name in the file, for messages.
  WireLine line{};                       ///< Line of the file.
  WireItem item = WireItem::kIgnored;    ///< Meaning.
  std::size_t axis = 0;                  ///< Axis, from 0.
  WireType type = WireType::kUnsigned;   ///< Representation.
  std::size_t at = 0;                    ///< First byte; unused in text.
  std::size_t bytes = 1;                 ///< Number of bytes; unused in text.
  bool big_endian = false;               ///< Most significant byte first.
  int bit_first = -1, bit_last = -1;     ///< Range of bits, if not all; -1: all.
  bool inverted = false;                 ///< All bits are inverted.
  int minus = 0;                         ///< Subtracted from each byte, as 65 for 'A'.
  double scale = 1, offset = 0;          ///< Conversion from the raw value.
  std::int64_t value = 0;                ///< Value of a constant.
  std::uint32_t reject = 0;              ///< Error bits with which a report is not used.
  std::vector<std::string> bit_names{};  ///< Names of the error bits, from bit 0.
  WireUnit unit = WireUnit::kAmpere;     ///< Unit of a motor value.
  double full = 0;                       ///< Torque at the motor at full duty cycle, N m.
  double limit = 0;                      ///< Largest absolute value, in `unit`; 0: of the type.
  int decimals = 3;                      ///< Digits of a fraction that are written.
  int wrap = 0;  ///< Bits after which a counter wraps around within the workspace; 0: it does not.

  friend bool operator==(const WireFieldText&, const WireFieldText&) = default;
};

/// Check value of a message.
enum class WireCheck : std::uint8_t { kNone, kSum8, kXor8, kCrc8, kCrc16, kCrc32 };

/// Check value and its parameters.
struct WireCheckText {
  WireCheck kind = WireCheck::kNone;  ///< Kind.
  std::uint32_t polynomial = 0;       ///< Generator polynomial of a CRC.
  std::uint32_t initial = 0;          ///< Initial value.
  std::uint32_t final_xor = 0;        ///< Combined with the result by exclusive or.
  bool reflected = false;             ///< The least significant bit comes first.
  std::size_t from = 0;               ///< First byte that is covered.
  /// First byte of the check value, which covers all bytes before it.
  std::size_t at = 0;
  bool big_endian = false;  ///< Most significant byte of the check value first.

  /// Returns the length of the check value, bytes.
  std::size_t bytes() const noexcept {
    switch (kind) {
      case WireCheck::kNone:
        return 0;
      case WireCheck::kSum8:
      case WireCheck::kXor8:
      case WireCheck::kCrc8:
        return 1;
      case WireCheck::kCrc16:
        return 2;
      case WireCheck::kCrc32:
        return 4;
    }
    return 0;
  }

  friend bool operator==(const WireCheckText&, const WireCheckText&) = default;
};

/// Messages of one direction.
struct WireLayoutText {
  WireLine line{};                            ///< Line of the file.
  WireFraming framing = WireFraming::kFixed;  ///< How messages are delimited.
  std::vector<std::byte> begin{}, end{};      ///< First and last bytes of each message.
  std::vector<std::byte> separator{};         ///< Bytes between two numbers of a text.
  std::vector<std::byte> ignore{};            ///< First bytes of messages that are not reports.
  /// Length with marks and check value; longest text; with kLength, the shortest message.
  std::size_t size = 0;
  std::size_t length_at = 0;    ///< Byte with the length, with kLength.
  std::size_t length_adds = 0;  ///< Number of bytes of a message that its length does not count.
  std::size_t padded = 0;       ///< Length with padding zeros; 0: not padded.
  WireCheckText check{};        ///< Check value.
  std::vector<WireFieldText> fields{};  ///< Fields.

  friend bool operator==(const WireLayoutText&, const WireLayoutText&) = default;
};

/// A message at the start or the end of a connection.
struct WireStep {
  WireLine line{};                  ///< Line of the file.
  std::vector<std::byte> send{};    ///< Bytes that are sent; empty: none.
  std::vector<std::byte> expect{};  ///< Expected answer; empty: none.
  std::vector<bool> any{};          ///< Bytes of the answer that may have any value.
  double within = 0.5;              ///< Longest time until the answer, s.

  friend bool operator==(const WireStep&, const WireStep&) = default;
};

/// USB properties of a described board.
struct WireIdentity {
  std::uint16_t vendor_id = 0, product_id = 0;  ///< USB ids.
  std::string product{};                        ///< Whole product string; empty: not compared.
  std::uint16_t usage_page = 0, usage = 0;      ///< HID usage; 0: not compared.
  std::uint8_t endpoint_in = 0x81, endpoint_out = 0x02;  ///< Endpoints of bulk transfers.

  friend bool operator==(const WireIdentity&, const WireIdentity&) = default;
};

/// A complete wire.
struct WireDescription {
  WireLine line{};                                ///< Line of the file.
  WireTransport transport = WireTransport::kHid;  ///< Connection.
  int baud = 115200;                              ///< Bit rate of a serial port.
  bool streams = false;                           ///< The board sends without being asked.
  double watchdog = 0;      ///< Time without a message until the motors are off, s; 0: none.
  WireIdentity identity{};  ///< How the board is recognised.
  WireLayoutText report{}, command{};  ///< Messages from and to the board.
  std::vector<WireStep> start{};       ///< Messages before the first command.
  std::vector<std::byte> goodbye{};    ///< Last message, after the zero force; empty: none.

  friend bool operator==(const WireDescription&, const WireDescription&) = default;
};

}  // namespace thimble::driver

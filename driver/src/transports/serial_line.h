#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace thimble::driver {

/// An FTDI converter as a serial line with control wires. For set-up only (boot, firmware upload);
/// forces and positions go through a Transport. Every function returns false if the converter did
/// not accept the request; the line is then unusable. Real-time: never from the servo thread.
class SerialLine {
 public:
  SerialLine() = default;
  SerialLine(const SerialLine&) = delete;
  SerialLine& operator=(const SerialLine&) = delete;
  virtual ~SerialLine() = default;

  /// Sets the rate by the converter's own divisor word (FTDI's SET_BAUD_RATE value).
  virtual bool set_rate_divisor(std::uint16_t divisor) = 0;
  /// Sets 8 data bits, no parity, 1 stop bit, no flow control.
  virtual bool set_frame_8n1() = 0;
  virtual bool set_rts(bool high) = 0;  ///< Sets the line RTS.
  virtual bool set_dtr(bool high) = 0;  ///< Sets the line DTR.
  /// Sets the time for which the converter holds bytes back before it sends a packet that is not
  /// full, ms.
  virtual bool set_latency_ms(std::uint8_t latency_ms) = 0;
  /// Discards every byte in the converter, both ways.
  virtual bool purge() = 0;

  /// Sends all bytes.
  virtual bool write(std::span<const std::byte> bytes) = 0;
  /// Waits up to `timeout_ms` for bytes (without FTDI's status bytes). Returns their number: 0 if
  /// none arrived, -1 if the converter is gone.
  virtual int read(std::span<std::byte> bytes, int timeout_ms) = 0;
};

}  // namespace thimble::driver

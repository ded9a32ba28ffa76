#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "thimble/device_sim/usb/usb_device.h"
#include "usb/setup_packet.h"

namespace thimble::device_sim::usb {

/// A queue of bytes of fixed capacity; bytes that do not fit are lost and counted. Real-time: safe.
class ByteQueue {
 public:
  static constexpr std::size_t kCapacity = 1024;  ///< Bytes.

  std::size_t size() const noexcept { return size_; }    ///< Returns the number of queued bytes.
  std::uint64_t lost() const noexcept { return lost_; }  ///< Returns the number of lost bytes.
  void clear() noexcept { size_ = 0; }                   ///< Drops all queued bytes.
  /// Adds a byte; counts it as lost if there is no room.
  void push(std::byte byte) noexcept {
    if (size_ == kCapacity) {
      ++lost_;
      return;
    }
    bytes_[(first_ + size_++) % kCapacity] = byte;
  }
  /// Takes the oldest byte. Precondition: not empty (otherwise returns zero).
  std::byte pop() noexcept {
    if (size_ == 0) return std::byte{0};
    const std::byte byte = bytes_[first_];
    first_ = (first_ + 1) % kCapacity;
    --size_;
    return byte;
  }

 private:
  std::array<std::byte, kCapacity> bytes_{};
  std::size_t first_ = 0, size_ = 0;
  std::uint64_t lost_ = 0;
};

/// The board behind an FTDI converter: it receives bytes and control wires, and sends bytes.
class SerialBoard {
 public:
  SerialBoard() = default;
  SerialBoard(const SerialBoard&) = delete;
  SerialBoard& operator=(const SerialBoard&) = delete;
  virtual ~SerialBoard() = default;

  /// Returns the present baud rate of the board. Real-time: safe.
  virtual double rate() const noexcept = 0;
  /// Receives one byte; may send some. Real-time: safe.
  virtual void hear(std::byte byte, ByteQueue& says) noexcept = 0;
  /// Receives a change of the control wires. Real-time: safe.
  virtual void wires(bool dtr, bool rts) noexcept = 0;
};

/// An FT232BM converter. It moves bytes in both directions at the line's rate, starts every packet
/// to the host with two status bytes, and has the latency timer and the vendor requests of FTDI [S
/// Linux, drivers/usb/serial/ftdi_sio.h; libftdi]. Bytes sent at a baud rate other than that of the
/// board are lost, as noise would be.
class FtdiChip {
 public:
  static constexpr std::uint8_t kInEndpoint = 0x81;       ///< To the host.
  static constexpr std::uint8_t kOutEndpoint = 0x02;      ///< From the host.
  static constexpr std::size_t kStatusBytes = 2;          ///< Before the data of each packet.
  static constexpr std::uint8_t kLatencyDefault_ms = 16;  ///< After power-on [S ftdi_sio].

  /// Keeps a reference to the board, which must outlive the converter.
  explicit FtdiChip(SerialBoard& board) noexcept : board_(board) {}

  // All functions are Real-time: safe.

  /// Answers a control request of the host.
  PacketResult control(const SetupPacket& setup, std::span<std::byte> data) noexcept;
  /// Fills a packet if the latency timer has expired or 62 bytes wait.
  PacketResult in(std::int64_t time_ns, std::span<std::byte> packet) noexcept;
  /// Takes a packet of the host for the serial line.
  PacketResult out(std::span<const std::byte> packet) noexcept;

  /// Returns the time that the line needs for the bytes of the host that can be sent within
  /// `dt_ns`, ns; 0 if nothing waits. The caller advances by that time before `deliver`.
  std::int64_t line_time_ns(std::int64_t dt_ns) const noexcept;
  /// Delivers the host's bytes to the board, and the board's bytes to the host, as many as the line
  /// carries in `dt_ns`.
  void deliver(std::int64_t dt_ns) noexcept;

  /// Returns the latency timer set by the host, ms.
  std::uint8_t latency_ms() const noexcept { return latency_ms_; }
  /// Returns the line's rate set by the host, baud.
  double rate() const noexcept;
  /// Returns the number of bytes lost because the rates did not match.
  std::uint64_t garbled() const noexcept { return garbled_; }

 private:
  SerialBoard& board_;
  ByteQueue to_board_, from_board_, to_host_;
  double to_board_credit_ = 0, to_host_credit_ = 0;  // bytes that the line could have carried
  std::uint32_t divisor_ = 0x4138;                   // 9600 baud
  std::uint8_t latency_ms_ = kLatencyDefault_ms;
  bool dtr_ = false, rts_ = false;
  std::int64_t last_packet_ns_ = 0;
  std::uint64_t garbled_ = 0;
};

}  // namespace thimble::device_sim::usb

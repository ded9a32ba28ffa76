#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <string>
#include <vector>

#include "thimble/device_sim/usb/usb_device.h"
#include "thimble/device_sim/usb/usbip_server.h"
#include "usb/control_pipe.h"
#include "usb/setup_packet.h"
#include "usb/usb_description.h"
#include "usb/usbip_wire.h"

namespace thimble::device_sim::usb {

/// One connection of a USB/IP client to a device: bytes in, bytes out, and in between the schedule
/// of a full-speed bus. It owns no socket and no clock, so that tests can pass bytes directly.
///
/// An interrupt transfer waits for its frame, as on a real bus. In each frame an interrupt endpoint
/// moves one packet if its interval has passed, a bulk endpoint up to kBulkPackets, and the control
/// pipe one transfer. Bulk data to the device may also be sent at once, in the unused part of a
/// frame (`send_bulk`). Transfers of one endpoint keep their order.
class UsbipSession {
 public:
  /// Bulk packets of 64 bytes per frame [USB 2.0, table 5-9].
  static constexpr int kBulkPackets = 19;
  /// Max. number of waiting transfers; a client that submits more is disconnected.
  static constexpr std::size_t kPendingMax = 256;

  /// Max. number of bytes that wait for a client that does not read them. Then no more bytes of the
  /// client are accepted and none of its transfers run. One reply may exceed the limit. [chosen: a
  /// second of reports]
  static constexpr std::size_t kOutputMax = 1U << 16;

  /// State of a connection.
  enum class State : std::uint8_t {
    kAsking,    ///< Not attached yet.
    kAttached,  ///< Transfers are processed.
    kClosing,   ///< Send the rest of `output`, then disconnect.
  };

  /// Keeps a reference to the device, which must outlive the session.
  UsbipSession(UsbDevice& device, std::string bus_id);

  /// Takes bytes of the client. `available` states whether the device may be imported now. Bytes
  /// that are not a message set the state to kClosing. Real-time: never from the servo thread.
  void receive(std::span<const std::byte> bytes, bool available);

  /// Runs one frame of the bus at its start time (ns); a device that is gone sets the state to
  /// kClosing. The caller advances the device's time. Real-time: never from the servo thread.
  void frame(std::int64_t time_ns);

  /// Returns whether bulk data wait to be sent to the device. Real-time: safe.
  bool has_bulk_to_send() const noexcept;

  /// Sends bulk data to the device in the running frame. The caller advances the device's time.
  /// Real-time: never from the servo thread.
  void send_bulk();

  /// Returns whether more bytes of the client may be accepted: not while too many unread bytes wait
  /// for it. Real-time: safe.
  bool takes_more() const noexcept { return output_.size() < kOutputMax; }

  /// Returns the bytes for the client; the caller removes the bytes it has sent from the front.
  std::vector<std::byte>& output() noexcept { return output_; }

  State state() const noexcept { return state_; }
  const UsbipCounters& counters() const noexcept { return counters_; }

 private:
  struct Transfer {
    std::uint32_t sequence = 0;
    std::uint8_t address = 0;  // of the endpoint
    SetupPacket setup;
    std::vector<std::byte> data;  // data for the device, or room for data from it
    std::size_t moved = 0;
  };
  enum class Step : std::uint8_t { kWaits, kComplete, kGone };

  bool whole(Decode decoded) noexcept;
  std::size_t ask(std::span<const std::byte> bytes, bool available);
  std::size_t command(std::span<const std::byte> bytes);
  void unlink(const UsbipCommand& command);
  template <class Chosen>
  void run_chosen(std::int64_t frame, Chosen&& chosen);
  bool is_bulk_out(const Transfer& transfer) const noexcept;
  Step run(Transfer& transfer, std::int64_t frame);
  Step run_control(Transfer& transfer);
  Step run_packets(Transfer& transfer, const EndpointDescription& endpoint);
  Step complete(const Transfer& transfer, std::int32_t status);

  UsbDevice& device_;
  std::string bus_id_;
  ControlPipe pipe_;
  State state_ = State::kAsking;
  std::vector<std::byte> input_, output_;
  std::deque<Transfer> pending_;
  UsbipCounters counters_;
};

}  // namespace thimble::device_sim::usb

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

/// One connection of a USB/IP client to a device: bytes in, bytes out, and in between the
/// schedule of a full-speed bus. It owns no socket and no clock, so that tests feed it by hand.
///
/// An interrupt transfer waits for its frame, as it does on a real bus: in each frame an interrupt
/// endpoint moves one packet if its interval is over, a bulk endpoint up to kBulkPackets, and the
/// control pipe one transfer. What goes out in bulk may also go at once, in what a frame has left
/// (`send_bulk`). Transfers of one endpoint keep their order.
class UsbipSession {
 public:
  /// How many bulk packets of 64 bytes a frame holds [USB 2.0, table 5-9].
  static constexpr int kBulkPackets = 19;
  /// How many transfers may wait; a client that hands over more is hung up on.
  static constexpr std::size_t kPendingMax = 256;

  /// How many bytes may wait for a client that does not read them: then nothing more is taken from
  /// it and no transfer of its is run. One reply may go beyond. [chosen: a second of reports]
  static constexpr std::size_t kOutputMax = 1U << 16;

  /// What a connection is good for.
  enum class State : std::uint8_t {
    kAsking,    ///< Not attached yet.
    kAttached,  ///< Transfers flow.
    kClosing,   ///< Send what is left of `output`, then hang up.
  };

  /// Keeps a reference to the device, which must live longer.
  UsbipSession(UsbDevice& device, std::string bus_id);

  /// Takes bytes of the client. `available` says whether the device may be imported now. What is no
  /// message makes the state kClosing. Real-time: never from the servo thread.
  void receive(std::span<const std::byte> bytes, bool available);

  /// Runs one frame of the bus at its start time (ns); a device that is gone makes the state
  /// kClosing. The caller moves the device's time. Real-time: never from the servo thread.
  void frame(std::int64_t time_ns);

  /// Returns whether bulk data wait to go to the device. Real-time: safe.
  bool has_bulk_to_send() const noexcept;

  /// Sends bulk data to the device in the running frame. The caller moves the device's time.
  /// Real-time: never from the servo thread.
  void send_bulk();

  /// Returns whether more bytes of the client may be taken: not while too many wait for it to be
  /// read. Real-time: safe.
  bool takes_more() const noexcept { return output_.size() < kOutputMax; }

  /// Gives the bytes for the client; the caller takes away from the front what it sent.
  std::vector<std::byte>& output() noexcept { return output_; }

  State state() const noexcept { return state_; }
  const UsbipCounters& counters() const noexcept { return counters_; }

 private:
  struct Transfer {
    std::uint32_t sequence = 0;
    std::uint8_t address = 0;  // of the endpoint
    SetupPacket setup;
    std::vector<std::byte> data;  // what goes to the device, or room for what it sends
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

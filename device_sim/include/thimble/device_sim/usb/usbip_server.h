#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "thimble/device_sim/usb/usb_fault.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::device_sim::usb {

class UsbipSession;

/// Counts of what happened on one connection, or on all of a server.
struct UsbipCounters {
  std::uint64_t submitted = 0;  ///< Transfers asked for.
  std::uint64_t completed = 0;  ///< Transfers answered without error.
  std::uint64_t stalled = 0;    ///< Transfers answered by a stall.
  std::uint64_t babbled = 0;    ///< Transfers in which the device sent more than it was asked for.
  std::uint64_t unlinked = 0;   ///< Transfers taken back while pending.
};

/// The registered TCP port of USB/IP.
inline constexpr std::uint16_t kUsbipPort = 3240;

/// Where a server listens and what it calls its device.
struct UsbipServerSettings {
  std::string address = "127.0.0.1";  ///< IPv4; anything but loopback lets other machines in.
  std::uint16_t port = kUsbipPort;    ///< 0 lets the system choose.
  std::string bus_id = "1-1";         ///< By which the kernel asks for it.
};

/// Serves one device to USB/IP clients: sockets on one side, frames of the bus on the other. Any
/// number of clients may ask; one at a time may have the device. One thread.
///
/// No client can hold it up: one that does not ask within kPatience_ns, or does not read for so
/// long what it asked for, is disconnected; meanwhile a bounded number of bytes is kept for it. If
/// all places are taken, a new client gets the place of the one that has asked for nothing the
/// longest.
class THIMBLE_EXPORT UsbipServer {
 public:
  /// How long a client may ask for nothing, or read nothing, ns of the bus. [chosen]
  static constexpr std::int64_t kPatience_ns = 5'000'000'000;
  /// How many clients may be connected.
  static constexpr std::size_t kClientsMax = 16;

  /// Called after each frame with its number.
  using FrameObserver = std::function<void(std::int64_t)>;

  /// Listens. Keeps a reference to the device, which must live longer. Fails with a sentence that
  /// says what to do if the port is taken. Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<UsbipServer>> open(FaultyDevice& device,
                                                           const UsbipServerSettings& settings);

  /// Serves a device without listening; clients come by `adopt` only.
  UsbipServer(FaultyDevice& device, std::string bus_id);
  UsbipServer(const UsbipServer&) = delete;
  UsbipServer& operator=(const UsbipServer&) = delete;
  /// Hangs up on everybody; an attached kernel then sees the device unplugged.
  ~UsbipServer();

  /// Takes over a connected stream socket as a client and closes it in the end.
  void adopt(int socket);

  /// Waits up to `timeout_ms` for clients, takes what they say and sends what is ready.
  void serve(int timeout_ms);

  /// Lets the bus run one frame with this start time (ns) and sends what became ready.
  void frame(std::int64_t time_ns);

  /// Sends what clients have for bulk endpoints, in the middle of a frame, at this time (ns).
  void send_bulk(std::int64_t time_ns);

  /// Serves at the pace of the wall clock, a frame each millisecond, until `stop` is set. A frame
  /// that comes too late is left out and counted.
  void run(const std::atomic<bool>& stop, const FrameObserver& observer);

  /// Returns the port that it listens on, 0 if on none.
  std::uint16_t port() const noexcept { return port_; }
  const std::string& bus_id() const noexcept { return bus_id_; }  ///< Returns the device's.
  /// Returns whether a client has the device now.
  bool attached() const noexcept;
  /// Returns how many frames `run` left out.
  std::uint64_t late_frames() const noexcept { return late_frames_; }
  /// Returns what happened on all connections so far.
  UsbipCounters counters() const noexcept;

 private:
  struct Client {
    int socket = -1;
    std::unique_ptr<UsbipSession> session;
    bool heard_all = false;     // the client has hung up
    std::int64_t since_ns = 0;  // when it came; once attached, when it last read what waits for it
  };

  void take(Client& client);
  void wait_for(int timer);
  void send_ready(Client& client);
  void accept_client();
  bool make_room();
  void drop_late();
  void drop_finished();

  FaultyDevice& device_;
  std::string bus_id_;
  std::uint16_t port_ = 0;
  int listener_ = -1;
  std::vector<Client> clients_;
  UsbipCounters past_;
  std::uint64_t late_frames_ = 0;
  std::int64_t now_ns_ = 0;  // of the bus
};

}  // namespace thimble::device_sim::usb

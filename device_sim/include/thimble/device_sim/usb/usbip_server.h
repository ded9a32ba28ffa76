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

/// Counters of one connection, or of all connections of a server.
struct UsbipCounters {
  std::uint64_t submitted = 0;  ///< Transfers requested.
  std::uint64_t completed = 0;  ///< Transfers answered without error.
  std::uint64_t stalled = 0;    ///< Transfers answered by a stall.
  std::uint64_t babbled = 0;    ///< Transfers in which the device sent more than requested.
  std::uint64_t unlinked = 0;   ///< Transfers cancelled while pending.
};

/// Registered TCP port of USB/IP.
inline constexpr std::uint16_t kUsbipPort = 3240;

/// Address of a server and name of its device.
struct UsbipServerSettings {
  /// IPv4 address; other machines can connect unless it is loopback.
  std::string address = "127.0.0.1";
  std::uint16_t port = kUsbipPort;  ///< TCP port; 0: chosen by the system.
  std::string bus_id = "1-1";       ///< Bus id by which the kernel requests the device.
};

/// Serves one device to USB/IP clients: connects sockets with frames of the bus. Any number of
/// clients may send requests, but only one at a time can attach the device. Single-threaded.
///
/// No client can block the server. A client is disconnected if it sends no request within
/// kPatience_ns, or does not read its replies for that time. Meanwhile a bounded number of bytes is
/// buffered for it. If all places are taken, a new client replaces the one that has been without a
/// request for longest.
class THIMBLE_EXPORT UsbipServer {
 public:
  /// Longest time for which a client may send no request or read nothing, ns of the bus. [chosen]
  static constexpr std::int64_t kPatience_ns = 5'000'000'000;
  /// Largest number of connected clients.
  static constexpr std::size_t kClientsMax = 16;

  /// Callback after each frame, with the frame number.
  using FrameObserver = std::function<void(std::int64_t)>;

  /// Opens a server and listens. Keeps a reference to the device, which must outlive it. If the
  /// port is taken, the error states the remedy. Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<UsbipServer>> open(FaultyDevice& device,
                                                           const UsbipServerSettings& settings);

  /// Constructs a server that does not listen; clients are added by `adopt` only.
  UsbipServer(FaultyDevice& device, std::string bus_id);
  UsbipServer(const UsbipServer&) = delete;
  UsbipServer& operator=(const UsbipServer&) = delete;
  /// Disconnects all clients; an attached kernel then sees the device unplugged.
  ~UsbipServer();

  /// Takes ownership of a connected stream socket as a client.
  void adopt(int socket);

  /// Waits up to `timeout_ms` for clients, processes their requests and sends available replies.
  void serve(int timeout_ms);

  /// Runs one frame of the bus with this start time (ns) and sends the replies that became
  /// available.
  void frame(std::int64_t time_ns);

  /// Sends the clients' data for bulk endpoints, in the middle of a frame, at this time (ns).
  void send_bulk(std::int64_t time_ns);

  /// Serves in real time, one frame per millisecond, until `stop` is set. A late frame is skipped
  /// and counted.
  void run(const std::atomic<bool>& stop, const FrameObserver& observer);

  /// Returns the listening port, 0 if there is none.
  std::uint16_t port() const noexcept { return port_; }
  /// Returns the bus id of the device.
  const std::string& bus_id() const noexcept { return bus_id_; }
  /// Returns whether a client has attached the device.
  bool attached() const noexcept;
  /// Returns the number of frames that `run` skipped.
  std::uint64_t late_frames() const noexcept { return late_frames_; }
  /// Returns the counters of all connections so far.
  UsbipCounters counters() const noexcept;

 private:
  struct Client {
    int socket = -1;
    std::unique_ptr<UsbipSession> session;
    bool heard_all = false;  // True if the client has disconnected.
    // Time of the connection; once attached, time at which the client last read pending data.
    std::int64_t since_ns = 0;
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
  std::int64_t now_ns_ = 0;  // Time of the bus, ns.
};

}  // namespace thimble::device_sim::usb

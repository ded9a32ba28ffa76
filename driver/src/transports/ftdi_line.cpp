#include "transports/ftdi_line.h"

#include <libusb-1.0/libusb.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "transports/ftdi_packet.h"
#include "transports/ftdi_transport.h"
#include "transports/node_lock.h"

namespace thimble::driver {
namespace {

// Requests of FTDI converters and their values [S libnifalcon FalconCommLibUSB.cpp, libftdi].
constexpr std::uint8_t kVendorOut = LIBUSB_REQUEST_TYPE_VENDOR;  // to the device
enum FtdiRequest : std::uint8_t {
  kReset = 0,
  kModemControl = 1,
  kFlowControl = 2,
  kBaudRate = 3,
  kData = 4,
  kLatency = 9,
};
constexpr std::uint16_t kPurgeReceived = 1, kPurgeToSend = 2;
constexpr std::uint16_t kDtr = 0x0001, kDtrMask = 0x0100;
constexpr std::uint16_t kRts = 0x0002, kRtsMask = 0x0200;
constexpr std::uint16_t kEightBits = 8;
constexpr unsigned kTimeout_ms = 1000;

class UsbFtdiLine final : public FtdiLine {
 public:
  explicit UsbFtdiLine(FtdiUsb usb) : usb_(std::move(usb)) {}

  bool set_rate_divisor(std::uint16_t divisor) override { return request(kBaudRate, divisor); }
  bool set_frame_8n1() override { return request(kData, kEightBits) && request(kFlowControl, 0); }
  bool set_rts(bool high) override {
    return request(kModemControl, high ? kRts | kRtsMask : kRtsMask);
  }
  bool set_dtr(bool high) override {
    return request(kModemControl, high ? kDtr | kDtrMask : kDtrMask);
  }
  bool set_latency_ms(std::uint8_t latency_ms) override { return request(kLatency, latency_ms); }
  bool purge() override {
    heard_.clear();
    return request(kReset, kPurgeReceived) && request(kReset, kPurgeToSend);
  }

  bool write(std::span<const std::byte> bytes) override {
    std::vector<std::byte> copy(bytes.begin(), bytes.end());
    int sent = 0;
    return usb_.handle &&
           libusb_bulk_transfer(usb_.handle.get(), kFtdiEndpointOut,
                                reinterpret_cast<unsigned char*>(copy.data()),
                                static_cast<int>(copy.size()), &sent, kTimeout_ms) == 0 &&
           sent == static_cast<int>(copy.size());
  }

  int read(std::span<std::byte> bytes, int timeout_ms) override {
    // The converter sends only its status bytes once per latency time, so those rounds are counted.
    for (int waited_ms = 0; heard_.empty() && waited_ms <= timeout_ms; ++waited_ms) {
      std::array<std::byte, kFtdiPacketSize> packet{};
      int count = 0;
      const int code = usb_.handle
                           ? libusb_bulk_transfer(usb_.handle.get(), kFtdiEndpointIn,
                                                  reinterpret_cast<unsigned char*>(packet.data()),
                                                  static_cast<int>(packet.size()), &count,
                                                  static_cast<unsigned>(std::max(timeout_ms, 1)))
                           : LIBUSB_ERROR_NO_DEVICE;
      if (code == LIBUSB_ERROR_TIMEOUT && count == 0) return 0;
      if (code != 0 && code != LIBUSB_ERROR_TIMEOUT) return -1;
      for_each_ftdi_packet(std::span(packet).first(static_cast<std::size_t>(count)),
                           [&](std::span<const std::byte> content) {
                             heard_.insert(heard_.end(), content.begin(), content.end());
                           });
    }
    const std::size_t size = std::min(bytes.size(), heard_.size());
    std::copy_n(heard_.begin(), size, bytes.begin());
    heard_.erase(heard_.begin(), heard_.begin() + static_cast<std::ptrdiff_t>(size));
    return static_cast<int>(size);
  }

  Result<std::unique_ptr<Transport>> into_transport(const Framing& framing,
                                                    const Clock& clock) override {
    return start_ftdi_transport(std::move(usb_), framing, clock);
  }

 private:
  bool request(std::uint8_t number, int value) {
    return usb_.handle && libusb_control_transfer(usb_.handle.get(), kVendorOut, number,
                                                  static_cast<std::uint16_t>(value), 0, nullptr, 0,
                                                  kTimeout_ms) == 0;
  }

  FtdiUsb usb_;
  std::vector<std::byte> heard_;  // bytes received and not read yet
};

Error cannot_open(const UsbAddress& address, int code) {
  const std::string where = "the USB device at bus " + std::to_string(address.bus) + ", device " +
                            std::to_string(address.device);
  if (code == LIBUSB_ERROR_ACCESS) {
    return Error{
        "No access to " + where +
        ". Install udev/70-thimble.rules and plug the arm in again (see `thimble doctor`)."};
  }
  if (code == LIBUSB_ERROR_BUSY) {
    return Error{in_use(usb_node(address))};
  }
  return Error{where + " cannot be opened (" + libusb_strerror(code) + ")."};
}

}  // namespace

Result<FtdiUsb> open_bulk_device(const UsbAddress& address, const BulkEnds& ends) {
  libusb_context* raw_context = nullptr;
  if (const int code = libusb_init(&raw_context); code != 0) return cannot_open(address, code);
  FtdiUsb usb;
  usb.context.reset(raw_context);
  libusb_device** devices = nullptr;
  const ssize_t count = libusb_get_device_list(usb.context.get(), &devices);
  int code = LIBUSB_ERROR_NO_DEVICE;
  for (ssize_t i = 0; i < count; ++i) {
    if (libusb_get_bus_number(devices[i]) != address.bus ||
        libusb_get_device_address(devices[i]) != address.device) {
      continue;
    }
    libusb_device_handle* handle = nullptr;
    code = libusb_open(devices[i], &handle);
    usb.handle.reset(handle);
  }
  if (devices != nullptr) libusb_free_device_list(devices, 1);
  if (code != 0) return cannot_open(address, code);
  libusb_set_auto_detach_kernel_driver(usb.handle.get(), 1);
  // Only one program can claim an interface, so the claim is the lock.
  code = libusb_claim_interface(usb.handle.get(), kFtdiInterface);
  if (code != 0) return cannot_open(address, code);
  // An endpoint that stalled under the previous program stays halted until it is cleared. A
  // converter that refuses this fails at the first request.
  libusb_clear_halt(usb.handle.get(), ends.in);
  libusb_clear_halt(usb.handle.get(), ends.out);
  return usb;
}

Result<std::unique_ptr<FtdiLine>> FtdiLine::open(const UsbAddress& address) {
  auto usb = open_bulk_device(address, {});
  if (!usb) return usb.error();
  return std::unique_ptr<FtdiLine>(std::make_unique<UsbFtdiLine>(std::move(usb).value()));
}

}  // namespace thimble::driver

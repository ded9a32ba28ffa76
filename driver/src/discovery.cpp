#include "thimble/driver/discovery.h"

#include <libusb-1.0/libusb.h>

#include <memory>

namespace thimble::driver {
namespace {

struct KnownArm {
  std::uint16_t vendor_id;
  std::uint16_t product_id;
  const char* arm;
  const char* bus;
};

// All [S]: read in the arms' open-source drivers and firmware, or in their vendors' udev rules.
constexpr KnownArm kKnownArms[] = {
    {0x1234, 0x0006, "WoodenHaptics", "USB HID"},  {0x16c0, 0x0486, "Polhem v2", "USB HID"},
    {0x0403, 0xcb48, "Novint Falcon", "USB FTDI"}, {0x2988, 0x0302, "Touch", "USB serial"},
    {0x2988, 0x0304, "Touch X", "USB HID"},        {0x1451, 0x0402, "Force Dimension", "USB"},
};

const KnownArm* known_arm(std::uint16_t vendor_id, std::uint16_t product_id) noexcept {
  for (const KnownArm& known : kKnownArms) {
    if (known.vendor_id == vendor_id && known.product_id == product_id) return &known;
  }
  return nullptr;
}

Error cannot_list(int code) {
  return Error{std::string("USB devices cannot be listed (") + libusb_strerror(code) +
               "). Check that /dev/bus/usb is there and readable."};
}

}  // namespace

const char* arm_of_usb_id(std::uint16_t vendor_id, std::uint16_t product_id) noexcept {
  const KnownArm* known = known_arm(vendor_id, product_id);
  return known ? known->arm : nullptr;
}

Result<std::vector<FoundArm>> find_arms() {
  libusb_context* raw_context = nullptr;
  if (const int code = libusb_init(&raw_context); code != 0) return cannot_list(code);
  const std::unique_ptr<libusb_context, void (*)(libusb_context*)> context(raw_context,
                                                                           &libusb_exit);
  libusb_device** devices = nullptr;
  const ssize_t count = libusb_get_device_list(context.get(), &devices);
  if (count < 0) return cannot_list(static_cast<int>(count));

  std::vector<FoundArm> found;
  for (ssize_t i = 0; i < count; ++i) {
    libusb_device_descriptor descriptor{};
    if (libusb_get_device_descriptor(devices[i], &descriptor) != 0) continue;
    const KnownArm* known = known_arm(descriptor.idVendor, descriptor.idProduct);
    if (!known) continue;
    found.push_back({.arm = known->arm,
                     .bus = known->bus,
                     .address = "bus " + std::to_string(libusb_get_bus_number(devices[i])) +
                                ", device " + std::to_string(libusb_get_device_address(devices[i])),
                     .vendor_id = descriptor.idVendor,
                     .product_id = descriptor.idProduct});
  }
  libusb_free_device_list(devices, 1);
  return found;
}

}  // namespace thimble::driver

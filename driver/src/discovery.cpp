#include "thimble/driver/discovery.h"

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <fstream>
#include <system_error>

namespace thimble::driver {
namespace {

namespace fs = std::filesystem;

struct KnownArm {
  std::uint16_t vendor_id;
  std::uint16_t first_product_id, last_product_id;
  ArmKind kind;
  const char* arm;
  const char* bus;
};

// All [S]: read in the arms' open-source drivers and firmware, or in their vendors' udev rules.
// 16c0:0480 to 048f are the ids that a Teensy takes by what its program does; 0486 is raw HID, and
// those with a serial port may be a Haptikfabriken arm or any other Teensy.
constexpr KnownArm kKnownArms[] = {
    {0x1234, 0x0006, 0x0006, ArmKind::kWoody, "WoodenHaptics", "USB HID"},
    {0x16c0, 0x0486, 0x0486, ArmKind::kPolhem, "Polhem v2", "USB HID"},
    {0x16c0, 0x0480, 0x048f, ArmKind::kHfabLine, "hfab (Teensy)", "USB serial"},
    {0x0403, 0xcb48, 0xcb48, ArmKind::kFalcon, "Novint Falcon", "USB FTDI"},
    {0x2988, 0x0302, 0x0302, ArmKind::kUnsupported, "Touch", "USB serial"},
    {0x2988, 0x0304, 0x0304, ArmKind::kUnsupported, "Touch X", "USB HID"},
    {0x1451, 0x0402, 0x0402, ArmKind::kUnsupported, "Force Dimension", "USB"},
};

const KnownArm* known_arm(std::uint16_t vendor_id, std::uint16_t product_id) noexcept {
  for (const KnownArm& known : kKnownArms) {
    if (known.vendor_id == vendor_id && known.first_product_id <= product_id &&
        product_id <= known.last_product_id) {
      return &known;
    }
  }
  return nullptr;
}

template <class Number>
Number number_in(const fs::path& file, int base) {
  const std::string text = read_line(file);
  Number number{};
  std::from_chars(text.data(), text.data() + text.size(), number, base);
  return number;
}

/// Lists a folder in the order of names; nothing if it is none.
std::vector<fs::path> entries(const fs::path& folder) {
  std::vector<fs::path> found;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

/// Finds the first hidraw node of a device: interface/bus:vendor:product.n/hidraw/hidrawN. The
/// first interface is the one that carries reports; a Teensy's second is its debug output.
std::string hidraw_node(const fs::path& device) {
  for (const fs::path& interface : entries(device)) {
    for (const fs::path& hid : entries(interface)) {
      for (const fs::path& node : entries(hid / "hidraw"))
        return "/dev/" + node.filename().string();
    }
  }
  return {};
}

/// Finds the first serial port of a device: interface/tty/ttyACM0.
std::string tty_node(const fs::path& device) {
  for (const fs::path& interface : entries(device)) {
    for (const fs::path& node : entries(interface / "tty")) {
      return "/dev/" + node.filename().string();
    }
  }
  return {};
}

std::string usb_node(const UsbAddress& address) {
  char text[40];
  std::snprintf(text, sizeof text, "/dev/bus/usb/%03d/%03d", address.bus, address.device);
  return text;
}

}  // namespace

std::string read_line(const fs::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  return line;
}

std::string FoundArm::name() const {
  if (!serial.empty()) return serial;
  return "usb-" + std::to_string(usb.bus) + "-" + std::to_string(usb.device);
}

const char* arm_of_usb_id(std::uint16_t vendor_id, std::uint16_t product_id) noexcept {
  const KnownArm* known = known_arm(vendor_id, product_id);
  return known ? known->arm : nullptr;
}

Result<std::vector<FoundArm>> find_arms(const fs::path& root) {
  const fs::path devices = root / "sys/bus/usb/devices";
  std::error_code missing;
  if (!fs::is_directory(devices, missing)) {
    return Error{"USB devices cannot be listed: " + devices.string() +
                 " is not there. Check that the kernel has USB and that sysfs is mounted."};
  }
  std::vector<FoundArm> found;
  for (const fs::path& device : entries(devices)) {
    const auto vendor_id = number_in<std::uint16_t>(device / "idVendor", 16);
    const auto product_id = number_in<std::uint16_t>(device / "idProduct", 16);
    const KnownArm* known = known_arm(vendor_id, product_id);
    if (!known) continue;
    FoundArm arm;
    arm.kind = known->kind;
    arm.arm = known->arm;
    arm.bus = known->bus;
    arm.vendor_id = vendor_id;
    arm.product_id = product_id;
    arm.serial = read_line(device / "serial");
    arm.usb = {.bus = number_in<int>(device / "busnum", 10),
               .device = number_in<int>(device / "devnum", 10)};
    arm.address =
        "bus " + std::to_string(arm.usb.bus) + ", device " + std::to_string(arm.usb.device);
    arm.sysfs = device;
    switch (known->kind) {
      case ArmKind::kWoody:
      case ArmKind::kPolhem:
        arm.node = hidraw_node(device);
        break;
      case ArmKind::kHfabLine:
        arm.node = tty_node(device);
        // A Teensy without a serial port (a keyboard, say) is no arm.
        if (arm.node.empty() && product_id != 0x0483) continue;
        break;
      case ArmKind::kFalcon:
      case ArmKind::kUnsupported:
        arm.node = usb_node(arm.usb);
        break;
    }
    const fs::path node = root / fs::path(arm.node).relative_path();
    arm.accessible = !arm.node.empty() && access(node.c_str(), R_OK | W_OK) == 0;
    found.push_back(std::move(arm));
  }
  return found;
}

}  // namespace thimble::driver

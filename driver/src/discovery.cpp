#include "thimble/driver/discovery.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <span>
#include <system_error>

#include "arm_table.h"
#include "board_identity.h"
#include "transports/hid_descriptor.h"
#include "vendors/linked_arms.h"

namespace thimble::driver {
namespace {

namespace fs = std::filesystem;

template <class Number>
Number number_in(const fs::path& file, int base) {
  const std::string text = read_line(file);
  Number number{};
  std::from_chars(text.data(), text.data() + text.size(), number, base);
  return number;
}

/// Reads a string of a device; control characters of a terminal become '?'.
std::string device_string(const fs::path& file) {
  std::string text = read_line(file);
  std::replace_if(
      text.begin(), text.end(), [](char sign) { return sign < ' ' || sign > '~'; }, '?');
  return text;
}

/// Lists a folder, sorted by name; empty if it is not a folder.
std::vector<fs::path> entries(const fs::path& folder) {
  std::vector<fs::path> found;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

/// Lists the entries whose name is that of a bus, a colon and more. In a device's folder these are
/// its interfaces ("1-1:1.0"), in an interface's folder its HID devices ("0003:1234:0006.0001") [S
/// linux/drivers/usb/core, drivers/hid/hid-core.c]. All other entries are attributes, and links
/// that lead to half of /sys.
std::vector<fs::path> bus_entries(const fs::path& folder) {
  std::vector<fs::path> found = entries(folder);
  std::erase_if(found, [](const fs::path& entry) {
    return entry.filename().string().find(':') == std::string::npos;
  });
  return found;
}

HidReports descriptor_of(const fs::path& hid) {
  constexpr std::size_t kDescriptorMax =
      4096;  // HID_MAX_DESCRIPTOR_SIZE, linux/include/linux/hid.h
  std::array<char, kDescriptorMax> bytes{};
  std::ifstream stream(hid / "report_descriptor", std::ios::binary);
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return read_hid_descriptor(
      std::as_bytes(std::span(bytes).first(static_cast<std::size_t>(stream.gcount()))));
}

/// A hidraw node with its report descriptor.
struct HidNode {
  std::string node;
  HidReports reports;
};

/// Finds a device's raw HID node: interface/bus:vendor:product.n/hidraw/hidrawN. A Teensy has a
/// second one, its debug output, and their order is not defined. So the node is selected by usage
/// page; if none has it, the first node is used.
HidNode hidraw_node(const fs::path& device) {
  HidNode found;
  for (const fs::path& interface : bus_entries(device)) {
    for (const fs::path& hid : bus_entries(interface)) {
      for (const fs::path& node : entries(hid / "hidraw")) {
        const HidReports reports = descriptor_of(hid);
        const bool raw = reports.usage_page == kRawHidPage && reports.usage == kRawHidUsage;
        if (!raw && !found.node.empty()) continue;
        found = {"/dev/" + node.filename().string(), reports};
        if (raw) return found;
      }
    }
  }
  return found;
}

/// Finds the first serial port of a device: interface/tty/ttyACM0.
std::string tty_node(const fs::path& device) {
  for (const fs::path& interface : bus_entries(device)) {
    for (const fs::path& node : entries(interface / "tty")) {
      return "/dev/" + node.filename().string();
    }
  }
  return {};
}

/// A described board with its certainty.
struct Described {
  const DescribedBoard* board = nullptr;
  Certainty certainty = Certainty::kUnknown;
};

/// Returns the described board that a device is. If several match, the first of the most certain.
/// A board that the driver knows by itself needs a proof to be another one.
Described described_of(const std::vector<DescribedBoard>& boards, const UsbFacts& facts,
                       const std::optional<BoardIdentity>& known) {
  Described found;
  for (const DescribedBoard& board : boards) {
    if (!matches(board, facts)) continue;
    const Certainty certainty = certainty_of(board);
    if (found.board == nullptr || certainty < found.certainty) found = {&board, certainty};
  }
  if (found.board == nullptr || !known) return found;
  const bool taken = known->certainty == Certainty::kUnsupported ||
                     known->board == BoardKind::kFalconFtdi ||
                     (known->board != BoardKind::kOther && found.certainty != Certainty::kKnown);
  return taken ? Described{} : found;
}

}  // namespace

std::string usb_node(const UsbAddress& address) {
  const auto digits = [](int number) {
    const std::string text = std::to_string(number);
    return std::string(text.size() < 3 ? 3 - text.size() : 0, '0') + text;
  };
  return "/dev/bus/usb/" + digits(address.bus) + '/' + digits(address.device);
}

std::string read_line(const fs::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  return line;
}

bool is_placeholder(std::string_view serial) noexcept {
  // Serial numbers of boards whose makers set none: mbed's USB library has 0123456789 [S mbed
  // USBDevice.cpp, stringIserialDesc]; the others are usual in such libraries and examples.
  constexpr std::string_view kCounted = "0123456789ABCDEF";
  const auto same = [&serial](char sign) { return sign == serial.front(); };
  return serial.empty() || std::all_of(serial.begin(), serial.end(), same) ||
         kCounted.starts_with(serial) || kCounted.substr(1).starts_with(serial) ||
         serial == "1234567890" || serial == "0123456789abcdef";
}

std::string FoundArm::name() const {
  if (!serial_is_shared && !is_placeholder(serial)) return serial;
  if (!sysfs.empty()) return "usb-" + sysfs.filename().string();
  return "usb-" + std::to_string(usb.bus) + "-" + std::to_string(usb.device);
}

Result<std::vector<FoundArm>> find_arms(const fs::path& root,
                                        const std::vector<DescribedBoard>& described) {
  const fs::path devices = root / "sys/bus/usb/devices";
  std::vector<FoundArm> found;
  if (root == "/") found = find_linked_arms();
  std::error_code missing;
  if (!fs::is_directory(devices, missing)) {
    if (!found.empty()) return found;
    return Error{"Cannot list USB devices: " + devices.string() +
                 " does not exist. Check that the kernel supports USB and that sysfs is mounted."};
  }
  for (const fs::path& device : entries(devices)) {
    const auto vendor_id = number_in<std::uint16_t>(device / "idVendor", 16);
    const auto product_id = number_in<std::uint16_t>(device / "idProduct", 16);
    const std::string product = device_string(device / "product");
    const HidNode hid = hidraw_node(device);
    const std::string tty = tty_node(device);
    const UsbFacts facts{.vendor_id = vendor_id,
                         .product_id = product_id,
                         .product = product,
                         .has_hidraw = !hid.node.empty(),
                         .hid = hid.reports,
                         .has_tty = !tty.empty()};
    const auto identity = identify(facts);
    const Described own = described_of(described, facts, identity);
    if (!identity && own.board == nullptr) continue;
    FoundArm arm;
    if (own.board != nullptr) {
      arm.kind = ArmKind::kDescribed;
      arm.board = BoardKind::kDescribed;
      arm.certainty = own.certainty;
      arm.arm = own.board->arm;
      arm.bus = own.board->bulk ? kBulkBus : own.board->serial ? kSerialBus : kHidBus;
      arm.arm_file = own.board->arm_file;
    } else {
      arm.kind = kind_of(identity->board);
      arm.board = identity->board;
      arm.certainty = identity->certainty;
      arm.arm = identity->arm;
      arm.bus = identity->bus;
    }
    arm.vendor_id = vendor_id;
    arm.product_id = product_id;
    arm.serial = device_string(device / "serial");
    arm.product = product;
    arm.manufacturer = device_string(device / "manufacturer");
    arm.release = number_in<std::uint16_t>(device / "bcdDevice", 16);
    arm.hid = hid.reports;
    arm.usb = {.bus = number_in<int>(device / "busnum", 10),
               .device = number_in<int>(device / "devnum", 10)};
    arm.address =
        "bus " + std::to_string(arm.usb.bus) + ", device " + std::to_string(arm.usb.device);
    arm.sysfs = device;
    arm.node = arm.bus == kHidBus ? hid.node : arm.bus == kSerialBus ? tty : usb_node(arm.usb);
    const fs::path node = root / fs::path(arm.node).relative_path();
    arm.accessible = !arm.node.empty() && access(node.c_str(), R_OK | W_OK) == 0;
    found.push_back(std::move(arm));
  }
  link_boards(found);
  for (FoundArm& arm : found) {
    const auto same = [&arm](const FoundArm& other) { return other.serial == arm.serial; };
    arm.serial_is_shared = std::count_if(found.begin(), found.end(), same) > 1;
  }
  return found;
}

}  // namespace thimble::driver

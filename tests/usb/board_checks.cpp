#include "usb/board_checks.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "thimble/device_sim/usb/arm_shelf.h"
#include "thimble/driver/transports.h"
#include "thimble/driver/wire_link.h"
#include "usb/board_vectors.h"
#include "usb/usb_description.h"

namespace thimble::usb_test {
namespace {

constexpr std::int64_t kPeriod_ns = 1'000'000;

std::string line_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

}  // namespace

int verdict(bool pass, const std::string& what, const std::string& detail) {
  std::printf("%s %s: %s\n", pass ? "PASS" : "FAIL", what.c_str(), detail.c_str());
  std::fflush(stdout);
  return pass ? 0 : 1;
}

int check_kernel(const VirtualArm& arm) {
  const auto found = arm.find();
  if (!found) return verdict(false, arm.name + " in the kernel", found.error().message);
  const auto made = device_sim::usb::make_usb_arm(arm.board(), {});
  if (!made) return verdict(false, arm.name + " in the kernel", made.error().message);
  const device_sim::usb::UsbDescription& d = (*made)->description();
  char release[8];
  std::snprintf(release, sizeof release, "%04x", static_cast<unsigned>(d.release));
  const std::filesystem::path& device = found->sysfs;
  std::string wrong;
  const auto same = [&](const char* what, const std::string& wanted) {
    const std::string shown = line_of(device / what);
    if (shown != wanted) wrong += std::string(" ") + what + " is '" + shown + "',";
  };
  same("bcdDevice", release);
  same("manufacturer", d.manufacturer);
  same("product", d.product);
  same("serial", d.serial);
  std::string interfaces = std::to_string(d.interfaces.size());
  interfaces.insert(0, 2 - interfaces.size(), ' ');  // the kernel prints two digits
  same("bNumInterfaces", interfaces);
  std::string nodes;
  for (std::size_t i = 0; i < d.interfaces.size(); ++i) {
    const auto& wanted = d.interfaces[i].report_descriptor;
    if (wanted.empty()) continue;
    const auto folder = device / (device.filename().string() + ":1." + std::to_string(i));
    bool matches = false;
    std::error_code ignored;
    for (const auto& hid : std::filesystem::directory_iterator(folder, ignored)) {
      std::ifstream in(hid.path() / "report_descriptor", std::ios::binary);
      const std::string shown((std::istreambuf_iterator<char>(in)), {});
      if (shown.empty()) continue;
      matches = std::equal(shown.begin(), shown.end(), wanted.begin(), wanted.end(),
                           [](char a, std::byte b) { return static_cast<std::byte>(a) == b; });
      for (const auto& node : std::filesystem::directory_iterator(hid.path() / "hidraw", ignored)) {
        const std::string path = "/dev/" + node.path().filename().string();
        nodes += " " + path + " of interface " + std::to_string(i) + ",";
        if ((path == found->node) != (i == 0)) wrong += " the arm's node is " + found->node + ",";
      }
    }
    if (!matches) wrong += " report descriptor of interface " + std::to_string(i) + ",";
  }
  return verdict(wrong.empty(), arm.name + " in the kernel",
                 wrong.empty() ? "bcdDevice " + std::string(release) + "," + nodes +
                                     " descriptors byte for byte"
                               : "not as sent by the board:" + wrong);
}

int check_vectors(const VirtualArm& arm) {
  int count = 0, bad = 0;
  for (const BoardVector& vector : kBoardVectors) {
    if (vector.board != arm.name) continue;
    const auto protocol = arm.protocol();
    driver::ArmReading reading;
    if (!protocol->decode(vector.report(), reading)) return verdict(false, arm.name, "no report");
    const Eigen::Vector3d p_BT = protocol->pose(reading).p_BT;
    const Eigen::Vector3d wanted(vector.tip[0], vector.tip[1], vector.tip[2]);
    bad += (p_BT - wanted).norm() < 1e-8 ? 0 : 1;
    ++count;
  }
  if (count == 0) return 0;
  return verdict(bad == 0, arm.name + " signs",
                 std::to_string(count) + " published poses, " + std::to_string(bad) + " elsewhere");
}

int check_unasked(const VirtualArm& arm) {
  const driver::WallClock clock(0);
  const auto found = arm.find();
  if (!found || arm.is_falcon()) return 0;
  const auto wire = arm.open(*found, clock);
  if (!wire) return verdict(false, arm.name + " listened to", wire.error().message);
  std::uint64_t reports = 0;
  const std::int64_t end_ns = clock.now_ns() + 300'000'000;
  while (clock.now_ns() < end_ns) {
    std::array<std::byte, driver::kReportCapacity> buffer{};
    const auto read = (*wire)->read_latest(buffer, clock.now_ns() + 10'000'000);
    if (read.status == driver::TransportStatus::kOk) reports += 1 + read.skipped;
  }
  return verdict(arm.answers() ? reports == 0 : reports > 250, arm.name + " listened to",
                 std::to_string(reports) + " reports in 300 ms without a message");
}

int check_wrong_length(const VirtualArm& arm) {
  const driver::WallClock clock(0);
  const auto found = arm.find();
  if (!found || arm.is_falcon()) return 0;
  const std::size_t size = arm.message_size() == 64 ? 14 : 64;
  auto wire = driver::open_hid_transport(found->node, size, clock);
  if (!wire)
    return verdict(true, arm.name + " with messages of another length",
                   "refused: " + wire.error().message);
  auto device =
      driver::Device::open(std::make_unique<driver::WireLink>(std::move(*wire), arm.protocol()),
                           check_settings(), clock.now_ns());
  if (!device)
    return verdict(true, arm.name + " with messages of another length",
                   "refused: " + device.error().message);
  if (!(*device)->activate()) return 1;
  for (int i = 0; i < 100; ++i) {
    (*device)->read(clock.now_ns(), clock.now_ns() + kPeriod_ns);
    (*device)->write({});
  }
  const driver::Fault fault = (*device)->fault();
  return verdict(fault != driver::Fault::kNone, arm.name + " with messages of another length",
                 "fault '" + std::string(driver::name(fault)) + "'");
}

}  // namespace thimble::usb_test

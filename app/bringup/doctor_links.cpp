#include "bringup/doctor_links.h"

#include <grp.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdio>
#include <system_error>

#include "board_identity.h"
#include "vendors/dhd/dhd_library.h"
#include "vendors/haply/haply_link.h"
#include "vendors/hd/hd_library.h"

namespace thimble::bringup {
namespace {

using driver::BoardKind;
using driver::Certainty;
using driver::FoundArm;

/// Returns whether it is the USB side of an arm that a service drives.
bool is_haply_on_usb(const FoundArm& arm) {
  return arm.certainty == Certainty::kUnsupported && arm.arm == "Haply Inverse3";
}

/// Returns whether a program of this name runs.
bool runs(const std::string& program, const std::filesystem::path& root) {
  std::error_code ignored;
  const std::filesystem::directory_iterator processes(root / "proc", ignored);
  return std::any_of(begin(processes), end(processes), [&](const auto& process) {
    return driver::read_line(process.path() / "comm") == program;
  });
}

/// Returns whether a shared library is where Debian or a vendor's installer puts it.
bool is_installed(const char* library, const std::filesystem::path& root) {
  std::error_code ignored;
  for (const char* folder : {"lib", "lib64", "lib/x86_64-linux-gnu", "usr/lib", "usr/lib64",
                             "usr/lib/x86_64-linux-gnu", "usr/local/lib"}) {
    if (std::filesystem::exists(root / folder / library, ignored)) return true;
  }
  return false;
}

/// Returns the group of a file; empty if the group has no name.
std::string group_of(const std::filesystem::path& file) {
  struct stat status {};
  if (stat(file.c_str(), &status) != 0) return {};
  const group* found = getgrgid(status.st_gid);
  return found == nullptr ? std::string() : found->gr_name;
}

/// Returns a udev rule that gives the user at the screen access to an arm's node.
std::string rule_for(const FoundArm& arm) {
  char maker[8];
  std::snprintf(maker, sizeof maker, "%04x", arm.vendor_id);
  const std::string id = std::string("\"") + maker + "\"";
  const std::string access = "TAG+=\"uaccess\"";
  if (arm.bus == driver::kSerialBus) {
    return "SUBSYSTEM==\"tty\", ATTRS{idVendor}==" + id + ", " + access +
           ", ENV{ID_MM_DEVICE_IGNORE}=\"1\"";
  }
  if (arm.bus == driver::kHidBus) {
    return "SUBSYSTEM==\"hidraw\", ATTRS{idVendor}==" + id + ", " + access;
  }
  return "SUBSYSTEM==\"usb\", ENV{DEVTYPE}==\"usb_device\", ATTR{idVendor}==" + id + ", " + access;
}

}  // namespace

std::string access_fix(const FoundArm& arm) {
  if (is_haply_on_usb(arm)) {
    return "Use it through its vendor's service; `thimble devices` then lists it on another line. "
           "This USB device is never opened.";
  }
  if (arm.arm == "Force Dimension") {
    const auto library = driver::dhd::library();
    return library ? std::string("Plug it in again.")
                   : library.error().message +
                         " Install the vendor's SDK and set FDSDK to its folder, or set "
                         "THIMBLE_DHD_LIBRARY to its libdrd.so.3. Thimble drives the arm through "
                         "this library.";
  }
  const auto library = driver::hd::library();
  if (library) return "Plug it in again.";
  return library.error().message +
         " Install OpenHaptics and the arm's driver (they need libncurses5 and membership in the "
         "group of the device node), or set THIMBLE_HD_LIBRARY to libHD.so. Thimble drives the arm "
         "through this library.";
}

Finding examine_linked(const FoundArm& arm) {
  const std::string name = arm.arm + " " + arm.name() + ": ";
  if (arm.certainty == Certainty::kUnknown) {
    return {Health::kAdvice,
            name + "the server on " + arm.address +
                " is `thimble exec --serve haply`, not Haply's service.",
            "--device auto ignores it; to use it, pass --device " + arm.name()};
  }
  if (!arm.trouble.empty()) {
    return {Health::kProblem,
            name + "its service on " + arm.address + " lists it, but it cannot be used.",
            arm.trouble};
  }
  return {Health::kGood,
          name + "its service on " + arm.address + " lists it" +
              (arm.software.empty() ? " without version numbers" : " (" + arm.software + ")") +
              ". Not tested on hardware.",
          {}};
}

Finding examine_access(const FoundArm& arm, const std::filesystem::path& root) {
  const std::string name = arm.arm + " " + arm.name() + ": ";
  if (arm.node.empty()) {
    return {
        Health::kProblem,
        name +
            "no kernel driver is bound to it, so its vendor's library has no device node to open.",
        arm.bus == driver::kSerialBus ? "sudo modprobe cdc_acm, then plug it in again"
                                      : "sudo modprobe usbhid, then plug it in again"};
  }
  if (arm.accessible) {
    return {Health::kGood,
            name + "you have access to " + arm.node + ", which its vendor's library opens.",
            {}};
  }
  const std::string group = group_of(root / std::filesystem::path(arm.node).relative_path());
  std::string remedy =
      "The vendor's set-up steps for access are not published; repeat the set-up from its manual. ";
  if (!group.empty() && group != "root") {
    remedy += "Or join the group of the device node and log in again: sudo usermod -aG " + group +
              " $USER. ";
  }
  remedy +=
      "Or add this line to /etc/udev/rules.d/70-vendor-arm.rules and plug the arm in again: " +
      rule_for(arm);
  return {Health::kProblem,
          name + "you have no access to " + arm.node + ", which its vendor's library must open" +
              (group.empty() ? "." : " (group " + group + ")."),
          remedy};
}

std::vector<Finding> examine_services(const std::vector<FoundArm>& arms) {
  const bool on_usb = std::any_of(arms.begin(), arms.end(), is_haply_on_usb);
  const bool served = std::any_of(arms.begin(), arms.end(), [](const FoundArm& arm) {
    return arm.board == BoardKind::kHaplyService;
  });
  if (!on_usb || served) return {};
  const auto asked = driver::haply::find_arms(driver::haply::port_of_user());
  const std::string why = asked ? "The service runs but lists no Inverse3." : asked.error().message;
  return {{Health::kProblem, "An Inverse3 is plugged in, but no service lists it. " + why,
           "Install and start Haply's Inverse Service; if it uses another port, set "
           "THIMBLE_HAPLY_PORT to its WebSocket port"}};
}

std::vector<Finding> examine_touch(const std::vector<FoundArm>& arms,
                                   const std::filesystem::path& root) {
  std::vector<Finding> findings;
  const bool plugged_in = std::any_of(arms.begin(), arms.end(), [](const FoundArm& arm) {
    return arm.vendor_id == driver::kTouchMaker;
  });
  if (!plugged_in) return findings;
  if (runs("ModemManager", root)) {
    findings.push_back({Health::kAdvice,
                        "ModemManager is running and may open the Touch's serial port first.",
                        "sudo systemctl stop ModemManager while you use the Touch"});
  }
  if (!is_installed("libncurses.so.5", root)) {
    findings.push_back({Health::kAdvice,
                        "libncurses.so.5 is not installed; the Touch's vendor library needs it.",
                        "Install libncurses5 (Debian 12: sudo apt install libncurses5)"});
  }
  return findings;
}

}  // namespace thimble::bringup

#include "bringup/doctor.h"

#include <grp.h>
#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <system_error>
#include <thread>

#include "bringup/board_advice.h"
#include "bringup/doctor_links.h"
#include "bringup/doctor_timing.h"
#include "files/data_folders.h"
#include "thimble/driver/discovery.h"
#include "thimble/scene/real_arm.h"
#include "transports/node_lock.h"

namespace thimble::bringup {
namespace {

namespace fs = std::filesystem;
using driver::BoardKind;
using driver::FoundArm;
using driver::read_line;

constexpr const char* kRule = "70-thimble.rules";

// The rule that came with this program: next to app/ in the sources, or below the same prefix.
fs::path own_rule() {
  const fs::path own = scene::own_folder();
  for (const fs::path& place : {own.parent_path() / "udev" / kRule,
                                own.parent_path().parent_path() / "lib/udev/rules.d" / kRule}) {
    std::error_code missing;
    if (!own.empty() && fs::exists(place, missing)) return place;
  }
  return fs::path("udev") / kRule;
}

std::string install_rule() {
  return "sudo cp " + own_rule().string() +
         " /etc/udev/rules.d/ && sudo udevadm control --reload && sudo udevadm trigger";
}

class Examination {
 public:
  explicit Examination(const SystemInfo& system) : system_(system) {}

  std::vector<Finding> run() {
    look_for_rule();
    look_at_arms();
    for (Finding& found : examine_timing(system_, arm_)) findings_.push_back(std::move(found));
    return std::move(findings_);
  }

 private:
  void note(Health health, std::string what, std::string remedy = {}) {
    findings_.push_back({health, std::move(what), std::move(remedy)});
  }

  fs::path below_root(const fs::path& path) const { return system_.root / path.relative_path(); }

  void look_for_rule() {
    for (const char* folder : {"/etc/udev/rules.d", "/usr/lib/udev/rules.d", "/lib/udev/rules.d",
                               "/usr/local/lib/udev/rules.d", "/run/udev/rules.d"}) {
      std::error_code missing;
      if (fs::exists(below_root(fs::path(folder) / kRule), missing)) {
        rule_ = true;
        note(Health::kGood, std::string("The udev rule is installed in ") + folder + ".");
        return;
      }
    }
    note(Health::kProblem, "The udev rule is not installed; only root may open an arm.",
         install_rule());
  }

  void look_at_arms() {
    const auto arms = scene::find_arms(system_.root);
    if (!arms) {
      note(Health::kProblem, arms.error().message, "sudo modprobe usbcore");
      return;
    }
    if (arms->empty()) {
      note(Health::kAdvice, "No supported arm was found on USB.",
           "Plug it in and switch it on; `lsusb` lists it if the computer detects it.");
    }
    arm_ = std::any_of(arms->begin(), arms->end(), [](const FoundArm& arm) {
      return arm.certainty != driver::Certainty::kUnsupported;
    });
    for (const FoundArm& arm : *arms) look_at(arm);
    for (Finding& found : examine_services(*arms)) findings_.push_back(std::move(found));
    for (Finding& found : examine_touch(*arms, system_.root)) {
      findings_.push_back(std::move(found));
    }
  }

  void look_at(const FoundArm& arm) {
    const std::string name = arm.arm + " " + arm.name() + ": ";
    if (arm.certainty == driver::Certainty::kUnsupported) {
      note(Health::kAdvice,
           name + "plugged in, but not supported over USB because its protocol is not public.",
           access_fix(arm));
      return;
    }
    if (arm.board == BoardKind::kHaplyService) {
      findings_.push_back(examine_linked(arm));
      return;
    }
    if (arm.board == BoardKind::kDhdLibrary || arm.board == BoardKind::kHdLibrary) {
      note(Health::kGood, name + "its vendor's library is installed (" + arm.software +
                              "). Not tested on hardware.");
      findings_.push_back(examine_access(arm, system_.root));
      look_at_holder(arm, name);
      look_at_power(arm, name);
      look_at_hub(arm, name);
      return;
    }
    look_at_driver(arm, name);
    if (arm.certainty == driver::Certainty::kUnknown) {
      note(Health::kAdvice, name + what_it_may_be(arm), how_to_use(arm));
    } else {
      look_at_access(arm, name);
    }
    look_at_holder(arm, name);
    look_at_power(arm, name);
    look_at_hub(arm, name);
  }

  void look_at_driver(const FoundArm& arm, const std::string& name) {
    const std::string bound = bound_driver(arm);
    switch (arm.board) {
      case BoardKind::kMbedHid8:
      case BoardKind::kMbedHid14:
      case BoardKind::kTeensyRawHid64:
      case BoardKind::kOther:
        if (!arm.node.empty()) {
          note(Health::kGood, name + "the kernel's HID driver provides it as " + arm.node + ".");
        } else if (bound.empty()) {
          note(Health::kProblem,
               name + "no kernel driver is bound to it, so it has no hidraw node.",
               "sudo modprobe usbhid && sudo modprobe hid-generic, then plug it in again");
        } else {
          note(Health::kProblem,
               name + "the kernel driver " + bound + " is bound to it, but it has no hidraw node.",
               "Use a kernel with CONFIG_HIDRAW, such as Debian's, then plug it in again");
        }
        return;
      case BoardKind::kTextLines:
        if (!arm.node.empty()) {
          note(Health::kGood, name + "the kernel's serial driver provides it as " + arm.node + ".");
        } else {
          note(Health::kProblem,
               name + "no kernel driver is bound to it, so it has no serial port.",
               "sudo modprobe cdc_acm, then plug it in again");
        }
        return;
      case BoardKind::kDescribed:
        if (arm.node.empty()) {
          note(Health::kProblem, name + "no kernel driver is bound to it, so it has no node.",
               "sudo modprobe cdc_acm usbhid, then plug it in again");
        } else {
          note(Health::kGood, name + "it is described by the arm file " + arm.arm_file +
                                  ", and the kernel provides it as " + arm.node + ".");
        }
        return;
      case BoardKind::kHaplyService:
      case BoardKind::kDhdLibrary:
      case BoardKind::kHdLibrary:
        return;  // opened by their vendors' software
      case BoardKind::kFalconFtdi:
        look_at_falcon(arm, bound, name);
        return;
    }
  }

  void look_at_falcon(const FoundArm& arm, const std::string& bound, const std::string& name) {
    if (bound == "ftdi_sio") {
      const std::string latency = falcon_latency(arm);
      note(Health::kAdvice,
           name + "the kernel's serial driver ftdi_sio is bound to it" +
               (latency.empty() ? "" : " with a latency timer of " + latency + " ms") +
               ". Thimble detaches the driver and sets 1 ms; other programs may need it detached "
               "first.",
           "echo " + arm.sysfs.filename().string() +
               ":1.0 | sudo tee /sys/bus/usb/drivers/ftdi_sio/unbind");
    } else if (!bound.empty() && bound != "usbfs") {
      note(Health::kProblem, name + "the kernel driver " + bound + " is bound to it.",
           "echo " + arm.sysfs.filename().string() + ":1.0 | sudo tee /sys/bus/usb/drivers/" +
               bound + "/unbind");
    } else if (bound == "usbfs") {
      note(Health::kAdvice, name + "another program has it open.", "Close that program");
    } else {
      note(Health::kGood, name + "no kernel driver blocks access.");
    }
  }

  void look_at_access(const FoundArm& arm, const std::string& name) {
    if (arm.node.empty()) return;  // already reported above
    if (arm.accessible) {
      note(Health::kGood, name + "you have access to " + arm.node + ".");
    } else if (arm.board == BoardKind::kDescribed) {
      note(Health::kProblem,
           name + "you have no access to " + arm.node +
               ": the installed udev rule covers only the arms that Thimble knows.",
           "echo '" + udev_line(arm) +
               "' | sudo tee -a /etc/udev/rules.d/71-my-arm.rules && sudo udevadm control "
               "--reload, then plug it in again");
    } else if (!rule_) {
      note(Health::kProblem,
           name + "you have no access to " + arm.node + ": the udev rule is missing.",
           install_rule());
    } else if (!system_.in_plugdev) {
      note(Health::kProblem,
           name + "you have no access to " + arm.node +
               ": it was plugged in before the rule was installed, or you are not the user of the "
               "local session.",
           "Plug it in again; over a remote login: sudo usermod -aG plugdev $USER, then log in "
           "again");
    } else {
      note(Health::kProblem,
           name + "you have no access to " + arm.node +
               ", although the udev rule and your groups are correct.",
           "Plug it in again, or: sudo udevadm trigger");
    }
  }

  void look_at_holder(const FoundArm& arm, const std::string& name) {
    if (arm.node.empty()) return;
    if (const auto holder = driver::find_holder(arm.node, system_.root)) {
      note(Health::kProblem,
           name + "the program " + holder->program + " (process " + std::to_string(holder->pid) +
               ") has it open.",
           "Close that program; only one may send forces");
    }
  }

  void look_at_power(const FoundArm& arm, const std::string& name) {
    if (read_line(arm.sysfs / "power/control") == "auto") {
      note(Health::kAdvice, name + "the kernel may suspend it to save power.",
           "echo on | sudo tee /sys/bus/usb/devices/" + arm.sysfs.filename().string() +
               "/power/control");
    }
  }

  /// A full-speed arm behind a full-speed hub shares 12 Mbit/s with all devices there. Behind a
  /// high-speed hub it has a translator that may add a frame.
  void look_at_hub(const FoundArm& arm, const std::string& name) {
    const std::string port = arm.sysfs.filename().string();
    const std::size_t dot = port.rfind('.');
    if (dot == std::string::npos) return;
    const std::string hub = port.substr(0, dot);
    const std::string speed = read_line(arm.sysfs.parent_path() / hub / "speed");
    if (speed == "12" || speed == "1.5") {
      note(Health::kAdvice,
           name +
               "it is connected to a full-speed hub and shares bus time with the hub's other "
               "devices.",
           "Plug it directly into the computer");
    } else {
      note(Health::kAdvice,
           name + "it is connected to a hub; a direct connection is more reliable.",
           "Plug it directly into the computer");
    }
  }

  static std::string bound_driver(const FoundArm& arm) {
    const fs::path link = arm.sysfs / (arm.sysfs.filename().string() + ":1.0") / "driver";
    std::error_code missing;
    const fs::path target = fs::read_symlink(link, missing);
    return missing ? std::string() : target.filename().string();
  }

  static std::string falcon_latency(const FoundArm& arm) {
    const fs::path interface = arm.sysfs / (arm.sysfs.filename().string() + ":1.0");
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(interface, ignored)) {
      std::string latency = read_line(entry.path() / "latency_timer");
      if (!latency.empty()) return latency;
    }
    return {};
  }

  const SystemInfo& system_;
  std::vector<Finding> findings_;
  bool rule_ = false;
  bool arm_ = false;  // an arm that can be driven is plugged in
};

/// Returns whether the kernel grants a thread of this process the priority of the servo loop.
bool may_run_first() {
  constexpr int kPriority = 80;
  bool granted = false;
  std::thread([&granted] {
    sched_param requested{};
    requested.sched_priority = kPriority;
    granted = pthread_setschedparam(pthread_self(), SCHED_FIFO, &requested) == 0;
  }).join();
  return granted;
}

}  // namespace

SystemInfo this_machine() {
  SystemInfo system;
  rlimit limit{};
  if (getrlimit(RLIMIT_RTPRIO, &limit) == 0) {
    system.real_time_priority_max =
        limit.rlim_cur == RLIM_INFINITY ? 99 : static_cast<long>(limit.rlim_cur);
  }
  // An administrator may lack that capability, for example in a container.
  if (geteuid() == 0 && may_run_first()) system.real_time_priority_max = 99;
  if (const group* plugdev = getgrnam("plugdev")) {
    std::vector<gid_t> groups(static_cast<std::size_t>(std::max(getgroups(0, nullptr), 0)));
    const int count = getgroups(static_cast<int>(groups.size()), groups.data());
    groups.resize(static_cast<std::size_t>(std::max(count, 0)));
    system.in_plugdev = std::find(groups.begin(), groups.end(), plugdev->gr_gid) != groups.end();
  }
  return system;
}

Finding examine_log(const fs::path& file) {
  fs::path place = file;
  std::error_code missing;
  // Missing parent folders are created when they are needed.
  while (!fs::exists(place, missing) && place.has_relative_path()) place = place.parent_path();
  if (access(place.c_str(), W_OK) == 0) {
    return {Health::kGood, "Events are logged to " + file.string() + ".", {}};
  }
  return {Health::kAdvice, "Events cannot be logged to " + file.string() + ".",
          "Make " + place.string() + " writable, or choose another file with --log"};
}

std::vector<Finding> examine(const SystemInfo& system) {
  return Examination(system).run();
}

}  // namespace thimble::bringup

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "arms/falcon/falcon_boot.h"
#include "cli/commands.h"
#include "cli/file_options.h"
#include "cli/plug_commands.h"
#include "cli/report_error.h"
#include "cli/usage/help_text.h"
#include "cli/usage/usage_error.h"
#include "gravity_terms.h"
#include "log/logger.h"
#include "log/printed_text.h"
#include "output/output_file.h"
#include "signals.h"
#include "thimble/device_sim/usb/arm_shelf.h"
#include "thimble/device_sim/usb/usb_fault.h"
#include "thimble/device_sim/usb/usbip_server.h"
#include "thimble/device_sim/usb/vhci.h"
#include "thimble/scene/arm_file.h"

namespace thimble::cli {
namespace {

namespace usb = device_sim::usb;

struct PlugOptions {
  std::string arm;
  std::string address = "127.0.0.1";
  std::uint16_t port = usb::kUsbipPort;
  bool attach = false;
  std::string motion = "tap";
  std::string serial, arm_file;
  std::uint64_t seed = 0;
  std::string firmware, faults, control, trace;
};

/// Attaches the device to the kernel in a separate thread, because the server must answer
/// meanwhile. Repeats this whenever the device is plugged in again.
class KernelAttachment {
 public:
  KernelAttachment(std::uint16_t port, std::string bus_id)
      : port_(port), bus_id_(std::move(bus_id)) {}
  KernelAttachment(const KernelAttachment&) = delete;
  KernelAttachment& operator=(const KernelAttachment&) = delete;
  ~KernelAttachment() {
    if (thread_.joinable()) thread_.join();
  }

  /// Starts an attempt, unless one is pending.
  void begin() {
    if (busy_.load()) return;
    if (thread_.joinable()) thread_.join();
    busy_.store(true);
    thread_ = std::thread([this] {
      const auto attached = usb::attach_to_kernel(port_, bus_id_);
      if (attached) {
        scene::print_format("Attached to this kernel: port %d of the virtual USB host.\n",
                            *attached);
      } else {
        scene::logger().error("{}", attached.error().message);
        failed_.store(true);
      }
      std::fflush(stdout);
      busy_.store(false);
    });
  }
  bool busy() const { return busy_.load(); }
  bool failed() const { return failed_.load(); }

 private:
  std::uint16_t port_;
  std::string bus_id_;
  std::thread thread_;
  std::atomic<bool> busy_{false}, failed_{false};
};

/// Writes the true state of the arm in each frame in which a packet moved, for tests.
class TruthTrace {
 public:
  explicit TruthTrace(output::OutputFile output)
      : output_(std::move(output)),
        file_(fdopen(fcntl(output_.descriptor(), F_DUPFD_CLOEXEC, 3), "w")) {
    if (file_ != nullptr) {
      std::fprintf(file_,
                   "# frame reports sampled_frame c0 c1 c2 exact0 exact1 exact2 messages m0 m1 m2 "
                   "amp0 amp1 amp2 x y z motors_on sampled_ns message_ns\n");
    }
  }
  TruthTrace(const TruthTrace&) = delete;
  TruthTrace& operator=(const TruthTrace&) = delete;
  ~TruthTrace() {
    if (file_ != nullptr) std::fclose(file_);
  }

  void add(std::int64_t frame, const usb::ArmTruth& truth) {
    if (file_ == nullptr) return;
    const bool moved =
        truth.reports != reports_ || truth.messages != messages_ || truth.motors_on != motors_on_;
    if (!moved) return;
    reports_ = truth.reports;
    messages_ = truth.messages;
    motors_on_ = truth.motors_on;
    std::fprintf(file_, "%lld %llu %lld %d %d %d %.4f %.4f %.4f %llu %d %d %d %.6f %.6f %.6f ",
                 static_cast<long long>(frame), static_cast<unsigned long long>(truth.reports),
                 static_cast<long long>(truth.report_ns / usb::UsbDevice::kFrame_ns),
                 truth.counts[0], truth.counts[1], truth.counts[2], truth.exact_counts[0],
                 truth.exact_counts[1], truth.exact_counts[2],
                 static_cast<unsigned long long>(truth.messages), truth.motor_values[0],
                 truth.motor_values[1], truth.motor_values[2], truth.currents[0], truth.currents[1],
                 truth.currents[2]);
    std::fprintf(file_, "%.7f %.7f %.7f %d %lld %lld\n", truth.p_BT[0], truth.p_BT[1],
                 truth.p_BT[2], truth.motors_on ? 1 : 0, static_cast<long long>(truth.report_ns),
                 static_cast<long long>(truth.message_ns));
  }

 private:
  output::OutputFile output_;
  std::FILE* file_;
  std::uint64_t reports_ = 0, messages_ = 0;
  bool motors_on_ = false;
};

usb::HandMotion motion_of(const std::string& name) {
  if (name == "none") return usb::HandMotion::kNone;
  if (name == "rest") return usb::HandMotion::kRest;
  return name == "tap" ? usb::HandMotion::kTap : usb::HandMotion::kStroke;
}

void print_instructions(const usb::UsbipServer& server, const PlugOptions& options) {
  scene::print_format("The simulated arm '%s' is available on port %u as USB device %s.\n",
                      options.arm.c_str(), static_cast<unsigned>(server.port()),
                      server.bus_id().c_str());
  if (!options.attach) {
    scene::print_format(
        "To plug it in, run as root: modprobe vhci-hcd; usbip --tcp-port %u attach -r 127.0.0.1 "
        "-b %s\n",
        static_cast<unsigned>(server.port()), server.bus_id().c_str());
  }
  scene::print_format("Press Ctrl-C to unplug it.\n");
  std::fflush(stdout);
}

/// Returns the arm file at `path`; fails if its arm cannot be simulated.
driver::Result<scene::ArmFile> simulated_file(const std::string& path) {
  auto file = scene::load_arm(path);
  if (file && !file->can_simulate) {
    return driver::Error{"--arm: " + path +
                         " has no section 'simulation', so the arm cannot be simulated."};
  }
  return file;
}

int plug(const PlugOptions& options) {
  usb::ShelfOptions shelf;
  shelf.motion = motion_of(options.motion);
  shelf.serial = options.serial;
  shelf.seed = options.seed;
  if (!options.firmware.empty()) {
    auto image = driver::falcon::read_firmware(options.firmware);
    if (!image) {
      return report_error(image.error(), kExitBadInput);
    }
    shelf.firmware = std::move(*image);
  }
  std::optional<Eigen::Vector3d> gravity_B;
  if (!options.arm_file.empty()) {
    const auto file = simulated_file(options.arm_file);
    if (!file) return report_error(file.error(), kExitBadInput);
    shelf.arm = usb::ShelfArm{.model = file->model, .settings = file->simulated};
    shelf.arm->settings.firmware.described = file->wire;
    gravity_B = file->R_WB.transpose() * Eigen::Vector3d(0, 0, -scene::kGravity);
  }
  auto arm = usb::make_usb_arm(options.arm, shelf);
  if (!arm) {
    return report_error(arm.error(), kExitBadInput);
  }
  usb::FaultyDevice device(**arm, options.seed);
  PluggedArm plugged{
      .device = device, .arm = **arm, .p_BH = (*arm)->truth().p_BT, .gravity_B = gravity_B};
  if (!options.faults.empty() && !execute_file(plugged, options.faults)) return kExitBadInput;
  CommandPipe control;
  if (!options.control.empty() && !control.open(options.control)) {
    return report_error(
        {"--control: cannot create the pipe " + options.control + ". Remove an existing file."},
        kExitBadInput);
  }
  std::optional<TruthTrace> trace;
  if (!options.trace.empty()) {
    auto output = output::OutputFile::open(options.trace, output::kMotionTrace);
    // The file is published at once, because it is read while the arm is plugged in.
    auto named = output ? output->publish() : driver::Result<void>(output.error());
    if (!named) return report_error(named.error(), kExitBadInput);
    trace.emplace(std::move(output).value());
  }
  auto server = usb::UsbipServer::open(device, {.address = options.address, .port = options.port});
  if (!server) {
    return report_error(server.error(), kExitTrouble);
  }
  print_instructions(**server, options);

  // Set by Ctrl-C, or when the kernel refused the device.
  const std::atomic<bool>& interrupted = scene::catch_interrupts();
  std::atomic<bool> stop{false};
  KernelAttachment attachment((*server)->port(), (*server)->bus_id());
  if (options.attach) attachment.begin();
  bool was_plugged = true;
  (*server)->run(stop, [&](std::int64_t frame) {
    if (trace) trace->add(frame, (*arm)->truth());
    control.poll(plugged);
    if (options.attach && device.plugged() && !was_plugged) attachment.begin();
    was_plugged = device.plugged();
    if (interrupted.load() || attachment.failed()) stop.store(true);
  });
  const usb::UsbipCounters counters = (*server)->counters();
  scene::print_format(
      "Unplugged. Transfers: %llu submitted, %llu completed, %llu stalled, %llu too long, %llu "
      "cancelled. Skipped frames: %llu.\n",
      static_cast<unsigned long long>(counters.submitted),
      static_cast<unsigned long long>(counters.completed),
      static_cast<unsigned long long>(counters.stalled),
      static_cast<unsigned long long>(counters.babbled),
      static_cast<unsigned long long>(counters.unlinked),
      static_cast<unsigned long long>((*server)->late_frames()));
  for (std::size_t kind = 0; kind < usb::kFaultKinds; ++kind) {
    const auto fault = static_cast<usb::FaultKind>(kind);
    if (device.hits(fault) == 0) continue;
    scene::print_format("Fault %s affected %llu packets.\n", std::string(usb::name(fault)).c_str(),
                        static_cast<unsigned long long>(device.hits(fault)));
  }
  return attachment.failed() ? kExitTrouble : kExitDone;
}

/// Returns why the name of a simulated USB arm is invalid; "" if it is valid.
std::string check_arm_name(const std::string& name) {
  std::vector<std::string> names;
  for (const usb::ShelfEntry& entry : usb::kShelf) names.emplace_back(entry.name);
  names.emplace_back(usb::kDescribedName);
  if (std::find(names.begin(), names.end(), name) != names.end()) return {};
  std::string known;
  for (const std::string& one : names) known += (known.empty() ? "" : ", ") + one;
  return "expected one of " + known + "; found \"" + name + "\"." + suggestion(name, names);
}

/// Returns why a text is no address of the server; "" if it is one.
std::string check_address(const std::string& text) {
  in_addr address{};
  if (inet_pton(AF_INET, text.c_str(), &address) == 1) return {};
  return "expected an IPv4 address, for example 127.0.0.1, found \"" + text + "\"";
}

/// Returns the names and descriptions of the arms, one per line.
std::string arm_list() {
  std::string list = "Arms:\n";
  for (const usb::ShelfEntry& entry : usb::kShelf) {
    list += std::string(entry.name) + ": " + std::string(entry.what) + "\n";
  }
  list += "described: arm of --arm on the HID board that its file describes\n";
  return list;
}

constexpr const char* kPlugNotes =
    "--hand     none: no hand after homing. rest: holds the home pose. tap: moves up\n"
    "           and down. stroke: moves on a circle.\n"
    "--arm      Replaces torque constants, tip, weight, drive train, hand and wiring\n"
    "           of the built-in arm. The tested driver does not need the file.\n"
    "--serial   Default: that of the board (all mbed boards: 0123456789).\n"
    "--faults   One fault per line: KIND [in|out] [after=FRAMES] [for=FRAMES]\n"
    "           [rate=CHANCE]. KIND: stall, short, long, torn, stale, duplicate,\n"
    "           silence, bit_errors, unplug, lost.\n"
    "--control  Commands: a fault as in --faults; `heal` (ends faults); `hand X Y Z`\n"
    "           (m, along the axes of the base, from the start of the hand);\n"
    "           `hand off`, `hand on` (let go of the tip, hold it); `mass KG`\n"
    "           (fixed to the tip).\n"
    "--trace    One line per USB frame with packets.";

}  // namespace

void add_plug_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("plug", "Export a simulated arm as a USB device (USB/IP)");
  auto options = std::make_shared<PlugOptions>();
  command->add_option("ARM", options->arm, "Name of the arm, see below")
      ->required()
      ->check(CLI::Validator(check_arm_name, ""));
  constexpr const char* kConnection = "Connection";
  command
      ->add_flag("--attach", options->attach, "Attach it to this kernel (needs root and vhci-hcd)")
      ->group(kConnection);
  command->add_option("--port", options->port, "TCP port of the server; 0: any free port")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str()
      ->group(kConnection);
  command->add_option("--listen", options->address, "Address of the server; 0.0.0.0: all networks")
      ->option_text("ADDRESS")
      ->check(CLI::Validator(check_address, ""))
      ->capture_default_str()
      ->group(kConnection);
  constexpr const char* kArm = "Simulated arm";
  add_arm_option(*command, options->arm_file, "Arm file with the constants of the simulated arm")
      ->group(kArm);
  command->add_option("--hand", options->motion, "Motion of the simulated hand")
      ->check(CLI::IsMember({"none", "rest", "tap", "stroke"}))
      ->capture_default_str()
      ->group(kArm);
  command->add_option("--serial", options->serial, "Serial number of the USB device")
      ->option_text("TEXT")
      ->group(kArm);
  command->add_option("--seed", options->seed, "Seed of all random numbers")
      ->capture_default_str()
      ->group(kArm);
  command
      ->add_option("--firmware", options->firmware,
                   "Accept only this firmware (Falcon; default: any)")
      ->option_text("FILE")
      ->group(kArm);
  constexpr const char* kTests = "Tests";
  command->add_option("--faults", options->faults, "File with USB faults to simulate")
      ->option_text("FILE")
      ->group(kTests);
  command->add_option("--control", options->control, "Create a named pipe for commands")
      ->option_text("PIPE")
      ->group(kTests);
  command->add_option("--trace", options->trace, "Write the true state of the simulated arm")
      ->option_text("FILE")
      ->group(kTests);
  add_example(*command, "thimble plug polhem --attach", arm_list() + "\n" + kPlugNotes);
  command->callback([options, &exit_code] { exit_code = plug(*options); });
}

}  // namespace thimble::cli

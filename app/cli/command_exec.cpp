#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "cli/commands.h"
#include "cli/options/ros_options.h"
#include "cli/options/theme_option.h"
#include "cli/report_error.h"
#include "cli/usage/usage_error.h"
#include "compat/core/open_channel.h"
#include "compat/haply/haply_service.h"
#include "compat/server/arm_server.h"
#include "compat/server/foreign_libraries.h"
#include "compat/server/library_folder.h"
#include "files/scene_inputs.h"
#include "hold_key.h"
#include "log/logger.h"
#include "output/output_plan.h"
#include "print.h"
#include "recording/recording_layout.h"
#include "ros2/ros_module.h"
#include "signals.h"
#include "system/printable_text.h"
#include "thimble/scene/shipped_files.h"

namespace thimble::cli {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

struct ExecRequest {
  compat::ExecOptions options;
  std::vector<std::string> arms, devices;
  std::string clock = "wall";
  std::string serve;  // "haply", or empty
  std::uint16_t port = compat::haply::kPort;
  RosArguments ros;
  std::string hold_to_run;
  std::vector<std::string> presses;
};

/// Reads the options of the topics, if topics are wanted.
driver::Result<void> take_topics(RosArguments ros, compat::ExecOptions& options) {
  if (!ros.asked) return {};
  if (auto fits = check_ros_arguments(ros); !fits) return fits;
  if (ros.options.force != ros2::RosForce::kNone) {
    return driver::Error{
        "--ros-force cannot be used here: the program commands the forces. Remove it."};
  }
  if (options.paced) {
    return driver::Error{"--ros2 requires real time. Remove --clock virtual."};
  }
  if (auto there = ros2::check_ros_module(); !there) return there;
  options.topics = ros.options;
  return {};
}

/// The environment variable with the service's port; clients of Thimble read it.
constexpr const char* kPortVariable = "THIMBLE_HAPLY_PORT";

/// Joins the lists of --arm and --device: the first of each describes the program's first arm.
std::vector<compat::ExecArm> arms_of(const ExecRequest& asked) {
  std::vector<compat::ExecArm> arms(
      std::max<std::size_t>({1, asked.arms.size(), asked.devices.size()}));
  for (std::size_t i = 0; i < asked.arms.size(); ++i) arms[i].arm_file = asked.arms[i];
  for (std::size_t i = 0; i < asked.devices.size(); ++i) arms[i].device = asked.devices[i];
  return arms;
}

/// The environment variable in which wrappers of Force Dimension's libraries find the SDK.
constexpr const char* kSdkVariable = "FDSDK";

/// Returns the environment of the program: this process's, with our libraries first, the arms'
/// address, and the port of the service, if there is one.
std::vector<std::string> environment(const fs::path& libraries, const std::string& address,
                                     const compat::haply::Service* service) {
  std::vector<std::string> variables;
  std::string search = "LD_LIBRARY_PATH=" + libraries.string();
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string text = *variable;
    if (text.starts_with("LD_LIBRARY_PATH=")) {
      const std::string before = text.substr(text.find('=') + 1);
      if (!before.empty()) search += ":" + before;
    } else if (!text.starts_with(std::string(compat::kChannelVariable) + "=") &&
               !text.starts_with(std::string(kSdkVariable) + "=") &&
               !(service != nullptr && text.starts_with(std::string(kPortVariable) + "="))) {
      variables.push_back(text);
    }
  }
  variables.push_back(search);
  variables.push_back(std::string(kSdkVariable) + "=" + (libraries / "fdsdk").string());
  variables.push_back(std::string(compat::kChannelVariable) + "=" + address);
  if (service != nullptr) {
    variables.push_back(std::string(kPortVariable) + "=" + std::to_string(service->port()));
  }
  return variables;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> all;
  for (std::string& text : texts) all.push_back(text.data());
  all.push_back(nullptr);
  return all;
}

/// Starts the program; the error is errno.
int start(std::vector<std::string> command, std::vector<std::string> variables, pid_t& child) {
  const auto arguments = pointers(command);
  const auto variable_list = pointers(variables);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  // Restores the default actions of the signals that this process ignores
  // (ignore_sigpipe_and_sigxfsz).
  sigset_t own;
  sigemptyset(&own);
  sigaddset(&own, SIGPIPE);
  sigaddset(&own, SIGXFSZ);
  posix_spawnattr_setsigdefault(&attributes, &own);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
  const int status = posix_spawnp(&child, arguments[0], nullptr, &attributes, arguments.data(),
                                  variable_list.data());
  posix_spawnattr_destroy(&attributes);
  return status;
}

/// Vendors' libraries that a program has loaded instead of ours.
struct ForeignLibraries {
  fs::path ours;                     ///< Folder of our libraries.
  std::set<std::string> found = {};  ///< Their paths.
  Clock::time_point next{};          ///< Time of the next look.

  /// Looks at the program's processes, often in the first second and rarely later.
  void look(pid_t program, Clock::time_point begin) {
    constexpr auto kStart = std::chrono::seconds(1);
    constexpr auto kPause = std::chrono::milliseconds(500);
    const Clock::time_point now = Clock::now();
    if (now < next) return;
    if (now - begin > kStart) next = now + kPause;
    found.merge(compat::foreign_libraries(program, ours));
  }
};

/// Serves the program until it ends, and returns its status (waitpid). An interrupt ends first the
/// forces, then the program.
int serve(compat::ArmServer& server, pid_t child, const std::atomic<bool>& stop,
          ForeignLibraries& foreign) {
  constexpr std::int64_t kPollTime_ns = 20'000'000;
  constexpr auto kTermDelay = std::chrono::milliseconds(500);
  constexpr auto kKillDelay = std::chrono::seconds(5);
  Clock::time_point stopped{};
  bool asked = false, killed = false;
  const Clock::time_point begin = Clock::now();
  for (int status = 0;;) {
    server.step(kPollTime_ns);
    foreign.look(child, begin);
    if (waitpid(child, &status, WNOHANG) == child) return status;
    if (!stop.load() && !server.ended_by_viewer()) continue;
    if (stopped == Clock::time_point{}) {
      stopped = Clock::now();
      server.end();
    }
    const auto since = Clock::now() - stopped;
    if (!asked && since > kTermDelay) asked = kill(child, SIGTERM) == 0;
    if (!killed && since > kKillDelay) killed = kill(child, SIGKILL) == 0;
  }
}

/// Serves programs started separately, until the user or a viewer ends it.
void serve_all(compat::ArmServer& server, const std::atomic<bool>& stop) {
  constexpr std::int64_t kPollTime_ns = 20'000'000;
  while (!stop.load() && !server.ended_by_viewer()) server.step(kPollTime_ns);
  server.end();
}

/// Ends the service. A client that still waits for an arm gets its answer first.
void end(compat::haply::Service& service, compat::ArmServer& server) {
  constexpr std::int64_t kPollTime_ns = 1'000'000;
  service.leave();
  while (!service.ended()) server.step(kPollTime_ns);
}

int exit_code_of(const compat::ArmServer& server, int status, bool stopped) {
  if (WIFSIGNALED(status)) {
    if (stopped) return kExitInterrupted;
    scene::logger().error("The program was terminated by signal {} ({}).", WTERMSIG(status),
                          strsignal(WTERMSIG(status)));
    return 128 + WTERMSIG(status);
  }
  const int own = WEXITSTATUS(status);
  if (own != 0) return own;
  return server.any_fault() ? kExitFault : kExitDone;
}

/// Makes the service and opens its arms; `code`: exit code for the error.
driver::Result<std::unique_ptr<compat::haply::Service>> make_service(const ExecRequest& asked,
                                                                     compat::ArmServer& server,
                                                                     ExitCode& code) {
  compat::use_channel(&server.channel(), server.address());
  code = kExitBadInput;
  auto service = compat::haply::Service::listen(
      asked.port, [](const std::string& sentence) { scene::logger().warn("{}", sentence); });
  if (!service) return service;
  constexpr std::int64_t kPollTime_ns = 1'000'000;
  while (!(*service)->ready()) server.step(kPollTime_ns);
  if (server.runs() < static_cast<int>(arms_of(asked).size())) {
    end(**service, server);
    code = kExitNoDevice;
    return driver::Error{"Not all arms could be opened, so the service was not started."};
  }
  return service;
}

/// Prints which vendors' libraries a program used instead of ours.
void warn_of_foreign_libraries(const std::string& program, const ForeignLibraries& foreign) {
  for (const std::string& library : foreign.found) {
    scene::logger().warn(
        "{} loaded {}, which does not find the arms of Thimble. Let it load the library by its "
        "bare name, without LD_PRELOAD, RPATH or a path.",
        program, driver::printable(library));
  }
}

/// Prints a possible reason why a program opened no arm.
void warn_of_no_arm(const std::string& program, const fs::path& libraries) {
  scene::logger().warn(
      "{} opened no arm. Either it loads other libraries (check with ldd, rpath), or it uses none "
      "of the libraries in {}",
      program, libraries.string());
}

int run_program(const ExecRequest& asked, const std::vector<std::string>& command) {
  const bool serves = !asked.serve.empty();
  if (command.empty() && !serves) {
    return report_error(
        {"PROGRAM is missing. Usage: thimble exec [OPTIONS] [--] PROGRAM ARGUMENTS..."},
        kExitBadInput);
  }
  const auto hold = session::hold_named(asked.hold_to_run);
  if (!hold) return report_error({"--hold-to-run: " + hold.error().message}, kExitBadInput);
  if (hold->by_caller) {
    return report_error(
        {"--hold-to-run key cannot be used here: the terminal belongs to the program. Use a "
         "button of the arm: --hold-to-run button."},
        kExitBadInput);
  }
  output::OutputPlan plan;
  for (const fs::path& file : scene::scene_inputs(asked.options.scene)) plan.read(file);
  for (const std::string& arm : asked.arms) plan.read(arm);
  plan.read(asked.options.hand);
  plan.read(asked.options.firmware);
  plan.write("--record", asked.options.record, session::kRecordingOutput, asked.options.overwrite);
  if (const auto begun = plan.begin(); !begun) return report_error(begun.error(), kExitBadInput);
  const auto libraries = compat::library_folder();
  if (!libraries) return report_error(libraries.error(), kExitTrouble);
  compat::ExecOptions options = asked.options;
  options.program = command.empty() ? asked.serve : fs::path(command.front()).filename().string();
  options.arms = arms_of(asked);
  options.paced = asked.clock == "virtual";
  options.hold = *hold;
  auto presses = scene::read_button_presses("--button-at", asked.presses);
  if (!presses) return report_error(presses.error(), kExitBadInput);
  options.presses = std::move(presses).value();
  if (auto taken = take_topics(asked.ros, options); !taken) {
    return report_error(taken.error(), kExitBadInput);
  }
  const std::atomic<bool>& stop = scene::catch_interrupts();
  for (const compat::ExecArm& arm : options.arms) {
    if (arm.device != "sim") scene::treat_sigtstp_as_exit();
  }
  auto made = compat::ArmServer::make(options, stop);
  if (!made) return report_error(made.error(), kExitBadInput);
  compat::ArmServer& server = **made;
  const scene::ForceExitGuard guard;
  std::unique_ptr<compat::haply::Service> service;
  if (serves) {
    ExitCode code = kExitDone;
    auto serving = make_service(asked, server, code);
    if (!serving) return report_error(serving.error(), code);
    service = std::move(serving).value();
    scene::terminal().info(
        "Programs of the Inverse3 can connect to the arm at ws://localhost:{}.{}", service->port(),
        command.empty() ? " Press Ctrl-C to stop." : "");
  }
  int status = 0;
  ForeignLibraries foreign{.ours = *libraries};
  if (command.empty()) {
    serve_all(server, stop);
  } else {
    pid_t child = 0;
    const int error =
        start(command, environment(*libraries, server.address(), service.get()), child);
    if (error != 0) {
      if (service) end(*service, server);
      return report_error({command.front() + " cannot be started: " + std::strerror(error) + "."},
                          kExitBadInput);
    }
    status = serve(server, child, stop, foreign);
  }
  if (service) end(*service, server);
  server.end();
  // Standard output belongs to the program, so this goes to standard error.
  session::print(stderr, "{}", server.report());
  warn_of_foreign_libraries(options.program, foreign);
  if (service && service->programs() == 0) {
    scene::logger().warn("No program connected to ws://localhost:{}.", service->port());
  } else if (server.runs() == 0) {
    warn_of_no_arm(options.program, *libraries);
  }
  return exit_code_of(server, status, stop.load());
}

}  // namespace

void add_exec_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("exec", "Run a program that was written for another maker's arm");
  auto asked = std::make_shared<ExecRequest>();
  compat::ExecOptions& options = asked->options;
  command->prefix_command();
  command->footer(
      "Example: thimble exec --arm vintage_phantom ./my_program\n\n"
      "Write the options before PROGRAM; the words after it are passed to the program.\n"
      "Supported APIs: HDAPI, DHD, CHAI3D and the service of the Inverse3. The program\n"
      "loads Thimble's libHD, libHL, libhdPhantom, libdhd and libdrd instead of the\n"
      "vendor's. libHL only returns errors.\n"
      "Its forces pass the safety gate. Without --device the arm is simulated.\n"
      "With --serve haply, programs of the Inverse3 connect as to the vendor's\n"
      "service. Without PROGRAM, the command serves them until Ctrl-C.\n\n"
      "--arm, --device  Repeat for a second arm.\n"
      "--hand           path: the path in the scene. free: follows the tip, holds\n"
      "                 nothing. mouse: the mouse in the viewer.\n"
      "                 FILE: lines \"t x y z\" (s, m) or \"t x y z buttons\", or a ROS\n"
      "                 bag. buttons: sum of 1 for the first, 2 for the second, 4...\n"
      "--button-at      Repeat for a further press. Without BUTTON, the first; without\n"
      "                 DURATION, 0.2 s. Presses are of simulated arms.\n"
      "--clock          virtual: each tick waits for the program, so that runs can be\n"
      "                 repeated exactly (simulated arms only).\n"
      "--hold-to-run    BUTTON: button (the first of the arm), or button2 to button16.\n" +
      std::string(kRosNotes) +
      "\n\n"
      "Exit code: the program's; 4 if it was 0 and a fault switched the force off.");
  constexpr const char* kArm = "Arm";
  command->add_option("--arm", asked->arms, "Arm file or name (`thimble run --list`)")
      ->allow_extra_args(false)
      ->option_text("NAME|FILE")
      ->group(kArm);
  command
      ->add_option("--device", asked->devices,
                   "Arm to use: sim, auto, or a name from `thimble devices`")
      ->allow_extra_args(false)
      ->option_text("ARM")
      ->group(kArm);
  command->add_option("--firmware", options.firmware, "Firmware image, for arms that need one")
      ->check(CLI::ExistingFile)
      ->group(kArm);
  command->add_flag("--yes", options.yes, "Enable the forces of a real arm without asking")
      ->group(kArm);
  command
      ->add_flag("--unchecked", options.unchecked,
                 "Allow full force without a feel check (else 0.5 N)")
      ->group(kArm);
  command->add_flag("--homed", options.homed, "Trust that the arm was powered on in its home pose")
      ->group(kArm);
  command
      ->add_option("--hold-to-run", asked->hold_to_run,
                   "Enable forces only while this button is held")
      ->option_text("BUTTON")
      ->group(kArm);
  command
      ->add_flag("--no-real-time", options.no_real_time,
                 "Run a real arm without real-time priority")
      ->group(kArm);
  constexpr const char* kRun = "Run";
  command
      ->add_option("--scene", options.scene, "Scene whose forces are added to those of the program")
      ->option_text("NAME|FILE")
      ->group(kRun);
  command
      ->add_option("--hand", options.hand,
                   "Input that moves the simulated hand: path, free, mouse, FILE")
      ->option_text("SOURCE")
      ->capture_default_str()
      ->group(kRun);
  command
      ->add_option("--button-at", asked->presses, "Press a button of the simulated arm at a time")
      ->allow_extra_args(false)
      ->option_text("SECONDS[:BUTTON[:DURATION]]")
      ->group(kRun);
  command
      ->add_option("--clock", asked->clock, "Real time, or simulated time in step with the program")
      ->check(CLI::IsMember({"virtual", "wall"}))
      ->capture_default_str()
      ->group(kRun);
  CLI::Option* view =
      command->add_flag("--view", options.view, "Show the run in a window")->group(kRun);
  add_theme_option(*command, options.theme, "Colour theme of the window (default light)")
      ->needs(view)
      ->group(kRun);
  constexpr const char* kService = "Service";
  command->add_option("--serve", asked->serve, "Serve JSON over WebSocket, on this computer only")
      ->check(CLI::IsMember({"haply"}))
      ->group(kService);
  command->add_option("--port", asked->port, "Port of --serve; 0: any free port")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str()
      ->group(kService);
  constexpr const char* kOutput = "Output";
  CLI::Option* record = command->add_option("--record", options.record, "Record every tick (HDF5)")
                            ->option_text("FILE")
                            ->group(kOutput);
  command->add_flag("--force", options.overwrite, "Let --record replace existing recordings")
      ->needs(record)
      ->group(kOutput);
  add_ros_options(*command, asked->ros, RosTime::kReal);
  command->callback([asked, command, &exit_code] {
    const auto words = command->remaining();
    // A word with a dash before PROGRAM is an option of this command.
    exit_code = !words.empty() && words.front().starts_with('-') && words.front() != "--"
                    ? report_error({unknown_word(*command, words.front())}, kExitBadInput)
                    : run_program(*asked, words);
  });
}

}  // namespace thimble::cli

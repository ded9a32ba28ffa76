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
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "cli/commands.h"
#include "cli/complain.h"
#include "cli/options/ros_options.h"
#include "cli/usage/usage_error.h"
#include "compat/core/open_channel.h"
#include "compat/haply/haply_service.h"
#include "compat/server/arm_server.h"
#include "compat/server/library_folder.h"
#include "files/scene_inputs.h"
#include "hold_key.h"
#include "log/logger.h"
#include "output/output_plan.h"
#include "print.h"
#include "recording/recording_layout.h"
#include "ros2/ros_module.h"
#include "signals.h"
#include "thimble/scene/shipped_files.h"

namespace thimble::cli {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

struct Asked {
  compat::ExecOptions options;
  std::vector<std::string> arms, devices;
  std::string clock = "wall";
  std::string serve;  // "haply", or empty
  std::uint16_t port = compat::haply::kPort;
  RosArguments ros;
  std::string hold_to_run;
};

/// Reads the options of the topics, if topics are wanted.
driver::Result<void> take_topics(RosArguments ros, compat::ExecOptions& options) {
  if (!ros.asked) return {};
  if (auto fits = check_ros_arguments(ros); !fits) return fits;
  if (ros.options.force != ros2::RosForce::kNone) {
    return driver::Error{"--ros-force: the program asks for the forces; leave it away."};
  }
  if (options.paced) {
    return driver::Error{"--ros2 tells of a run in real time: leave --clock virtual away."};
  }
  if (auto there = ros2::check_ros_module(); !there) return there;
  options.topics = ros.options;
  return {};
}

/// The environment variable with the service's port; clients of Thimble read it.
constexpr const char* kPortVariable = "THIMBLE_HAPLY_PORT";

/// Joins the lists of --arm and --device: the first of each describes the program's first arm.
std::vector<compat::ExecArm> arms_of(const Asked& asked) {
  std::vector<compat::ExecArm> arms(
      std::max<std::size_t>({1, asked.arms.size(), asked.devices.size()}));
  for (std::size_t i = 0; i < asked.arms.size(); ++i) arms[i].arm_file = asked.arms[i];
  for (std::size_t i = 0; i < asked.devices.size(); ++i) arms[i].device = asked.devices[i];
  return arms;
}

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
               !(service != nullptr && text.starts_with(std::string(kPortVariable) + "="))) {
      variables.push_back(text);
    }
  }
  variables.push_back(search);
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
  // (outlive_trouble_with_files).
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

/// Serves the program until it ends, and returns its status (waitpid). An interrupt ends first the
/// forces, then the program.
int serve(compat::ArmServer& server, pid_t child, const std::atomic<bool>& stop) {
  constexpr std::int64_t kLook_ns = 20'000'000;
  constexpr auto kPatience = std::chrono::milliseconds(500);
  constexpr auto kLongest = std::chrono::seconds(5);
  Clock::time_point stopped{};
  bool asked = false, killed = false;
  for (int status = 0;;) {
    server.step(kLook_ns);
    if (waitpid(child, &status, WNOHANG) == child) return status;
    if (!stop.load() && !server.ended_by_viewer()) continue;
    if (stopped == Clock::time_point{}) {
      stopped = Clock::now();
      server.end();
    }
    const auto since = Clock::now() - stopped;
    if (!asked && since > kPatience) asked = kill(child, SIGTERM) == 0;
    if (!killed && since > kLongest) killed = kill(child, SIGKILL) == 0;
  }
}

/// Serves programs started separately, until the user or a viewer ends it.
void serve_all(compat::ArmServer& server, const std::atomic<bool>& stop) {
  constexpr std::int64_t kLook_ns = 20'000'000;
  while (!stop.load() && !server.ended_by_viewer()) server.step(kLook_ns);
  server.end();
}

/// Ends the service. A client that still waits for an arm gets its answer first.
void end(compat::haply::Service& service, compat::ArmServer& server) {
  constexpr std::int64_t kLook_ns = 1'000'000;
  service.leave();
  while (!service.ended()) server.step(kLook_ns);
}

int exit_code_of(const compat::ArmServer& server, int status, bool stopped) {
  if (WIFSIGNALED(status)) {
    if (stopped) return kExitInterrupted;
    scene::logger().error("The program was ended by signal {} ({}).", WTERMSIG(status),
                          strsignal(WTERMSIG(status)));
    return 128 + WTERMSIG(status);
  }
  const int own = WEXITSTATUS(status);
  if (own != 0) return own;
  return server.any_fault() ? kExitFault : kExitDone;
}

/// Makes the service and opens its arms; `code`: exit code for the error.
driver::Result<std::unique_ptr<compat::haply::Service>> make_service(const Asked& asked,
                                                                     compat::ArmServer& server,
                                                                     ExitCode& code) {
  compat::use_channel(&server.channel(), server.address());
  code = kExitBadInput;
  auto service = compat::haply::Service::listen(
      asked.port, [](const std::string& sentence) { scene::logger().warn("{}", sentence); });
  if (!service) return service;
  constexpr std::int64_t kLook_ns = 1'000'000;
  while (!(*service)->ready()) server.step(kLook_ns);
  if (server.runs() < static_cast<int>(arms_of(asked).size())) {
    end(**service, server);
    code = kExitNoDevice;
    return driver::Error{"Not all arms could be opened, so no program is served."};
  }
  return service;
}

/// Prints a possible reason why a program opened no arm.
void warn_of_no_arm(const std::string& program, const fs::path& libraries) {
  scene::logger().warn(
      "{} opened no arm. It found libraries of its own (ldd, rpath), or it is written for none "
      "of those that are stood in for: {}",
      program, libraries.string());
}

int run_program(const Asked& asked, const std::vector<std::string>& command) {
  const bool serves = !asked.serve.empty();
  if (command.empty() && !serves) {
    return complain({"Which program? thimble exec [OPTIONS] [--] PROGRAM ARGUMENTS..."},
                    kExitBadInput);
  }
  const auto hold = session::hold_named(asked.hold_to_run);
  if (!hold) return complain({"--hold-to-run: " + hold.error().message}, kExitBadInput);
  if (hold->by_caller) {
    return complain({"--hold-to-run key: the terminal is the program's; hold a button of the arm: "
                     "--hold-to-run button."},
                    kExitBadInput);
  }
  output::OutputPlan plan;
  for (const fs::path& file : scene::scene_inputs(asked.options.scene)) plan.read(file);
  for (const std::string& arm : asked.arms) plan.read(arm);
  plan.read(asked.options.hand);
  plan.read(asked.options.firmware);
  plan.write("--record", asked.options.record, session::kRecordingOutput, asked.options.overwrite);
  if (const auto begun = plan.begin(); !begun) return complain(begun.error(), kExitBadInput);
  const auto libraries = compat::face_folder();
  if (!libraries) return complain(libraries.error(), kExitTrouble);
  compat::ExecOptions options = asked.options;
  options.program = command.empty() ? asked.serve : fs::path(command.front()).filename().string();
  options.arms = arms_of(asked);
  options.paced = asked.clock == "virtual";
  options.hold = *hold;
  if (auto taken = take_topics(asked.ros, options); !taken) {
    return complain(taken.error(), kExitBadInput);
  }
  const std::atomic<bool>& stop = scene::catch_interrupts();
  for (const compat::ExecArm& arm : options.arms) {
    if (arm.device != "sim") scene::leave_rather_than_stop();
  }
  auto made = compat::ArmServer::make(options, stop);
  if (!made) return complain(made.error(), kExitBadInput);
  compat::ArmServer& server = **made;
  const scene::LeavingGuard guard;
  std::unique_ptr<compat::haply::Service> service;
  if (serves) {
    ExitCode code = kExitDone;
    auto serving = make_service(asked, server, code);
    if (!serving) return complain(serving.error(), code);
    service = std::move(serving).value();
    scene::terminal().info("Programs of the Inverse3 find the arm at ws://localhost:{}.{}",
                           service->port(), command.empty() ? " Ctrl-C ends it." : "");
  }
  int status = 0;
  if (command.empty()) {
    serve_all(server, stop);
  } else {
    pid_t child = 0;
    const int error =
        start(command, environment(*libraries, server.address(), service.get()), child);
    if (error != 0) {
      if (service) end(*service, server);
      return complain({command.front() + " cannot be started: " + std::strerror(error) + "."},
                      kExitBadInput);
    }
    status = serve(server, child, stop);
  }
  if (service) end(*service, server);
  server.end();
  // Standard output belongs to the program, so this goes to standard error.
  session::print(stderr, "{}", server.report());
  if (service && service->programs() == 0) {
    scene::logger().warn("No program came to ws://localhost:{}.", service->port());
  } else if (server.runs() == 0) {
    warn_of_no_arm(options.program, *libraries);
  }
  return exit_code_of(server, status, stop.load());
}

}  // namespace

void add_exec_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "exec",
      "Run a program that was written for another maker's arm (HDAPI, DHD, CHAI3D, Inverse3)");
  auto asked = std::make_shared<Asked>();
  compat::ExecOptions& options = asked->options;
  command->prefix_command();
  command->footer(
      "Options stand before PROGRAM; what follows it is its own.\n"
      "The program finds libHD, libhdPhantom, libdhd and libdrd of ours in front of others. Its\n"
      "forces go through the gate of ours. A simulated arm is used unless --device names one.\n"
      "With --serve haply, programs of the Inverse3 find it as they find their vendor's service;\n"
      "without PROGRAM they are served until Ctrl-C.\n"
      "Exit code: the program's; 4 if it was 0 and a force went off with a fault.");
  command
      ->add_option("--arm", asked->arms,
                   "Arm file or name; again for a second arm (`thimble run --list`)")
      ->allow_extra_args(false);
  command
      ->add_option("--device", asked->devices,
                   "Arm to use: sim, auto, or a name that `thimble devices` lists; again for a "
                   "second arm")
      ->allow_extra_args(false);
  command->add_option("--scene", options.scene,
                      "Scene whose objects are felt as well: both forces add up");
  command
      ->add_option(
          "--hand", options.hand,
          "Who leads the simulated hand: path, as the scene says; mouse, by the viewer; or "
          "a file with lines \"t x y z\" (s, m), or a ROS bag")
      ->capture_default_str();
  command
      ->add_option(
          "--clock", asked->clock,
          "wall: in real time; virtual: each tick waits until the program waits for it, so "
          "that a program does the same each time (simulated arms only)")
      ->check(CLI::IsMember({"virtual", "wall"}))
      ->capture_default_str();
  command
      ->add_option(
          "--serve", asked->serve,
          "haply: show the arm as the service of an Inverse3 does (JSON over WebSocket, on "
          "this computer alone)")
      ->check(CLI::IsMember({"haply"}));
  command->add_option("--port", asked->port, "Port of --serve; 0: any that is free")
      ->capture_default_str();
  CLI::Option* record =
      command->add_option("--record", options.record, "Recording of every tick to write (HDF5)");
  command->add_flag("--force", options.overwrite, "Let --record replace existing recordings")
      ->needs(record);
  command->add_flag("--view", options.view, "Watch the run in a window");
  add_ros_options(*command, asked->ros, RosTime::kReal);
  command->add_option("--firmware", options.firmware, "Firmware image for an arm that needs one")
      ->check(CLI::ExistingFile);
  command->add_flag("--yes", options.yes, "Give a real arm forces without asking");
  command->add_flag("--unchecked", options.unchecked,
                    "Give a real arm its whole force though `thimble feel-check` was not passed");
  command->add_flag("--homed", options.homed, "A real arm was in its home pose when it got power");
  command->add_option("--hold-to-run", asked->hold_to_run,
                      "Give forces only while this button of the arm is held: button (the first), "
                      "button2 to button16");
  command->add_flag("--no-real-time", options.no_real_time,
                    "Use a real arm though the loop gets no real-time priority");
  command->callback([asked, command, &exit_code] {
    const auto words = command->remaining();
    // A word with a dash before PROGRAM is an option of this command.
    exit_code = !words.empty() && words.front().starts_with('-') && words.front() != "--"
                    ? complain({unknown_word(*command, words.front())}, kExitBadInput)
                    : run_program(*asked, words);
  });
}

}  // namespace thimble::cli

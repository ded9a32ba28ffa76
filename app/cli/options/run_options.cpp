#include "cli/options/run_options.h"

#include <fmt/core.h>

#include <cstdlib>
#include <vector>

#include "cli/commands.h"
#include "cli/file_options.h"
#include "cli/options/json_option.h"
#include "cli/options/theme_option.h"
#include "cli/parts/part.h"
#include "cli/usage/help_text.h"
#include "hand/button_plan.h"
#include "hold_key.h"
#include "log/logger.h"
#include "meshes/cache/cache_folder.h"
#include "ros2/ros_module.h"
#include "share/shared_layout.h"
#include "share/viewer_process.h"

namespace thimble::cli {

driver::Result<void> check_run_options(RunOptions& options) {
  if (options.budget && options.quality != "auto") {
    return driver::Error{"--budget requires --quality auto. Add it, or remove --budget."};
  }
  if (auto fits = check_ros_arguments(options.ros); !fits) return fits;
  const auto hold = session::hold_named(options.hold_to_run);
  if (!hold) return driver::Error{"--hold-to-run: " + hold.error().message};
  if (hold->by_caller) {
    if (auto there = session::HoldKey::check(); !there) return there;
    if (options.clock == "virtual") {
      return driver::Error{
          "--hold-to-run key requires real time. Remove --clock virtual, or use a button."};
    }
  }
  if (!options.save_mesh.empty() &&
      std::filesystem::path(options.save_mesh).extension() != ".off") {
    return driver::Error{"--save-mesh: " + options.save_mesh +
                         ": meshes are written as OFF. Use a file name that ends in .off."};
  }
  if (options.stepped() && options.devices != std::vector<std::string>{"sim"}) {
    return driver::Error{"--clock virtual cannot be used with a real arm. Remove it."};
  }
  if (options.by_topic() && !options.ros.asked) {
    return driver::Error{"--hand topic requires --ros2. Add it."};
  }
  options.ros.options.lead_hand = options.by_topic();
  if (options.ros.asked) {
    if (auto there = ros2::check_ros_module(); !there) return there;
  }
  if (!options.presses.empty() && options.devices != std::vector<std::string>{"sim"}) {
    return driver::Error{
        "--button-at presses buttons of a simulated arm. Remove it to use a real arm."};
  }
  const auto presses = scene::read_button_presses("--button-at", options.presses);
  if (!presses) return presses.error();
  options.buttons = scene::steps_of(*presses);
  const bool felt = options.sound || options.rumble;
  if (felt && !options.view && !options.by_viewer()) {
    return driver::Error{"--sound and --rumble require the window. Add --view."};
  }
  if (!options.theme.empty() && !options.view && !options.by_viewer()) {
    return driver::Error{"--theme requires the window. Add --view."};
  }
  if (felt && options.clock == "virtual") {
    return driver::Error{
        "--sound and --rumble require real time. Remove --clock virtual. For the sound of a "
        "recording, use `thimble export REC.h5 --sound FILE.wav`."};
  }
  if (!options.by_viewer() && !options.by_topic()) return {};
  if (options.devices != std::vector<std::string>{"sim"}) {
    return driver::Error{"--hand " + options.hand +
                         " moves the hand of a simulated arm. Remove it to use a real arm."};
  }
  if (options.by_topic()) return {};
  if (options.clock == "virtual" && !options.duration) {
    return driver::Error{
        "--hand " + options.hand +
        " requires real time or a fixed duration. Remove --clock virtual, or add --duration."};
  }
  if (!options.no_view && !has_window()) {
    return driver::Error{"--hand " + options.hand +
                         " requires the window, which is not installed: " + how_to_get(kViewer) +
                         "."};
  }
  if (!options.no_view && !session::has_display()) {
    return driver::Error{
        "--hand " + options.hand +
        " requires the window, but there is no screen: DISPLAY and WAYLAND_DISPLAY are not set. "
        "Start it on a desktop, or add --no-view and move the hand from `thimble view --hand " +
        options.hand + "`."};
  }
  return {};
}

driver::Result<void> check_restart_options(const RunOptions& options,
                                           const session::RunArms& arms) {
  const char* asked = options.loop                     ? "--loop"
                      : options.reload.value_or(false) ? "--reload"
                      : options.speed                  ? "--speed"
                      : options.clock == "paced"       ? "--clock paced"
                                                       : nullptr;
  if (asked == nullptr) return {};
  if (arms.real()) {
    return driver::Error{fmt::format(
        "{} cannot be used with a real arm, which runs in real time and is started by a person. "
        "Remove it.",
        asked)};
  }
  if (options.ros.asked) {
    return driver::Error{fmt::format(
        "{} cannot be used with --ros2, whose topics belong to one run. Remove it.", asked)};
  }
  if (options.speed && !options.clock.empty() && options.clock != "paced") {
    return driver::Error{"--speed requires --clock paced. Remove --clock " + options.clock + "."};
  }
  return {};
}

session::SessionOptions session_options(const RunOptions& options, const session::RunArms& arms) {
  // Watching or moving the hand needs real time, unless another clock is chosen.
  const bool for_a_person = options.for_a_person();
  const bool wall = options.clock.empty() ? options.ros.asked : options.clock == "wall";
  const bool by_key = options.hold_to_run == "key";
  const bool paced =
      options.clock.empty() ? for_a_person || by_key || options.speed : options.clock == "paced";
  session::SessionOptions asked;
  asked.clock = wall || arms.real() ? session::ClockKind::kWall
                : paced             ? session::ClockKind::kPaced
                                    : session::ClockKind::kVirtual;
  const bool real_time = asked.clock != session::ClockKind::kVirtual;
  asked.duration = options.duration;
  asked.seed = options.seed;
  asked.arm_file = options.arm_file;
  asked.real_arm = arms.one.real;
  asked.terms = arms.one.terms;
  asked.real_arms = arms.several;
  asked.firmware = options.firmware;
  asked.record = options.record;
  asked.overwrite = options.force;
  asked.log = true;
  asked.share_out =
      !options.name.empty() || for_a_person || options.loop || (real_time && !options.no_view);
  asked.share_if_possible = options.name.empty() && !for_a_person && !options.loop;
  asked.restarts = !arms.real() && !options.ros.asked;
  asked.share_name = options.name;
  asked.hand_by_mouse = options.by_viewer();
  asked.hand_by_program = options.by_topic();
  asked.buttons = options.buttons;
  asked.homed = options.homed;
  asked.hold = *session::hold_named(options.hold_to_run);  // checked before
  asked.several_arms = true;
  asked.quality = options.quality;
  asked.budget = options.budget;
  if (options.mesh_cache) asked.mesh_cache = scene::chosen_mesh_cache();
  return asked;
}

session::ViewerChoice viewer_choice(const RunOptions& options) {
  const bool asked = options.for_a_person();
  if (asked && !has_window() && scene::verbosity() != scene::Verbosity::kQuiet) {
    scene::terminal().info(
        "The window is not installed: {}; `thimble view --text` prints the state of the run.",
        how_to_get(kViewer));
  }
  if (options.no_view || !has_window()) return session::ViewerChoice::kNever;
  return asked ? session::ViewerChoice::kAsked : session::ViewerChoice::kIfWatched;
}

std::vector<std::string> viewer_arguments(const RunOptions& options,
                                          const session::SessionOptions& asked) {
  std::vector<std::string> arguments;
  if (options.by_viewer()) arguments = {"--hand", options.hand};
  if (options.sound) arguments.emplace_back("--sound");
  if (options.rumble) arguments.emplace_back("--rumble");
  if (!options.theme.empty()) arguments.insert(arguments.end(), {"--theme", options.theme});
  for (const std::string& word : run_again_words(options, asked)) {
    arguments.push_back("--run-again=" + word);
  }
  return arguments;
}

CLI::Option* add_hold_option(CLI::App& command, std::string& hold, const std::string& about) {
  return command.add_option("--hold-to-run", hold, about)->option_text("INPUT");
}

namespace {

void add_arm_options(CLI::App& command, RunOptions& options) {
  constexpr const char* kArm = "Arm";
  command
      .add_option("--device", options.devices,
                  "Arm to use: sim, auto, or a name from `thimble devices`")
      ->take_all()
      ->allow_extra_args(false)
      ->capture_default_str()
      ->option_text("ARM")
      ->group(kArm);
  add_arm_option(command, options.arm_file, "Arm file to use instead of the scene's or the arm's")
      ->group(kArm);
  command.add_option("--firmware", options.firmware, "Firmware image, for arms that need one")
      ->check(CLI::ExistingFile)
      ->group(kArm);
  command.add_flag("--yes", options.yes, "Enable the forces of a real arm without asking")
      ->group(kArm);
  command
      .add_flag("--unchecked", options.unchecked,
                "Allow full force without a feel check (else 0.5 N)")
      ->group(kArm);
  command.add_flag("--homed", options.homed, "Trust that the arm was powered on in its home pose")
      ->group(kArm);
  command
      .add_flag("--no-real-time", options.no_real_time, "Run a real arm without real-time priority")
      ->group(kArm);
  add_hold_option(command, options.hold_to_run,
                  "Enable forces only while this button or key is held")
      ->group(kArm);
}

void add_time_options(CLI::App& command, RunOptions& options) {
  constexpr const char* kTime = "Time";
  command
      .add_option("--duration", options.duration,
                  "Duration of the run (default: that of the scene)")
      ->check(CLI::Validator(
          [](const std::string& text) {
            char* end = nullptr;
            const double seconds = std::strtod(text.c_str(), &end);
            // Rejects NaN, too.
            const bool good =
                end != text.c_str() && *end == 0 && seconds >= 1e-3 && seconds <= 86400;
            return good ? std::string() : "expected 0.001 to 86400 seconds, found " + text;
          },
          "SECONDS"))
      ->group(kTime);
  command
      .add_option("--clock", options.clock, "As fast as possible, paced by --speed, or real time")
      ->check(CLI::IsMember({"virtual", "paced", "wall"}))
      ->group(kTime);
  command.add_option("--speed", options.speed, "Speed relative to real time (default 1)")
      ->check(CLI::Range(session::kSpeedMin, session::kSpeedMax))
      ->group(kTime);
  command.add_flag("--loop", options.loop, "Restart the run whenever it ends")->group(kTime);
  // Two plain flags: the library sets a flag with a negation to false if it is absent.
  command
      .add_flag_callback(
          "--reload", [&options] { options.reload = true; },
          "Restart when the scene or arm file changes")
      ->group(kTime);
  command
      .add_flag_callback(
          "--no-reload", [&options] { options.reload = false; },
          "Do not restart when a file changes")
      ->group(kTime);
}

void add_hand_options(CLI::App& command, RunOptions& options) {
  command.add_option("--hand", options.hand, "Input that moves the simulated hand")
      ->check(CLI::IsMember({"path", "mouse", "keyboard", "gamepad", "spacemouse", "topic"}))
      ->capture_default_str()
      ->group("Hand");
  command
      .add_option("--button-at", options.presses, "Press a button of the simulated arm at a time")
      ->allow_extra_args(false)
      ->option_text("SECONDS[:BUTTON[:DURATION]]")
      ->group("Hand");
}

void add_viewing_options(CLI::App& command, RunOptions& options) {
  constexpr const char* kViewing = "Viewing";
  CLI::Option* view =
      command.add_flag("--view", options.view, "Show the run in a window")->group(kViewing);
  CLI::Option* none = command
                          .add_flag("--no-view", options.no_view,
                                    "Open no window, and do not share the run with viewers")
                          ->excludes(view)
                          ->group(kViewing);
  command.get_option("--loop")->excludes(none);
  command
      .add_flag("--sound", options.sound, "Play the contact as sound (clicks, textures, friction)")
      ->group(kViewing);
  command.add_flag("--rumble", options.rumble, "Play the contact as rumble of a gamepad")
      ->group(kViewing);
  add_theme_option(command, options.theme, "Colour theme of the window (default light)")
      ->group(kViewing);
  command.add_option("--name", options.name, "Name for `thimble view NAME` (default: the scene's)")
      ->option_text("NAME")
      ->group(kViewing);
}

void add_computation_options(CLI::App& command, RunOptions& options) {
  constexpr const char* kComputation = "Computation";
  add_quality_option(command, options.quality, "Accuracy preset; normal uses the scene's settings")
      ->group(kComputation);
  command.add_option("--budget", options.budget, "Computing time per tick for --quality auto, ns")
      ->check(CLI::Range(1.0, 1e9))
      ->group(kComputation);
  command.add_option("--seed", options.seed, "Seed of all random numbers (default: the scene's)")
      ->group(kComputation);
  command
      .add_flag("--mesh-cache", options.mesh_cache, "Store large prepared meshes for later runs")
      ->group(kComputation);
}

void add_output_options(CLI::App& command, RunOptions& options) {
  constexpr const char* kOutput = "Output";
  add_json_option(command)->group(kOutput);
  command
      .add_option("--report", options.report, "Write report.json, pictures and a page of the run")
      ->option_text("DIR")
      ->group(kOutput);
  CLI::Option* record = command.add_option("--record", options.record, "Record every tick (HDF5)")
                            ->option_text("FILE")
                            ->group(kOutput);
  command.add_flag("--force", options.force, "Let --record replace an existing recording")
      ->needs(record)
      ->group(kOutput);
  CLI::Option* save = command
                          .add_option("--save-mesh", options.save_mesh,
                                      "Save the final meshes (OFF, world frame, m)")
                          ->option_text("FILE")
                          ->group(kOutput);
  command.add_option("--save-object", options.save_object, "Save only the mesh of this object")
      ->option_text("NAME")
      ->needs(save)
      ->group(kOutput);
}

constexpr const char* kRunNotes =
    "--device   For a scene with several arms, write NAME=ARM for each real arm.\n"
    "--homed    The tip must be in the workspace; its home pose is not checked.\n"
    "--hold-to-run  INPUT: button (the first of the arm), button2 to button16, or\n"
    "           key (the space bar, in this terminal or in the window).\n"
    "--clock    virtual and paced give bit-identical results; real arms use wall.\n"
    "           Default: wall with --ros2; paced with --view, --speed, or a hand\n"
    "           moved in the window; otherwise virtual.\n"
    "--speed    Can be changed in a viewer. --speed, --loop and --reload require\n"
    "           simulated arms.\n"
    "--loop     To end it: Ctrl-C, stop in a viewer, or close the window of --view.\n"
    "           Later recordings are named FILE-2.h5, FILE-3.h5 and so on.\n"
    "--view     After the end, Restart in the window runs it again (simulated arms).\n"
    "--reload   Default with --view, or with a hand moved in the window.\n"
    "--hand     path: the path in the scene. mouse, keyboard, gamepad, spacemouse\n"
    "           (3Dconnexion): input in the window; the run ends when it is closed.\n"
    "           topic: the ROS 2 topic command/pose (crtk: servo_cp).\n"
    "--button-at  Repeat for a further press. Without BUTTON, the first; without\n"
    "           DURATION, 0.2 s.\n"
    "--sound, --rumble  Require the window.\n"
    "--quality  draft: lowest cost; reference: errors below perception at any cost;\n"
    "           auto: lowest cost with errors below perception. With --budget, auto\n"
    "           is the highest accuracy within this time for all objects. Times and\n"
    "           errors are stored results of `thimble study accuracy`, from another\n"
    "           machine. The choices are printed.\n"
    "--mesh-cache  Meshes of 10^6 triangles and more, at most 2 GiB, in\n"
    "           $THIMBLE_MESH_CACHE or ~/.cache/thimble/prepared. Results are\n"
    "           bit-identical. `thimble mesh cache` lists and clears them.";

}  // namespace

void add_run_options(CLI::App& command, RunOptions& options) {
  add_scene_option(command, options.scene)->required();
  add_arm_options(command, options);
  add_time_options(command, options);
  add_hand_options(command, options);
  add_viewing_options(command, options);
  add_computation_options(command, options);
  add_output_options(command, options);
  add_ros_options(command, options.ros, RosTime::kRealOrStepped);
  add_example(command, "thimble run elephant --view --record touch.h5",
              std::string(kRunNotes) + "\n" + kRosNotes);
}

}  // namespace thimble::cli

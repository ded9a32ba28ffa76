#include "cli/options/run_options.h"

#include <fmt/core.h>

#include <cstdlib>
#include <vector>

#include "cli/commands.h"
#include "cli/file_options.h"
#include "cli/parts/part.h"
#include "hold_key.h"
#include "log/logger.h"
#include "ros2/ros_module.h"
#include "share/shared_layout.h"
#include "share/viewer_process.h"

namespace thimble::cli {

driver::Result<void> check_run_options(RunOptions& options) {
  if (options.budget && options.quality != "auto") {
    return driver::Error{"--budget says what --quality auto may spend: name both, or neither."};
  }
  if (auto fits = check_ros_arguments(options.ros); !fits) return fits;
  const auto hold = session::hold_named(options.hold_to_run);
  if (!hold) return driver::Error{"--hold-to-run: " + hold.error().message};
  if (hold->by_caller) {
    if (auto there = session::HoldKey::check(); !there) return there;
    if (options.clock == "virtual") {
      return driver::Error{
          "--hold-to-run key needs real time: leave --clock virtual away, or hold a button."};
    }
  }
  if (!options.save_mesh.empty() &&
      std::filesystem::path(options.save_mesh).extension() != ".off") {
    return driver::Error{"--save-mesh: " + options.save_mesh +
                         ": a mesh is written as OFF; let the name end in .off."};
  }
  if (options.stepped() && options.devices != std::vector<std::string>{"sim"}) {
    return driver::Error{"A real arm has the time of the world: leave --clock virtual away."};
  }
  if (options.by_topic() && !options.ros.asked) {
    return driver::Error{"--hand topic needs the topics: add --ros2."};
  }
  options.ros.options.lead_hand = options.by_topic();
  if (options.ros.asked) {
    if (auto there = ros2::check_ros_module(); !there) return there;
  }
  const bool felt = options.sound || options.rumble;
  if (felt && !options.view && !options.by_viewer()) {
    return driver::Error{"--sound and --rumble are the window's: add --view."};
  }
  if (felt && options.clock == "virtual") {
    return driver::Error{
        "--sound and --rumble need real time: leave --clock away. Of a recording, `thimble export "
        "REC.h5 --sound FILE.wav` makes the sound."};
  }
  if (!options.by_viewer() && !options.by_topic()) return {};
  if (options.devices != std::vector<std::string>{"sim"}) {
    return driver::Error{"--hand " + options.hand +
                         " leads the simulated arm's hand; a real arm has yours."};
  }
  if (options.by_topic()) return {};
  if (options.clock == "virtual" && !options.duration) {
    return driver::Error{
        "--hand " + options.hand +
        " without an end needs real time: leave --clock away, or give --duration."};
  }
  if (!options.no_view && !has_window()) {
    return driver::Error{"--hand " + options.hand +
                         " needs the window, which is not installed: " + how_to_get(kViewer) + "."};
  }
  if (!options.no_view && !session::has_display()) {
    return driver::Error{
        "--hand " + options.hand +
        " needs the window, and there is no screen: DISPLAY and WAYLAND_DISPLAY are not set. Start "
        "it on a desktop, or add --no-view and lead the hand from `thimble view --hand " +
        options.hand + "`."};
  }
  return {};
}

driver::Result<void> check_course(const RunOptions& options, const session::RunArms& arms) {
  const char* asked = options.loop                     ? "--loop"
                      : options.reload.value_or(false) ? "--reload"
                      : options.speed                  ? "--speed"
                      : options.clock == "paced"       ? "--clock paced"
                                                       : nullptr;
  if (asked == nullptr) return {};
  if (arms.real()) {
    return driver::Error{fmt::format(
        "{} is for simulated arms: a real one has the time of the world, and only a person at it "
        "begins a run.",
        asked)};
  }
  if (options.ros.asked) {
    return driver::Error{
        fmt::format("{} does not go with --ros2, whose topics belong to one run.", asked)};
  }
  if (options.speed && !options.clock.empty() && options.clock != "paced") {
    return driver::Error{"--speed needs simulated time at a pace: leave --clock " + options.clock +
                         " away."};
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
  asked.homed = options.homed;
  asked.hold = *session::hold_named(options.hold_to_run);  // checked before
  asked.several_arms = true;
  asked.quality = options.quality;
  asked.budget = options.budget;
  return asked;
}

session::ViewerChoice viewer_choice(const RunOptions& options) {
  const bool asked = options.for_a_person();
  if (asked && !has_window() && scene::talk() != scene::Talk::kQuiet) {
    scene::terminal().info(
        "No window is installed: {}; `thimble view --text` prints what happens in the run.",
        how_to_get(kViewer));
  }
  if (options.no_view || !has_window()) return session::ViewerChoice::kNever;
  return asked ? session::ViewerChoice::kAsked : session::ViewerChoice::kIfWatched;
}

std::vector<std::string> viewer_arguments(const RunOptions& options) {
  std::vector<std::string> arguments;
  if (options.by_viewer()) arguments = {"--hand", options.hand};
  if (options.sound) arguments.emplace_back("--sound");
  if (options.rumble) arguments.emplace_back("--rumble");
  return arguments;
}

void add_hold_option(CLI::App& command, std::string& hold) {
  command.add_option("--hold-to-run", hold,
                     "Give forces only while this is held: button (the arm's first), button2 to "
                     "button16, or key (the space bar, in this terminal or in the window)");
}

void add_run_options(CLI::App& command, RunOptions& options) {
  add_scene_option(command, options.scene)->required();
  command
      .add_option("--device", options.devices,
                  "Arm to use: sim, auto, or a name that `thimble devices` lists; of a scene with "
                  "several arms NAME=ARM for each real one")
      ->take_all()
      ->allow_extra_args(false)
      ->capture_default_str();
  add_arm_option(
      command, options.arm_file,
      "Arm file in place of the scene's own; of a real arm, in place of the one it brings");
  command.add_option("--firmware", options.firmware, "Firmware image for an arm that needs one")
      ->check(CLI::ExistingFile);
  command.add_flag("--yes", options.yes, "Give a real arm forces without asking");
  command.add_flag("--unchecked", options.unchecked,
                   "Give a real arm its whole force though `thimble feel-check` was not passed; "
                   "without it such an arm gets at most 0.5 N");
  command.add_flag("--homed", options.homed,
                   "A real arm was in its home pose when it got power: check only that its tip is "
                   "in the workspace");
  command.add_flag("--no-real-time", options.no_real_time,
                   "Use a real arm though the loop gets no real-time priority");
  add_hold_option(command, options.hold_to_run);
  command.add_option("--duration", options.duration, "Seconds to run; the scene's own if absent")
      ->check(CLI::Validator(
          [](const std::string& text) {
            char* end = nullptr;
            const double seconds = std::strtod(text.c_str(), &end);
            // Rejects NaN, too.
            const bool good =
                end != text.c_str() && *end == 0 && seconds >= 1e-3 && seconds <= 86400;
            return good ? std::string() : "expected 0.001 to 86400 seconds, found " + text;
          },
          "SECONDS"));
  command
      .add_option("--clock", options.clock,
                  "virtual: as fast as it computes, repeatable to the bit; paced: the same ticks, "
                  "as fast as --speed says; wall: in real time, as with a real arm "
                  "(if absent: paced with --view, a hand led in the window or --speed, wall with "
                  "--ros2, virtual otherwise)")
      ->check(CLI::IsMember({"virtual", "paced", "wall"}));
  command
      .add_option("--speed", options.speed,
                  "Pace of a simulated arm's run, times real time; 1 if absent, and a viewer "
                  "changes it")
      ->check(CLI::Range(session::kSpeedLeast, session::kSpeedMost));
  command.add_flag("--reload,!--no-reload", options.reload,
                   "Begin anew when the file of the scene or of its arm changes, with a simulated "
                   "arm (if absent: with --view or a hand led in the window)");
  command
      .add_option("--hand", options.hand,
                  "Who leads the simulated hand: path, as the scene says; mouse, keyboard, gamepad "
                  "or spacemouse (3Dconnexion), in the window, until it is closed; topic, with "
                  "--ros2, by the topic command/pose (crtk: servo_cp)")
      ->check(CLI::IsMember({"path", "mouse", "keyboard", "gamepad", "spacemouse", "topic"}))
      ->capture_default_str();
  CLI::Option* view = command.add_flag("--view", options.view, "Watch the run in a window");
  CLI::Option* none =
      command.add_flag("--no-view", options.no_view, "Show the run to nobody")->excludes(view);
  command
      .add_flag(
          "--loop", options.loop,
          "Restart whenever the scene is over, with a simulated arm, until Ctrl-C or a viewer "
          "ends it, or with --view its window is closed; recordings after the first are "
          "FILE-2.h5 and so on")
      ->excludes(none);
  command.add_flag("--sound", options.sound,
                   "With the window: play what is felt as sound (clicks, textures, friction)");
  command.add_flag("--rumble", options.rumble,
                   "With the window: let a gamepad rumble as hard as the touch is");
  command.add_option("--name", options.name,
                     "Name of the run for `thimble view NAME`; the scene's if absent");
  add_quality_option(
      command, options.quality,
      "draft, normal (what the scene says), reference or auto (the cheapest at which nothing wrong "
      "can be felt): points on the diagrams of `thimble study accuracy`; each choice is printed");
  command
      .add_option("--budget", options.budget,
                  "With --quality auto: the most accurate points within so many ns per tick, of "
                  "all objects "
                  "together, on the machine that the stored diagrams name")
      ->check(CLI::Range(1.0, 1e9));
  command.add_option("--report", options.report,
                     "Folder for report.json, pictures and index.html, a page that plays the run");
  CLI::Option* record = command.add_option(
      "--record", options.record,
      "Recording of every tick to write (HDF5; thimble export makes a table of it)");
  command.add_flag("--force", options.force, "Let --record replace an existing recording")
      ->needs(record);
  CLI::Option* save = command.add_option(
      "--save-mesh", options.save_mesh,
      "OFF file for the meshes as they are at the end: moved, dented, sculpted (world, m)");
  command
      .add_option("--save-object", options.save_object,
                  "Save the mesh of this object of the scene alone")
      ->needs(save);
  add_ros_options(command, options.ros, RosTime::kRealOrStepped);
  command.add_option("--seed", options.seed, "Seed of everything random; the scene's if absent");
}

}  // namespace thimble::cli

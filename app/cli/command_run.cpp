#include <fmt/core.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "cli/commands.h"
#include "cli/complain.h"
#include "cli/file_options.h"
#include "interrupt.h"
#include "log/logger.h"
#include "open_arm.h"
#include "print.h"
#include "replug_watch.h"
#include "report/report.h"
#include "report/run_files.h"
#include "run_arm.h"
#include "run_attendance.h"
#include "setup.h"
#include "share/viewer_request_handler.h"
#include "stability/tuning.h"
#include "terminal.h"
#include "thimble/driver/discovery.h"
#include "thimble/render/mesh/save_mesh.h"
#include "thimble/scene/quality.h"
#include "thimble/scene/shipped_files.h"
#include "thimble/session/servo_thread.h"
#include "thimble/session/session.h"

namespace thimble::app {
namespace {

struct RunOptions {
  std::string scene;
  std::string device = "sim";
  std::string clock;  // empty: as suits
  std::optional<double> duration;
  std::optional<std::uint64_t> seed;
  std::string report;
  std::string arm_file;
  std::string firmware;
  std::string record;
  std::string save_mesh;
  std::string save_object;
  std::string hand = "path";
  std::string name;
  bool view = false, no_view = false;
  std::string quality = "normal";
  std::optional<double> budget;  // ns
  bool yes = false;
  bool unchecked = false;
  bool homed = false;
  bool no_real_time = false;

  bool led() const { return hand == "mouse"; }
};

/// Prints sentences, a line each.
void tell(const std::vector<std::string>& sentences) {
  for (const std::string& sentence : sentences) session::print(stdout, "{}\n", sentence);
  std::fflush(stdout);  // before a person is asked something
}

/// Fails if the options do not go together.
driver::Result<void> check(const RunOptions& options) {
  if (options.budget && options.quality != "auto") {
    return driver::Error{"--budget says what --quality auto may spend: name both, or neither."};
  }
  if (!options.led()) return {};
  if (options.device != "sim") {
    return driver::Error{"--hand mouse leads the simulated arm's hand; a real arm has yours."};
  }
  if (options.clock == "virtual" && !options.duration) {
    return driver::Error{
        "--hand mouse without an end needs real time: leave --clock away, or give --duration."};
  }
  return {};
}

/// Returns what the session is asked for.
session::SessionOptions session_options(const RunOptions& options, const session::RunArm& arm) {
  // A person who watches or leads does so in real time, unless he says otherwise.
  const bool for_a_person = options.view || options.led();
  const bool wall = options.clock.empty() ? for_a_person : options.clock == "wall";
  const bool real_time = wall || arm.real;
  session::SessionOptions asked;
  asked.clock = real_time ? session::ClockKind::kWall : session::ClockKind::kVirtual;
  asked.duration = options.duration;
  asked.seed = options.seed;
  asked.arm_file = options.arm_file;
  asked.real_arm = arm.real;
  asked.terms = arm.terms;
  asked.firmware = options.firmware;
  asked.record = options.record;
  asked.log = true;
  asked.share_out = !options.name.empty() || for_a_person || (real_time && !options.no_view);
  asked.share_if_possible = options.name.empty() && !for_a_person;
  asked.share_name = options.name;
  asked.hand_by_mouse = options.led();
  asked.homed = options.homed;
  const scene::Quality quality =
      scene::quality_named(options.quality).value_or(scene::Quality::kNormal);
  asked.rate_factor = scene::rate_factor_of(quality);
  asked.adjust = [&options, quality](scene::Scene& scene) {
    for (const std::string& choice : scene::apply_quality(quality, scene, options.budget)) {
      session::print(stdout, "{}: {}\n", options.quality, choice);
    }
  };
  return asked;
}

session::ViewerChoice viewer_choice(const RunOptions& options) {
  const bool asked = options.view || options.led();
  if (asked && !has_window()) {
    scene::terminal().info(
        "No window in this build (app/setup.sh release thimble makes one); `thimble view --text` "
        "tells of "
        "the run.");
  }
  if (options.no_view || !has_window()) return session::ViewerChoice::kNever;
  return asked ? session::ViewerChoice::kAsked : session::ViewerChoice::kIfWatched;
}

/// Ends the recording and tells where it is; who asked for one shall hear of what it lacks.
ExitCode end_recording(session::Session& session) {
  const auto recorded = session.end_recording();
  if (!recorded) return complain(recorded.error(), kExitTrouble);
  if (*recorded) session::print(stdout, "Recording: {}\n", (*recorded)->string());
  std::fflush(stdout);
  return kExitDone;
}

/// Writes the files that were asked for of a run that is over.
driver::Result<void> write_files(const session::Session& session,
                                 const session::RunFigures& figures, const RunOptions& options,
                                 int object) {
  if (!options.report.empty()) {
    if (auto written = write_run_files(session, figures, options.report); !written) return written;
    session::print(stdout, "Report and pictures: {}\n", options.report);
  }
  if (!options.save_mesh.empty()) {
    if (auto saved = render::save_mesh(session.mesh_now(object), options.save_mesh); !saved) {
      return saved;
    }
    session::print(stdout, "Mesh as it is now: {}\n", options.save_mesh);
  }
  return {};
}

/// Opens the arm of a session that is ready and runs it to its end. `guard` stands while an arm may
/// hold a force or a recording is not closed.
ExitCode run_session(session::Session& session, session::ServoThread& servo,
                     session::ViewerRequestHandler* desk, std::optional<scene::LeavingGuard>& guard,
                     const std::atomic<bool>& stop) {
  guard.emplace();
  const bool real = session.setup().real_arm().has_value();
  const auto open = session::open_arm(session, session::user_terminal(), stop);
  if (!open) {
    const ExitCode code = complain(open.error(), real ? kExitNoDevice : kExitBadInput);
    return stop.load() ? kExitInterrupted : code;
  }
  if (!*open) return kExitInterrupted;
  std::optional<session::ReplugWatch> watch;
  if (real) watch.emplace(session::replug_watch_of(session));

  servo.begin(session, stop);
  session::RunAttendance attendance(session, watch ? &*watch : nullptr, desk,
                                    isatty(STDERR_FILENO) != 0);
  while (!servo.ended()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    attendance.step();
  }
  attendance.clear();
  servo.join();
  session::keep_black_box(session);
  return kExitDone;
}

int run_scene(const RunOptions& options) {
  if (const auto fits = check(options); !fits) return complain(fits.error(), kExitBadInput);
  const auto arm = session::choose_run_arm(
      options.device,
      {.arm_file = options.arm_file, .firmware = options.firmware, .unchecked = options.unchecked});
  if (!arm) return complain(arm.error(), kExitNoDevice);
  tell(arm->told);

  // All that takes time comes before the arm is opened: an open arm is served in every millisecond.
  const std::atomic<bool>& stop = scene::catch_interrupts();
  if (arm->real) scene::leave_rather_than_stop();
  auto prepared = session::Session::prepare(options.scene, session_options(options, *arm));
  if (!prepared) return complain(prepared.error(), kExitBadInput);
  session::Session& session = **prepared;
  // Whoever leaves before the run leaves a recording that is whole, with no tick in it.
  const auto leave = [&session](int code) {
    if (const auto ended = session.end_recording(); !ended) complain(ended.error(), kExitTrouble);
    return code;
  };
  tell(session.told());
  for (const std::string& warning : stability_warnings(session.scene())) {
    scene::logger().warn("{} See thimble tune.", warning);
  }
  const auto object = options.save_object.empty() ? std::optional<int>(-1)
                                                  : session.find_object(options.save_object);
  if (!object) {
    return leave(
        complain({"--save-object: the scene has no object \"" + options.save_object + "\"."},
                 kExitBadInput));
  }
  const auto desk = session::open_viewer_requests(session, viewer_choice(options));
  session::ServoThread servo(session.real_time());
  if (arm->real) {
    if (auto granted = session::check_real_time(servo.grant(), options.no_real_time); !granted) {
      return leave(complain(granted.error(), kExitBadInput));
    }
  }
  if (!servo.grant().advice.empty()) scene::logger().warn("{}", servo.grant().advice);
  if (stop.load()) return leave(kExitInterrupted);
  if (!session::agree_to_forces(session, options.yes, session::user_terminal(), stop)) {
    return leave(stop.load() ? kExitInterrupted : kExitBadInput);
  }
  std::optional<scene::LeavingGuard> guard;
  const ExitCode ran = run_session(session, servo, desk.get(), guard, stop);
  if (ran != kExitDone) return leave(ran);
  // The touch went on, whatever became of the recording.
  const ExitCode recorded = end_recording(session);
  // Zero force is out and the recording closed; who is impatient may kill what follows. Not so
  // where the arm took no zero.
  if (session.device().zero_assured()) guard.reset();
  const session::RunFigures figures = session.figures(servo.grant());
  session::print(stdout, "{}", summary(figures));
  if (const auto written = write_files(session, figures, options, *object); !written) {
    return complain(written.error(), kExitTrouble);
  }
  const ExitCode ended = exit_code_of(figures.end, figures.fault, desk && desk->ended());
  return ended == kExitDone ? recorded : ended;
}

std::string first_sentence(const std::string& text) {
  const std::size_t end = text.find(". ");
  return end == std::string::npos ? text : text.substr(0, end + 1);
}

/// Prints what is known by name, and ends the program: there is nothing to run.
void list_shipped() {
  const auto print = [](const char* title, const std::vector<scene::ShippedFile>& files) {
    session::print(stdout, "{}:\n", title);
    for (const scene::ShippedFile& file : files) {
      session::print(stdout, "  {:<18} {}\n  {:<18}   {}\n", file.name, file.path.string(), "",
                     first_sentence(scene::description_of(file.path)));
    }
    if (files.empty())
      session::print(stdout, "  none is known by name here; give the path of a file\n");
  };
  print("Scenes", scene::shipped_scenes());
  print("Arms", scene::shipped_arms());
  throw CLI::Success();
}

}  // namespace

void add_run_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("run", "Touch a scene");
  auto options = std::make_shared<RunOptions>();
  add_scene_option(*command, options->scene)->required();
  command
      ->add_flag_callback("--list", list_shipped,
                          "List the scenes and arms that are known by name, and end")
      ->trigger_on_parse();
  command
      ->add_option("--device", options->device,
                   "Arm to use: sim, auto, or a name that `thimble devices` lists")
      ->capture_default_str();
  add_arm_option(
      *command, options->arm_file,
      "Arm file in place of the scene's own; of a real arm, in place of the one it brings");
  command->add_option("--firmware", options->firmware, "Firmware image for an arm that needs one")
      ->check(CLI::ExistingFile);
  command->add_flag("--yes", options->yes, "Give a real arm forces without asking");
  command->add_flag("--unchecked", options->unchecked,
                    "Give a real arm its whole force though `thimble feel-check` was not passed; "
                    "without it such an arm gets at most 0.5 N");
  command->add_flag("--homed", options->homed,
                    "A real arm was in its home pose when it got power: check only that its tip is "
                    "in the workspace");
  command->add_flag("--no-real-time", options->no_real_time,
                    "Use a real arm though the loop gets no real-time priority");
  command->add_option("--duration", options->duration, "Seconds to run; the scene's own if absent")
      ->check(CLI::Validator(
          [](const std::string& text) {
            char* end = nullptr;
            const double seconds = std::strtod(text.c_str(), &end);
            // Written so that NaN is refused.
            const bool good =
                end != text.c_str() && *end == 0 && seconds >= 1e-3 && seconds <= 86400;
            return good ? std::string() : "expected 0.001 to 86400 seconds, found " + text;
          },
          "SECONDS"));
  command
      ->add_option("--clock", options->clock,
                   "virtual: as fast as it computes, repeatable to the bit; wall: in real time "
                   "(if absent: wall with --view or --hand mouse, virtual otherwise)")
      ->check(CLI::IsMember({"virtual", "wall"}));
  command
      ->add_option("--hand", options->hand,
                   "Who leads the simulated hand: path, as the scene says; mouse, by the viewer, "
                   "until its window is closed")
      ->check(CLI::IsMember({"path", "mouse"}))
      ->capture_default_str();
  CLI::Option* view = command->add_flag("--view", options->view, "Watch the run in a window");
  command->add_flag("--no-view", options->no_view, "Show the run to nobody")->excludes(view);
  command->add_option("--name", options->name,
                      "Name of the run for `thimble view NAME`; the scene's if absent");
  add_quality_option(
      *command, options->quality,
      "draft, normal (what the scene says), reference or auto (the cheapest at which nothing wrong "
      "can be felt): points on the diagrams of `thimble study accuracy`; each choice is printed");
  command
      ->add_option("--budget", options->budget,
                   "With --quality auto: the most accurate points within so many ns per tick, of "
                   "all objects "
                   "together, on the machine that the stored diagrams name")
      ->check(CLI::Range(1.0, 1e9));
  command->add_option("--report", options->report, "Folder for report.json and pictures");
  command->add_option(
      "--record", options->record,
      "Recording of every tick to write (HDF5; thimble export makes a table of it)");
  CLI::Option* save = command->add_option(
      "--save-mesh", options->save_mesh,
      "OFF file for the meshes as they are at the end: moved, dented, sculpted (world, m)");
  command
      ->add_option("--save-object", options->save_object,
                   "Save the mesh of this object of the scene alone")
      ->needs(save);
  command->add_option("--seed", options->seed, "Seed of everything random; the scene's if absent");
  command->callback([options, &exit_code] { exit_code = run_scene(*options); });
}

}  // namespace thimble::app

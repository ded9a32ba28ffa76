#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "cli/commands.h"
#include "cli/complain.h"
#include "cli/file_options.h"
#include "enter_key.h"
#include "interrupt.h"
#include "recording/write_black_box.h"
#include "replug_watch.h"
#include "report/pictures.h"
#include "report/report.h"
#include "report/session_report.h"
#include "servo_thread.h"
#include "share/request_desk.h"
#include "share/viewer_process.h"
#include "stability/tuning.h"
#include "thimble/driver/heat_guard.h"
#include "thimble/render/mesh/save_mesh.h"
#include "thimble/scene/meshes.h"
#include "thimble/scene/quality.h"
#include "thimble/scene/real_arm.h"
#include "thimble/scene/shipped_files.h"
#include "thimble/session/session.h"
#include "thimble/session/start_pose.h"

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
  bool yes = false;
  bool unchecked = false;
  bool homed = false;
  bool no_real_time = false;

  bool led() const { return hand == "mouse"; }
};

/// Writes the seconds around a fault, if one came, where a person finds them.
void keep_black_box(session::Session& session) {
  const auto ticks = session.black_box().take();
  if (ticks.empty()) return;
  const auto written = session::write_black_box(ticks, session.recording_info());
  if (written) {
    std::fprintf(stderr, "thimble: the last seconds before the fault are in %s\n",
                 written->c_str());
  } else {
    complain(written.error(), kExitTrouble);
  }
}

/// Tells a person on a terminal how far the run is, until it ends.
/// Watches over a real arm meanwhile, and hears what viewers ask.
void show_progress(session::Session& session, const session::ServoThread& servo,
                   session::ReplugWatch* watch, session::RequestDesk* desk) {
  const bool on_terminal = isatty(STDERR_FILENO) != 0;
  bool warned_of_heat = false;
  const double total = static_cast<double>(session.ticks_planned()) *
                       static_cast<double>(session.period_ns()) * 1e-9;
  while (!servo.ended()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    if (watch != nullptr) watch->step();
    if (desk != nullptr) desk->step();
    if (session.black_box().full()) keep_black_box(session);
    driver::TickRecord record;
    if (!session.snapshot().load(record)) continue;
    const double heat = *std::max_element(record.heat.begin(), record.heat.end());
    if (heat >= driver::HeatGuard::kWarning && !warned_of_heat) {
      warned_of_heat = true;
      std::fprintf(
          stderr,
          "thimble: A motor is at %.0f %% of the heat it bears; the force is lowered until "
          "it cools. Press less hard or rest.\n",
          100 * heat);
    }
    if (!on_terminal) continue;
    const double force = Eigen::Map<const Eigen::Vector3d>(record.f_sent_W.data()).norm();
    char of_total[32] = "";
    if (total > 0) std::snprintf(of_total, sizeof of_total, "of %.1f ", total);
    std::fprintf(stderr, "\r%6.1f %ss   %-8s  force %5.2f N   depth %5.2f mm ",
                 static_cast<double>(record.time_ns) * 1e-9, of_total,
                 record.in_contact ? "touching" : "free", force, record.depth * 1e3);
  }
  if (on_terminal) std::fprintf(stderr, "\r%*s\r", 70, "");
}

/// Prints sentences, a line each.
void tell(const std::vector<std::string>& sentences) {
  for (const std::string& sentence : sentences) std::printf("%s\n", sentence.c_str());
  std::fflush(stdout);  // before a person is asked something
}

/// Lets nobody be surprised by a force: asks before a real arm is opened.
bool may_begin(const driver::FoundArm& arm, bool at_home, bool yes, const std::atomic<bool>& stop) {
  std::fprintf(stderr, "%s %s is about to get forces. Keep clear of it, hold its grip%s, keep its ",
               arm.arm.c_str(), arm.name().c_str(), at_home ? " in the home pose" : "");
  std::fprintf(stderr, "switch at hand.\n");
  if (yes) return true;
  if (isatty(STDIN_FILENO) == 0) {
    std::fprintf(stderr, "thimble: Nobody is at the terminal to agree; say so with --yes.\n");
    return false;
  }
  std::fprintf(stderr, "Press Enter to begin, Ctrl-C to leave. ");
  while (!stop.load()) {
    const session::EnterKey key = session::look_for_enter();
    if (key != session::EnterKey::kNothing) return key == session::EnterKey::kPressed;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return false;
}

/// Opens the arm of a session on which all else is ready; a real one may have forces only once its
/// tip is where it must be. Returns false if `stop` was set before.
driver::Result<bool> open_arm(session::Session& session, const RunOptions& options, bool real,
                              const std::atomic<bool>& stop) {
  if (auto opened = session.open_arm(); !opened) return opened.error();
  if (!real) return true;
  auto placed =
      session::wait_for_start_pose(session.device(), session.clock(), session.start_pose(),
                                   !options.homed, session::user_terminal(), stop);
  if (!placed || !*placed) return placed;
  if (auto activated = session.activate(); !activated) return activated.error();
  return true;
}

/// Finds which object's mesh is to be saved: -1 for all. Nothing if the scene has no such object.
std::optional<int> object_to_save(const scene::Scene& scene, const std::string& name) {
  if (name.empty()) return -1;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    if (scene.objects[i].name == name) return static_cast<int>(i);
  }
  return {};
}

/// Says whether the run opens a viewer: if it is asked to, and where a person watches it in real
/// time.
bool wants_viewer(const RunOptions& options, bool real_time) {
  if (options.no_view) return false;
  if (options.view || options.led()) return session::has_display();
  return real_time && session::has_display() && isatty(STDERR_FILENO) != 0;
}

/// Opens the viewer if one is wanted, and serves all that come.
std::unique_ptr<session::RequestDesk> open_desk(session::Session& session,
                                                const RunOptions& options, bool real_time) {
  if (session.shared() == nullptr) return nullptr;
  std::unique_ptr<session::ViewerProcess> viewer;
  if (wants_viewer(options, real_time)) {
    auto started = session::ViewerProcess::start(session.shared()->name());
    if (started) {
      viewer = std::move(started).value();
    } else {
      complain(started.error(), kExitTrouble);
    }
  } else if (!options.no_view && (options.view || options.led())) {
    std::fprintf(stderr, "No screen (DISPLAY, WAYLAND_DISPLAY): watch by `thimble view %s`.\n",
                 session.shared()->name().c_str());
  }
  return std::make_unique<session::RequestDesk>(session, std::move(viewer), options.led());
}

int run_scene(const RunOptions& options) {
  if (options.led() && options.device != "sim") {
    return complain({"--hand mouse leads the simulated arm's hand; a real arm has yours."},
                    kExitBadInput);
  }
  if (options.led() && options.clock == "virtual" && !options.duration) {
    return complain({"--hand mouse without an end needs real time: leave --clock away, or give "
                     "--duration."},
                    kExitBadInput);
  }
  std::optional<driver::FoundArm> real_arm;
  if (options.device != "sim") {
    const auto plugged_in = driver::find_arms();
    auto chosen = scene::choose_arm(plugged_in ? *plugged_in : std::vector<driver::FoundArm>(),
                                    options.device);
    if (!chosen) return complain(chosen.error(), kExitNoDevice);
    real_arm = *chosen;
    if (!real_arm) {
      std::printf("No arm is plugged in: the simulated one is used.\n");
      const std::string left = plugged_in ? scene::boards_left_out(*plugged_in) : "";
      if (!left.empty()) std::printf("%s\n", left.c_str());
    }
  }
  std::optional<scene::RealArmTerms> terms;
  if (real_arm) {
    auto found = scene::terms_for(*real_arm, {.arm_file = options.arm_file,
                                              .firmware = options.firmware,
                                              .unchecked = options.unchecked});
    if (!found) return complain(found.error(), kExitNoDevice);
    terms = std::move(found).value();
    tell(terms->told);
  }
  session::SessionOptions session_options;
  // A person who watches or leads does so in real time, unless he says otherwise.
  const bool for_a_person = options.view || options.led();
  const bool wall = options.clock.empty() ? for_a_person : options.clock == "wall";
  session_options.clock = wall ? session::ClockKind::kWall : session::ClockKind::kVirtual;
  session_options.hand_by_mouse = options.led();
  session_options.duration = options.duration;
  session_options.seed = options.seed;
  session_options.mesh_folder = scene::mesh_folder();
  session_options.arm_file = options.arm_file;
  session_options.real_arm = real_arm;
  session_options.terms = terms;
  session_options.firmware = options.firmware;
  session_options.record = options.record;
  session_options.adjust = [&](scene::Scene& scene) {
    for (const std::string& choice :
         scene::apply_quality(scene::quality_named(options.quality), scene)) {
      std::printf("%s: %s\n", options.quality.c_str(), choice.c_str());
    }
  };
  if (real_arm) session_options.clock = session::ClockKind::kWall;
  const bool real_time = session_options.clock == session::ClockKind::kWall;
  session_options.share_out =
      !options.name.empty() || options.view || options.led() || (real_time && !options.no_view);
  session_options.share_name = options.name;
  session_options.share_if_possible = options.name.empty() && !for_a_person;
  session_options.homed = options.homed;

  // All that takes time comes before the arm is opened: an open arm is served in every millisecond.
  const std::atomic<bool>& stop = scene::catch_interrupts();
  if (real_arm) scene::leave_rather_than_stop();
  auto prepared = session::Session::prepare(options.scene, session_options);
  if (!prepared) return complain(prepared.error(), kExitBadInput);
  session::Session& session = **prepared;
  tell(session.told());
  // Whoever leaves before the run leaves a recording that is whole, with no tick in it.
  const auto leave = [&session](int code) {
    if (const auto ended = session.recording().stop(); !ended)
      complain(ended.error(), kExitTrouble);
    return code;
  };
  for (const std::string& note : session.mesh_notes()) {
    std::fprintf(stderr, "thimble: %s\n", note.c_str());
  }
  for (const std::string& warning : stability_warnings(session.scene())) {
    std::fprintf(stderr, "thimble: %s See thimble tune.\n", warning.c_str());
  }
  const auto saved = object_to_save(session.scene(), options.save_object);
  if (!saved) {
    return leave(
        complain({"--save-object: the scene has no object \"" + options.save_object + "\"."},
                 kExitBadInput));
  }
  const auto desk = open_desk(session, options, real_time);
  session::ServoThread servo(real_time);
  if (real_arm) {
    if (auto granted = session::check_real_time(servo.grant(), options.no_real_time); !granted) {
      return leave(complain(granted.error(), kExitBadInput));
    }
  }
  if (!servo.grant().advice.empty()) spdlog::warn("{}", servo.grant().advice);
  if (stop.load()) return leave(kExitInterrupted);
  if (real_arm) {
    const bool at_home = !options.homed && session.start_pose().has_home();
    if (!may_begin(*real_arm, at_home, options.yes, stop)) {
      return leave(stop.load() ? kExitInterrupted : kExitBadInput);
    }
  }
  auto guard = std::make_optional<scene::LeavingGuard>();
  const auto open = open_arm(session, options, real_arm.has_value(), stop);
  if (!open) {
    const int code = complain(open.error(), real_arm ? kExitNoDevice : kExitBadInput);
    return leave(stop.load() ? kExitInterrupted : code);
  }
  if (!*open) return leave(kExitInterrupted);
  std::optional<session::ReplugWatch> watch;
  if (real_arm) watch.emplace(session::replug_watch_of(session, *real_arm, options.firmware));

  servo.begin(session, stop);
  show_progress(session, servo, watch ? &*watch : nullptr, desk.get());
  const driver::ServoEnd end = servo.join();
  keep_black_box(session);

  // The touch went on, whatever became of the recording; who asked for one shall hear of it.
  int exit_code_when_done = kExitDone;
  if (session::Recorder* recorder = session.recording().recorder()) {
    const std::string path = recorder->path();
    if (const auto finished = session.recording().stop(); !finished) {
      exit_code_when_done = complain(finished.error(), kExitTrouble);
    } else {
      std::printf("Recording: %s\n", path.c_str());
    }
  }
  std::fflush(stdout);
  // Zero force is out and the recording closed; who is impatient may kill what follows. Not so
  // where the arm took no zero.
  if (session.device().zero_assured()) guard.reset();
  const RunReport report = report_of(session, end, servo.grant());
  std::printf("%s", summary(report).c_str());
  if (!options.report.empty()) {
    const std::filesystem::path folder = options.report;
    if (const auto written = write_report(report, folder); !written)
      return complain(written.error(), kExitTrouble);
    const PictureInfo info{.title = report.scene + ", " + report.arm,
                           .virtual_time = report.virtual_time,
                           .period = 1 / report.rate_asked,
                           .period_times = &report.statistics.period(),
                           .work_times = &report.statistics.work()};
    const auto drawn = draw_pictures(session.trace().rows(), session.mesh_W(), info, folder);
    if (!drawn) {
      return complain(drawn.error(), kExitTrouble);
    }
    if (session.dents() != nullptr && session.dents()->deepest().triangle_count > 0) {
      render::TriangleMesh bent = session.bent_mesh_W();
      for (Eigen::Vector3d& vertex : bent.vertices) vertex *= 1e3;
      const auto dent =
          draw_mesh(bent, folder / "dent.png", report.scene + ": the deepest dent", "mm");
      if (!dent) return complain(dent.error(), kExitTrouble);
    }
    std::printf("Report and pictures: %s\n", folder.c_str());
  }
  if (!options.save_mesh.empty()) {
    const auto written = render::save_mesh(session.mesh_now(*saved), options.save_mesh);
    if (!written) return complain(written.error(), kExitTrouble);
    std::printf("Mesh as it is now: %s\n", options.save_mesh.c_str());
  }
  switch (end) {
    case driver::ServoEnd::kDone:
      // A loop with a real arm outlives its faults.
      return report.fault == driver::Fault::kNone ? exit_code_when_done : kExitFault;
    case driver::ServoEnd::kStopped:
      return desk && desk->ended() ? exit_code_when_done : kExitInterrupted;
    case driver::ServoEnd::kFault:
      return kExitFault;
  }
  return kExitTrouble;
}

std::string first_sentence(const std::string& text) {
  const std::size_t end = text.find(". ");
  return end == std::string::npos ? text : text.substr(0, end + 1);
}

/// Prints what is known by name, and ends the program: there is nothing to run.
void list_shipped() {
  const auto print = [](const char* title, const std::vector<scene::ShippedFile>& files) {
    std::printf("%s:\n", title);
    for (const scene::ShippedFile& file : files) {
      std::printf("  %-18s %s\n  %-18s   %s\n", file.name.c_str(), file.path.c_str(), "",
                  first_sentence(scene::description_of(file.path)).c_str());
    }
    if (files.empty()) std::printf("  none is known by name here; give the path of a file\n");
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
  command
      ->add_option("--quality", options->quality,
                   "draft, normal (what the scene says) or reference: points on the diagrams of "
                   "`thimble study accuracy`; each choice is printed")
      ->check(CLI::IsMember({"draft", "normal", "reference"}))
      ->capture_default_str();
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

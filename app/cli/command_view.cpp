#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "cli/commands.h"
#include "cli/options/theme_option.h"
#include "cli/parts/part.h"
#include "cli/report_error.h"
#include "cli/usage/help_text.h"
#include "log/printed_text.h"
#include "report/html/page_libraries.h"
#include "share/run_attachment.h"
#include "share/shared_memory.h"
#include "share/steer/save_knobs.h"
#include "share/turn_knob.h"
#include "signals.h"
#include "text/counted.h"
#include "thimble/scene/shipped_files.h"
#include "web/web_server.h"

namespace thimble::cli {
namespace {

// Maximum time to wait for the next run when a run ends: it is already prepared, and only the
// recording has to be closed. Chosen.
constexpr std::chrono::seconds kNextRunTimeout{10};

struct ViewOptions {
  std::vector<std::string> shown;  // a run, or recordings
  bool start = false;
  bool list = false;
  bool text = false;
  bool web = false;
  std::uint16_t port = 0;  // 0: any free port
  bool follow = false;
  std::vector<std::string> turn;
  bool pause = false, resume = false, stop = false, restart = false;
  std::uint64_t steps = 0;
  std::optional<double> speed;
  std::string loop, scene;
  bool save_knobs = false, overwrite = false;
  std::string save_as;
  std::string record;
  bool record_stop = false;
  double seconds = 0;  // 0: no limit
  std::string theme;   // empty: of the window light, of a page that of the browser

  /// Returns the name of the run, or the file of --start; empty: the newest run, or no file.
  std::string run() const { return shown.empty() ? "" : shown.front(); }
  bool has_requests() const {
    return !turn.empty() || pause || resume || stop || !record.empty() || record_stop || restart ||
           steps > 0 || speed || !loop.empty() || !scene.empty() || save_knobs;
  }
  bool is_for_runs() const { return list || text || web || follow || has_requests(); }
};

int list_runs() {
  const auto runs = session::running_runs();
  for (const session::RunningRun& run : runs) {
    const auto reader = session::SharedReader::attach(run.name);
    if (!reader) {
      scene::print_format("%s: %s\n", run.name.c_str(), reader.error().message.c_str());
      continue;
    }
    const session::SharedScene& scene = (*reader)->scene();
    scene::print_format("%s: %s, %s (%s), process %lld\n", run.name.c_str(), scene.name.c_str(),
                        scene.arms.front().name.c_str(), scene.arms.front().device.c_str(),
                        static_cast<long long>(scene.pid));
    for (std::size_t i = 0; i < scene.knobs.size(); ++i) {
      const session::SharedScene::Knob& knob = scene.knobs[i];
      scene::print_format("    %s = %.4g %s (%.4g to %.4g)\n", knob.name.c_str(),
                          (*reader)->knob(i), knob.unit.c_str(), knob.min, knob.max);
    }
  }
  if (runs.empty())
    scene::print_format("No run is active. Start one with `thimble run SCENE --view`.\n");
  return kExitDone;
}

/// Sends the requests that change the course of the run: speed, loop, steps, scene, restart.
driver::Result<void> send_control_requests(session::SharedReader& reader,
                                           const ViewOptions& options) {
  if (options.speed) {
    if (auto asked = reader.ask_speed(*options.speed); !asked) return asked;
  }
  if (!options.loop.empty()) {
    if (auto asked = reader.ask_loop(options.loop == "on"); !asked) return asked;
  }
  if (options.steps > 0) {
    // After a pause request, the ticks meant are those after the pause.
    for (int i = 0;
         i < 200 && reader.pause_asked() && reader.state() == session::RunState::kRunning; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    if (auto asked = reader.ask_steps(options.steps); !asked) return asked;
  }
  if (!options.scene.empty()) {
    auto found = scene::find_scene(options.scene);
    if (!found) return found.error();
    const auto file = std::filesystem::absolute(*found).lexically_normal().string();
    if (auto asked = reader.ask_restart(file); !asked) return asked;
  }
  return options.restart ? reader.ask_restart() : driver::Result<void>();
}

/// Writes the current knobs of a run into a scene file, and prints its path.
int save(const session::SharedReader& reader, const ViewOptions& options) {
  const auto saved =
      session::save_knobs(reader, {.file = options.save_as, .over = options.overwrite});
  if (!saved) return report_error(saved.error(), kExitBadInput);
  scene::print_format("%s\n", saved->text().c_str());
  return kExitDone;
}

/// Sends all requests to a run, once.
driver::Result<void> send_once(session::SharedReader& reader, const ViewOptions& options) {
  for (const std::string& order : options.turn) {
    if (auto turned = session::turn_knob(reader, order); !turned) return turned;
  }
  if (options.pause || options.resume) reader.ask_pause(options.pause);
  if (auto asked = send_control_requests(reader, options); !asked) return asked;
  const bool taken = (options.record.empty() || reader.ask_record(options.record)) &&
                     (!options.record_stop || reader.ask_record_stop());
  if (!taken) return driver::Error{"Another viewer is sending a request; try again."};
  if (options.stop) reader.ask_stop();
  return {};
}

/// Sends all requests. If the run ends meanwhile, sends them once more to the next run.
int send_requests(const ViewOptions& options) {
  const auto latest = std::chrono::steady_clock::now() + kNextRunTimeout;
  std::string run = options.run();
  for (bool first = true;; first = false) {
    auto attached = session::SharedReader::attach(run);
    if (!attached && options.stop && !first) return kExitDone;  // the run has already ended
    if (!attached) return report_error(attached.error(), kExitBadInput);
    session::SharedReader& reader = **attached;
    run = reader.name();
    const auto asked =
        reader.check_accepted() ? send_once(reader, options) : reader.check_accepted();
    const auto heard = reader.check_accepted();
    if (heard && !asked) return report_error(asked.error(), kExitBadInput);
    if (heard) return options.save_knobs ? save(reader, options) : kExitDone;
    if (std::chrono::steady_clock::now() >= latest)
      return report_error(heard.error(), kExitBadInput);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

void print_line(const session::SharedReader& reader) {
  driver::TickRecord tick;
  const bool any = reader.newest(tick);
  const session::SharedReader::Counters counters = reader.counters();
  const double force = Eigen::Map<const Eigen::Vector3d>(tick.f_sent_W.data()).norm();
  scene::print_format("%s %s: ", reader.name().c_str(), session::name_of(reader.state()));
  if (any) {
    scene::print_format("%.3f s, force %.2f N, depth %.2f mm, ",
                        1e-9 * static_cast<double>(tick.time_ns), force, 1e3 * tick.depth);
  }
  scene::print_format("%s, %llu missed", scene::counted(counters.ticks, "tick").c_str(),
                      static_cast<unsigned long long>(counters.missed));
  if (counters.paused > 0) {
    scene::print_format(", %llu paused", static_cast<unsigned long long>(counters.paused));
  }
  scene::print_format("%s%s\n", counters.recording ? ", recording to " : "",
                      counters.recording ? reader.recording_path().c_str() : "");
  std::fflush(stdout);
}

/// Prints the state of a run once a second, without a window.
int print_states(const ViewOptions& options) {
  const std::atomic<bool>& stop = scene::catch_interrupts();
  session::RunAttachment runs(options.run());
  std::string last_notice;
  auto next_line = std::chrono::steady_clock::now();
  const auto end = next_line + std::chrono::duration<double>(options.seconds);
  while (!stop.load()) {
    if (options.seconds > 0 && std::chrono::steady_clock::now() >= end) return kExitDone;
    if (runs.step()) {
      scene::print_format("Watching %s: %s\n", runs.name().c_str(),
                          runs.reader()->scene().name.c_str());
      last_notice.clear();
    }
    std::string notice = runs.notice();
    if (notice.empty() && runs.reader() != nullptr) notice = runs.reader()->notice();
    const bool ended =
        runs.reader() != nullptr && runs.reader()->state() == session::RunState::kEnded;
    const auto now = std::chrono::steady_clock::now();
    if (runs.reader() != nullptr && last_notice != notice && ended) print_line(*runs.reader());
    if (runs.reader() != nullptr && !ended && now >= next_line) {
      print_line(*runs.reader());
      next_line = now + std::chrono::seconds(1);
    }
    if (!notice.empty() && notice != last_notice) scene::print_format("%s\n", notice.c_str());
    std::fflush(stdout);
    last_notice = notice;
    if (runs.over() && !options.follow) return kExitDone;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return kExitInterrupted;
}

/// Shows a run in browsers on this computer.
int serve(const ViewOptions& options) {
  const std::atomic<bool>& stop = scene::catch_interrupts();
  session::RunAttachment runs(options.run());
  const session::SharedReader* watched = nullptr;
  auto server = web::WebServer::listen(runs, options.port);
  if (!server) return report_error(server.error(), kExitBadInput);
  if (auto libraries = report::read_page_libraries(); !libraries) {
    return report_error(libraries.error(), kExitBadInput);
  }
  const std::string theme = options.theme.empty() ? "" : "#theme=" + options.theme;
  scene::print_format("Open %s%s\n", (*server)->address().c_str(), theme.c_str());
  std::string last_notice;
  const auto end =
      std::chrono::steady_clock::now() + std::chrono::duration<double>(options.seconds);
  int exit_code = kExitInterrupted;
  while (!stop.load()) {
    (*server)->step();
    if (runs.reader() != watched) {
      watched = runs.reader();
      scene::print_format("Watching %s: %s\n", runs.name().c_str(), watched->scene().name.c_str());
    }
    const std::string notice = runs.notice();
    if (!notice.empty() && notice != last_notice) scene::print_format("%s\n", notice.c_str());
    std::fflush(stdout);
    last_notice = notice;
    const bool late = options.seconds > 0 && std::chrono::steady_clock::now() >= end;
    if ((!runs.over() || options.follow) && !late) continue;
    exit_code = kExitDone;
    break;
  }
  (*server)->step();  // the last ticks
  (*server)->leave(std::chrono::seconds(stop.load() ? 0 : 2));
  return exit_code;
}

/// Distinguishes a recording from the name of a run, which is no path and has no ending.
bool is_recording(const std::string& shown) {
  return shown.find('/') != std::string::npos || std::filesystem::path(shown).has_extension();
}

int view_recordings(const ViewOptions& options, const ShowWindow& show_window) {
  for (const std::string& file : options.shown) {
    if (!is_recording(file)) {
      return report_error({file + " is the name of a run. Name either one run or recordings."},
                          kExitBadInput);
    }
  }
  // A missing window before a missing file: no file can be shown then. A missing file before the
  // options: it may be no recording.
  if (!show_window.recordings) {
    return report_error(
        {"The window is not installed: " + how_to_get(kViewer) +
         "; or write a page for a browser: `thimble replay FILE --page FILE.html`."},
        kExitBadInput);
  }
  for (const std::string& file : options.shown) {
    std::error_code unknown;
    if (!std::filesystem::exists(file, unknown)) {
      return report_error({"RUN: there is no file " + file + "."}, kExitBadInput);
    }
  }
  if (options.is_for_runs()) {
    return report_error(
        {options.shown.front() +
         " is a recording, so options that control a run cannot be used. To write it as "
         "text, use `thimble export`."},
        kExitBadInput);
  }
  return show_window.recordings(options.shown, options.seconds, options.theme);
}

int open_start_window(const ViewOptions& options, const ShowWindow& show_window) {
  if (options.is_for_runs()) {
    return report_error({"--start opens a window in which a run is chosen. Remove the options that "
                         "control a run."},
                        kExitBadInput);
  }
  if (options.shown.size() > 1) {
    return report_error({"--start: expected one file. Open the others in the window."},
                        kExitBadInput);
  }
  if (!show_window.start) {
    return report_error({"The window is not installed: " + how_to_get(kViewer) +
                         "; or run a scene in the terminal: `thimble run SCENE`."},
                        kExitBadInput);
  }
  return show_window.start(options.run(), options.seconds, options.theme);
}

int show(const ViewOptions& options, const ShowWindow& show_window) {
  if (options.start) return open_start_window(options, show_window);
  if (std::any_of(options.shown.begin(), options.shown.end(), is_recording)) {
    return view_recordings(options, show_window);
  }
  if (options.shown.size() > 1) {
    return report_error({"RUN: expected one run per window. Open a window for each."},
                        kExitBadInput);
  }
  if (options.list) return list_runs();
  if (options.has_requests()) return send_requests(options);
  if (options.text) return print_states(options);
  if (options.web) return serve(options);
  if (!show_window.runs) {
    return report_error({"The window is not installed: " + how_to_get(kViewer) +
                         "; or use `thimble view --text` or `thimble view --web`."},
                        kExitBadInput);
  }
  // Without a run, a window on the next one would be blank.
  if (options.shown.empty() && session::running_runs().empty()) {
    return open_start_window(options, show_window);
  }
  session::RunAttachment runs(options.run());
  return show_window.runs(runs, options.seconds, options.theme);
}

}  // namespace

void add_view_command(CLI::App& app, int& exit_code, const ShowWindow& show_window) {
  CLI::App* command = app.add_subcommand("view", "Show a run of another process, or a recording");
  auto options = std::make_shared<ViewOptions>();
  command->add_option("RUN", options->shown,
                      "Run to show (default: the newest), or recordings (.h5)");
  constexpr const char* kViewing = "Viewing";
  command->add_flag("--start", options->start, "Open the start window, to choose a scene or a file")
      ->group(kViewing);
  command->add_flag("--list", options->list, "List the runs and their knobs, then exit")
      ->group(kViewing);
  CLI::Option* text =
      command->add_flag("--text", options->text, "Print one line per second, without a window")
          ->group(kViewing);
  CLI::Option* web =
      command->add_flag("--web", options->web, "Show the run in a browser on this computer")
          ->excludes(text)
          ->group(kViewing);
  command->add_option("--port", options->port, "Port of --web (default: any free port)")
      ->check(CLI::Range(1, 65535))
      ->needs(web)
      ->group(kViewing);
  command
      ->add_flag("--follow", options->follow, "Wait for the next run of that name (--text, --web)")
      ->group(kViewing);
  command->add_option("--for", options->seconds, "Exit after N seconds")
      ->check(CLI::Range(0.1, 86400.0))
      ->group(kViewing);
  add_theme_option(*command, options->theme,
                   "Colour theme (default: window light, page as the browser)")
      ->excludes(text)
      ->group(kViewing);
  constexpr const char* kControl = "Control the run, then exit";
  command->add_option("--turn", options->turn, "Set knobs of the run")
      ->option_text("NAME=VALUE ...")
      ->group(kControl);
  CLI::Option* pause =
      command->add_flag("--pause", options->pause, "Pause the run")->group(kControl);
  command->add_flag("--resume", options->resume, "Resume a paused run")
      ->excludes(pause)
      ->group(kControl);
  command->add_option("--step", options->steps, "Advance a paused run by N ticks")
      ->check(CLI::Range(std::uint64_t{1}, session::kStepsMax))
      ->group(kControl);
  command
      ->add_option("--speed", options->speed,
                   "Speed relative to real time; results stay bit-identical")
      ->check(CLI::Range(session::kSpeedMin, session::kSpeedMax))
      ->group(kControl);
  CLI::Option* restart =
      command->add_flag("--restart", options->restart, "Restart the run from its first tick")
          ->group(kControl);
  command->add_option("--scene", options->scene, "Restart the run with this scene")
      ->option_text("NAME|FILE")
      ->excludes(restart)
      ->group(kControl);
  command->add_option("--loop", options->loop, "Restart the run when it ends")
      ->check(CLI::IsMember({"on", "off"}))
      ->group(kControl);
  command->add_flag("--stop", options->stop, "End the run")->group(kControl);
  constexpr const char* kSave = "Save from the run, then exit";
  CLI::Option* record =
      command->add_option("--record", options->record, "Start a recording of the run")
          ->option_text("FILE")
          ->group(kSave);
  command->add_flag("--record-stop", options->record_stop, "Stop the recording")
      ->excludes(record)
      ->group(kSave);
  CLI::Option* save = command
                          ->add_flag("--save-knobs", options->save_knobs,
                                     "Save the scene with its current knobs as a new file")
                          ->group(kSave);
  CLI::Option* save_as =
      command->add_option("--save-as", options->save_as, "File to create with --save-knobs")
          ->option_text("FILE")
          ->needs(save)
          ->group(kSave);
  command
      ->add_flag("--overwrite", options->overwrite,
                 "With --save-knobs: overwrite the scene file instead")
      ->needs(save)
      ->excludes(save_as)
      ->group(kSave);
  add_example(*command, "thimble view elephant --pause",
              "RUN  If the scene has several arms, name the recordings of all arms. The\n"
              "     recordings of several runs are shown on one time line, each from its\n"
              "     first tick on.\n"
              "     Without RUN, and without an active run, the start window opens. The window\n"
              "     waits for a RUN that is not active.\n"
              "--start  RUN is then a scene, mesh or recording to open, or may be absent. A\n"
              "     run that the window starts ends with it.\n"
              "--step, --speed, --restart and --scene require a simulated arm.\n"
              "--save-knobs prints the path of the new file. It is next to the scene file; for\n"
              "a scene that came with Thimble, it is in your own scenes folder.\n"
              "--overwrite requires that the scene file is your own.");
  command->callback(
      [options, show_window, &exit_code] { exit_code = show(*options, show_window); });
}

}  // namespace thimble::cli

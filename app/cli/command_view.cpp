#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "cli/commands.h"
#include "cli/complain.h"
#include "interrupt.h"
#include "share/knob_order.h"
#include "share/run_attachment.h"
#include "share/shared_memory.h"

namespace thimble::app {
namespace {

struct ViewOptions {
  std::vector<std::string> shown;  // a run, or recordings
  bool list = false;
  bool text = false;
  bool follow = false;
  std::vector<std::string> turn;
  bool pause = false, resume = false, stop = false;
  std::string record;
  bool record_stop = false;
  double seconds = 0;  // 0: without an end

  /// Returns the run that is watched; empty: the newest.
  std::string run() const { return shown.empty() ? "" : shown.front(); }
  bool asks() const {
    return !turn.empty() || pause || resume || stop || !record.empty() || record_stop;
  }
  bool is_for_runs() const { return list || text || follow || asks(); }
};

int list_runs() {
  const auto runs = session::running_runs();
  for (const session::RunningRun& run : runs) {
    const auto reader = session::SharedReader::attach(run.name);
    if (!reader) {
      std::printf("%s: %s\n", run.name.c_str(), reader.error().message.c_str());
      continue;
    }
    const session::SharedScene& scene = (*reader)->scene();
    std::printf("%s: %s, %s (%s), process %lld\n", run.name.c_str(), scene.name.c_str(),
                scene.arm.name.c_str(), scene.arm.device.c_str(),
                static_cast<long long>(scene.pid));
    for (std::size_t i = 0; i < scene.knobs.size(); ++i) {
      const session::SharedScene::Knob& knob = scene.knobs[i];
      std::printf("    %s = %.4g %s (%.4g to %.4g)\n", knob.name.c_str(), (*reader)->knob(i),
                  knob.unit.c_str(), knob.least, knob.most);
    }
  }
  if (runs.empty()) std::printf("No run is shown; start one with `thimble run SCENE --view`.\n");
  return kExitDone;
}

int ask(const ViewOptions& options) {
  auto attached = session::SharedReader::attach(options.run());
  if (!attached) return complain(attached.error(), kExitBadInput);
  session::SharedReader& reader = **attached;
  for (const std::string& order : options.turn) {
    if (auto turned = session::turn_knob(reader, order); !turned) {
      return complain(turned.error(), kExitBadInput);
    }
  }
  if (options.pause || options.resume) reader.ask_pause(options.pause);
  const bool heard = (options.record.empty() || reader.ask_record(options.record)) &&
                     (!options.record_stop || reader.ask_record_stop());
  if (options.stop) reader.ask_stop();
  if (!heard) return complain({"Another viewer is just asking for something."}, kExitTrouble);
  return kExitDone;
}

void print_line(const session::SharedReader& reader) {
  driver::TickRecord tick;
  const bool any = reader.newest(tick);
  const session::SharedReader::Counters counters = reader.counters();
  const double force = Eigen::Map<const Eigen::Vector3d>(tick.f_sent_W.data()).norm();
  std::printf("%s %s: ", reader.name().c_str(), session::name_of(reader.state()));
  if (any) {
    std::printf("%.3f s, force %.2f N, depth %.2f mm, ", 1e-9 * static_cast<double>(tick.time_ns),
                force, 1e3 * tick.depth);
  }
  std::printf("%llu ticks, %llu missed%s%s\n", static_cast<unsigned long long>(counters.ticks),
              static_cast<unsigned long long>(counters.missed),
              counters.recording ? ", recording to " : "",
              counters.recording ? reader.recording_path().c_str() : "");
  std::fflush(stdout);
}

/// Tells of a run once a second, without a screen.
int tell(const ViewOptions& options) {
  const std::atomic<bool>& stop = scene::catch_interrupts();
  session::RunAttachment runs(options.run());
  std::string told;
  auto next_line = std::chrono::steady_clock::now();
  const auto end = next_line + std::chrono::duration<double>(options.seconds);
  while (!stop.load()) {
    if (options.seconds > 0 && std::chrono::steady_clock::now() >= end) return kExitDone;
    if (runs.step()) {
      std::printf("Watching %s: %s\n", runs.name().c_str(), runs.reader()->scene().name.c_str());
      told.clear();
    }
    const std::string notice = runs.notice();
    const bool ended =
        runs.reader() != nullptr && runs.reader()->state() == session::RunState::kEnded;
    const auto now = std::chrono::steady_clock::now();
    if (runs.reader() != nullptr && told != notice && ended) print_line(*runs.reader());
    if (runs.reader() != nullptr && !ended && now >= next_line) {
      print_line(*runs.reader());
      next_line = now + std::chrono::seconds(1);
    }
    if (!notice.empty() && notice != told) std::printf("%s\n", notice.c_str());
    std::fflush(stdout);
    told = notice;
    if (ended && !options.follow) return kExitDone;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return kExitInterrupted;
}

/// Tells a recording from the name of a run, which is no path and has no ending.
bool is_recording(const std::string& shown) {
  return shown.find('/') != std::string::npos || std::filesystem::path(shown).has_extension();
}

int view_recordings(const ViewOptions& options, const ShowWindow& show_window) {
  for (const std::string& file : options.shown) {
    if (is_recording(file)) continue;
    return complain({file + " is the name of a run; show one run, or recordings."}, kExitBadInput);
  }
  if (options.is_for_runs()) {
    return complain({options.shown.front() +
                     " is a recording: nothing can be asked of it, and as text it is written by "
                     "`thimble export`."},
                    kExitBadInput);
  }
  if (!show_window.recordings) {
    return complain({"This thimble was built without a window; `thimble replay FILE --page "
                     "FILE.html` makes a page that a browser plays."},
                    kExitBadInput);
  }
  return show_window.recordings(options.shown, options.seconds);
}

int show(const ViewOptions& options, const ShowWindow& show_window) {
  if (std::any_of(options.shown.begin(), options.shown.end(), is_recording)) {
    return view_recordings(options, show_window);
  }
  if (options.shown.size() > 1) {
    return complain({"A window shows one run; open one for each."}, kExitBadInput);
  }
  if (options.list) return list_runs();
  if (options.asks()) return ask(options);
  if (options.text) return tell(options);
  if (!show_window.runs) {
    return complain({"This thimble was built without a window; use `thimble view --text`."},
                    kExitBadInput);
  }
  session::RunAttachment runs(options.run());
  return show_window.runs(runs, options.seconds);
}

}  // namespace

void add_view_command(CLI::App& app, int& exit_code, const ShowWindow& show_window) {
  CLI::App* command =
      app.add_subcommand("view", "Show a run that goes on in another process, or a recording");
  auto options = std::make_shared<ViewOptions>();
  command->add_option(
      "RUN", options->shown,
      "Name of the run, the newest if absent; or a recording (.h5), of a scene with "
      "several arms one of each");
  command->add_flag("--list", options->list, "List the runs and their knobs, and leave");
  command->add_flag("--text", options->text, "Print a line a second in place of a window");
  command->add_flag("--follow", options->follow,
                    "With --text: wait for the next run of that name when one ends");
  command->add_option("--turn", options->turn, "Turn a knob of the run, NAME=VALUE, and leave");
  CLI::Option* pause = command->add_flag("--pause", options->pause, "Pause the run, and leave");
  command->add_flag("--resume", options->resume, "Let a paused run go on, and leave")
      ->excludes(pause);
  CLI::Option* record =
      command->add_option("--record", options->record, "Record the run from now on, and leave");
  command->add_flag("--record-stop", options->record_stop, "End the recording, and leave")
      ->excludes(record);
  command->add_flag("--stop", options->stop, "End the run, and leave");
  command->add_option("--for", options->seconds, "Stop looking on after so many seconds")
      ->check(CLI::Range(0.1, 86400.0));
  command->callback(
      [options, show_window, &exit_code] { exit_code = show(*options, show_window); });
}

}  // namespace thimble::app

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "cli/arm_choice.h"
#include "cli/commands.h"
#include "cli/end_run.h"
#include "cli/file_options.h"
#include "cli/options/json_option.h"
#include "cli/options/run_options.h"
#include "cli/report_error.h"
#include "cli/usage/usage_error.h"
#include "files/scene_inputs.h"
#include "hold_key.h"
#include "log/logger.h"
#include "log/printed_text.h"
#include "mesh/file/off_text.h"
#include "open_arm.h"
#include "output/output_file.h"
#include "output/output_plan.h"
#include "print.h"
#include "recording/recording_layout.h"
#include "replug_watch.h"
#include "report/figure_json.h"
#include "report/html/touch_page.h"
#include "report/report.h"
#include "report/run_files.h"
#include "ros2/ros_run.h"
#include "run_arm.h"
#include "run_attendance.h"
#include "setup.h"
#include "share/shared_run.h"
#include "share/steer/next_run.h"
#include "share/viewer_request_handler.h"
#include "signals.h"
#include "stability/tuning.h"
#include "terminal.h"
#include "thimble/driver/discovery.h"
#include "thimble/render/mesh/mesh_file.h"
#include "thimble/scene/quality.h"
#include "thimble/scene/shipped_files.h"
#include "thimble/session/servo_thread.h"
#include "thimble/session/session.h"

namespace thimble::cli {
namespace {

/// Prints on standard output, unless --quiet is set.
template <class... Args>
void report(fmt::format_string<Args...> format, Args&&... args) {
  if (scene::verbosity() == scene::Verbosity::kQuiet) return;
  session::print(scene::text_stream(), format, std::forward<Args>(args)...);
}

/// Prints sentences, one per line.
void print_lines(const std::vector<std::string>& sentences) {
  for (const std::string& sentence : sentences) report("{}\n", sentence);
  std::fflush(stdout);  // before the user is asked a question
}

/// Ends the recording and prints its path, and what it lacks if a recording was requested.
ExitCode end_recording(session::Session& session, const std::string& asked) {
  const auto recorded = session.end_recording();
  if (!recorded) return report_error(recorded.error(), kExitTrouble);
  for (std::size_t arm = 0; *recorded && arm < session.arms(); ++arm) {
    report("Recording: {}\n", session::file_of_arm(asked, session.arm_name(arm)).string());
  }
  std::fflush(stdout);
  return kExitDone;
}

/// Writes the requested files of a finished run.
driver::Result<void> write_files(const session::Session& session,
                                 const driver::RealTimeGrant& grant, const RunOptions& options,
                                 report::RunPage* page, int object) {
  if (page != nullptr) page->finish();
  if (!options.report.empty()) {
    auto written = report::write_run_files(session, grant, options.report, page);
    if (!written) return written;
    report("Report and pictures: {}\n", options.report);
  }
  if (page != nullptr) {
    // The pictures are written; a missing page is no error.
    const auto file = std::filesystem::path(options.report) / "index.html";
    const auto written = page->write(grant, file);
    if (!written)
      scene::logger().warn("{} was not written: {}", file.string(), written.error().message);
    if (written) report("Page: {}\n", file.string());
  }
  if (!options.save_mesh.empty()) {
    const std::string text = render::off_text(session.mesh_now(object));
    if (auto saved = output::write_file(options.save_mesh, output::kMesh, text); !saved) {
      return saved;
    }
    report("Mesh as it is now: {}\n", options.save_mesh);
  }
  return {};
}

/// Helpers that run alongside a session and are queried afterwards. Destroyed before the session.
struct RunHelpers {
  std::shared_ptr<ros2::SteppedClock> clock;          // clock of a stepped run, otherwise null
  std::vector<std::unique_ptr<ros2::RosRun>> topics;  // one per arm
  std::unique_ptr<report::RunPage> page;
};

/// Opens the topics of all arms.
driver::Result<void> open_topics(session::Session& session, const ros2::RosOptions& options,
                                 RunHelpers& helpers) {
  for (std::size_t arm = 0; arm < session.arms(); ++arm) {
    auto opened = ros2::RosRun::open(session, options, arm, helpers.clock.get());
    if (!opened) return opened.error();
    helpers.topics.push_back(std::move(opened).value());
  }
  return {};
}

/// Opens the arm of a session that is ready and runs it to its end. `guard` is set while an arm may
/// hold a force or a recording is open.
ExitCode run_session(session::Session& session, session::ServoThread& servo,
                     session::ViewerRequestHandler* desk, const RunOptions& options,
                     RunHelpers& helpers, std::optional<scene::ForceExitGuard>& guard,
                     const std::atomic<bool>& stop) {
  guard.emplace();
  const bool real = session.setup().any_real();
  const auto open = session::open_arm(session, session::user_terminal(), stop);
  if (!open) {
    const ExitCode code = report_error(open.error(), real ? kExitNoDevice : kExitBadInput);
    return stop.load() ? kExitInterrupted : code;
  }
  if (!*open) return kExitInterrupted;
  if (options.ros.asked) {
    if (auto opened = open_topics(session, options.ros.options, helpers); !opened) {
      return report_error(opened.error(), kExitBadInput);
    }
  }
  if (!options.report.empty()) helpers.page = std::make_unique<report::RunPage>(session);
  std::optional<session::HoldKey> key;
  if (session.setup().hold().by_caller) {
    scene::terminal().info(
        "Hold the space bar, in this terminal or in the viewer window, to enable forces.");
    key.emplace(session);
  }
  std::optional<session::ReplugWatches> watch;
  if (real) watch.emplace(session, key ? key->terminal() : session::user_terminal());

  servo.begin(session, stop);
  session::RunAttendance attendance(session, watch ? &*watch : nullptr, desk, true);
  while (!servo.ended()) {
    // Ten times a second; a short run must not wait for the next time.
    for (int slice = 0; slice < 20 && !servo.ended(); ++slice) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    attendance.step();
  }
  attendance.clear();
  servo.join();
  session::keep_black_boxes(session, true);
  return kExitDone;
}

/// Returns the file name for the recording of the n-th run of a command: touch.h5, touch-2.h5.
std::string numbered(const std::string& file, int number) {
  if (file.empty() || number == 1) return file;
  const std::filesystem::path path(file);
  const std::string name =
      fmt::format("{}-{}{}", path.stem().string(), number, path.extension().string());
  return (path.parent_path() / name).string();
}

/// State of one command across restarts of its run.
struct RunContext {
  RunOptions& options;
  const session::RunArms& arms;
  const std::atomic<bool>& stop;
  session::SessionOptions asked;
  std::shared_ptr<ros2::SteppedClock> clock;  // clock of a stepped run, otherwise null
  std::optional<session::NextRun> next;       // prepares the next run, if restarts are allowed
  std::unique_ptr<session::ViewerProcess> viewer;
  int number = 1;         // number of the current run
  std::string recording;  // file of the current run
};

/// Returns the object whose mesh is saved; -1 for all.
driver::Result<int> find_object(const session::Session& session, const RunOptions& options) {
  if (options.save_object.empty()) return -1;
  if (const auto object = session.find_object(options.save_object)) return *object;
  std::vector<std::string> names;
  for (const auto& object : session.scene().objects) names.push_back(object.name);
  return driver::Error{"--save-object: there is no object \"" + options.save_object +
                       "\" in the scene." + suggestion(options.save_object, names)};
}

/// As `find_object`. Fails if --save-mesh would write a file without triangles.
driver::Result<int> find_saved_object(const session::Session& session, const RunOptions& options) {
  auto object = find_object(session, options);
  if (!object || options.save_mesh.empty()) return object;
  if (!session.mesh_now(*object).triangles.empty()) return object;
  if (*object < 0) {
    return driver::Error{"--save-mesh: no object of the scene has a mesh. Remove the option."};
  }
  return driver::Error{"--save-object: the object \"" + options.save_object +
                       "\" has no mesh. Name another object."};
}

/// Prepares the next run without viewers and recording, while the current one continues.
driver::Result<std::unique_ptr<session::Session>> prepare_next(const RunContext& context,
                                                               const std::filesystem::path& scene) {
  session::SessionOptions asked = context.asked;
  asked.share_out = false;
  asked.record.clear();
  auto prepared = session::Session::prepare(scene, asked);
  if (!prepared) return prepared;
  if (auto saved = find_saved_object(**prepared, context.options); !saved) return saved.error();
  return prepared;
}

/// Starts the recording of the prepared run and takes over the shared name of the run before it.
/// The name is never without a run.
driver::Result<void> begin_next(RunContext& context, session::Session& session,
                                session::Session& before) {
  if (!context.asked.record.empty()) {
    const bool force = context.options.force;
    std::error_code unknown;
    int number = context.number;
    do {
      context.recording = numbered(context.options.record, number++);
    } while (!force && std::filesystem::exists(
                           session::file_of_arm(context.recording, session.arm_name(0)), unknown));
    if (auto begun = session.begin_recording(context.recording, force); !begun) return begun;
  }
  return session.share(context.asked, before.shared());
}

/// Prints the result of a finished run as JSON.
void print_run_json(const session::Session& session, const driver::RealTimeGrant& grant,
                    const RunContext& context, ExitCode code) {
  if (!json_asked()) return;
  nlohmann::ordered_json arms = nlohmann::ordered_json::array();
  for (std::size_t arm = 0; arm < session.arms(); ++arm) {
    const session::RunFigures figures = session.figures(grant, arm);
    const std::string recording =
        context.recording.empty()
            ? std::string()
            : session::file_of_arm(context.recording, session.arm_name(arm)).string();
    arms.push_back({{"name", session.arm_name(arm)},
                    {"recording", recording},
                    {"report", report::report_json(figures)},
                    {"figures", report::figures_json(session::figures_of(figures))}});
  }
  print_json("run", {{"scene", session.scene().name},
                     {"warnings", session.warnings()},
                     {"report_folder", context.options.report},
                     {"exit_code", static_cast<int>(code)},
                     {"arms", std::move(arms)}});
}

/// Runs a prepared session to its end. Writes and prints the requested results, unless another run
/// `then` follows.
ExitCode run_one(RunContext& context, session::Session& session,
                 std::unique_ptr<session::Session>& then) {
  const RunOptions& options = context.options;
  const bool first = context.number == 1;
  // An early exit leaves a valid recording without ticks.
  const auto leave = [&session](ExitCode code) {
    if (const auto ended = session.end_recording(); !ended)
      report_error(ended.error(), kExitTrouble);
    return code;
  };
  for (const std::string& choice : session.setup().quality_choices()) {
    report("{}: {}\n", options.quality, choice);
  }
  for (const std::string& choice :
       session.setup().objects().tracker_notes(session.setup().scene())) {
    report("tracker: {}\n", choice);
  }
  print_lines(session.warnings());
  for (const std::string& warning : stability::stability_warnings(session.scene())) {
    scene::logger().warn("{} See `thimble tune`.", warning);
  }
  const auto object = find_saved_object(session, options);
  if (!object) return leave(report_error(object.error(), kExitBadInput));
  session::NextRun* next = context.next ? &*context.next : nullptr;
  const auto desk =
      first ? session::open_viewer_requests(session, viewer_choice(options),
                                            options.ends_with_window(),
                                            viewer_arguments(options, context.asked), next)
            : std::make_unique<session::ViewerRequestHandler>(session, std::move(context.viewer),
                                                              options.ends_with_window(), next);
  if (!desk) next = nullptr;
  if (next != nullptr) next->begin(session);
  session::ServoThread servo(session.real_time());
  if (context.arms.real()) {
    if (auto granted = session::check_real_time(servo.grant(), options.no_real_time); !granted) {
      return leave(report_error(granted.error(), kExitBadInput));
    }
  }
  if (!servo.grant().advice.empty()) scene::logger().warn("{}", servo.grant().advice);
  if (context.stop.load()) return leave(kExitInterrupted);
  if (!session::agree_to_forces(session, options.yes, session::user_terminal(), context.stop)) {
    return leave(context.stop.load() ? kExitInterrupted : kExitBadInput);
  }
  std::optional<scene::ForceExitGuard> guard;
  RunHelpers helpers{.clock = context.clock, .topics = {}, .page = nullptr};
  const std::atomic<bool>& end = next != nullptr ? next->ended() : context.stop;
  const ExitCode ran = run_session(session, servo, desk.get(), options, helpers, guard, end);
  if (ran != kExitDone) return leave(ran);
  // A failure of the recording does not end the run.
  const ExitCode recorded = end_recording(session, context.recording);
  // From here Ctrl-C may kill the process: zero force is sent and the recording is closed. Not so
  // if the arm did not accept zero force.
  const scene::WritingGuard writing;
  if (zero_assured(session)) guard.reset();
  if (desk) desk->close();
  if (next != nullptr) then = next->take(servo.join(), context.stop.load());
  if (scene::verbosity() != scene::Verbosity::kQuiet) print_summaries(session, servo.grant());
  for (const auto& arm : helpers.topics) report("{}", arm->report());
  if (then) {
    std::fflush(stdout);
    context.viewer = desk->take_viewer();
    return recorded;
  }
  const auto written = write_files(session, servo.grant(), options, helpers.page.get(), *object);
  if (!written) {
    return report_error(written.error(), kExitTrouble);
  }
  const ExitCode ended = end_of(session, desk && desk->ended());
  print_run_json(session, servo.grant(), context, ended != kExitDone ? ended : recorded);
  if (ended != kExitDone) return ended;
  if (next != nullptr && next->failed()) return kExitBadInput;
  if (const auto read = session.setup().objects().check_pages(session.scene()); !read) {
    return report_error(read.error(), kExitBadInput);
  }
  return recorded;
}

/// Adds all files that a run reads and writes.
void plan_outputs(const RunOptions& options, output::OutputPlan& plan) {
  for (const std::filesystem::path& file : scene::scene_inputs(options.scene)) plan.read(file);
  plan.read(options.arm_file);
  plan.read(options.firmware);
  plan.check("--record", options.record, session::kRecordingOutput, options.force);
  plan.write("--save-mesh", options.save_mesh, output::kMesh);
  plan.write_folder("--report", options.report, report::run_file_names());
}

/// Checks the folders of a report that has one folder per arm.
driver::Result<void> begin_arm_folders(const session::Session& session, const RunOptions& options,
                                       output::OutputPlan& plan) {
  if (session.arms() == 1 || options.report.empty()) return {};
  for (std::size_t arm = 0; arm < session.arms(); ++arm) {
    plan.write_folder("--report", std::filesystem::path(options.report) / session.arm_name(arm),
                      report::run_file_names());
  }
  return plan.begin();
}

int run_scene(RunOptions& options) {
  if (const auto fits = check_run_options(options); !fits)
    return report_error(fits.error(), kExitBadInput);
  if (const auto readable = check_arm_file(options.arm_file); !readable) {
    return report_error(readable.error(), kExitBadInput);
  }
  const auto arms = session::choose_run_arms(
      options.devices,
      {.arm_file = options.arm_file, .firmware = options.firmware, .unchecked = options.unchecked});
  if (!arms) return report_error(arms.error(), kExitNoDevice);
  if (const auto fits = check_restart_options(options, *arms); !fits) {
    return report_error(fits.error(), kExitBadInput);
  }
  print_lines(arms->warnings);

  // All slow work comes before the arm is opened: an open arm is served every millisecond.
  const std::atomic<bool>& stop = scene::catch_interrupts();
  if (arms->real()) scene::treat_sigtstp_as_exit();
  output::OutputPlan outputs;
  plan_outputs(options, outputs);
  if (const auto begun = outputs.begin(); !begun) return report_error(begun.error(), kExitBadInput);
  RunContext context{options, *arms, stop,          session_options(options, *arms), {}, {},
                     {},      1,     options.record};
  if (options.stepped()) {
    context.asked.own_clock = context.clock = std::make_shared<ros2::SteppedClock>(stop);
  }
  if (context.asked.restarts) {
    context.next.emplace([&context](const auto& scene) { return prepare_next(context, scene); },
                         options.reloads(), options.loop, options.speed.value_or(1));
  }
  auto prepared = session::Session::prepare(options.scene, context.asked);
  if (!prepared) return report_error(prepared.error(), kExitBadInput);
  std::unique_ptr<session::Session> session = std::move(prepared).value();
  if (const auto begun = begin_arm_folders(*session, options, outputs); !begun) {
    return report_error(begun.error(), kExitBadInput);
  }
  for (;;) {
    std::unique_ptr<session::Session> then;
    const ExitCode code = run_one(context, *session, then);
    if (!then) return code;
    ++context.number;
    if (auto begun = begin_next(context, *then, *session); !begun) {
      return report_error(begun.error(), kExitTrouble);
    }
    session = std::move(then);
  }
}

std::string first_sentence(const std::string& text) {
  const std::size_t end = text.find(". ");
  return end == std::string::npos ? text : text.substr(0, end + 1);
}

/// Prints the shipped scenes and arms, and ends the program.
void list_shipped() {
  nlohmann::ordered_json listed;
  const auto print = [&listed](const char* title, const char* key,
                               const std::vector<scene::ShippedFile>& files) {
    listed[key] = nlohmann::ordered_json::array();
    session::print(scene::text_stream(), "{}:\n", title);
    for (const scene::ShippedFile& file : files) {
      const std::string description = first_sentence(scene::description_of(file.path));
      session::print(scene::text_stream(), "  {:<18} {}\n  {:<18}   {}\n", file.name,
                     file.path.string(), "", description);
      listed[key].push_back(
          {{"name", file.name}, {"path", file.path.string()}, {"description", description}});
    }
    if (files.empty())
      session::print(scene::text_stream(), "  none found; use the path of a file\n");
  };
  print("Scenes", "scenes", scene::shipped_scenes());
  print("Arms", "arms", scene::shipped_arms());
  print_json("list", listed);
  throw CLI::Success();
}

}  // namespace

void add_run_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("run", "Run a scene with a simulated or a real arm");
  auto options = std::make_shared<RunOptions>();
  add_run_options(*command, *options);
  // After --json, whose callback decides how the list is printed.
  command->add_flag_callback("--list", list_shipped,
                             "List the scenes and arms that have a name, then exit");
  command->callback([options, &exit_code] { exit_code = run_scene(*options); });
}

}  // namespace thimble::cli

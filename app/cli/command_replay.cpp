#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "bag/read_bag.h"
#include "cli/commands.h"
#include "cli/file_options.h"
#include "cli/report_error.h"
#include "cli/usage/help_text.h"
#include "log/printed_text.h"
#include "output/output_plan.h"
#include "print.h"
#include "recording/recording_layout.h"
#include "recording/replay_bag.h"
#include "recording/replay_trajectory.h"
#include "recording/trajectory_file.h"
#include "report/html/touch_page.h"
#include "system/regular_file.h"
#include "text/counted.h"
#include "thimble/session/recording.h"

namespace thimble::cli {
namespace {

struct ReplayOptions {
  std::vector<std::string> files;
  std::string scene;
  std::string record;
  bool force = false;
  std::string page;
  bool verify = false;
  session::TrajectoryForm form;
  std::string length = "m", time = "s";
  std::string frame;
  session::BagTopics bag;
  std::string axes = "plain";
  std::string csv;
};

/// Distinguishes a recording from a text by the first byte of an HDF5 file [HDF5 file format,
/// superblock].
bool is_recording(const std::string& file) {
  const std::string first = driver::read_head(file, 1);
  return first.empty() || first.front() == '\x89';
}

void print_comparison(const std::string& file, const session::TrajectoryComparison& compared,
                      const std::string& name, bool forces) {
  scene::print_format("%s: %s of %s along the trajectory, %zu in contact; force %.4g N (RMS)",
                      file.c_str(), scene::counted(compared.ticks, "tick").c_str(), name.c_str(),
                      compared.touching, compared.force_rms);
  if (!forces) {
    scene::print_format(".\n");
    return;
  }
  scene::print_format(", recorded %.4g N.\n", compared.recorded_rms);
  scene::print_format("Force error %.4g N (RMS)", compared.error_rms);
  if (compared.recorded_rms > 0) {
    scene::print_format(", %.3g %% of the recorded force",
                        100 * compared.error_rms / compared.recorded_rms);
  }
  scene::print_format(
      "; direction error below %.3g degrees in 99 %% of %s; contact differs in %zu.\n",
      compared.direction_p99 * 180 / std::numbers::pi,
      scene::counted(compared.directions, "tick").c_str(), compared.contact_disagrees);
}

/// Touches a scene along the probe positions of a trajectory file.
int replay_probe(const ReplayOptions& options) {
  if (!options.page.empty()) {
    return report_error(
        {"--page requires a recording. Convert the trajectory first with --record FILE."},
        kExitBadInput);
  }
  if (options.scene.empty()) {
    return report_error(
        {options.files.front() + " is not a recording. A trajectory requires --scene; add it."},
        kExitBadInput);
  }
  session::TrajectoryForm form = options.form;
  form.metres = options.length == "mm" ? 1e-3 : 1;
  form.seconds = options.time == "ms" ? 1e-3 : 1;
  const auto replay =
      session::replay_trajectory_file(options.files.front(), form, options.frame, options.scene);
  if (!replay) return report_error(replay.error(), kExitBadInput);
  print_comparison(options.files.front(), replay->compared, replay->felt.info.scene,
                   form.has_forces());
  if (options.record.empty()) return kExitDone;
  if (auto written = session::write_recording(options.record, replay->felt.info, replay->felt.ticks,
                                              options.force);
      !written) {
    return report_error(written.error(), kExitTrouble);
  }
  return kExitDone;
}

/// Touches a scene along the positions of a ROS bag.
int replay_a_bag(const ReplayOptions& options) {
  const std::string& file = options.files.front();
  if (options.scene.empty())
    return report_error({file + " is a bag, which requires --scene. Add it."}, kExitBadInput);
  if (!options.page.empty()) {
    return report_error({"--page requires a recording. Convert the bag first with --record FILE."},
                        kExitBadInput);
  }
  session::BagTopics topics = options.bag;
  topics.axes = options.axes == "omni" ? bag::BagAxes::kOmni : bag::BagAxes::kPlain;
  const auto replayed = session::replay_bag(file, topics, options.scene);
  if (!replayed) return report_error(replayed.error(), kExitBadInput);
  const session::TrajectoryReplay& replay = replayed->replay;
  print_comparison(file, replay.compared, replay.felt.info.scene, replayed->has_forces);
  if (replayed->has_forces)
    scene::print_format("Largest force error %.3g N.\n", replayed->error_max);
  if (!options.csv.empty()) {
    if (auto written = session::write_csv(replay.felt, options.csv); !written) {
      return report_error(written.error(), kExitTrouble);
    }
  }
  if (options.record.empty()) return kExitDone;
  auto written =
      session::write_recording(options.record, replay.felt.info, replay.felt.ticks, options.force);
  return written ? kExitDone : report_error(written.error(), kExitTrouble);
}

/// Prints how the forces of one hand compare with the recorded ones.
void print_replay(const std::string& file, const session::Replay& replay) {
  const session::ReplayComparison& compared = replay.compared;
  session::print(scene::text_stream(), "{}: {} of {} with the recorded motion; ", file,
                 scene::counted(compared.ticks, "tick"), replay.felt.info.scene);
  if (compared.differing == 0) {
    session::print(scene::text_stream(), "all forces are bit-identical to the recorded ones.\n");
  } else {
    session::print(
        scene::text_stream(),
        "{} forces differ from the recorded ones, first in tick {}, by at most {:.3g} N.\n",
        compared.differing, *compared.first, compared.largest);
  }
}

/// Prints why forces differ from the recorded ones. Returns false if no reason is known: then the
/// run should have been repeatable but was not.
bool print_reason(const session::Recording& recording, const std::string& scene) {
  const auto repeatable = session::check_repeatable(recording, scene);
  if (!repeatable) {
    session::print(scene::text_stream(), "Reason: {}\n", repeatable.error().message);
    return true;
  }
  if (const auto unhashed = session::unhashed_files(recording, scene); !unhashed.empty()) {
    session::print(scene::text_stream(), "Reason: {}\n", unhashed);
    return true;
  }
  session::print(scene::text_stream(),
                 "Scene, options, arm, other files and program are those of the recording, so all "
                 "forces should be "
                 "identical. Please report this error with the recording.\n");
  return false;
}

int replay_recordings(const ReplayOptions& options) {
  output::OutputPlan plan;
  for (const std::string& file : options.files) plan.read(file);
  plan.read(options.scene);
  const bool one = options.files.size() == 1;
  const bool from_bag = one && bag::is_bag(options.files.front());
  const bool from_text = one && !from_bag && !is_recording(options.files.front());
  if (from_bag || from_text) {
    plan.write("--record", options.record, session::kRecordingOutput, options.force);
  }
  plan.write("--page", options.page, output::kWebPage);
  plan.write("--csv", options.csv, output::kTable);
  if (auto begun = plan.begin(); !begun) return report_error(begun.error(), kExitBadInput);
  if (from_bag) return replay_a_bag(options);
  if (!options.csv.empty()) {
    return report_error(
        {"--csv requires a bag. For other files use --record FILE, then `thimble export`."},
        kExitBadInput);
  }
  if (from_text) return replay_probe(options);
  std::vector<session::Recording> recordings;
  for (const std::string& file : options.files) {
    auto recording = session::read_recording(file);
    if (!recording) return report_error(recording.error(), kExitBadInput);
    if (options.verify) {
      if (auto same = session::check_repeatable(*recording, options.scene); !same) {
        return report_error({"--verify: " + same.error().message}, kExitBadInput);
      }
    }
    recordings.push_back(std::move(recording).value());
  }
  for (const session::Recording& recording : recordings) {
    if (options.record.empty()) break;
    plan.write("--record", session::file_of_arm(options.record, recording.info.arm_in_scene),
               session::kRecordingOutput, options.force);
  }
  if (auto begun = plan.begin(); !begun) return report_error(begun.error(), kExitBadInput);
  report::ReplayPage page;
  auto replays =
      session::replay_together(recordings, options.scene, options.page.empty() ? nullptr : &page);
  if (!replays) return report_error(replays.error(), kExitBadInput);
  bool differs = false, unexplained = false;
  for (std::size_t i = 0; i < replays->size(); ++i) {
    session::Replay& replay = (*replays)[i];
    print_replay(options.files[i], replay);
    if (replay.compared.differing > 0 && !print_reason(recordings[i], options.scene)) {
      unexplained = true;
    }
    differs = differs || replay.compared.differing > 0;
    if (options.record.empty()) continue;
    replay.felt.info.device = "replay of " + options.files[i];
    const std::filesystem::path file =
        session::file_of_arm(options.record, replay.felt.info.arm_in_scene);
    if (auto written =
            session::write_recording(file, replay.felt.info, replay.felt.ticks, options.force);
        !written) {
      return report_error(written.error(), kExitTrouble);
    }
  }
  if (!options.page.empty()) {
    if (auto written = page.write(*replays, options.page); !written) {
      return report_error({options.page + " was not written: " + written.error().message},
                          kExitTrouble);
    }
    session::print(scene::text_stream(), "Page: {}\n", options.page);
  }
  return unexplained || (options.verify && differs) ? kExitTrouble : kExitDone;
}

}  // namespace

void add_replay_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("replay", "Repeat a recorded motion in a scene and compare the forces");
  auto options = std::make_shared<ReplayOptions>();
  command->add_option("FILE", options->files, "Recordings, a trajectory (text), or a ROS 2 bag")
      ->required();
  add_scene_option(*command, options->scene, "--scene", "Scene to use instead of the recorded one");
  command->add_flag("--verify", options->verify, "Fail unless all forces are bit-identical");
  constexpr const char* kOutput = "Output";
  CLI::Option* record = command->add_option("--record", options->record, "Record the replay (HDF5)")
                            ->option_text("FILE")
                            ->group(kOutput);
  command->add_flag("--force", options->force, "Let --record replace an existing recording")
      ->needs(record)
      ->group(kOutput);
  command->add_option("--page", options->page, "Write an HTML page that plays the result")
      ->option_text("FILE")
      ->group(kOutput);
  constexpr const char* kTrajectory = "Trajectories";
  command
      ->add_option("--columns", options->form.columns, "Columns of the file in order; - skips one")
      ->option_text("LIST")
      ->capture_default_str()
      ->group(kTrajectory);
  command->add_option("--length", options->length, "Unit of positions in the world frame")
      ->check(CLI::IsMember({"m", "mm"}))
      ->capture_default_str()
      ->group(kTrajectory);
  command->add_option("--time", options->time, "Unit of time")
      ->check(CLI::IsMember({"s", "ms"}))
      ->capture_default_str()
      ->group(kTrajectory);
  command->add_option("--frame", options->frame, "Frame of the positions: world, or an object")
      ->option_text("NAME")
      ->group(kTrajectory);
  constexpr const char* kBags = "Bags";
  command->add_option("--topic", options->bag.pose, "Topic of the positions (PoseStamped)")
      ->option_text("NAME")
      ->group(kBags);
  command->add_option("--wrench-topic", options->bag.wrench, "Topic of the forces (WrenchStamped)")
      ->option_text("NAME")
      ->group(kBags);
  command
      ->add_option("--axes", options->axes, "Axes of positions: the world's, or the Omni drivers'")
      ->check(CLI::IsMember({"plain", "omni"}))
      ->capture_default_str()
      ->group(kBags);
  command->add_option("--csv", options->csv, "Write the result as a table (CSV)")
      ->option_text("FILE")
      ->group(kBags);
  add_example(*command, "thimble replay touch.h5 --verify",
              "FILE      Recordings are from `thimble run SCENE --record FILE`, one per arm. A\n"
              "          trajectory has one line per probe position, with the force. A bag\n"
              "          (SQLite) is a folder or a .db3 file.\n"
              "--scene   Required for a trajectory or a bag.\n"
              "--verify  Also fails if the scene or the program differs from the recording's.\n"
              "--frame   For an object, positions are in the frame and unit of its mesh file.\n"
              "--topic, --wrench-topic  Default: the only topic of that type; if there are\n"
              "          several, /pose and /wrench.");
  command->callback([options, &exit_code] { exit_code = replay_recordings(*options); });
}

}  // namespace thimble::cli

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <memory>
#include <numbers>
#include <string>

#include "cli/commands.h"
#include "cli/complain.h"
#include "cli/file_options.h"
#include "print.h"
#include "recording/replay_trajectory.h"
#include "recording/trajectory_file.h"
#include "thimble/session/recording.h"

namespace thimble::app {
namespace {

struct ReplayOptions {
  std::string file;
  std::string scene;
  std::string record;
  bool verify = false;
  session::TrajectoryForm form;
  std::string length = "m", time = "s";
  std::string frame;
};

/// Tells a recording from a text: by the first byte of an HDF5 file [HDF5 file format, superblock].
bool is_recording(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  return !stream || stream.get() == 0x89;
}

void print_comparison(const std::string& file, const session::TrajectoryComparison& compared,
                      const std::string& scene, bool forces) {
  std::printf("%s: %zu ticks of %s along the trajectory, %zu of them touching; force %.4g N (rms)",
              file.c_str(), compared.ticks, scene.c_str(), compared.touching, compared.force_rms);
  if (!forces) {
    std::printf(".\n");
    return;
  }
  std::printf(", recorded %.4g N.\n", compared.recorded_rms);
  std::printf("Force error %.4g N (rms)", compared.error_rms);
  if (compared.recorded_rms > 0) {
    std::printf(", %.3g %% of the recorded", 100 * compared.error_rms / compared.recorded_rms);
  }
  std::printf(
      "; direction within %.3g degrees in 99 of 100 of %zu ticks; contact differs in %zu.\n",
      compared.direction_p99 * 180 / std::numbers::pi, compared.directions,
      compared.contact_disagrees);
}

/// Lets the probe of a trajectory file touch a scene.
int replay_probe(const ReplayOptions& options) {
  if (options.scene.empty()) {
    return complain({options.file + " is no recording; as a trajectory it needs --scene."},
                    kExitBadInput);
  }
  session::TrajectoryForm form = options.form;
  form.metres = options.length == "mm" ? 1e-3 : 1;
  form.seconds = options.time == "ms" ? 1e-3 : 1;
  const auto replay =
      session::replay_trajectory_file(options.file, form, options.frame, options.scene);
  if (!replay) return complain(replay.error(), kExitBadInput);
  print_comparison(options.file, replay->compared, replay->felt.info.scene, form.has_forces());
  if (options.record.empty()) return kExitDone;
  if (auto written =
          session::write_recording(options.record, replay->felt.info, replay->felt.ticks);
      !written) {
    return complain(written.error(), kExitTrouble);
  }
  return kExitDone;
}

int replay_recording(const ReplayOptions& options) {
  if (!is_recording(options.file)) return replay_probe(options);
  const auto recording = session::read_recording(options.file);
  if (!recording) return complain(recording.error(), kExitBadInput);
  if (options.verify) {
    if (auto same = session::check_repeatable(*recording, options.scene); !same) {
      return complain({"--verify: " + same.error().message}, kExitBadInput);
    }
  }
  auto replay = session::replay(*recording, options.scene);
  if (!replay) return complain(replay.error(), kExitBadInput);
  const session::ReplayComparison& compared = replay->compared;
  session::print(stdout, "{}: {} ticks of {} by the recorded hand; ", options.file, compared.ticks,
                 replay->felt.info.scene);
  if (compared.differing == 0) {
    session::print(stdout, "every force is the recorded one to the bit.\n");
  } else {
    session::print(
        stdout, "{} forces differ from the recorded ones, first in tick {}, by {:.3g} N at most.\n",
        compared.differing, *compared.first, compared.largest);
  }
  if (!options.record.empty()) {
    replay->felt.info.device = "replay of " + options.file;
    if (auto written =
            session::write_recording(options.record, replay->felt.info, replay->felt.ticks);
        !written) {
      return complain(written.error(), kExitTrouble);
    }
  }
  return options.verify && compared.differing > 0 ? kExitTrouble : kExitDone;
}

}  // namespace

void add_replay_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "replay", "Let a recorded hand touch a scene again, and compare the forces");
  auto options = std::make_shared<ReplayOptions>();
  command
      ->add_option("FILE", options->file,
                   "Recording, made by `thimble run SCENE --record FILE`, or a trajectory as text: "
                   "where a probe was in each line, and what it felt")
      ->required();
  command
      ->add_option(
          "--columns", options->form.columns,
          "Columns of a trajectory: t x y z fx fy fz, in its order; - for one to leave out")
      ->capture_default_str();
  command->add_option("--length", options->length, "Unit of length of a trajectory in the world")
      ->check(CLI::IsMember({"m", "mm"}))
      ->capture_default_str();
  command->add_option("--time", options->time, "Unit of time of a trajectory")
      ->check(CLI::IsMember({"s", "ms"}))
      ->capture_default_str();
  command->add_option("--frame", options->frame,
                      "Where a trajectory is told in: world, or the object whose mesh file has its "
                      "frame and unit");
  add_scene_option(*command, options->scene, "--scene",
                   "Scene to touch in place of the recorded one: what would this hand have felt?");
  command->add_option("--record", options->record, "Recording of what is felt now to write");
  command->add_flag("--verify", options->verify,
                    "Fail unless scene and build are those of the recording and every force is the "
                    "same to the bit");
  command->callback([options, &exit_code] { exit_code = replay_recording(*options); });
}

}  // namespace thimble::app

#include <cinttypes>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "build_info.h"
#include "commands.h"
#include "complain.h"
#include "meshes.h"
#include "recording/read_recording.h"
#include "recording/recording_file.h"
#include "recording/replay.h"
#include "scene_file.h"
#include "scene_objects.h"
#include "text_file.h"

namespace thimble::app {
namespace {

struct ReplayOptions {
  std::string file;
  std::string scene;
  std::string record;
  bool verify = false;
};

/// Says what keeps a replay from being the same run again; nothing if it must be the same.
driver::Result<void> comparable(const Recording& recording, const std::string& scene_file) {
  if (first_gap(recording.ticks)) {
    return driver::Error{
        "--verify: ticks are missing in the recording, because the disk was slow."};
  }
  if (!recording.ticks.empty() && recording.ticks.front().tick != 0) {
    return driver::Error{"--verify: the recording does not begin with the run's first tick."};
  }
  if (text_of(scene_file) != recording.info.scene_text) {
    return driver::Error{"--verify: " + scene_file +
                         " is not the scene that was recorded; it has been changed since."};
  }
  if (program_name() != recording.info.program) {
    return driver::Error{"--verify: recorded by " + recording.info.program + ", this is " +
                         program_name() + "; only the same build promises the same bits."};
  }
  return {};
}

int replay_recording(const ReplayOptions& options) {
  const auto recording = read_recording(options.file);
  if (!recording) return complain(recording.error(), kExitBadInput);
  const std::string scene_file = options.scene.empty() ? recording->info.scene_file : options.scene;
  if (options.verify) {
    if (auto same = comparable(*recording, scene_file); !same) {
      return complain(same.error(), kExitBadInput);
    }
  }
  const auto scene = read_scene(scene_file, mesh_folder(), recording->info.arm_file);
  if (!scene) return complain(scene.error(), kExitBadInput);
  auto objects = SceneObjects::build(*scene);
  if (!objects) return complain(objects.error(), kExitBadInput);

  std::vector<driver::TickRecord> felt;
  felt.reserve(recording->ticks.size());
  const ReplayComparison compared = replay(
      recording->ticks, **objects, [&](const driver::TickRecord& tick) { felt.push_back(tick); });
  std::printf("%s: %" PRIu64 " ticks of %s by the recorded hand; ", options.file.c_str(),
              compared.ticks, scene->name.c_str());
  if (compared.differing == 0) {
    std::printf("every force is the recorded one to the bit.\n");
  } else {
    std::printf("%" PRIu64 " forces differ from the recorded ones, first in tick %" PRIu64
                ", by %.3g N at most.\n",
                compared.differing, *compared.first, compared.largest);
  }
  if (!options.record.empty()) {
    RecordingInfo info = recording->info;
    info.scene = scene->name;
    info.scene_file = scene_file;
    info.scene_text = text_of(scene_file);
    info.program = program_name();
    info.device = "replay of " + options.file;
    info.clock = "virtual";
    if (auto written = write_recording(options.record, info, felt); !written) {
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
  command->add_option("FILE", options->file, "Recording, made by `thimble run SCENE --record FILE`")
      ->required();
  command->add_option(
      "--scene", options->scene,
      "Scene to touch in place of the recorded one: what would this hand have felt?");
  command->add_option("--record", options->record, "Recording of what is felt now to write");
  command->add_flag("--verify", options->verify,
                    "Fail unless scene and build are those of the recording and every force is the "
                    "same to the bit");
  command->callback([options, &exit_code] { exit_code = replay_recording(*options); });
}

}  // namespace thimble::app

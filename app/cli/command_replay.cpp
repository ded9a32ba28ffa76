#include <cinttypes>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "build_info.h"
#include "cli/commands.h"
#include "cli/complain.h"
#include "cli/file_options.h"
#include "object_mesh.h"
#include "recording/read_recording.h"
#include "recording/recording_file.h"
#include "recording/replay.h"
#include "recording/replay_trajectory.h"
#include "recording/trajectory_file.h"
#include "text_file.h"
#include "thimble/scene/meshes.h"
#include "thimble/scene/scene_file.h"
#include "thimble/scene/scene_objects.h"

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

/// Says what keeps a replay from being the same run again; nothing if it must be the same.
driver::Result<void> comparable(const session::Recording& recording,
                                const std::string& scene_file) {
  if (session::first_gap(recording.ticks)) {
    return driver::Error{
        "--verify: ticks are missing in the recording, because the disk was slow."};
  }
  if (!recording.ticks.empty() && recording.ticks.front().tick != 0) {
    return driver::Error{"--verify: the recording does not begin with the run's first tick."};
  }
  if (scene::text_of(scene_file) != recording.info.scene_text) {
    return driver::Error{"--verify: " + scene_file +
                         " is not the scene that was recorded; it has been changed since."};
  }
  if (scene::program_name() != recording.info.program) {
    return driver::Error{"--verify: recorded by " + recording.info.program + ", this is " +
                         scene::program_name() + "; only the same build promises the same bits."};
  }
  return {};
}

/// Tells a recording from a text: by the first byte of an HDF5 file [HDF5 file format, superblock].
bool is_recording(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  return !stream || stream.get() == 0x89;
}

/// Takes a trajectory from the frame of an object's mesh file into the world; one that is in the
/// world already if no object is named.
driver::Result<void> into_world(std::vector<session::TrajectoryPoint>& trajectory,
                                const scene::Scene& scene, const std::string& frame) {
  if (frame.empty() || frame == "world") return {};
  for (const scene::SceneObject& object : scene.objects) {
    if (object.name != frame) continue;
    if (object.mesh_file.empty() || object.paged) {
      return driver::Error{"--frame: \"" + frame + "\" has no mesh file in memory; give the " +
                           "trajectory in the world, in m."};
    }
    const auto mesh = scene::load_object_mesh(object);
    if (!mesh) return mesh.error();
    const scene::MeshPlacement& place = mesh->place;
    for (session::TrajectoryPoint& point : trajectory) {
      point.p = place.p_WM + place.scale * (object.R_WO * point.p);
      point.f = object.R_WO * point.f;
    }
    return {};
  }
  return driver::Error{"--frame: expected world or an object of the scene, found \"" + frame +
                       "\"."};
}

void print_comparison(const std::string& file, const session::TrajectoryComparison& compared,
                      const scene::Scene& scene, bool forces) {
  std::printf("%s: %zu ticks of %s along the trajectory, %zu of them touching; force %.4g N (rms)",
              file.c_str(), compared.ticks, scene.name.c_str(), compared.touching,
              compared.force_rms);
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
  // In the frame of a mesh file its unit is that of the file.
  if (!options.frame.empty() && options.frame != "world") {
    form.metres = 1;
    form.farthest = 1e9;
  }
  auto trajectory = session::read_trajectory(options.file, form);
  if (!trajectory) return complain(trajectory.error(), kExitBadInput);
  const auto scene = scene::read_scene(options.scene, scene::mesh_folder(), {});
  if (!scene) return complain(scene.error(), kExitBadInput);
  if (auto placed = into_world(*trajectory, *scene, options.frame); !placed) {
    return complain(placed.error(), kExitBadInput);
  }
  constexpr double kLongest = 86400;  // s
  if (!(trajectory->back().time - trajectory->front().time < kLongest)) {
    return complain({options.file + " lasts for more than a day; --time says the unit."},
                    kExitBadInput);
  }
  auto objects = scene::SceneObjects::build(*scene);
  if (!objects) return complain(objects.error(), kExitBadInput);
  std::vector<driver::TickRecord> felt;
  const session::TrajectoryComparison compared = session::replay_trajectory(
      *trajectory, scene->rate, **objects, [&](const driver::TickRecord& tick) {
        if (!options.record.empty()) felt.push_back(tick);
      });
  print_comparison(options.file, compared, *scene, form.has_forces());
  if (options.record.empty()) return kExitDone;
  const session::RecordingInfo info{.scene = scene->name,
                                    .scene_file = options.scene,
                                    .scene_text = scene::text_of(options.scene),
                                    .arm = scene->arm.name,
                                    .arm_file = scene->arm_file.string(),
                                    .arm_text = scene::text_of(scene->arm_file),
                                    .device = "trajectory " + options.file,
                                    .clock = "virtual",
                                    .program = scene::program_name(),
                                    .rate = scene->rate,
                                    .seed = scene->seed};
  if (auto written = session::write_recording(options.record, info, felt); !written) {
    return complain(written.error(), kExitTrouble);
  }
  return kExitDone;
}

int replay_recording(const ReplayOptions& options) {
  if (!is_recording(options.file)) return replay_probe(options);
  const auto recording = session::read_recording(options.file);
  if (!recording) return complain(recording.error(), kExitBadInput);
  const std::string scene_file = options.scene.empty() ? recording->info.scene_file : options.scene;
  if (options.verify) {
    if (auto same = comparable(*recording, scene_file); !same) {
      return complain(same.error(), kExitBadInput);
    }
  }
  const auto scene = scene::read_scene(scene_file, scene::mesh_folder(), recording->info.arm_file);
  if (!scene) return complain(scene.error(), kExitBadInput);
  auto objects = scene::SceneObjects::build(*scene);
  if (!objects) return complain(objects.error(), kExitBadInput);

  std::vector<driver::TickRecord> felt;
  felt.reserve(recording->ticks.size());
  const session::ReplayComparison compared = session::replay(
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
    session::RecordingInfo info = recording->info;
    info.scene = scene->name;
    info.scene_file = scene_file;
    info.scene_text = scene::text_of(scene_file);
    info.program = scene::program_name();
    info.device = "replay of " + options.file;
    info.clock = "virtual";
    if (auto written = session::write_recording(options.record, info, felt); !written) {
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

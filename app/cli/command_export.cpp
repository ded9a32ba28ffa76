#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>

#include "cli/commands.h"
#include "cli/options/json_option.h"
#include "cli/report_error.h"
#include "cli/usage/help_text.h"
#include "log/printed_text.h"
#include "output/output_plan.h"
#include "recording/bag_export.h"
#include "text/counted.h"
#include "thimble/session/recording.h"
#include "view/feedback/touch_sound.h"
#include "view/feedback/wav_file.h"

namespace thimble::cli {
namespace {

struct ExportOptions {
  std::string file;
  std::string csv;
  std::string bag;
  std::string sound;
  bool info = false;
};

/// Prints what a recording contains.
void print_info(const session::Recording& recording) {
  const session::RecordingInfo& info = recording.info;
  const double duration = recording.ticks.empty()
                              ? 0
                              : 1e-9 * static_cast<double>(recording.ticks.back().time_ns -
                                                           recording.ticks.front().time_ns);
  nlohmann::ordered_json json{{"scene", info.scene},
                              {"scene_file", info.scene_file},
                              {"arm", info.arm},
                              {"arm_file", info.arm_file},
                              {"arm_in_scene", info.arm_in_scene},
                              {"device", info.device},
                              {"clock", info.clock},
                              {"program", info.program},
                              {"rate_Hz", info.rate},
                              {"seed", info.seed},
                              {"options", info.options},
                              {"ticks", recording.ticks.size()},
                              {"duration_s", duration},
                              {"complete", recording.complete}};
  std::size_t width = 0;
  for (const auto& [name, value] : json.items()) width = std::max(width, name.size());
  for (const auto& [name, value] : json.items()) {
    const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
    scene::print_format("%-*s  %s\n", static_cast<int>(width), name.c_str(),
                        text.empty() ? "-" : text.c_str());
  }
  print_json("recording", json);
}

int export_recording(const ExportOptions& options) {
  output::OutputPlan plan;
  plan.read(options.file);
  plan.write("--csv", options.csv, output::kTable);
  plan.write_new_folder("--bag", options.bag);
  plan.write("--sound", options.sound, output::kSound);
  if (auto begun = plan.begin(); !begun) return report_error(begun.error(), kExitBadInput);
  const auto recording = session::read_recording(options.file);
  if (!recording) return report_error(recording.error(), kExitBadInput);
  const auto report_file = [&recording](const std::string& file) {
    scene::print_format("%s: %s of %s at %g Hz%s.\n", file.c_str(),
                        scene::counted(recording->ticks.size(), "tick").c_str(),
                        recording->info.scene.c_str(), recording->info.rate,
                        recording->complete ? "" : "; the recording was cut off");
  };
  if (options.info) print_info(*recording);
  if (!options.csv.empty()) {
    if (auto written = session::write_csv(*recording, options.csv); !written) {
      return report_error(written.error(), kExitTrouble);
    }
    report_file(options.csv);
  }
  if (!options.bag.empty()) {
    if (auto written = session::export_bag(*recording, options.bag); !written) {
      return report_error(written.error(), kExitTrouble);
    }
    report_file(options.bag);
  }
  if (!options.sound.empty()) {
    const auto samples = view::sound_of(recording->ticks, std::llround(1e9 / recording->info.rate));
    if (auto written = view::write_wav(samples, view::TouchSound::kRate, options.sound); !written) {
      return report_error(written.error(), kExitTrouble);
    }
    report_file(options.sound);
  }
  return kExitDone;
}

}  // namespace

void add_export_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("export", "Write a recording as a table, a ROS bag or a sound file");
  auto options = std::make_shared<ExportOptions>();
  command->add_option("FILE", options->file, "Recording, from `thimble run SCENE --record FILE`")
      ->required();
  CLI::Option_group* as = command->add_option_group("Output");
  as->add_option("--csv", options->csv, "Table with one line per tick, in SI units")
      ->option_text("FILE");
  as->add_option("--bag", options->bag, "Folder for a ROS 2 bag (SQLite)")->option_text("DIR");
  as->add_option("--sound", options->sound, "WAV file with the sound of the contact")
      ->option_text("FILE");
  as->add_flag("--info", options->info, "Print scene, arm, rate, seed and duration");
  as->require_option(1, 4);
  add_json_option(*command)->needs("--info");
  add_example(*command, "thimble export touch.h5 --csv touch.csv",
              "The topics of the bag are /pose, /wrench (force after the safety gate) and\n"
              "/wrench_wanted (force before it).\n"
              "--sound writes the sound that `thimble view --sound` plays.");
  command->callback([options, &exit_code] { exit_code = export_recording(*options); });
}

}  // namespace thimble::cli

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "cli/commands.h"
#include "cli/complain.h"
#include "thimble/session/recording.h"

namespace thimble::app {
namespace {

struct ExportOptions {
  std::string file;
  std::string csv;
};

int export_recording(const ExportOptions& options) {
  const auto recording = session::read_recording(options.file);
  if (!recording) return complain(recording.error(), kExitBadInput);
  if (auto written = session::write_csv(*recording, options.csv); !written) {
    return complain(written.error(), kExitTrouble);
  }
  std::printf("%s: %zu ticks of %s at %g Hz%s.\n", options.csv.c_str(), recording->ticks.size(),
              recording->info.scene.c_str(), recording->info.rate,
              recording->complete ? "" : "; the recording was cut off");
  return kExitDone;
}

}  // namespace

void add_export_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("export", "Write a recording as a table that any program reads");
  auto options = std::make_shared<ExportOptions>();
  command->add_option("FILE", options->file, "Recording, made by `thimble run SCENE --record FILE`")
      ->required();
  command->add_option("--csv", options->csv, "Table to write: a line per tick, SI units")
      ->required();
  command->callback([options, &exit_code] { exit_code = export_recording(*options); });
}

}  // namespace thimble::app

// In place of the commands that app/demo.sh does without.
#include "cli/commands.h"

namespace thimble::cli {

void add_calibrate_command(CLI::App& app, int& exit_code) {
  add_absent_command(app, exit_code, "calibrate",
                     "Find an arm's home pose and the signs of its encoders");
}

void add_doctor_command(CLI::App& app, int& exit_code) {
  add_absent_command(app, exit_code, "doctor", "Say why an arm cannot be used, and what fixes it");
}

void add_export_command(CLI::App& app, int& exit_code) {
  add_absent_command(app, exit_code, "export", "Write a recording as a table");
}

void add_mesh_command(CLI::App& app, int& exit_code) {
  add_absent_command(app, exit_code, "mesh", "Tell what a mesh is and what is wrong with it");
}

void add_plug_command(CLI::App& app, int& exit_code) {
  add_absent_command(app, exit_code, "plug", "Export a simulated arm as a USB device");
}

void add_replay_command(CLI::App& app, int& exit_code) {
  add_absent_command(app, exit_code, "replay", "Let a recorded hand touch a scene again");
}

void add_help_command(CLI::App& app, int& exit_code) {
  add_absent_command(app, exit_code, "help",
                     "List the keys of scene and arm files, with units and limits");
}

}  // namespace thimble::cli

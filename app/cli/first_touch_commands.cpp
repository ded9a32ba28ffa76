#include "cli/commands.h"

// In place of the commands that only the whole program has: they stay in its help, and say what to
// build.
namespace thimble::app {

void add_window_command(CLI::App& app, int& exit_code) {
  add_view_command(app, exit_code, {});
}

bool has_window() {
  return false;
}

void add_calibrate_command(CLI::App& app, int& exit_code) {
  add_absent_command(app, exit_code, "calibrate",
                     "Find an arm's home pose and the signs of its encoders");
}

void add_doctor_command(CLI::App& app, int& exit_code) {
  add_absent_command(app, exit_code, "doctor", "Say why an arm cannot be used, and what mends it");
}

void add_exec_command(CLI::App& app, int& exit_code) {
  add_absent_command(app, exit_code, "exec",
                     "Run a program that was written for another maker's arm");
}

void add_export_command(CLI::App& app, int& exit_code) {
  add_absent_command(app, exit_code, "export", "Write a recording as a table");
}

void add_feel_check_command(CLI::App& app, int& exit_code) {
  add_absent_command(app, exit_code, "feel-check", "Check an arm by hand");
}

void add_identify_command(CLI::App& app, int& exit_code) {
  add_absent_command(app, exit_code, "identify",
                     "Measure an arm's mass, friction, gains, delay and cables by small forces");
}

void add_twin_command(CLI::App& app, int& exit_code) {
  add_absent_command(app, exit_code, "twin",
                     "Let the simulated arm relive a recording, and tell how far both are apart");
}

void add_hil_command(CLI::App& app, int& exit_code) {
  add_absent_command(app, exit_code, "hil",
                     "Check an arm as a test server does: reports, delays, watchdog, friction, "
                     "walls, soak");
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

void add_study_command(CLI::App& app, int& exit_code) {
  add_absent_command(app, exit_code, "study",
                     "Measure, draw and tell in figures; each study says what");
}

void add_bench_command(CLI::App& app, int& exit_code) {
  add_absent_command(app, exit_code, "bench",
                     "Is this machine good enough for a scene at 1, 4 and 8 kHz?");
}

void add_help_command(CLI::App& app, int& exit_code) {
  add_absent_command(app, exit_code, "help",
                     "List the keys of scene and arm files, with units and limits");
}

void add_cost_probe_command(CLI::App&, int&) {}

}  // namespace thimble::app

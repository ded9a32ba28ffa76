// In place of the commands that check and measure an arm, in a program without
// THIMBLE_COMMISSIONING.
#include "cli/commands.h"

namespace thimble::cli {

void add_feel_check_command(CLI::App& app, int& exit_code) {
  add_absent_command(app, exit_code, "feel-check", "Check an arm by hand", "THIMBLE_COMMISSIONING");
}

void add_identify_command(CLI::App& app, int& exit_code) {
  add_absent_command(app, exit_code, "identify",
                     "Measure an arm's mass, friction, gains, delay and cables by small forces",
                     "THIMBLE_COMMISSIONING");
}

void add_twin_command(CLI::App& app, int& exit_code) {
  add_absent_command(app, exit_code, "twin", "Compare a recorded arm with its simulated twin",
                     "THIMBLE_COMMISSIONING");
}

void add_hil_command(CLI::App& app, int& exit_code) {
  add_absent_command(app, exit_code, "hil",
                     "Check an arm as a test server does: reports, delays, watchdog, friction, "
                     "walls, soak",
                     "THIMBLE_COMMISSIONING");
}

}  // namespace thimble::cli

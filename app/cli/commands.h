#pragma once

#include <functional>
#include <string>
#include <vector>

// The argument library, which takes seconds to read.
namespace CLI {
class App;
}

namespace thimble::session {
class RunAttachment;
}

namespace thimble::cli {

/// Opens windows until they are closed, or for so many seconds if they are above 0, and gives the
/// exit code; empty where there are none.
struct ShowWindow {
  std::function<int(session::RunAttachment& runs, double seconds)> runs;
  std::function<int(const std::vector<std::string>& files, double seconds)> recordings;
};

// One function per command of the program. Each adds its sub-command with options and help to
// `app`; when the user chose it, its exit code (exit_code.h) is left in `exit_code`.

/// `thimble run SCENE`: touches a scene.
void add_run_command(CLI::App& app, int& exit_code);
/// `thimble shot SCENE`: draws a moment of a scene.
void add_shot_command(CLI::App& app, int& exit_code);
/// `thimble view RUN`: shows a run that goes on in another process, by `show_window` or as text, or
/// a recording.
void add_view_command(CLI::App& app, int& exit_code, const ShowWindow& show_window);
/// `thimble view RUN` with the window of this program.
void add_window_command(CLI::App& app, int& exit_code);
/// Returns whether this program has a window: what app/demo.sh builds has none.
bool has_window();
/// `thimble devices`: lists the arms.
void add_devices_command(CLI::App& app, int& exit_code);
/// `thimble calibrate`: finds an arm's home pose and the signs of its encoders.
void add_calibrate_command(CLI::App& app, int& exit_code);
/// `thimble feel-check`: checks an arm by hand.
void add_feel_check_command(CLI::App& app, int& exit_code);
/// `thimble identify`: measures an arm's constants.
void add_identify_command(CLI::App& app, int& exit_code);
/// `thimble twin FILE`: compares a recorded arm with its simulated twin.
void add_twin_command(CLI::App& app, int& exit_code);
/// `thimble hil`: checks an arm as a laboratory's test server does.
void add_hil_command(CLI::App& app, int& exit_code);
/// `thimble doctor`: says why an arm cannot be used, and what mends it.
void add_doctor_command(CLI::App& app, int& exit_code);
/// `thimble exec PROGRAM`: runs a program that was written for another maker's arm.
void add_exec_command(CLI::App& app, int& exit_code);
/// `thimble export FILE`: writes a recording as a table.
void add_export_command(CLI::App& app, int& exit_code);
/// `thimble replay FILE`: lets a recorded hand touch a scene again.
void add_replay_command(CLI::App& app, int& exit_code);
/// `thimble plug ARM`: exports a simulated arm as a USB device.
void add_plug_command(CLI::App& app, int& exit_code);
/// `thimble manual`: what the installation makes the manual page of.
void add_manual_command(CLI::App& app, int& exit_code);
/// `thimble mesh FILE`: tells what a mesh is and what is wrong with it.
void add_mesh_command(CLI::App& app, int& exit_code);
/// `thimble mesh page IN OUT`: cuts a mesh into volumes on disk.
void add_mesh_page_command(CLI::App& mesh_command, int& exit_code);
/// `thimble study NAME`: measures and draws.
void add_study_command(CLI::App& app, int& exit_code);
/// `thimble study stability`: measures where walls are stable.
void add_stability_study(CLI::App& study_command, int& exit_code);
/// `thimble study trouble`: touches random scenes.
void add_trouble_study(CLI::App& study_command, int& exit_code);
/// `thimble tune SCENE`: tells what arm, loop and hand can carry.
void add_tune_command(CLI::App& app, int& exit_code);
/// `thimble study accuracy`: what accuracy costs in time.
void add_accuracy_study(CLI::App& study_command, int& exit_code);
/// `thimble study gating SCENE`: which effects a scene could do without.
void add_gating_study(CLI::App& study_command, int& exit_code);
/// `thimble bench SCENE`: whether this machine is good enough for a scene at 1, 4 and 8 kHz.
void add_bench_command(CLI::App& app, int& exit_code);
/// `thimble help FILE`: lists the keys of scene and arm files.
void add_help_command(CLI::App& app, int& exit_code);
/// `thimble cost-probe SUBJECT STROKES`: what `thimble study cost` counts the instructions of.
void add_cost_probe_command(CLI::App& app, int& exit_code);
/// `thimble mesh generate OUT`: writes a page file of any number of triangles.
void add_mesh_generate_command(CLI::App& mesh_command, int& exit_code);

/// Adds a command that this program lacks: it is listed in the help, and answers with how to build
/// the whole program. `part` is the option of CMake that it belongs to, if there is one.
void add_absent_command(CLI::App& app, int& exit_code, const std::string& name,
                        const std::string& about, const std::string& part = {});

}  // namespace thimble::cli

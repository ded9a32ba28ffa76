#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "arm_policy/feel_check_record.h"
#include "bringup/identify/constants_table.h"
#include "bringup/identify/identify.h"
#include "bringup/identify/output/identified_file.h"
#include "bringup/identify/simulated_bench.h"
#include "cli/arm_choice.h"
#include "cli/commands.h"
#include "cli/options/old_names.h"
#include "cli/prompts/key_stop.h"
#include "cli/prompts/yes_question.h"
#include "cli/report_error.h"
#include "cli/usage/help_text.h"
#include "enter_key.h"
#include "identified/identify_page.h"
#include "log/logger.h"
#include "log/printed_text.h"
#include "output/output_plan.h"
#include "recording/recording_layout.h"
#include "signals.h"
#include "text_file.h"
#include "thimble/scene/build_info.h"
#include "thimble/scene/shipped_files.h"
#include "thimble/session/recording.h"

namespace thimble::cli {
namespace {

struct IdentifyCommand {
  ArmChoice choice;
  bringup::IdentifyOptions options;
  std::string output;
  std::string record;
  bool force = false;
  std::string report;
  bool yes = false;
  bool write_bad_fit = false;
  bool names_places = false, names_max_force = false;  // on the command line
};

// Duration of a motion divided by that of one place: seven places take about as long as one motion,
// and together with both motions of 60 s three minutes. And the minimum at one place, s [chosen: it
// gives the mass of light arms to 0.2 %].
constexpr double kPlaceShare = 12, kPlaceSecondsMin = 2;

std::string today() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[16];
  std::strftime(text, sizeof text, "%Y-%m-%d", &utc);
  return text;
}

/// Returns how the user stops the motion.
const char* how_to_stop(bool terminal) {
  return terminal ? "press any key to stop" : "press Ctrl-C to stop";
}

/// Returns the sentence that announces the motion of the tip.
std::string poses_text(const bringup::IdentifyOptions& options) {
  if (options.places == 0) return "";
  return fmt::format(", then move slowly to {} poses of its workspace and shake for {:g} s at each",
                     options.places, options.place_seconds);
}

/// Opens a real arm and asks for what the motion needs. The arm is idle meanwhile.
driver::Result<std::unique_ptr<bringup::BenchArm>> open_real(const ChosenArm& chosen,
                                                             const IdentifyCommand& command,
                                                             bool loaded,
                                                             const std::atomic<bool>& stop) {
  auto bench = bringup::BenchArm::open(chosen.file, chosen.real_arm, command.choice.firmware, {},
                                       command.options.max_force);
  if (!bench) return bench;
  if (loaded) {
    scene::print_format(
        "Fix %g kg rigidly to the tip, in the middle of the workspace, and support it from below. "
        "Let go when you feel that the arm carries it. Press Enter to begin.\n",
        command.options.known_mass);
  } else {
    scene::print_format(
        "Put the tip into the middle of the workspace so that it stays there, and remove your "
        "hand. The tip will shake by a few millimetres with at most %g N for %g s%s; %s. Press "
        "Enter to begin.\n",
        command.options.max_force, command.options.seconds, poses_text(command.options).c_str(),
        how_to_stop(has_terminal()));
  }
  std::fflush(stdout);
  session::EnterKey key = session::EnterKey::kNothing;
  const auto done = [&key] {
    return (key = session::check_enter_key()) != session::EnterKey::kNothing;
  };
  if (!(*bench)->hold(done, stop) || key != session::EnterKey::kPressed) {
    return driver::Error{"Cancelled before the motion began; nothing was saved."};
  }
  return bench;
}

/// Returns whether the feel check of a real arm is valid, and reports if not. Larger forces than
/// those of that check need known signs and watchdog.
bool checked(const ChosenArm& chosen, const std::string& firmware) {
  const scene::RealArmFile file{
      .path = chosen.path, .file = chosen.file, .why = {}, .warnings = {}};
  return scene::has_passed(scene::describe_checked(*chosen.real_arm, file, firmware));
}

/// Writes the motion without a known mass as a recording, for `thimble twin`.
driver::Result<void> write_motion(const ChosenArm& chosen, const std::string& path,
                                  const std::vector<driver::TickRecord>& ticks, bool replace) {
  const auto file = scene::find_arm_file(chosen.path.string());
  if (!file) return file.error();
  session::RecordingInfo info;
  info.scene = "identify";
  info.arm = chosen.file.name;
  info.arm_file = file->string();
  info.arm_text = scene::text_of(*file);
  info.device = chosen.name;
  info.clock = chosen.real_arm ? "wall" : "virtual";
  info.program = scene::program_name();
  info.rate = 1000;
  return session::write_recording(path, info, ticks, replace);
}

/// Writes the result into the new file, if the user agrees. A bad fit is saved only if that was
/// requested explicitly.
int keep(const IdentifyCommand& command, const ChosenArm& chosen, const bringup::Identified& found,
         bool writes, const std::atomic<bool>& stop) {
  const bool bad = !found.against.empty();
  const int done = bad ? kExitUnmet : kExitDone;
  for (const std::string& sentence : found.against)
    scene::print_format("BAD FIT  %s\n", sentence.c_str());
  const auto left = [done](const char* why) {
    scene::print_format("Nothing was written%s\n", why);
    return done;
  };
  if (bad && !command.write_bad_fit) return left(".");
  if (!writes) return left(". Name the new file with --output, or confirm with --yes.");
  if (!command.yes && has_terminal()) {
    const std::string question = (bad ? "The fit is bad. Write it anyway, marked BAD FIT, to "
                                      : "Write these constants to the new arm file ") +
                                 command.output + "?";
    if (!ask_yes_no(question, stop)) return stop.load() ? kExitInterrupted : left(".");
  }
  const auto file = scene::find_arm_file(chosen.path.string());
  if (!file) return report_error(file.error(), kExitBadInput);
  const auto written = bringup::write_identified(*file, command.output, found,
                                                 {.date = today(), .arm = chosen.name});
  if (!written) return report_error(written.error(), kExitTrouble);
  scene::print_format("Written to %s%s.\n", command.output.c_str(),
                      bad ? ", with each value marked BAD FIT" : "");
  return done;
}

/// Replaces defaults that do not fit the arm, and states each in a line.
void fit_defaults(IdentifyCommand& command, const scene::ArmFile& file) {
  bringup::IdentifyOptions& options = command.options;
  if (!command.names_places && !bringup::check_places(file, options)) {
    options.places = 0;
    scene::print_format(
        "--places is 0 for this arm: the inertia of links is identified for arms with three motors "
        "only.\n");
  }
  const double max_force = bringup::default_max_force(file);
  if (!command.names_max_force && max_force < options.max_force) {
    options.max_force = max_force;
    scene::print_format(
        "--max-force is %g N for this arm, the limit of its file (gate.force_max).\n", max_force);
  }
}

/// Writes the page with plots.
int write_report(const IdentifyCommand& command, const ChosenArm& chosen,
                 const bringup::Identified& found) {
  const auto written = identified::write_identify_page(found, chosen.file,
                                                       {.arm = chosen.file.name,
                                                        .device = chosen.name,
                                                        .simulated = !chosen.real_arm,
                                                        .date = today(),
                                                        .program = scene::program_name(),
                                                        .seconds = command.options.seconds,
                                                        .max_force = command.options.max_force,
                                                        .bad_fit_is_written = command.write_bad_fit,
                                                        .known_mass = command.options.known_mass},
                                                       command.report);
  if (!written) return report_error(written.error(), kExitTrouble);
  scene::print_format("Report in %s/index.html.\n", command.report.c_str());
  return kExitDone;
}

int identify_arm(IdentifyCommand command) {
  const auto chosen = resolve(command.choice, false);
  if (!chosen) return report_error(chosen.error(), exit_code_of(command.choice));
  const SimulatedNote simulated(*chosen, "constant of an arm on the desk");
  for (const std::string& sentence : chosen->messages)
    scene::print_format("%s\n", sentence.c_str());
  if (auto allowed = check_priority(command.choice, *chosen); !allowed) {
    return report_error(allowed.error(), kExitBadInput);
  }
  if (chosen->real_arm && !checked(*chosen, command.choice.firmware)) {
    return report_error(
        {"identify moves the arm by itself, and this arm has not passed the feel check "
         "with this arm file. Run `thimble feel-check` first."},
        kExitBadInput);
  }
  fit_defaults(command, chosen->file);
  if (auto right = bringup::check_places(chosen->file, command.options); !right) {
    return report_error(right.error(), kExitBadInput);
  }
  if (auto right = bringup::check_forces(chosen->file, command.options); !right) {
    return report_error(right.error(), kExitBadInput);
  }
  // --output, --yes or an answer at the terminal requests the file.
  const bool writes = !command.output.empty() || command.yes || has_terminal();
  if (command.output.empty()) command.output = chosen->file.name + "_identified.yaml";
  if (auto free = bringup::check_new_file(command.output); writes && !free) {
    return report_error(free.error(), kExitBadInput);
  }
  output::OutputPlan plan;
  plan.read(chosen->path);
  plan.read(command.choice.firmware);
  if (writes) plan.write("--output", command.output, output::kArmFile);
  plan.write("--record", command.record, session::kRecordingOutput, command.force);
  plan.write_folder("--report", command.report, {"figures.json", "index.html"});
  if (auto begun = plan.begin(); !begun) return report_error(begun.error(), kExitBadInput);
  const std::atomic<bool>& stop = scene::catch_interrupts();
  if (chosen->real_arm) scene::treat_sigtstp_as_exit();
  const scene::ForceExitGuard guard;
  // Gives a person time to let go of the mass.
  if (chosen->real_arm) command.options.lead = 4;
  command.options.link = true;
  command.options.place_seconds = std::max(kPlaceSecondsMin, command.options.seconds / kPlaceShare);
  std::optional<KeyStop> keys;
  const bringup::OpenBench open = [&](bool loaded) {
    keys.reset();  // Enter begins the motion, so it must not stop it
    auto bench = chosen->real_arm ? open_real(*chosen, command, loaded, stop)
                                  : bringup::simulated_bench(
                                        chosen->file, loaded ? command.options.known_mass : 0,
                                        false, command.options.max_force);
    if (!bench) return bench;
    keys.emplace();
    scene::print_format("The tip %s; %s.\n",
                        loaded ? "shakes with the known mass" : "shakes by small forces",
                        how_to_stop(keys->listens()));
    std::fflush(stdout);
    return bench;
  };
  std::vector<driver::TickRecord> ticks;
  if (!command.record.empty()) {
    // Allocates in advance: no allocation during a real arm's ticks.
    ticks.reserve(static_cast<std::size_t>(1000 * (command.options.seconds + 10)));
    command.options.watch = [&ticks](const driver::TickRecord& tick) { ticks.push_back(tick); };
  }
  const auto found = bringup::identify(open, chosen->file, command.options, stop);
  const bool by_key = keys && keys->pressed();
  keys.reset();
  if (stop.load()) {
    scene::print_format("%s; nothing was saved.\n", by_key ? "Stopped by a key" : "Stopped");
    return kExitInterrupted;
  }
  if (!ticks.empty()) {
    if (auto written = write_motion(*chosen, command.record, ticks, command.force); !written) {
      return report_error(written.error(), kExitTrouble);
    }
    scene::print_format("The motion was recorded in %s.\n", command.record.c_str());
  }
  if (!found) return report_error(found.error(), kExitFault);
  scene::print_format("%s", bringup::constants_table(*found, chosen->file).c_str());
  scene::logger().info("The arm {} was identified{}.", chosen->name,
                       found->against.empty() ? "" : ", with a bad fit");
  // The arm file first: a picture that cannot be drawn must not lose it.
  const int kept = keep(command, *chosen, *found, writes, stop);
  if (command.report.empty()) return kept;
  const int reported = write_report(command, *chosen, *found);
  return reported == kExitDone ? kept : reported;
}

}  // namespace

void add_identify_command(CLI::App& app, int& exit_code) {
  CLI::App* sub = app.add_subcommand(
      "identify", "Measure mass, friction, gains, delay and cable stiffness of an arm");
  auto command = std::make_shared<IdentifyCommand>();
  command->options.places = 7;
  command->choice.add_options(*sub);
  command->choice.add_real_time_option(*sub);
  constexpr const char* kMotion = "Motion";
  sub->add_option("--known-mass", command->options.known_mass,
                  "Mass to fix to the tip for a second motion, kg")
      ->check(CLI::Range(0.0, 0.06))
      ->group(kMotion);
  CLI::Option* duration =
      sub->add_option("--duration", command->options.seconds, "Duration of each motion, s")
          ->check(CLI::Range(10.0, 600.0))
          ->capture_default_str()
          ->group(kMotion);
  add_old_name(*sub, "--seconds", duration, command->options.seconds)
      ->check(CLI::Range(10.0, 600.0));
  CLI::Option* places = sub->add_option("--places", command->options.places,
                                        "Poses for measuring the link inertia; 0: none")
                            ->check(CLI::Range(3, 9) | CLI::IsMember({0}))
                            ->capture_default_str()
                            ->group(kMotion);
  CLI::Option* max_force =
      sub->add_option("--max-force", command->options.max_force, "Largest force of the motion, N")
          ->check(CLI::PositiveNumber)
          ->capture_default_str()
          ->group(kMotion);
  CLI::Option* force_most =
      add_old_name(*sub, "--force-most", max_force, command->options.max_force)
          ->check(CLI::PositiveNumber);
  constexpr const char* kOutput = "Output";
  sub->add_option("--output", command->output, "New arm file (default: NAME_identified.yaml here)")
      ->option_text("FILE")
      ->group(kOutput);
  sub->add_flag("--yes", command->yes, "Write the arm file without asking")->group(kOutput);
  sub->add_flag("--write-bad-fit", command->write_bad_fit,
                "Also write constants of a bad fit, marked BAD FIT")
      ->group(kOutput);
  CLI::Option* record =
      sub->add_option("--record", command->record, "Record the motion of the bare tip (HDF5)")
          ->option_text("FILE")
          ->group(kOutput);
  sub->add_flag("--force", command->force, "Let --record replace an existing recording")
      ->needs(record)
      ->group(kOutput);
  sub->add_option("--report", command->report, "Write a page with plots and the measured constants")
      ->option_text("DIR")
      ->group(kOutput);
  add_example(*sub, "thimble identify --device auto --output my_arm.yaml",
              "The arm moves by itself, with small forces.\n"
              "--known-mass  Without it, only ratios of masses and forces are identified.\n"
              "--places      After the motion, the tip moves to these poses of its workspace.\n"
              "              0 for an arm with one or two motors.\n"
              "--max-force   At most gate.force_max of the arm file, also by default.\n"
              "--yes         Without it, the command asks at a terminal. Without a terminal,\n"
              "              the file is written only with --output or --yes.\n"
              "--record      Use the recording with `thimble twin`.\n"
              "--report      The page also lists the constants that were not identified, with\n"
              "              the reasons.");
  sub->callback([command, places, max_force, force_most, &exit_code] {
    command->names_places = places->count() > 0;
    command->names_max_force = max_force->count() + force_most->count() > 0;
    exit_code = identify_arm(*command);
  });
}

}  // namespace thimble::cli

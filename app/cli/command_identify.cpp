#include <CLI/CLI.hpp>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "bringup/identify/constants_table.h"
#include "bringup/identify/identified_file.h"
#include "bringup/identify/identify.h"
#include "bringup/identify/simulated_bench.h"
#include "cli/arm_choice.h"
#include "cli/commands.h"
#include "cli/complain.h"
#include "enter_key.h"
#include "identified/identify_page.h"
#include "interrupt.h"
#include "log/logger.h"
#include "terms/feel_check_record.h"
#include "thimble/scene/build_info.h"
#include "thimble/scene/shipped_files.h"
#include "thimble/session/recording.h"

namespace thimble::app {
namespace {

struct IdentifyCommand {
  ArmChoice choice;
  IdentifyOptions options;
  std::string output;
  std::string record;
  std::string report;
};

std::string today() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[16];
  std::strftime(text, sizeof text, "%Y-%m-%d", &utc);
  return text;
}

/// Opens a real arm and asks for what the motion needs; the arm is idle meanwhile.
driver::Result<std::unique_ptr<BenchArm>> open_real(const ChosenArm& chosen,
                                                    const IdentifyCommand& command, bool loaded,
                                                    const std::atomic<bool>& stop) {
  auto bench =
      BenchArm::open(chosen.file, chosen.real_arm, command.choice.firmware, {}, kIdentifyForceMax);
  if (!bench) return bench;
  if (loaded) {
    std::printf(
        "Fix %g kg to the tip so that it cannot swing, in the middle of the workspace, and hold it "
        "from below; let go once you feel that it is carried. Press Enter to begin.\n",
        command.options.known_mass);
  } else {
    std::printf(
        "Put the tip into the middle of the workspace, so that it stays there, and take your hand "
        "off. It will shake by some millimetres with at most %g N for %g s; Ctrl-C ends it. Press "
        "Enter to begin.\n",
        kIdentifyForceMax, command.options.seconds);
  }
  std::fflush(stdout);
  session::EnterKey key = session::EnterKey::kNothing;
  const auto done = [&key] {
    return (key = session::look_for_enter()) != session::EnterKey::kNothing;
  };
  if (!(*bench)->hold(done, stop) || key != session::EnterKey::kPressed) {
    return driver::Error{"It was left before it began; nothing was kept."};
  }
  return bench;
}

/// Says whether a real arm passed its feel check as it is: what asks for more than that check may
/// needs an arm of which signs and watchdog are known.
bool checked(const ChosenArm& chosen, const std::string& firmware) {
  const scene::RealArmFile file{.path = chosen.path, .file = chosen.file, .why = {}, .told = {}};
  return scene::has_passed(scene::describe_checked(*chosen.real_arm, file, firmware));
}

/// Writes the motion with the bare tip as a recording, for `thimble twin`.
driver::Result<void> write_motion(const ChosenArm& chosen, const std::string& path,
                                  const std::vector<driver::TickRecord>& ticks) {
  const auto file = scene::find_arm_file(chosen.path.string());
  if (!file) return file.error();
  std::ostringstream text;
  text << std::ifstream(*file).rdbuf();
  session::RecordingInfo info;
  info.scene = "identify";
  info.arm = chosen.file.name;
  info.arm_file = file->string();
  info.arm_text = text.str();
  info.device = chosen.name;
  info.clock = chosen.real_arm ? "wall" : "virtual";
  info.program = scene::program_name();
  info.rate = 1000;
  return session::write_recording(path, info, ticks);
}

int identify_arm(IdentifyCommand command) {
  const auto chosen = resolve(command.choice, false);
  if (!chosen) return complain(chosen.error(), kExitNoDevice);
  const SimulatedNote simulated(*chosen, "constant of an arm on the desk");
  for (const std::string& sentence : chosen->told) std::printf("%s\n", sentence.c_str());
  if (chosen->real_arm && !checked(*chosen, command.choice.firmware)) {
    return complain({"Identifying asks for up to 1 N, and this arm, with this arm file, has not "
                     "passed its feel check. Run `thimble feel-check` first."},
                    kExitBadInput);
  }
  if (command.output.empty()) command.output = chosen->file.name + "_identified.yaml";
  const std::atomic<bool>& stop = scene::catch_interrupts();
  if (chosen->real_arm) scene::leave_rather_than_stop();
  const scene::LeavingGuard guard;
  // A person needs time to let go of the mass.
  if (chosen->real_arm) command.options.lead = 4;
  command.options.link = true;
  const OpenBench open = [&](bool loaded) {
    return chosen->real_arm
               ? open_real(*chosen, command, loaded, stop)
               : simulated_bench(chosen->file, loaded ? command.options.known_mass : 0);
  };
  std::vector<driver::TickRecord> ticks;
  if (!command.record.empty()) {
    // Room at once: a real arm's ticks wait for nobody.
    ticks.reserve(static_cast<std::size_t>(1000 * (command.options.seconds + 10)));
    command.options.watch = [&ticks](const driver::TickRecord& tick) { ticks.push_back(tick); };
  }
  const auto found = identify(open, chosen->file, command.options, stop);
  if (stop.load()) return kExitInterrupted;
  if (!ticks.empty()) {
    if (auto written = write_motion(*chosen, command.record, ticks); !written) {
      return complain(written.error(), kExitTrouble);
    }
    std::printf("The motion was recorded in %s.\n", command.record.c_str());
  }
  if (!found) return complain(found.error(), kExitFault);
  std::printf("%s", constants_table(*found, chosen->file).c_str());
  if (!command.report.empty()) {
    const auto written = write_identify_page(*found, chosen->file,
                                             {.arm = chosen->file.name,
                                              .device = chosen->name,
                                              .simulated = !chosen->real_arm,
                                              .date = today(),
                                              .program = scene::program_name(),
                                              .seconds = command.options.seconds,
                                              .known_mass = command.options.known_mass},
                                             command.report);
    if (!written) return complain(written.error(), kExitTrouble);
    std::printf("Report in %s/index.html.\n", command.report.c_str());
  }
  scene::logger().info("The arm {} was identified{}.", chosen->name,
                       found->against.empty() ? "" : ", and its fit is bad");
  if (!found->against.empty()) {
    for (const std::string& sentence : found->against)
      std::printf("BAD FIT  %s\n", sentence.c_str());
    std::printf("Nothing was written.\n");
    return kExitUnmet;
  }
  const auto file = scene::find_arm_file(chosen->path.string());
  if (!file) return complain(file.error(), kExitBadInput);
  const auto written = write_identified(*file, command.output, found->constants,
                                        {.date = today(), .arm = chosen->name});
  if (!written) return complain(written.error(), kExitTrouble);
  std::printf("Written to %s.\n", command.output.c_str());
  return kExitDone;
}

}  // namespace

void add_identify_command(CLI::App& app, int& exit_code) {
  CLI::App* sub = app.add_subcommand(
      "identify", "Measure an arm's mass, friction, gains, delay and cables by small forces");
  auto command = std::make_shared<IdentifyCommand>();
  command->choice.add_options(*sub);
  sub->add_option(
         "--known-mass", command->options.known_mass,
         "Mass that you fix to the tip for a second motion, kg: without it only the ratios "
         "of masses and forces can be seen")
      ->check(CLI::Range(0.0, 0.06));
  sub->add_option("--seconds", command->options.seconds, "Of each motion")
      ->check(CLI::Range(10.0, 600.0))
      ->capture_default_str();
  sub->add_option("--output", command->output,
                  "New arm file to write; left out: NAME_identified.yaml in this folder");
  sub->add_option("--record", command->record,
                  "Recording of the motion with the bare tip to write, for `thimble twin`");
  sub->add_option("--report", command->report,
                  "Folder for a page with plots, constants and what was not identified, and why");
  sub->callback([command, &exit_code] { exit_code = identify_arm(*command); });
}

}  // namespace thimble::app

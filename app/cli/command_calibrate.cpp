#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "arm/calibration.h"
#include "arm_table.h"
#include "bringup/bench_arm.h"
#include "bringup/feel_check.h"
#include "cli/arm_choice.h"
#include "cli/commands.h"
#include "cli/report_error.h"
#include "cli/usage/help_text.h"
#include "enter_key.h"
#include "hand/place_text.h"
#include "log/logger.h"
#include "log/printed_text.h"
#include "signals.h"
#include "thimble/scene/arm_simulation.h"
#include "thimble/scene/real_arm.h"
#include "vendors/dhd/dhd_link.h"
#include "vendors/hd/hd_link.h"

namespace thimble::cli {
namespace {

/// The path of the simulated hand: it reaches each pose after a second and holds it for a second.
std::vector<std::pair<double, Eigen::Vector3d>> simulated_hand(const Eigen::Vector3d& p_home,
                                                               const std::vector<int>& axes,
                                                               const scene::ArmFile& file) {
  const std::optional<Eigen::Vector3d>& p_check = file.home.check_p_WT;
  std::vector<std::pair<double, Eigen::Vector3d>> way{{0, p_home}};
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const int axis = axes[i];
    const double begin = 2 + 4 * static_cast<double>(i);
    // Only motions that a vintage arm can make from its home pose.
    const double distance = std::min(0.04, scene::calibration_move(file, p_home, axis));
    const Eigen::Vector3d there = p_home + distance * Eigen::Vector3d::Unit(axis);
    way.emplace_back(begin, p_home);
    way.emplace_back(begin + 1, there);
    way.emplace_back(begin + 2, there);
    way.emplace_back(begin + 3, p_home);
  }
  if (p_check) way.emplace_back(way.back().first + 1, *p_check);
  return way;
}

Eigen::Vector3d home_of(const scene::ArmFile& file) {
  return file.p_WB +
         file.R_WB * driver::make_arm(file.protocol, file.model, file.wire.get())->pose({}).p_BT;
}

/// Waits for the user to press Enter; kExitDone once it is pressed.
int wait_for_enter() {
  std::fflush(stdout);
  const std::atomic<bool>& stop = scene::catch_interrupts();
  session::EnterKey key = session::EnterKey::kNothing;
  while ((key = session::check_enter_key()) == session::EnterKey::kNothing) {
    if (stop.load()) return kExitInterrupted;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  if (key == session::EnterKey::kPressed) return kExitDone;
  return report_error({"Standard input is closed, so nothing was done. Run it at a terminal."},
                      kExitBadInput);
}

/// Prints the result of the library's calibration.
int report_calibration(const driver::Result<void>& done, const std::string& name) {
  if (!done) return report_error(done.error(), kExitFault);
  scene::print_format("Done. Check it: thimble feel-check --device %s\n", name.c_str());
  return kExitDone;
}

/// Calibrates a Touch by its library, after the user has done the manual step.
int calibrate_by_library(const std::string& name) {
  const auto library = driver::hd::library();
  if (!library) return report_error(library.error(), kExitNoDevice);
  const auto how = driver::hd::how_to_calibrate(*library);
  if (!how) return report_error(how.error(), kExitNoDevice);
  scene::print_format("%s Press Enter.\n", how->c_str());
  if (const int entered = wait_for_enter(); entered != kExitDone) return entered;
  return report_calibration(driver::hd::calibrate(*library), name);
}

/// Lets an arm of Force Dimension find its zero, after the user has agreed to the motion.
int find_zero_by_library(const std::string& name) {
  const auto library = driver::dhd::library();
  if (!library) return report_error(library.error(), kExitNoDevice);
  scene::print_format(
      "The arm will MOVE BY ITSELF until it has found its zero. Clear its workspace, let go of it, "
      "and press Enter.\n");
  if (const int entered = wait_for_enter(); entered != kExitDone) return entered;
  return report_calibration(driver::dhd::find_zero(*library), name);
}

/// Returns what the user is asked to do, in this order: the home pose, a motion along each axis of
/// the world, and the second pose if the arm file has one.
std::vector<std::string> prompts_of(const scene::ArmFile& file, const std::vector<int>& axes) {
  constexpr std::array<const char*, 5> kHow = {
      "Push the links against the stops of the home pose.",
      "Put the links into the jig or at the marks of the home pose.",
      "Put the arm into its home pose, at the index marks of its encoders.",
      "Put the arm into its home pose, which its absolute encoders should report.",
      "Put the arm into its home pose and press the button of its board."};
  constexpr std::array<const char*, 3> kWays = {"towards you", "to your right", "up"};
  std::vector<std::string> prompts{file.home.how == scene::HomeMethod::kUnknown
                                       ? "Put the arm into its home pose."
                                       : kHow.at(static_cast<std::size_t>(file.home.how) - 1)};
  for (const int axis : axes) {
    const char* const way = kWays.at(static_cast<std::size_t>(axis));
    const double cm = 1e2 * scene::calibration_move(file, home_of(file), axis);
    prompts.push_back(
        prompts.size() == 1
            ? fmt::format("Move the grip about {:.3g} cm {}.", cm, way)
            : fmt::format("Return to the home pose, then move about {:.3g} cm {}.", cm, way));
  }
  if (file.home.check_p_WT) {
    prompts.push_back(fmt::format("Move the tip to the second pose, {} m.",
                                  scene::place_text(*file.home.check_p_WT, 3)));
  }
  return prompts;
}

int calibrate(const ArmChoice& choice, bool dry_run) {
  auto chosen = resolve(choice, true);
  if (!chosen) return report_error(chosen.error(), exit_code_of(choice));
  if (chosen->real_arm && chosen->real_arm->kind == driver::ArmKind::kDhd && !dry_run) {
    return find_zero_by_library(chosen->name);
  }
  if (chosen->real_arm && chosen->real_arm->kind == driver::ArmKind::kHd && !dry_run) {
    return calibrate_by_library(chosen->name);
  }
  const driver::ArmRow* row = driver::row_of(chosen->file.protocol);
  if (row != nullptr && row->has_own_link()) {
    return report_error(
        {"The arm " + chosen->name + " (" + chosen->file.name +
         ") is calibrated by the vendor's software; Thimble uses its positions unchanged. "
         "Calibrate it there, then check it: thimble feel-check --device " +
         chosen->name},
        kExitBadInput);
  }
  const SimulatedNote simulated(*chosen, "calibration");
  for (const std::string& sentence : chosen->messages)
    scene::print_format("%s\n", sentence.c_str());
  const std::vector<int> axes = bringup::feel_check_axes(chosen->file);
  const std::optional<Eigen::Vector3d>& p_check = chosen->file.home.check_p_WT;
  std::vector<std::pair<double, Eigen::Vector3d>> way;
  if (!chosen->real_arm) way = simulated_hand(home_of(chosen->file), axes, chosen->file);
  const std::atomic<bool>& stop = scene::catch_interrupts();
  if (chosen->real_arm) scene::treat_sigtstp_as_exit();
  const scene::ForceExitGuard guard;
  // The force is zero throughout. The limit is only needed to open the device.
  auto bench = bringup::BenchArm::open(chosen->file, chosen->real_arm, choice.firmware, way, 0.1);
  if (!bench) return report_error(bench.error(), kExitNoDevice);

  const std::vector<std::string> prompts = prompts_of(chosen->file, axes);
  std::vector<driver::ArmReading> readings(prompts.size());
  for (std::size_t i = 0; i < prompts.size(); ++i) {
    // The simulated hand is at home after 1 s, and in each other pose from 3 s on, 4 s apart. It is
    // in the second pose at its end.
    const bool checks = p_check && i + 1 == prompts.size();
    const double time = i == 0   ? 1
                        : checks ? 4.0 * static_cast<double>(i) + 0.5
                                 : 4.0 * static_cast<double>(i) - 0.5;
    scene::print_format("%s%s\n", prompts[i].c_str(),
                        chosen->real_arm ? " Hold it there and press Enter." : "");
    session::EnterKey key = session::EnterKey::kNothing;
    const auto done = [&] {
      if (!chosen->real_arm) return (*bench)->now() >= time;
      return (key = session::check_enter_key()) != session::EnterKey::kNothing;
    };
    if (!(*bench)->hold(done, stop)) {
      if (stop.load()) return kExitInterrupted;
      return report_error({std::string(driver::describe((*bench)->device().fault()))}, kExitFault);
    }
    if (key == session::EnterKey::kClosed)
      return report_error({"Standard input is closed. Run it at a terminal."}, kExitBadInput);
    readings[i].counts = (*bench)->device().state().counts;
  }
  const driver::ArmKind kind = chosen->real_arm ? chosen->real_arm->kind : chosen->file.protocol;
  std::array<driver::ArmReading, 3> moved;
  for (std::size_t i = 0; i < axes.size(); ++i) moved[i] = readings[1 + i];
  auto found = scene::find_calibration(chosen->file, kind, readings[0], moved, axes);
  if (!found) return report_error(found.error(), kExitTrouble);
  if (p_check) {
    const auto right = scene::check_home(chosen->file, kind, *found, readings.back());
    if (!right) return report_error(right.error(), kExitTrouble);
    scene::print_format("The second pose agrees with the encoders within %.1f mm.\n",
                        1e3 * chosen->file.home.within);
  }
  scene::print_format("home_counts  %d %d %d\nencoder_sign %d %d %d\nmotor_sign   %d %d %d\n",
                      found->home_counts[0], found->home_counts[1], found->home_counts[2],
                      found->encoder_sign[0], found->encoder_sign[1], found->encoder_sign[2],
                      found->motor_sign[0], found->motor_sign[1], found->motor_sign[2]);
  if (dry_run || !chosen->real_arm) return kExitDone;
  found->arm_file = chosen->path.stem().string();
  if (auto saved = scene::save_calibration(chosen->name, *found); !saved) {
    return report_error(saved.error(), kExitTrouble);
  }
  scene::logger().info("{} is calibrated: home_counts {} {} {}, saved in {}.", chosen->name,
                       found->home_counts[0], found->home_counts[1], found->home_counts[2],
                       scene::calibration_file(chosen->name).string());
  scene::print_format(
      "Saved in %s, for the arm file %s. Check it: thimble feel-check --device %s\n",
      scene::calibration_file(chosen->name).c_str(), found->arm_file.c_str(), chosen->name.c_str());
  return kExitDone;
}

}  // namespace

void add_calibrate_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("calibrate", "Find the home pose of an arm and the signs of its encoders");
  auto choice = std::make_shared<ArmChoice>();
  auto dry_run = std::make_shared<bool>(false);
  choice->add_options(*command);
  command->add_flag("--dry-run", *dry_run, "Print the result without saving it");
  add_example(*command, "thimble calibrate --device auto");
  command->callback([choice, dry_run, &exit_code] { exit_code = calibrate(*choice, *dry_run); });
}

}  // namespace thimble::cli

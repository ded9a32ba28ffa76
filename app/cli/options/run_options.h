#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/options/ros_options.h"
#include "run_arm.h"
#include "share/viewer_request_handler.h"
#include "thimble/driver/result.h"
#include "thimble/session/session.h"

namespace thimble::cli {

/// The options of `thimble run`.
struct RunOptions {
  std::string scene;
  std::vector<std::string> devices = {"sim"};
  std::string clock;  // empty: chosen automatically
  std::optional<double> duration;
  std::optional<std::uint64_t> seed;
  std::string report;
  std::string arm_file;
  std::string firmware;
  std::string record;
  bool force = false;  // replace an existing recording
  std::string save_mesh;
  std::string save_object;
  std::string hand = "path";
  std::vector<std::string> presses;
  std::vector<scene::ButtonStep> buttons;  // read from `presses` by check_run_options
  std::string name;
  bool view = false, no_view = false;
  bool sound = false, rumble = false;
  std::string theme;  // of the window; empty: light
  bool loop = false;
  std::optional<bool> reload;   // none: chosen automatically
  std::optional<double> speed;  // times real time
  std::string quality = "normal";
  std::optional<double> budget;  // ns
  bool mesh_cache = false;
  bool yes = false;
  bool unchecked = false;
  bool homed = false;
  bool no_real_time = false;
  std::string hold_to_run;  // empty: no enabling input
  RosArguments ros;

  /// Returns whether a person moves the simulated hand in the viewer.
  bool by_viewer() const { return hand != "path" && !by_topic(); }
  /// Returns whether a topic of ROS 2 moves the simulated hand.
  bool by_topic() const { return hand == "topic"; }
  /// Returns whether a topic of ROS 2 advances the time.
  bool stepped() const { return ros.asked && clock == "virtual"; }
  /// Returns whether a person watches a simulated arm's run.
  bool for_a_person() const { return view || by_viewer(); }
  /// Returns whether the run ends when its window is closed.
  bool ends_with_window() const { return by_viewer() || (view && loop); }
  /// Returns whether the run restarts when its scene file changes.
  bool reloads() const { return reload.value_or(for_a_person()); }
};

/// Adds --hold-to-run, which names an enabling input.
CLI::Option* add_hold_option(CLI::App& command, std::string& hold, const std::string& about);

/// Adds the arguments of `thimble run`. The options must outlive the command.
void add_run_options(CLI::App& command, RunOptions& options);

/// Fails if the options contradict each other; the error contains the remedy.
driver::Result<void> check_run_options(RunOptions& options);

/// Fails if an option that restarts or paces the run cannot be used with these arms.
driver::Result<void> check_restart_options(const RunOptions& options, const session::RunArms& arms);

/// Returns the session's options. `options` must outlive them.
session::SessionOptions session_options(const RunOptions& options, const session::RunArms& arms);

/// Returns which viewer shows the run.
session::ViewerChoice viewer_choice(const RunOptions& options);

/// Returns the arguments of `thimble view` in addition to the run's name. `asked`: the session's
/// options.
std::vector<std::string> viewer_arguments(const RunOptions& options,
                                          const session::SessionOptions& asked);

/// Returns the arguments of `thimble` by which the window starts an ended run again: `run`, the
/// scene, and the options that change the ticks. They write no file. Empty if the run cannot be
/// started without its terminal: with a real arm, with topics, or with the key of the terminal as
/// enabling input.
std::vector<std::string> run_again_words(const RunOptions& options,
                                         const session::SessionOptions& asked);

}  // namespace thimble::cli

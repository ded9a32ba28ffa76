#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>

#include "cli/commands.h"
#include "cli/file_options.h"
#include "cli/options/json_option.h"
#include "cli/options/old_names.h"
#include "cli/report_error.h"
#include "cli/usage/help_text.h"
#include "log/printed_text.h"
#include "output/output_plan.h"
#include "report/figure_json.h"
#include "ros2/ros_latency.h"
#include "stability/tuning.h"
#include "thimble/driver/clock.h"
#include "thimble/scene/scene_objects.h"
#include "thimble/scene/shipped_files.h"

namespace thimble::cli {
namespace {

struct TuneCommand {
  std::string scene;
  std::string arm_file;
  std::string folder;
  double spread_us = 0;
  double measure = 0;  // s
  bool topics = false;
  std::uint32_t domain = 0;
};

/// Measures the standard deviation of this computer's periods with an empty loop, s.
double measured_spread(double rate, double duration) {
  driver::WallClock clock;
  const auto period_ns = static_cast<std::int64_t>(std::llround(1e9 / rate));
  const auto ticks = static_cast<int>(duration * rate);
  std::int64_t due_ns = clock.now_ns(), last_ns = due_ns;
  double square = 0;
  for (int i = 0; i < ticks; ++i) {
    due_ns += period_ns;
    clock.sleep_until_ns(due_ns);
    const std::int64_t now_ns = clock.now_ns();
    const double off = 1e-9 * static_cast<double>(now_ns - last_ns - period_ns);
    square += off * off;
    last_ns = now_ns;
  }
  return ticks > 0 ? std::sqrt(square / ticks) : 0;
}

int tune_scene(const TuneCommand& command) {
  output::OutputPlan plan;
  plan.read(command.scene);
  plan.read(command.arm_file);
  plan.write_folder("--output", command.folder, {"figures.json"}, /*plots=*/false);
  if (auto begun = plan.begin(); !begun) return report_error(begun.error(), kExitBadInput);
  const auto scene = scene::load_scene(command.scene, {.arm = command.arm_file});
  if (!scene) return report_error(scene.error(), kExitBadInput);
  if (!scene->arms.front().arm.can_simulate) {
    return report_error(
        {"The arm file has no section `simulation` with mass, friction and hand. Add one, as "
         "in app/arms/vintage_phantom.yaml."},
        kExitBadInput);
  }
  // Errors of a mesh also apply here.
  const auto objects = scene::SceneObjects::build(*scene);
  if (!objects) return report_error(objects.error(), kExitBadInput);
  for (const std::string& note : (*objects)->notes())
    scene::print_format("Note      %s\n", note.c_str());
  for (const std::string& choice : (*objects)->tracker_notes(*scene))
    scene::print_format("Tracker   %s\n", choice.c_str());
  stability::TuneOptions options{.period_spread = 1e-6 * command.spread_us};
  if (command.measure > 0) {
    options.period_spread = measured_spread(scene->rate, command.measure);
    scene::print_format("Measured  period of this computer: standard deviation %.1f us.\n",
                        1e6 * options.period_spread);
  }
  if (command.topics) {
    constexpr double kDuration = 5;  // s [chosen]
    const auto ages =
        ros2::measure_ros_latency(command.scene, command.arm_file, command.domain, kDuration);
    if (!ages) return report_error(ages.error(), kExitTrouble);
    options.topics = stability::AnswerAges{.median = 1e-9 * ages->percentile(0.5),
                                           .percentile_99 = 1e-9 * ages->percentile(0.99)};
  }
  const auto tuned = stability::tune(*scene, options);
  if (!tuned) return report_error(tuned.error(), kExitBadInput);
  scene::print_format("%s\n%s", tuned->text.c_str(), report::figure_table(tuned->figures).c_str());
  if (!command.folder.empty()) {
    std::error_code status;
    std::filesystem::create_directories(command.folder, status);
    const std::filesystem::path file = std::filesystem::path(command.folder) / "figures.json";
    if (const auto written = report::write_figures(tuned->figures, file); !written) {
      return report_error(written.error(), kExitTrouble);
    }
    scene::print_format("Written to %s.\n", file.c_str());
  }
  print_json("tune", {{"scene", command.scene},
                      {"advice", tuned->text},
                      {"figures", report::figures_json(tuned->figures)}});
  const std::string unmet = report::unmet_line(tuned->figures);
  if (unmet.empty()) return kExitDone;
  scene::print_toned(scene::Tone::kBad, unmet + "\n");
  return kExitUnmet;
}

}  // namespace

void add_tune_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("tune", "Compute the stiffness, damping and friction that remain stable");
  auto options = std::make_shared<TuneCommand>();
  add_scene_option(*command, options->scene)->required();
  add_arm_option(*command, options->arm_file, "Arm file to use instead of the scene's");
  CLI::Option* output =
      command->add_option("--output", options->folder, "Write figures.json to this folder")
          ->option_text("DIR");
  add_old_name(*command, "--out", output, options->folder);
  add_json_option(*command);
  CLI::Option* spread =
      command
          ->add_option("--spread", options->spread_us, "Standard deviation of the loop period, us")
          ->check(CLI::Range(0.0, 1e6))
          ->capture_default_str();
  command
      ->add_option("--measure", options->measure,
                   "Measure the spread on this computer for N seconds")
      ->check(CLI::Range(0.1, 600.0))
      ->excludes(spread);
  CLI::Option* topics = command->add_flag("--ros2", options->topics,
                                          "Also compute the stiffest wall for forces over ROS 2");
  command->add_option("--ros-domain", options->domain, "ROS_DOMAIN_ID of the measurement")
      ->check(CLI::Range(0, 232))
      ->capture_default_str()
      ->needs(topics);
  add_example(*command, "thimble tune elephant",
              "--ros2 measures the delay of forces that another program computes and sends\n"
              "as a topic. This takes 5 s and requires the package thimble-ros2.");
  command->callback([options, &exit_code] { exit_code = tune_scene(*options); });
}

}  // namespace thimble::cli

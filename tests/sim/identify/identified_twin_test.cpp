// Results for wire, firmware and motors are written to the new file, and the arm of that file
// behaves like the measured one.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "bringup/identify/output/identified_further.h"
#include "bringup/identify/record_motion.h"
#include "read_scene.h"
#include "support/identify/identified_arm.h"
#include "support/refuses.h"
#include "support/scratch.h"
#include "yaml/yaml_reader.h"

namespace thimble::bringup {
namespace {

using support::hidden_arm;
using support::HiddenArm;
using support::identified;

constexpr const char* kArm = THIMBLE_SOURCE_DIR "/app/arms/vintage_phantom.yaml";

std::string own_text() {
  std::ostringstream content;
  content << std::ifstream(kArm).rdbuf();
  return content.str();
}

scene::ArmFile read(const std::string& text) {
  auto yaml = scene::YamlFile::parse(text, "arm file");
  return scene::read_arm(*yaml).value();
}

TEST(IdentifiedTwin, HasTheDelayAndTheWatchdogOfItsArm) {
  HiddenArm arm = hidden_arm(1);
  auto& simulated = arm.file.simulated;
  simulated.wire.delay_in_ns = 300'000;
  simulated.wire.delay_out_ns = 900'000;
  simulated.firmware.watchdog_ns = 95'000'000;
  const IdentifyOptions options{.seconds = 12, .link = true, .seed = 1};
  const auto found = identified(arm, options);
  ASSERT_TRUE(found.ok()) << found.error().message;
  ASSERT_TRUE(found->against.empty()) << found->against.front();
  ASSERT_TRUE(found->watchdog && found->watchdog->known());
  const auto file = support::scratch_folder() / "thimble_identified_twin.yaml";
  std::filesystem::remove(file);
  const auto written = write_identified(kArm, file, *found, {.date = "2026-11-25", .arm = "A 1"});
  ASSERT_TRUE(written.ok()) << written.error().message;
  const auto loaded = scene::load_arm(file);
  ASSERT_TRUE(loaded.ok()) << loaded.error().message;
  const auto& put = loaded->simulated;
  EXPECT_NEAR(1e-9 * static_cast<double>(put.firmware.watchdog_ns), 0.095, 0.002);
  EXPECT_EQ(put.firmware.report_period_ns, 1'000'000);
  EXPECT_EQ(put.wire.jitter_ns, 0);
  // The twin, measured in the same way.
  const HiddenArm twin{.file = *loaded, .gain = {}};
  const auto again = identified(twin, options);
  ASSERT_TRUE(again.ok()) << again.error().message;
  EXPECT_NEAR(again->constants.delay.value, found->constants.delay.value, 5e-5);
  EXPECT_NEAR(again->watchdog->time.value, found->watchdog->time.value, 0.002);
}

TEST(IdentifiedTwin, WritesCommentsForValuesWithoutAKey) {
  Identified found;
  found.constants.mass = {0.08, 0.001};
  found.constants.coulomb = {0.04, 0.001};
  for (Estimate& gain : found.constants.gain) gain = {2, 0.01};
  found.constants.delay = {0.0002, 1e-5};
  found.friction.directions_differ = true;
  found.friction.mean = {Estimate{0.04, 0.001}, {0.04, 0.001}, {0.04, 0.001}};
  found.friction.uneven = {Estimate{0.01, 0.001}, {0, 0.001}, {0, 0.001}};
  found.reports = ReportTiming{.period = {0.001, 1e-8}, .jitter = {6e-5, 1e-6}, .reports = 2000};
  found.saturation[1] = {.seen = true, .max_torque = {0.3, 0.01}, .asked = 0.5, .searched = true};
  const IdentifiedMark mark{.date = "2026-11-25", .arm = "A 1"};
  const auto first = identified_text(own_text(), found.constants, mark);
  ASSERT_TRUE(first.ok()) << first.error().message;
  const auto text = further_text(*first, found, mark);
  ASSERT_TRUE(text.ok()) << text.error().message;
  EXPECT_NE(text->find("    # 0.03 N along +x of the base [I 2026-11-25, A 1, +- 0.0014]: not "
                       "simulated\n"),
            std::string::npos)
      << *text;
  EXPECT_NE(text->find("# 0.05 N along -x"), std::string::npos);
  EXPECT_NE(
      text->find("    # jitter: 0.000207846  # s, evenly spread [I 2026-11-25, A 1, +- 3.5e-06]"),
      std::string::npos)
      << *text;
  const scene::ArmFile own = read(own_text()), after = read(*text);
  EXPECT_EQ(after.simulated.wire.jitter_ns, 0);
  EXPECT_EQ(after.simulated.wire.delay_out_ns, 200'000);
  EXPECT_EQ(after.simulated.firmware.report_period_ns, 1'000'000);
  // 0.3 N m at the joint, with the constants used for the requested torques.
  const auto& drive = own.model.drives[1];
  EXPECT_NEAR(after.simulated.motors.current_max, 0.3 / (drive.ratio * drive.torque_constant),
              1e-4);
}

TEST(IdentifiedTwin, KeepsWhatWasNotMeasured) {
  Identified found;
  found.constants.mass = {0.08, 0.001};
  for (Estimate& gain : found.constants.gain) gain = {1, 0.01};
  found.constants.delay = {0.003, 1e-5};
  const IdentifiedMark mark{.date = "2026-11-25", .arm = "A 1"};
  const auto put = [&] {
    return read(further_text(*identified_text(own_text(), found.constants, mark), found, mark)
                    .value())
        .simulated;
  };
  const auto& own = read(own_text()).simulated;
  EXPECT_EQ(put().firmware.watchdog_ns, own.firmware.watchdog_ns);
  EXPECT_EQ(put().firmware.report_period_ns, own.firmware.report_period_ns);
  EXPECT_EQ(put().wire.delay_out_ns, 3'000'000);
  // The report rate of an arm that sends only when asked depends on the host.
  found.reports = ReportTiming{.period = {0.0005, 1e-8}, .jitter = {6e-5, 1e-6}, .reports = 2000};
  found.watchdog.emplace();
  found.watchdog->last.end = WatchdogEnd::kAnswersOnly;
  EXPECT_EQ(put().firmware.report_period_ns, own.firmware.report_period_ns);
  found.watchdog.reset();
  EXPECT_EQ(put().firmware.report_period_ns, 500'000);
  // A file that names jitter gets the measured value.
  std::string named = own_text();
  named.insert(named.find("    delay_in:"), "    jitter: 0.1\n");
  const auto text = further_text(*identified_text(named, found.constants, mark), found, mark);
  ASSERT_TRUE(text.ok()) << text.error().message;
  EXPECT_NEAR(1e-9 * static_cast<double>(read(*text).simulated.wire.jitter_ns), 2.078e-4, 1e-7);
}

TEST(IdentifiedTwin, BadFitIsInEveryMark) {
  Identified found;
  found.constants.mass = {0.08, 0.001};
  for (Estimate& gain : found.constants.gain) gain = {1.1, 0.01};
  found.against = {"A joint sticks."};
  const auto file = support::scratch_folder() / "thimble_bad_fit.yaml";
  std::filesystem::remove(file);
  const auto written = write_identified(kArm, file, found, {.date = "2026-11-25", .arm = "A 1"});
  ASSERT_TRUE(written.ok()) << written.error().message;
  std::ifstream lines(file);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "# BAD FIT: A joint sticks.");
  int marks = 0;
  while (std::getline(lines, line)) {
    if (line.find("[I ") == std::string::npos) continue;
    ++marks;
    EXPECT_NE(line.find("[I 2026-11-25, A 1, BAD FIT, +- "), std::string::npos) << line;
  }
  EXPECT_GE(marks, 6);
  EXPECT_TRUE(support::refuses(
      write_identified(kArm, file, found, {.date = "2026-11-25", .arm = "A 1"}), "already exists"));
}

TEST(IdentifyForce, StaysBelowTheUsersLimit) {
  const HiddenArm arm = hidden_arm(7);
  double before = 0;
  for (const double allowed : {0.5, 1.0, 2.0}) {
    auto bench = simulated_bench(arm.file, 0, false, allowed);
    ASSERT_TRUE(bench.ok()) << bench.error().message;
    double most = 0;
    (*bench)->watch([&most](const driver::TickRecord& tick) {
      most = std::max(most, Eigen::Vector3d(tick.f_wanted_W.data()).norm());
    });
    const std::atomic<bool> never{false};
    const auto motion = record_motion(
        **bench, arm.file, {.seconds = 3, .lead = 0.5, .max_force = allowed, .seed = 7}, never);
    ASSERT_TRUE(motion.ok()) << motion.error().message;
    EXPECT_LE(most, allowed);
    EXPECT_GT(most, before);
    EXPECT_GT(most, 0.6 * allowed);
    before = allowed;
  }
}

TEST(IdentifyForce, LimitMustSuitTheFileAndTheMass) {
  const scene::ArmFile file = scene::load_arm(kArm).value();
  EXPECT_TRUE(check_forces(file, {}).ok());
  EXPECT_TRUE(check_forces(file, {.known_mass = 0.06}).ok());
  EXPECT_TRUE(check_forces(file, {.max_force = file.limits.force_max}).ok());
  EXPECT_TRUE(support::refuses(check_forces(file, {.max_force = 5.1}), "gate.force_max"));
  EXPECT_TRUE(support::refuses(check_forces(file, {.max_force = 0.1}), "at least"));
  EXPECT_TRUE(support::refuses(check_forces(file, {.max_force = std::nan("")}), "at least"));
  EXPECT_TRUE(
      support::refuses(check_forces(file, {.known_mass = 0.04, .max_force = 0.5}), "0.031 kg"));
}

TEST(IdentifyForce, WatchdogPushStaysWithinTheLimit) {
  const HiddenArm arm = hidden_arm(3);
  auto bench = simulated_bench(arm.file, 0);
  ASSERT_TRUE(bench.ok()) << bench.error().message;
  double most = 0;
  (*bench)->watch([&most](const driver::TickRecord& tick) {
    most = std::max(most, Eigen::Vector3d(tick.f_wanted_W.data()).norm());
  });
  const std::atomic<bool> never{false};
  const WatchdogTime found = watchdog_time(**bench,
                                           {.named = 0.1,
                                            .mass = 0.1,
                                            .coulomb = 0.99,
                                            .delay = arm.delay,
                                            .workspace = arm.file.workspace},
                                           arm.file.limits.soft_start, never);
  EXPECT_EQ(found.last.end, WatchdogEnd::kTooMuch);
  EXPECT_EQ(most, 0);
}

}  // namespace
}  // namespace thimble::bringup

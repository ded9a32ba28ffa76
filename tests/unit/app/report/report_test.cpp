#include "report/report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "report/figure_output.h"
#include "support/scratch.h"

namespace thimble::report {
namespace {

using session::Figure;

session::RunFigures example() {
  session::RunFigures report;
  report.scene = "elephant";
  report.object = "elephant";
  report.arm = "vintage_phantom";
  report.virtual_time = false;
  report.seed = 42;
  report.requested_rate = 1000;
  report.force_limit = 5;
  report.triangles = 5558;
  driver::TickRecord record;
  for (int i = 0; i <= 2000; ++i) {
    record.time_ns = record.due_ns = i * 1'000'000LL;
    record.work_ns = 8000;
    record.fresh = true;
    record.in_contact = i >= 500 && i < 1500;
    record.depth = record.in_contact ? 0.001 : 0;
    record.f_sent_W = {0, 0, record.in_contact ? 0.8 : 0};
    report.statistics.take(record);
  }
  report.wire.reports = 2001;
  report.gate.limited = 3;
  return report;
}

nlohmann::json read(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return nlohmann::json::parse(stream);
}

TEST(Report, ContainsTheValuesOfTheRun) {
  const std::filesystem::path folder = support::scratch_folder() / "thimble_report";
  ASSERT_TRUE(write_report(example(), folder).ok());
  const nlohmann::json report = read(folder / "report.json");
  EXPECT_EQ(report["scene"], "elephant");
  EXPECT_EQ(report["arm"]["name"], "vintage_phantom");
  EXPECT_EQ(report["seed"], 42);
  EXPECT_EQ(report["clock"], "wall");
  EXPECT_EQ(report["ticks"], 2001);
  EXPECT_NEAR(report["rate_Hz"]["reached"].get<double>(), 1000, 1e-6);
  EXPECT_EQ(report["period"]["p50"], 1000.0);
  EXPECT_NEAR(report["tick_time"]["p99_9"].get<double>(), 8, 0.008);
  EXPECT_EQ(report["contact"]["touch_downs"], 1);
  EXPECT_EQ(report["contact"]["lost"], 0);
  EXPECT_NEAR(report["contact"]["time_s"].get<double>(), 1, 1e-9);
  EXPECT_NEAR(report["force_N"]["max"].get<double>(), 0.8, 1e-12);
  EXPECT_EQ(report["gate"]["limited"], 3);
  EXPECT_EQ(report["wire"]["reports"], 2001);
  EXPECT_EQ(report["end"]["reason"], "done");
  EXPECT_EQ(report["end"]["fault"], "none");
  EXPECT_FALSE(report["build"]["version"].get<std::string>().empty());
}

TEST(Report, WritesEachFigureWithItsGoal) {
  const std::filesystem::path folder = support::scratch_folder() / "thimble_report";
  session::RunFigures report = example();
  report.lost_contacts = 2;
  ASSERT_TRUE(write_report(report, folder).ok());
  const nlohmann::json figures = read(folder / "figures.json");
  ASSERT_TRUE(figures.is_array());
  const auto named = [&](const std::string& name) {
    const auto found = std::find_if(figures.begin(), figures.end(),
                                    [&](const auto& figure) { return figure["name"] == name; });
    return found == figures.end() ? nlohmann::json() : *found;
  };
  EXPECT_EQ(named("force_max")["goal"], "<= 5");
  EXPECT_EQ(named("force_max")["met"], true);
  EXPECT_EQ(named("lost_contacts")["value"], 2.0);
  EXPECT_EQ(named("lost_contacts")["met"], false);
  EXPECT_FALSE(named("touch_downs").contains("goal"));
}

TEST(Report, SummaryIsPlainText) {
  const std::string text = summary(example());
  EXPECT_NE(text.find(": 1 contact,"), std::string::npos) << text;
  EXPECT_NE(text.find("0.80 N maximum"), std::string::npos) << text;
  EXPECT_NE(text.find("No contact was lost"), std::string::npos) << text;
  const auto lines = std::count(text.begin(), text.end(), '\n');
  EXPECT_GE(lines, 8);
  EXPECT_LE(lines, 12);
}

TEST(Report, SummaryHasTheRmsForceWithoutContact) {
  session::RunFigures report;
  driver::TickRecord record;
  record.f_sent_W = {0, 0, 1.5};
  for (int i = 0; i < 10; ++i) {
    record.time_ns = i * 1'000'000LL;
    report.statistics.take(record);
  }
  const std::string text = summary(report);
  EXPECT_NE(text.find("1.50 N RMS over the run, which had no contact"), std::string::npos) << text;
}

TEST(Report, NamesTheWallThatPushed) {
  session::RunFigures report = example();
  EXPECT_EQ(summary(report).find("Walls"), std::string::npos);
  report.walls = {.pushed = 51, .f_strongest_W = {0, 0, 2.5}};
  const std::string text = summary(report);
  EXPECT_NE(text.find("walls pushed in 51 ticks, with at most 2.50 N (-z wall)"), std::string::npos)
      << text;
  const std::filesystem::path folder = support::scratch_folder() / "thimble_report_walls";
  ASSERT_TRUE(write_report(report, folder).ok());
  EXPECT_EQ(read(folder / "report.json")["walls"],
            nlohmann::json({{"ticks", 51}, {"force_max_N", 2.5}, {"side", "-z"}}));
}

TEST(Report, NamesGravityCompensationThatIsNotTrusted) {
  session::RunFigures report = example();
  report.carried_weight = 0.06;
  EXPECT_EQ(summary(report).find("not trusted"), std::string::npos);
  report.carry_withdrawn = 2;
  const std::string text = summary(report);
  EXPECT_NE(text.find("Gravity   compensation is not trusted: it was switched off 2 times"),
            std::string::npos)
      << text;
  const std::filesystem::path folder = support::scratch_folder() / "thimble_report_carried";
  ASSERT_TRUE(write_report(report, folder).ok());
  const auto carried = read(folder / "report.json")["gravity_compensation"];
  EXPECT_EQ(carried["trusted"], false);
  EXPECT_EQ(carried["withdrawn"], 2);
}

TEST(Report, NamesTheFaultThatEndedIt) {
  session::RunFigures report = example();
  report.end = driver::ServoEnd::kFault;
  report.fault = driver::Fault::kOverSpeed;
  EXPECT_NE(summary(report).find(driver::describe(driver::Fault::kOverSpeed)), std::string::npos);
}

TEST(Report, NamesTheLinkInAdditionToTheFault) {
  session::RunFigures report = example();
  report.end = driver::ServoEnd::kDone;
  EXPECT_EQ(summary(report).find("Link "), std::string::npos);
  report.fault = driver::Fault::kOverSpeed;
  report.link = driver::LinkState::kLost;
  report.home_needed = true;
  EXPECT_NE(summary(report).find("the arm was disconnected at the end"), std::string::npos);
  const std::filesystem::path folder = support::scratch_folder() / "thimble_report_link";
  ASSERT_TRUE(write_report(report, folder).ok());
  const auto end = read(folder / "report.json")["end"];
  EXPECT_EQ(end["fault"], "over_speed");
  EXPECT_EQ(end["link"], "lost");
  EXPECT_EQ(end["home_needed"], true);
}

TEST(Report, WarnsIfZeroForceWasNotAccepted) {
  session::RunFigures report = example();
  report.end = driver::ServoEnd::kDone;
  EXPECT_NE(summary(report).find("the arm accepted zero force."), std::string::npos);
  EXPECT_EQ(summary(report).find("DANGER"), std::string::npos);
  report.zero_assured = false;
  report.fault = driver::Fault::kRefused;
  for (const auto end :
       {driver::ServoEnd::kDone, driver::ServoEnd::kStopped, driver::ServoEnd::kFault}) {
    report.end = end;
    const std::string text = summary(report);
    EXPECT_EQ(text.find("the arm accepted zero force"), std::string::npos);
    EXPECT_NE(text.find("The arm may still apply a force"), std::string::npos);
    EXPECT_NE(text.find(driver::describe(driver::Fault::kRefused)), std::string::npos);
  }
  const std::filesystem::path folder = support::scratch_folder() / "thimble_report_danger";
  ASSERT_TRUE(write_report(report, folder).ok());
  EXPECT_EQ(read(folder / "report.json")["end"]["zero_assured"], false);
}

TEST(Report, ErrorNamesTheFolder) {
  const auto done = write_report(example(), "/proc/no_such_folder");
  ASSERT_FALSE(done.ok());
  EXPECT_NE(done.error().message.find("/proc/no_such_folder"), std::string::npos);
}

TEST(Report, NameMayBeInvalidUtf8) {
  session::RunFigures report = example();
  report.scene = "\xff\xfe";
  const std::filesystem::path folder = support::scratch_folder() / "thimble_report";
  EXPECT_TRUE(write_report(report, folder).ok());
  EXPECT_TRUE(read(folder / "report.json")["scene"].is_string());
}

TEST(Figure, NameMayBeInvalidUtf8) {
  const std::filesystem::path file = support::scratch_folder() / "figures_of_bytes.json";
  ASSERT_TRUE(write_figures({{"bytes_\xff", 1, "", ""}}, file).ok());
  EXPECT_EQ(read(file)[0]["name"], "bytes_\xEF\xBF\xBD");
}

TEST(Figure, MeetsItsGoalOrNot) {
  EXPECT_TRUE((Figure{"a", 5, "N", "<= 5"}.met()));
  EXPECT_FALSE((Figure{"a", 5.001, "N", "<= 5"}.met()));
  EXPECT_TRUE((Figure{"a", 20, "", ">= 20"}.met()));
  EXPECT_FALSE((Figure{"a", 5, "", "< 5"}.met()));
  EXPECT_FALSE((Figure{"a", 5, "", "> 5"}.met()));
  EXPECT_TRUE((Figure{"a", 0, "", "== 0"}.met()));
  EXPECT_TRUE((Figure{"a", 5, "", ""}.met()));
  EXPECT_FALSE((Figure{"a", 5, "", "about 5"}.met()));
  for (const char* goal : {"<= 5", ">= 5", "== 5", "< 5", "> 5"}) {
    EXPECT_FALSE((Figure{"a", std::numeric_limits<double>::quiet_NaN(), "", goal}.met())) << goal;
  }
}

TEST(Figure, LastLineNamesUnmetGoalsWithTheirPlace) {
  const std::vector<Figure> figures{{"edge", 2, "%", "<= 1", "at B = 3 N s/m"},
                                    {"rate", 1, "%", "<= 3", "at 250 Hz"},
                                    {"cycles", 90, "%", ">= 95"},
                                    {"area", std::numeric_limits<double>::quiet_NaN(), "", ""}};
  EXPECT_EQ(
      unmet_line(figures),
      "NOT MET: 2 of 4 figures: edge = 2 % (goal <= 1; at B = 3 N s/m); cycles = 90 % (goal >= "
      "95)");
  EXPECT_EQ(unmet_line({figures[1], figures[3]}), "");
  EXPECT_NE(figure_table(figures).find("met  (at 250 Hz)"), std::string::npos);
}

TEST(Report, SummaryNamesHotMotorsOnly) {
  session::RunFigures report = example();
  report.heat_known = true;
  report.max_heat = 0.7;
  EXPECT_EQ(summary(report).find("Heat"), std::string::npos);
  report.max_heat = 0.93;
  report.heat_lowered = 412;
  EXPECT_NE(summary(report).find("a motor reached 93 % of its limit; force reduced in 412 ticks"),
            std::string::npos);
}

TEST(Report, SummaryNamesTheEnergyStageIfPresent) {
  session::RunFigures report = example();
  EXPECT_EQ(summary(report).find("by the gate"), std::string::npos);
  report.energy_stage = driver::EnergyStage::kPassivity;
  report.gate.min_energy = -0.0031;
  report.gate.damped = 17;
  EXPECT_NE(
      summary(report).find("at most 3.10 mJ given beyond the energy taken; damping in 17 ticks"),
      std::string::npos);
  report.energy_stage = driver::EnergyStage::kBounding;
  report.gate.bounded = 4;
  report.gate.stalls = 1;
  report.reopen = 0.04;
  EXPECT_NE(summary(report).find("force limited in 4 ticks"), std::string::npos);
  EXPECT_NE(summary(report).find("was blocked 1 time; the force returned within 40 ms"),
            std::string::npos);
}

}  // namespace
}  // namespace thimble::report

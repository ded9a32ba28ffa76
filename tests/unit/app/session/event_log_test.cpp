#include "events/event_log.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <fstream>
#include <regex>
#include <string>
#include <thread>
#include <vector>

#include "log/logger.h"
#include "support/scratch.h"
#include "thimble/scene/scene_file.h"
#include "thimble/session/session.h"

// Logs of whole runs.

namespace thimble::session {
namespace {

class EventLogTest : public ::testing::Test {
 protected:
  EventLogTest() {
    std::filesystem::remove(file_);
    EXPECT_TRUE(scene::begin_log({.verbosity = verbosity_, .file = file_, .heading = "test"}));
    options_.log = true;
    options_.duration = 1;
  }

  std::unique_ptr<Session> open() {
    auto session = Session::open(
        std::string(THIMBLE_SOURCE_DIR) + "/tests/data/scenes/two_boxes.yaml", options_);
    EXPECT_TRUE(session) << session.error().message;
    return session ? std::move(session).value() : nullptr;
  }

  /// Returns the log of the run without the time of day.
  std::vector<std::string> log() const {
    std::ifstream in(file_);
    std::vector<std::string> lines;
    const std::regex head(R"(^\S+ (\w+) +\d+ two_boxes: )");
    for (std::string line; std::getline(in, line);) {
      std::smatch found;
      if (std::regex_search(line, found, head))
        lines.push_back(found.str(1) + " " + found.suffix().str());
    }
    return lines;
  }

  scene::Verbosity verbosity_ = scene::Verbosity::kNormal;
  std::filesystem::path file_ = support::scratch_folder() / "events.log";
  SessionOptions options_;
  std::atomic<bool> stop_{false};
};

TEST_F(EventLogTest, LogsAFaultInVirtualTime) {
  auto session = open();
  ASSERT_TRUE(session);
  // Far above the arm's limit, and NaN after half a second.
  const auto law = [](const driver::DeviceState& state) noexcept {
    driver::ForceCommand command;
    command.f_T_W = {0, 0, state.tick < 500 ? 100.0 : std::nan("")};
    return command;
  };
  ASSERT_TRUE(session->set_law(driver::ForceLaw(law)));
  EXPECT_EQ(session->run(stop_), driver::ServoEnd::kFault);
  session.reset();
  const auto lines = log();
  const std::vector<std::string> begin = {
      "info The arm is open: .* \\(sim\\) runs two_boxes at 1000 Hz in virtual time\\.",
      "info Active limits: 5 N, 3 m/s, mean power 1 W over 2 s, rise 2000 N/s, soft start 0\\.3 "
      "s .*, energy stage .*, "
      "walls "
      "of 200 N/m from \\(-110, -110, -110\\) to \\(110, 110, 110\\) mm .*, enabling input: none, "
      "feel check: simulated\\.",
      "info tick 0, 0\\.000 s: Forces are enabled\\.",
      "debug tick 0, 0\\.000 s: The soft start limits the force\\.",
  };
  ASSERT_GT(lines.size(), begin.size());
  for (std::size_t i = 0; i < begin.size(); ++i) {
    EXPECT_TRUE(std::regex_match(lines[i], std::regex(begin[i]))) << lines[i];
  }
  const auto count = [&lines](const std::string& words) {
    return std::count_if(lines.begin(), lines.end(), [&words](const std::string& line) {
      return std::regex_search(line, std::regex(words));
    });
  };
  EXPECT_EQ(count("^info tick \\d+, .* s: The force is limited to the arm's maximum\\.$"), 1);
  EXPECT_EQ(
      count("^info tick 500, 0\\.500 s: The force was limited to the arm's maximum \\d+ times"), 1);
  EXPECT_EQ(count("^error tick 500, 0\\.500 s: Force is off \\(force_not_finite\\)\\. "), 1);
  EXPECT_EQ(count("^error "), 1);
  EXPECT_EQ(lines.back(), "info The run is over; the arm accepted zero force.");
}

TEST_F(EventLogTest, LogsNothingIfDisabled) {
  options_.log = false;
  auto session = open();
  ASSERT_TRUE(session);
  session->run(stop_);
  session.reset();
  EXPECT_TRUE(log().empty());
}

TEST_F(EventLogTest, RealTimeEventsKeepTheirTime) {
  options_.clock = ClockKind::kWall;
  options_.duration = 0.3;
  auto session = open();
  ASSERT_TRUE(session);
  const auto begun = std::chrono::system_clock::now();
  session->run(stop_);
  const auto passed = std::chrono::system_clock::now() - begun;
  session.reset();
  const auto lines = log();
  ASSERT_GE(lines.size(), 4u);
  EXPECT_EQ(lines[1].rfind("info Active limits: ", 0), 0u) << lines[1];
  EXPECT_EQ(lines[2].rfind("info tick 0, ", 0), 0u) << lines[2];
  EXPECT_EQ(lines.back(), "info The run is over; the arm accepted zero force.");
  EXPECT_GT(passed, std::chrono::milliseconds(290));
}

TEST_F(EventLogTest, RealTimeEventsAreLoggedDuringTheRun) {
  options_.clock = ClockKind::kWall;
  options_.duration = 30;
  auto session = open();
  ASSERT_TRUE(session);
  std::thread servo([&] { session->run(stop_); });
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  bool logged = false;
  while (!logged && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    for (const std::string& line : log()) logged |= line.rfind("info tick 0, ", 0) == 0;
  }
  EXPECT_TRUE(logged);
  stop_.store(true);
  servo.join();
}

TEST_F(EventLogTest, DoesNotChangeForces) {
  std::vector<std::array<double, 3>> forces[2];
  for (const bool logged : {false, true}) {
    options_.log = logged;
    auto session = open();
    ASSERT_TRUE(session);
    session->run(stop_);
    for (const driver::TickRecord& row : session->ticks()) {
      forces[logged ? 1 : 0].push_back(row.f_sent_W);
    }
  }
  EXPECT_EQ(forces[0].size(), 1000u);
  EXPECT_EQ(forces[0], forces[1]);
}

TEST_F(EventLogTest, ReportsTheNumberOfLostEvents) {
  auto session = open();
  ASSERT_TRUE(session);
  {
    // In real time the writer checks every 50 ms. Meanwhile the tip chatters for 8 s of ticks.
    EventLog log({.name = "two_boxes", .what = "a test", .objects = {}, .real_time = true},
                 session->device());
    driver::TickRecord record;
    for (std::size_t i = 0; i < 50 * EventLog::kRingEvents; ++i) {
      record.in_contact = !record.in_contact;
      record.tick = i;
      log.take(record);
    }
  }
  const auto lines = log();
  const std::regex lacks(R"(^warning (\d+) events were lost because the log could not keep up\.)");
  std::size_t missing = 0;
  for (const std::string& line : lines) {
    std::smatch found;
    if (std::regex_search(line, found, lacks)) missing += std::stoul(found.str(1));
  }
  EXPECT_GT(missing, 0u);
  EXPECT_LT(missing, 50 * EventLog::kRingEvents);
}

}  // namespace
}  // namespace thimble::session

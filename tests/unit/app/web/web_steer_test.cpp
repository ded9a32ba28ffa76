// Commands of a page to a run, without a network.
#include <gtest/gtest.h>

#include <string>

#include "live_updates.h"
#include "share/shared_reader.h"
#include "share/shared_run.h"
#include "web/live_feed.h"
#include "web/request_guard.h"
#include "web/steer_run.h"

namespace thimble::web {
namespace {

/// Run that accepts all commands of pages, unless `scene` prevents it.
struct Steered {
  explicit Steered(session::SharedScene scene = steered_scene())
      : run(session::SharedRun::create("", scene, 100).value()),
        reader(session::SharedReader::over(run->memory().again().value()).value()) {
    run->set_state(session::RunState::kRunning);
  }
  static session::SharedScene steered_scene() {
    session::SharedScene scene = live_scene();
    scene.restarts = true;
    scene.knobs.push_back({"clay: stiffness", "N/m", 10, 1000, 300});
    return scene;
  }
  /// Returns the reason why a request is refused; empty if it is accepted.
  std::string ask(const std::string& words) const {
    const auto asked = steer_run(*reader, words);
    return asked ? std::string() : asked.error().message;
  }

  std::unique_ptr<session::SharedRun> run;
  std::unique_ptr<session::SharedReader> reader;
};

TEST(SteerRun, PausesStepsRestartsAndChangesKnobs) {
  const Steered steered;
  EXPECT_EQ(steered.ask("pause"), "");
  EXPECT_TRUE(steered.run->pause_asked());
  EXPECT_NE(steered.ask("step 3").find("pause it first"), std::string::npos)
      << "the run is not paused";
  steered.run->set_state(session::RunState::kPaused);
  EXPECT_EQ(steered.ask("step 3"), "");
  EXPECT_EQ(steered.run->steps_asked(), 3U);
  EXPECT_EQ(steered.ask("resume"), "");
  EXPECT_FALSE(steered.run->pause_asked());
  EXPECT_EQ(steered.ask("turn clay: stiffness=250.5"), "");
  EXPECT_EQ(steered.run->knob_wanted(0), 250.5);
  EXPECT_EQ(steered.ask("restart"), "");
  ASSERT_TRUE(steered.run->restart_request_after(0));
  EXPECT_EQ(steered.run->restart_request_after(0)->scene, "") << "no page names a file";
}

TEST(SteerRun, RejectsUnsupportedRequests) {
  const Steered steered;
  for (const char* words :
       {"", " ", "stop", "pause now", "restart /etc/passwd", "step", "step ", "step -1", "step 1x",
        "step 99999999999999999999", "Pause", "turn", "turn clay: stiffness=1e9",
        "turn clay: stiffness=nan", "turn clay: colour=1", "turn =", "record x.h5"}) {
    EXPECT_NE(steered.ask(words), "") << words;
  }
  EXPECT_FALSE(steered.run->pause_asked());
  EXPECT_FALSE(steered.run->stop_asked());
  EXPECT_FALSE(steered.run->restart_request_after(0));
  EXPECT_EQ(steered.run->steps_asked(), 0U);
  EXPECT_EQ(steered.run->knob_wanted(0), 300);

  session::SharedScene real = Steered::steered_scene();
  real.arms.front().device = "omega3";
  const Steered desk(real);
  EXPECT_NE(desk.ask("restart").find("physical arm (omega3)"), std::string::npos);
  EXPECT_NE(desk.ask("step 1").find("physical arm (omega3)"), std::string::npos);
  EXPECT_FALSE(desk.run->restart_request_after(0));
  EXPECT_EQ(desk.ask("pause"), "") << "a physical arm's run can be paused";

  steered.run->close();
  for (const char* words : {"pause", "restart", "turn clay: stiffness=20"}) {
    EXPECT_NE(steered.ask(words).find("accepts no requests"), std::string::npos) << words;
  }
  desk.run->set_state(session::RunState::kEnded);
  EXPECT_EQ(desk.ask("pause"), "The run has ended.");
}

TEST(SteerRun, PagesShowKnobsAndTheNotice) {
  const Steered steered;
  LiveFeed feed(*steered.reader);
  LiveFeed::Place place;
  feed.step();
  steered.reader->turn_knob(0, 77);
  steered.run->set_notice("line 3: wrong");
  feed.step();
  const auto updates = updates_of(feed.message(place));
  ASSERT_FALSE(updates.empty());
  const nlohmann::json& last = updates.back().json;
  EXPECT_EQ(last["knobs"], nlohmann::json::array({77.0})) << "reported without a new tick";
  EXPECT_EQ(last["notice"], "line 3: wrong");
}

TEST(RequestGuard, ChangesNeedTheTokenAndTheServedPage) {
  const RequestGuard guard = RequestGuard::make().value();
  const std::string& token = guard.token();
  const RequestGuard::Request good{"/steer", "127.0.0.1:8080", "http://127.0.0.1:8080", token};
  const auto refused = [&](const RequestGuard::Request& request) {
    return !guard.refuse_change(request, "/steer", 8080).empty();
  };
  EXPECT_FALSE(refused(good));
  RequestGuard::Request other = good;
  for (const char* origin : {"", "null", "http://evil.example", "http://localhost:8080"}) {
    other.origin = origin;
    EXPECT_TRUE(refused(other)) << origin;
  }
  other = good;
  other.host = "evil.example:8080";
  EXPECT_TRUE(refused(other));
  other = good;
  other.token = {};
  const std::string with_token = "/steer?token=" + token;
  for (const std::string_view target : {std::string_view("/steer"), std::string_view(with_token)}) {
    other.target = target;
    EXPECT_TRUE(refused(other)) << "a token in the address is none";
  }
  other = good;
  other.target = "/";
  EXPECT_TRUE(refused(other));
}

}  // namespace
}  // namespace thimble::web

#include "view/start/run_again.h"

#include <gtest/gtest.h>

#include <memory>

#include "share/shared_run.h"

namespace thimble::view {
namespace {

/// A run whose knobs a viewer can turn.
struct KnobRun {
  explicit KnobRun(const std::vector<std::string>& names) {
    session::SharedScene scene;
    scene.period_ns = 1'000'000;
    for (const std::string& name : names) {
      session::SharedScene::Knob knob;
      knob.name = name;
      knob.min = 1;
      knob.max = 9;
      knob.initial = 5;
      scene.knobs.push_back(knob);
    }
    run = session::SharedRun::create("", scene, 8).value();
    reader = session::SharedReader::over(run->memory().again().value()).value();
  }
  std::unique_ptr<session::SharedRun> run;
  std::unique_ptr<session::SharedReader> reader;
};

TEST(RunAgain, KeepsOptionsAndName) {
  EXPECT_EQ(run_again_command({"run", "/a.yaml", "--no-view", "--seed=7"}, "", "me"),
            (std::vector<std::string>{"run", "/a.yaml", "--no-view", "--seed=7", "--name=me"}));
}

TEST(RunAgain, RunsTheSceneThatWasShownLast) {
  EXPECT_EQ(run_again_command({"run", "/a.yaml"}, "/x/../b c.yaml", "me"),
            (std::vector<std::string>{"run", "/b c.yaml", "--name=me"}));
}

TEST(RunAgain, SceneFileIsNeverAnOption) {
  const auto words = run_again_command({"run", "/a.yaml"}, "--yes", "me");
  EXPECT_TRUE(words[1].starts_with("/")) << words[1];
}

TEST(RunAgain, KeepsOnlyChangedKnobs) {
  const KnobRun before({"one", "two", "gone"});
  before.reader->turn_knob(1, 7);
  before.reader->turn_knob(2, 8);
  const auto knobs = changed_knobs(*before.reader);
  ASSERT_EQ(knobs.size(), 2u);
  EXPECT_EQ(knobs[0].name, "two");
  EXPECT_EQ(knobs[0].value, 7);
}

TEST(RunAgain, TurnsKnobsByName) {
  const KnobRun after({"two", "one"});
  turn_knobs(*after.reader, {{"gone", 8}, {"two", 7}});
  EXPECT_EQ(after.reader->knob_wanted(0), 7);
  EXPECT_EQ(after.reader->knob_wanted(1), 5);
}

}  // namespace
}  // namespace thimble::view

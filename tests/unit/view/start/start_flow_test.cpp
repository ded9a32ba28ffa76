#include "view/start/start_flow.h"

#include <gtest/gtest.h>

namespace thimble::view {
namespace {

StartFlow shown_flow() {
  StartFlow flow;
  flow.run_started();
  flow.shown();
  return flow;
}

TEST(StartFlow, ShowsCardsUntilTheRunCanBeShown) {
  StartFlow flow;
  EXPECT_EQ(flow.stage(), StartStage::kChoosing);
  flow.run_started();
  EXPECT_EQ(flow.stage(), StartStage::kStarting);
  flow.shown();
  EXPECT_EQ(flow.stage(), StartStage::kShown);
}

TEST(StartFlow, ReturnsToCardsWithTheErrorOfARunThatFails) {
  StartFlow flow;
  flow.run_started();
  flow.run_ended(2, "warning\nthimble: box.yaml:3: unknown key \"mesch\".\n\n");
  EXPECT_EQ(flow.stage(), StartStage::kChoosing);
  EXPECT_EQ(flow.message(), "box.yaml:3: unknown key \"mesch\".");
}

TEST(StartFlow, NamesTheExitCodeOfARunWithoutAMessage) {
  StartFlow flow;
  flow.run_started();
  flow.run_ended(139, "");
  EXPECT_NE(flow.message().find("139"), std::string::npos);
}

TEST(StartFlow, KeepsShowingARunThatHasEnded) {
  StartFlow flow = shown_flow();
  flow.run_ended(0, "");
  EXPECT_EQ(flow.stage(), StartStage::kShown);
  EXPECT_EQ(flow.message(), "");
}

TEST(StartFlow, RestartsOnlyARunThatHasEnded) {
  StartFlow flow = shown_flow();
  EXPECT_FALSE(flow.run_again());
  flow.run_ended(0, "");
  EXPECT_TRUE(flow.run_again());
}

TEST(StartFlow, KeepsThePictureDuringARestart) {
  StartFlow flow = shown_flow();
  flow.run_ended(0, "");
  flow.run_started();
  EXPECT_EQ(flow.stage(), StartStage::kShown);
  EXPECT_FALSE(flow.run_again()) << "it is running";
}

TEST(StartFlow, ReportsARestartThatFailsBesideThePicture) {
  StartFlow flow = shown_flow();
  flow.run_ended(0, "");
  flow.run_started();
  flow.run_ended(2, "thimble: the scene is gone.");
  EXPECT_EQ(flow.stage(), StartStage::kShown);
  EXPECT_EQ(flow.message(), "the scene is gone.");
  EXPECT_TRUE(flow.run_again());
}

TEST(StartFlow, EndsTheRunOnTheWayBack) {
  StartFlow running = shown_flow();
  EXPECT_TRUE(running.back());
  EXPECT_EQ(running.stage(), StartStage::kChoosing);
  StartFlow ended = shown_flow();
  ended.run_ended(0, "");
  EXPECT_FALSE(ended.back());
  EXPECT_FALSE(ended.run_again());
}

TEST(StartFlow, IgnoresTheEndOfARunThatWasLeft) {
  StartFlow flow = shown_flow();
  flow.back();
  flow.run_ended(130, "interrupted");
  EXPECT_EQ(flow.message(), "");
}

TEST(StartFlow, WaitsForARunOfAnotherProcess) {
  StartFlow flow = StartFlow::waiting();
  flow.other_run_over(true);
  EXPECT_EQ(flow.stage(), StartStage::kWaiting);
  EXPECT_FALSE(flow.run_again()) << "no run was shown";
  flow.shown();
  EXPECT_EQ(flow.stage(), StartStage::kShown);
  EXPECT_FALSE(flow.run_again()) << "it has not ended";
}

TEST(StartFlow, RestartsARunOfAnotherProcessAfterItsEnd) {
  StartFlow flow = StartFlow::waiting();
  flow.shown();
  flow.other_run_over(false);
  EXPECT_FALSE(flow.run_again());
  flow.other_run_over(true);
  EXPECT_TRUE(flow.run_again());
  flow.run_started();
  flow.other_run_over(true);
  EXPECT_FALSE(flow.run_again()) << "its successor is running";
  flow.run_ended(0, "");
  EXPECT_TRUE(flow.run_again());
}

TEST(StartFlow, NoRestartIfTheNextRunOfAnotherProcessIsShown) {
  StartFlow flow = StartFlow::waiting();
  flow.shown();
  flow.other_run_over(true);
  flow.other_run_over(false);
  EXPECT_FALSE(flow.run_again());
}

}  // namespace
}  // namespace thimble::view

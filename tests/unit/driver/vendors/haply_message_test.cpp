#include "vendors/haply/haply_message.h"
#include "support/seed.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

namespace thimble::driver::haply {
namespace {

const std::string kState =
    R"({"inverse3":[{"device_id":"049D","state":{"cursor_position":{"x":0.01,"y":-0.12,"z":0.15},)"
    R"("cursor_velocity":{"x":1,"y":-2,"z":3.5}},"status":{"calibrated":true}}],)"
    R"("verse_grip":[{"state":{"orientation":{"x":0,"y":0,"z":0,"w":1},"button":true,"hall":3}}]})";

TEST(HaplyMessage, ReadsAState) {
  ArmState state;
  ASSERT_EQ(read_state(kState, "049D", state), StateRead::kOk);
  EXPECT_EQ(state.p_BT, Eigen::Vector3d(0.01, -0.12, 0.15));
  EXPECT_EQ(state.v_BT, Eigen::Vector3d(1, -2, 3.5));
  EXPECT_TRUE(state.has_grip);
  EXPECT_EQ(state.buttons, 1);
  EXPECT_TRUE(state.R_BT.isIdentity());
}

TEST(HaplyMessage, IdentifiesAnArmByItsIdOnly) {
  ArmState state;
  EXPECT_EQ(read_state(kState, "049E", state), StateRead::kGone);
  EXPECT_EQ(read_state(R"({"inverse3":[]})", "049D", state), StateRead::kGone);
  // A message about another device contains nothing about the arm.
  EXPECT_EQ(read_state(R"({"event":"battery"})", "049D", state), StateRead::kRejected);
  EXPECT_EQ(read_state("[]", "049D", state), StateRead::kRejected);
  EXPECT_EQ(read_state("", "049D", state), StateRead::kRejected);
}

TEST(HaplyMessage, RejectsImpossibleNumbers) {
  const auto with = [](const std::string& from, const std::string& to) {
    std::string text = kState;
    return text.replace(text.find(from), from.size(), to);
  };
  const std::string wrong[] = {with("0.01", "NaN"),
                               with("0.01", "1e999"),
                               with("0.01", "null"),
                               with("0.01", "\"0.01\""),
                               with("0.01", "10"),
                               with("3.5", "3500"),
                               with("\"y\":-2,", ""),
                               with("cursor_position", "position"),
                               with("\"calibrated\":true", "\"calibrated\":false"),
                               with("\"calibrated\":true", "\"ready\":false"),
                               with("\"w\":1", "\"w\":0"),
                               with("\"w\":1", "\"w\":7")};
  for (const std::string& text : wrong) {
    ArmState state;
    state.p_BT = {1, 2, 3};
    EXPECT_EQ(read_state(text, "049D", state), StateRead::kRejected) << text;
    EXPECT_EQ(state.p_BT, Eigen::Vector3d(1, 2, 3)) << text;
    EXPECT_FALSE(state.has_grip) << text;
  }
}

TEST(HaplyMessage, AcceptsOrRejectsAnyDamagedMessage) {
  std::mt19937 random(static_cast<std::uint32_t>(support::seed_of(7)));
  std::uniform_int_distribution<std::size_t> place(0, kState.size() - 1);
  std::uniform_int_distribution<int> byte(0, 255);
  for (int i = 0; i < 20'000; ++i) {
    std::string text = kState.substr(0, i % 3 == 0 ? place(random) : kState.size());
    for (int k = 0; k < i % 5 && !text.empty(); ++k) {
      text[place(random) % text.size()] = static_cast<char>(byte(random));
    }
    ArmState state;
    const StateRead read = read_state(text, "049D", state);
    EXPECT_TRUE(state.p_BT.allFinite() && state.R_BT.allFinite());
    if (read != StateRead::kOk) {
      EXPECT_TRUE(state.p_BT.isZero(0));
    }
    (void)read_first(text);
  }
}

TEST(HaplyMessage, RequestsAForceInBothSpellings) {
  EXPECT_EQ(force_message("049D", {0.25, -1, 0}),
            R"({"inverse3":[{"device_id":"049D","commands":{"set_cursor_force":{)"
            R"("vector":{"x":0.250000,"y":-1.000000,"z":0.000000},)"
            R"("values":{"x":0.250000,"y":-1.000000,"z":0.000000}}}}]})");
}

}  // namespace
}  // namespace thimble::driver::haply

#include "hand/button_plan.h"

#include <gtest/gtest.h>

namespace thimble::scene {
namespace {

TEST(ButtonPlan, ReadsAPress) {
  const auto press = read_button_press("1.5:2:0.3");
  ASSERT_TRUE(press);
  EXPECT_EQ(press->begin, 1.5);
  EXPECT_EQ(press->buttons, 2);
  EXPECT_EQ(press->duration, 0.3);
  EXPECT_EQ(read_button_press("3")->buttons, 1);
  EXPECT_EQ(read_button_press("3:16")->buttons, 0x8000);
}

TEST(ButtonPlan, RefusesWhatIsNoPress) {
  for (const char* bad : {"", "x", "-1", "1:", "1:0", "1:17", "1:1:0", "1:1:-1", "1:1:1:1", "1 2",
                          "nan", "1e9", "1:1:inf"}) {
    EXPECT_FALSE(read_button_press(bad)) << bad;
  }
}

TEST(ButtonPlan, PressesAddToTheButtonsOfTheHandsFile) {
  const std::vector<ButtonPress> presses = {{.begin = 0.15, .duration = 0.1, .buttons = 4},
                                            {.begin = 0.2, .duration = 0.2, .buttons = 8}};
  ButtonPlan plan(steps_of(presses, {{0.1, 1}, {0.3, 2}}));
  for (const auto& [time, buttons] :
       {std::pair(0.0, 0), {0.1, 1}, {0.15, 5}, {0.22, 13}, {0.26, 9}, {0.3, 10}, {0.41, 2}}) {
    EXPECT_EQ(plan.at(time), buttons) << time;
  }
}

TEST(ButtonPlan, WithoutStepsNoButtonIsHeld) {
  ButtonPlan plan(steps_of({}));
  EXPECT_TRUE(plan.empty());
  EXPECT_EQ(plan.at(1), 0);
}

}  // namespace
}  // namespace thimble::scene

#include "view/compare/run_list.h"

#include <gtest/gtest.h>

#include "../screenless.h"
#include "view/compare/run_colours.h"

namespace thimble::view {
namespace {

Comparison three() {
  Comparison comparison;
  for (const char* name : {"a.h5", "b.h5", "c.h5"}) {
    ComparedRun& run = comparison.runs.emplace_back();
    run.name = name;
    run.colour = kRunColours[comparison.runs.size() - 1];
  }
  comparison.runs[1].ended = true;
  comparison.runs[1].end = 1.25;
  return comparison;
}

TEST(RunLines, NameTheRecordingsOfThePicture) {
  Comparison comparison = three();
  comparison.runs[2].in_picture = false;
  const auto lines = run_lines(comparison);
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0].text, "a.h5");
  EXPECT_EQ(lines[0].colour, kRunColours[0]);
  EXPECT_EQ(lines[1].text, "b.h5, ended");
  EXPECT_EQ(lines[1].colour, ended_colour(kRunColours[1]));
}

TEST(RunLines, AreAbsentForOneRecording) {
  Comparison comparison = three();
  comparison.runs.resize(1);
  EXPECT_TRUE(run_lines(comparison).empty());
}

TEST(RunLines, KeepTheEndOfALongName) {
  Comparison comparison = three();
  comparison.runs[0].name = std::string(100, 'x') + "/trial_7.h5";
  const std::string text = run_lines(comparison)[0].text;
  EXPECT_LE(text.size(), 40U);
  EXPECT_EQ(text.substr(0, 3), "...");
  EXPECT_EQ(text.substr(text.size() - 10), "trial_7.h5");
}

class RunList : public Screenless {
 protected:
  RunList() : Screenless(380, 200) {}

  static void click(Comparison& comparison, const ImVec2& mouse) {
    for (const bool down : {false, false, true, false}) {
      frame(mouse, down, 0, [&] {
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize({380, 200});
        ImGui::Begin("panel", nullptr, ImGuiWindowFlags_NoDecoration);
        draw_run_list(comparison);
        ImGui::End();
      });
    }
  }
  /// The middle of the radio button of a row.
  static ImVec2 radio(int row) {
    const ImGuiStyle& style = ImGui::GetStyle();
    const float side = ImGui::GetFontSize() + 2 * style.FramePadding.y;
    return {style.WindowPadding.x + 0.5F * side,
            style.WindowPadding.y + 0.5F * side +
                static_cast<float>(row) * (side + style.ItemSpacing.y)};
  }
};

TEST_F(RunList, ClickChoosesTheSceneIfScenesDiffer) {
  Comparison comparison = three();
  click(comparison, radio(1));
  EXPECT_EQ(comparison.wanted, std::nullopt);
  comparison.runs[2].in_picture = false;
  click(comparison, radio(1));
  EXPECT_EQ(comparison.wanted, std::optional<std::size_t>(1));
}

}  // namespace
}  // namespace thimble::view

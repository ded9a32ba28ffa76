#include "view/start/wait_page.h"

#include <epoxy/gl.h>
// After the header above, which includes OpenGL.
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>
#include <imgui_internal.h>

#include "../screenless.h"

namespace thimble::view {
namespace {

class WaitPage : public Screenless {
 protected:
  WaitPage() : Screenless(960, 640) {}

  static WaitRequest draw(const ImVec2& mouse, bool left, const std::vector<int>& keys,
                          const std::string& trouble = {}) {
    WaitRequest request = WaitRequest::kNone;
    frame(mouse, left, 0, [&] {
      request = draw_wait_page({0, 0, 960, 640}, "part", trouble, keys);
    });
    return request;
  }
  /// Returns the height of the content of the page.
  static float height() { return ImGui::FindWindowByName("waiting for a run")->ContentSizeIdeal.y; }
};

TEST_F(WaitPage, FillsTheWindow) {
  draw({-1, -1}, false, {});
  const ImGuiWindow* const window = ImGui::FindWindowByName("waiting for a run");
  ASSERT_NE(window, nullptr);
  EXPECT_EQ(window->Size.x, 960);
  EXPECT_EQ(window->Size.y, 640);
}

TEST_F(WaitPage, EnterOpensTheScenes) {
  EXPECT_EQ(draw({-1, -1}, false, {GLFW_KEY_A}), WaitRequest::kNone);
  EXPECT_EQ(draw({-1, -1}, false, {GLFW_KEY_ENTER}), WaitRequest::kScenes);
}

TEST_F(WaitPage, QClosesTheWindow) {
  EXPECT_EQ(draw({-1, -1}, false, {GLFW_KEY_Q}), WaitRequest::kClose);
}

TEST_F(WaitPage, ButtonOpensTheScenes) {
  bool opened = false;
  // The button is below the sentences, in the middle column.
  for (float y = 220; y < 620 && !opened; y += 8) {
    for (const bool down : {false, true, false}) {
      opened = draw({300, y}, down, {}) == WaitRequest::kScenes || opened;
    }
  }
  EXPECT_TRUE(opened);
}

TEST_F(WaitPage, ShowsWhyTheRunCannotBeRead) {
  draw({-1, -1}, false, {});
  draw({-1, -1}, false, {});
  const float without = height();
  draw({-1, -1}, false, {}, "The run is of another version.");
  draw({-1, -1}, false, {}, "The run is of another version.");
  EXPECT_GT(height(), without + 10);
}

}  // namespace
}  // namespace thimble::view

#include "view/start/start_page.h"

#include <epoxy/gl.h>
// After the header above, which includes OpenGL.
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include "../screenless.h"

namespace thimble::view {
namespace {

StartModel model_with(std::size_t recent, std::size_t shipped) {
  StartModel model;
  const auto cards = [](const char* title, std::size_t count) {
    StartGroup group{title, {}};
    for (std::size_t i = 0; i < count; ++i) {
      const std::string name = title + std::to_string(i);
      group.entries.push_back({.name = name,
                               .file = "/" + name + ".yaml",
                               .scene = "/" + name + ".yaml",
                               .about = "about " + name});
    }
    return group;
  };
  model.groups = {cards("recent", recent), cards("shipped", shipped)};
  model.hand = HandSource::kMouse;
  return model;
}

class StartPageDrawn : public Screenless {
 protected:
  StartPageDrawn() : Screenless(1280, 800) {}

  StartRequest draw(const ImVec2& mouse, bool left, const std::vector<int>& keys, StartModel& model,
                    float width = 1280, float height = 800) {
    StartRequest request = StartRequest::kNone;
    frame(mouse, left, 0, [&] {
      request = page_.draw(
          {0, 0, width, height}, 1, keys,
          [this](const StartEntry&) {
            ++pictures_;
            return 0U;
          },
          model);
    });
    return request;
  }

  StartPage page_;
  int pictures_ = 0;
};

TEST_F(StartPageDrawn, AsksForPicturesOfVisibleCardsOnly) {
  StartModel model = model_with(2, 300);
  draw({-1, -1}, false, {}, model);
  draw({-1, -1}, false, {}, model);
  pictures_ = 0;
  draw({-1, -1}, false, {}, model);
  EXPECT_GE(pictures_, 4);
  EXPECT_LT(pictures_, 60);
}

TEST_F(StartPageDrawn, ClickSelectsACard) {
  StartModel model = model_with(0, 12);
  model.groups.erase(model.groups.begin());
  model.selected = {0, 5};
  for (const bool down : {false, true, false}) draw({100, 200}, down, {}, model);
  EXPECT_EQ(model.selected, (CardPlace{0, 0}));
}

TEST_F(StartPageDrawn, EnterRunsAndArrowsSelect) {
  StartModel model = model_with(2, 12);
  draw({-1, -1}, false, {}, model);
  EXPECT_EQ(draw({-1, -1}, false, {GLFW_KEY_RIGHT}, model), StartRequest::kNone);
  EXPECT_EQ(model.selected, (CardPlace{0, 1}));
  EXPECT_EQ(draw({-1, -1}, false, {GLFW_KEY_ENTER}, model), StartRequest::kRun);
}

TEST_F(StartPageDrawn, SelectedMeshIsMadeAScene) {
  StartModel model = model_with(2, 1);
  model.groups[0].entries[1].kind = FileKind::kMesh;
  EXPECT_EQ(draw({-1, -1}, false, {GLFW_KEY_RIGHT}, model), StartRequest::kMakeScene);
}

TEST_F(StartPageDrawn, EscapeCancelsARunThatStarts) {
  StartModel model = model_with(2, 1);
  EXPECT_EQ(draw({-1, -1}, false, {GLFW_KEY_ESCAPE}, model), StartRequest::kNone);
  model.starting = true;
  EXPECT_EQ(draw({-1, -1}, false, {GLFW_KEY_ESCAPE}, model), StartRequest::kCancel);
}

TEST_F(StartPageDrawn, IsDrawnInAnySizeAndWithoutCards) {
  StartModel model;
  for (const float width : {1.0F, 300.0F, 2500.0F}) {
    for (const float height : {1.0F, 200.0F, 1500.0F}) {
      EXPECT_EQ(draw({-1, -1}, false, {GLFW_KEY_DOWN}, model, width, height), StartRequest::kNone);
    }
  }
}

TEST(StartModel, KeepsTheSelectedFileWhenCardsChange) {
  StartModel model = model_with(0, 3);
  model.selected = {1, 2};
  model.set_groups(model_with(2, 3).groups);
  ASSERT_NE(model.entry(), nullptr);
  EXPECT_EQ(model.entry()->name, "shipped2");
  model.set_groups(model_with(1, 1).groups);
  EXPECT_EQ(model.selected, CardPlace());
}

TEST(StartModel, SeveralArmsFollowTheirPaths) {
  StartModel model = model_with(1, 0);
  StartEntry entry = *model.entry();
  EXPECT_EQ(hand_for(model, entry), HandSource::kMouse);
  entry.several_arms = true;
  EXPECT_EQ(hand_for(model, entry), std::nullopt);
}

}  // namespace
}  // namespace thimble::view

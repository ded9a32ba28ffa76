#include "view/knob_panel.h"

#include <gtest/gtest.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "share/shared_run.h"
#include "view/side_panel.h"

#include "clockwork.h"
#include "screenless.h"

namespace thimble::view {
namespace {

class SidePanel : public Screenless {
 protected:
  SidePanel() : Screenless(600, 100) {}

  /// Presses the mouse on the slider, at a share of its length from the left, and returns the
  /// value.
  static double pressed(const session::SharedScene::Knob& knob, float share) {
    double value = knob.initial;
    for (int i = 0; i < 4; ++i) {
      // The grab is a few points wide, and its middle follows the mouse.
      frame({16 + share * 500, 50}, i > 1, 0, [&] {
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize({600, 100});
        ImGui::Begin("panel", nullptr, ImGuiWindowFlags_NoDecoration);
        ImGui::SetCursorPos({16, 42});
        ImGui::SetNextItemWidth(500);
        knob_slider(knob, value);
        ImGui::End();
      });
    }
    return value;
  }
};

session::SharedScene::Knob knob(double min, double max) {
  session::SharedScene::Knob made;
  made.name = "one";
  made.unit = "m";
  made.min = min;
  made.max = max;
  made.initial = min;
  return made;
}

TEST_F(SidePanel, WideKnobIsLogarithmic) {
  for (const double least : {1e-2, 1e-5, 2e-7, 1e-9}) {
    const auto wide = knob(least, 1000 * least);
    for (const float share : {0.25F, 0.5F, 0.75F}) {
      EXPECT_NEAR(std::log10(pressed(wide, share) / least), 3 * share, 0.1) << least;
    }
  }
}

TEST_F(SidePanel, NarrowKnobIsLinear) {
  EXPECT_NEAR(pressed(knob(0, 2000), 0.25F), 500, 20);
  EXPECT_NEAR(pressed(knob(100, 300), 0.5F), 200, 4);
  EXPECT_EQ(pressed(knob(100, 300), 0.999F), 300);
}

TEST_F(SidePanel, KnobHasAReadableUnit) {
  auto rough = knob(1e-6, 1e-4);
  EXPECT_EQ(knob_text(rough, 2e-5), "20 um");
  rough.unit = "N/m";
  EXPECT_EQ(knob_text(rough, 2e-5), "2e-05 N/m");
  rough.unit = "";
  EXPECT_EQ(knob_text(rough, 0.25), "0.25");
}

/// Draws the panel of a run with knobs and a field, and returns the parts that are cut off.
std::vector<std::string> cut_off(float width, float height, float scale) {
  set_text_style(scale, Theme::kDark);
  ImGuiIO& io = ImGui::GetIO();
  unsigned char* pixels = nullptr;
  int wide = 0;
  int high = 0;
  io.Fonts->GetTexDataAsRGBA32(&pixels, &wide, &high);
  io.DisplaySize = {width, height};
  session::SharedScene scene;
  scene.name = "a scene with a name that is rather long";
  scene.arms.front().name = "vintage_phantom";
  scene.arms.front().device = "sim";
  scene.period_ns = 1'000'000;
  scene.field.push_back({{0, 0, 0}, {0, 0, 1}});
  scene.knobs = {knob(1e-6, 1e-3), knob(0, 1000)};
  scene.knobs[0].name = "sandpaper: texture roughness";
  const auto run = session::SharedRun::create("", scene, 10).value();
  const auto reader = session::SharedReader::over(run->memory().again().value()).value();
  Clockwork source(PlayHead::of_run(), reader.get());
  source.shown_scene().name = scene.name;
  source.shown_scene().objects.push_back({.name = "field", .mesh = {}, .field = true});
  driver::TickRecord& tick = source.shown_moment().tick;
  tick.in_contact = true;
  tick.depth = 0.12345;
  tick.f_sent_W = {0, 0, -7.77};
  tick.heat = {0.97, 0, 0};
  const float panel = panel_width(width, scale);
  ViewChoice choice;
  for (int frame = 0; frame < 3; ++frame) {
    io.DeltaTime = 0.02F;
    ImGui::NewFrame();
    draw_side_panel({width - panel, 0, panel, height}, source, {}, choice);
    ImGui::Render();
  }
  std::vector<std::string> cut;
  for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows) {
    // The panel itself scrolls only if its text is too large for the window.
    const bool scrolls = (window->Flags & ImGuiWindowFlags_NoScrollbar) == 0 &&
                         (std::string(window->Name) != "panel" || height < 420 * scale);
    if (!window->WasActive || window->Hidden) continue;
    if (window->ContentSize.x > window->ContentRegionRect.GetWidth() + 1) {
      cut.push_back(std::string(window->Name) + " is cut at the right");
    }
    if (!scrolls && window->ContentSize.y > window->ContentRegionRect.GetHeight() + 1) {
      cut.push_back(std::string(window->Name) + " is cut below");
    }
  }
  return cut;
}

/// Returns the text of the help, line by line.
std::string help_text(bool closing_ends) {
  ViewNotes notes;
  notes.closing_ends = closing_ends;
  static std::string taken;
  taken.clear();
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {1280, 800};
  io.SetClipboardTextFn = [](void*, const char* text) { taken = text; };
  ViewChoice choice;
  choice.help = true;
  for (int frame = 0; frame < 3; ++frame) {  // a window of automatic size is hidden at first
    io.DeltaTime = 0.02F;
    ImGui::NewFrame();
    if (frame == 2) ImGui::LogToClipboard();  // until the end of the window
    draw_notices({0, 0, 1280, 800}, notes, choice);
    ImGui::Render();
  }
  return taken;
}

TEST_F(SidePanel, HelpStatesWhetherClosingEndsTheRun) {
  const std::string watching = help_text(false), leading = help_text(true);
  EXPECT_NE(watching.find("Q close"), std::string::npos) << watching;
  EXPECT_NE(watching.find("The run continues when the window closes."), std::string::npos)
      << watching;
  EXPECT_EQ(leading.find("The run continues"), std::string::npos) << leading;
  EXPECT_NE(leading.find("Closing ends the run: this window moves its hand."), std::string::npos)
      << leading;
}

TEST_F(SidePanel, HelpListsEachKeyOnce) {
  for (int which = 0; which < 8; ++which) {
    ViewNotes notes;
    notes.recording = (which & 1) != 0;
    notes.leads = !notes.recording && (which & 2) != 0;
    notes.holds_key = !notes.recording && (which & 4) != 0;
    std::set<std::string> seen;
    for (const RunKey& one : listed_keys(notes)) {
      std::string key = one.key;
      if (key.ends_with(" held")) key.resize(key.size() - 5);
      EXPECT_TRUE(seen.insert(key).second) << which << ": " << key;
    }
    EXPECT_TRUE(seen.contains("space")) << which;
    EXPECT_TRUE(seen.contains(", .")) << which;
    EXPECT_EQ(seen.contains("B"), !notes.recording);
    EXPECT_EQ(seen.contains("H"), notes.leads);
  }
}

/// Draws notices into a window with a scene part, and returns the box of a name.
ScreenPart box_of(const char* name, const ViewNotes& notes, bool help, const ImVec2& window,
                  const ScreenPart& part) {
  set_text_style(1, Theme::kLight);
  ImGuiIO& io = ImGui::GetIO();
  unsigned char* pixels = nullptr;
  int wide = 0;
  int high = 0;
  io.Fonts->GetTexDataAsRGBA32(&pixels, &wide, &high);
  io.DisplaySize = window;
  ViewChoice choice;
  choice.help = help;
  for (int frame = 0; frame < 4; ++frame) {
    io.DeltaTime = 0.02F;
    ImGui::NewFrame();
    draw_notices(part, notes, choice);
    ImGui::Render();
  }
  const ImGuiWindow* box = ImGui::FindWindowByName(name);
  return {box->Pos.x, box->Pos.y, box->Size.x, box->Size.y};
}

TEST_F(SidePanel, NoticeLeavesTheLegendVisible) {
  ViewNotes notes;
  notes.notice =
      "The run has ended. The next one named two_hands_and_more is shown when it starts.";
  for (const float width : {320.0F, 500.0F, 900.0F, 1800.0F}) {
    for (const float legend : {0.0F, 150.0F, 300.0F}) {
      notes.legend = {0, 0, legend, legend > 0 ? 60.0F : 0.0F};
      const ScreenPart box = box_of("notice", notes, false, {width + 300, 600}, {0, 0, width, 600});
      EXPECT_TRUE(box.x >= legend || box.y >= notes.legend.height) << width << ", " << legend;
      EXPECT_GE(box.x, 0) << width << ", " << legend;
      EXPECT_LE(box.x + box.width, width) << width << ", " << legend;
    }
  }
}

TEST_F(SidePanel, HelpFitsTheWindow) {
  ViewNotes notes;
  notes.leads = true;
  for (const auto& [width, height] : {std::pair{700.0F, 420.0F}, {960.0F, 640.0F}}) {
    const ScreenPart box =
        box_of("help", notes, true, {width, height}, {0, 0, width - 350, height - 40});
    EXPECT_GE(box.x, 0) << width;
    EXPECT_LE(box.x + box.width, width) << width;
    EXPECT_GE(box.y, 0) << width;
    EXPECT_LE(box.y + box.height, height) << width;
  }
}

TEST_F(SidePanel, ManyKnobsScroll) {
  set_text_style(1, Theme::kLight);
  ImGuiIO& io = ImGui::GetIO();
  unsigned char* pixels = nullptr;
  int wide = 0;
  int high = 0;
  io.Fonts->GetTexDataAsRGBA32(&pixels, &wide, &high);
  io.DisplaySize = {1280, 1000};
  session::SharedScene scene;
  scene.period_ns = 1'000'000;
  scene.arms.front().device = "sim";
  scene.knobs.assign(40, knob(0, 1000));
  const auto run = session::SharedRun::create("", scene, 10).value();
  const auto reader = session::SharedReader::over(run->memory().again().value()).value();
  Clockwork source(PlayHead::of_run(), reader.get());
  ViewChoice choice;
  for (int frame = 0; frame < 3; ++frame) {
    io.DeltaTime = 0.02F;
    ImGui::NewFrame();
    draw_side_panel({900, 0, 380, 1000}, source, {}, choice);
    ImGui::Render();
  }
  const ImGuiWindow* knobs = nullptr;
  for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows) {
    if (std::string(window->Name).find("/knobs") != std::string::npos) knobs = window;
  }
  ASSERT_NE(knobs, nullptr);
  EXPECT_TRUE(knobs->ScrollbarY);
  EXPECT_GE(knobs->ScrollMax.y + knobs->InnerRect.GetHeight(), knobs->ContentSize.y);
  EXPECT_LE(knobs->Pos.y + knobs->Size.y, 1000);
}

TEST_F(SidePanel, ShowsEverythingInUsualWindowSizes) {
  for (const auto& [width, height] :
       {std::pair{700.0F, 420.0F}, {1280.0F, 800.0F}, {2560.0F, 1440.0F}}) {
    for (const float scale : {0.75F, 1.0F, 1.5F}) {
      EXPECT_EQ(cut_off(width, height, scale), std::vector<std::string>{})
          << width << " x " << height << ", " << scale;
    }
  }
  EXPECT_EQ(cut_off(2560, 1440, 3), std::vector<std::string>{});
}

}  // namespace
}  // namespace thimble::view

#include "view/side_panel.h"

#include <epoxy/gl.h>
// After the header above, which includes OpenGL.
#include <GLFW/glfw3.h>
#include <fmt/core.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "thimble/driver/heat_guard.h"
#include "view/compare/run_list.h"
#include "view/knob_panel.h"
#include "view/number_text.h"
#include "view/panel_flow.h"
#include "view/playback/time_line.h"

namespace thimble::view {
namespace {

/// When a key has an effect.
enum class For { kAll, kRun, kRecording, kLedRun, kHeldRun, kFreeRun };

/// One key and its effect.
struct Key {
  const char* key;
  const char* does;
  For when = For::kAll;
};

constexpr std::array kKeys = {Key{"left drag", "rotate the view"},
                              Key{"right drag", "pan (also shift + left drag)"},
                              Key{"wheel", "zoom"},
                              Key{"ctrl + left drag", "move the hand; wheel: push", For::kLedRun},
                              Key{"H", "swap the two left drags", For::kLedRun},
                              Key{"F", "frame the scene"},
                              Key{"T", "tip to the middle"},
                              Key{"space", "pause or continue", For::kFreeRun},
                              Key{"space held", "enables forces", For::kHeldRun},
                              Key{"space", "play or stop", For::kRecording},
                              Key{"1 to 4 held", "buttons of a simulated arm", For::kRun},
                              Key{"left, right", "one moment back or on (shift: 1 s)"},
                              Key{"Home, End", "oldest moment; now or the end"},
                              Key{", .", "slower, faster"},
                              Key{"R", "record, stop recording", For::kRun},
                              Key{"S", "screenshot"},
                              Key{"G", "Gouraud or Phong shading"},
                              Key{"E", "edges of polygons"},
                              Key{"P", "active triangle and edge planes"},
                              Key{"A", "arm"},
                              Key{"C", "shapes that collide"},
                              Key{"F1", "this help"},
                              Key{"Q", "close"}};

bool has_effect(For when, const ViewNotes& notes) {
  switch (when) {
    case For::kAll:
      return true;
    case For::kRun:
      return !notes.recording;
    case For::kRecording:
      return notes.recording;
    case For::kLedRun:
      return notes.leads;
    case For::kHeldRun:
      return notes.holds_key;
    case For::kFreeRun:
      return !notes.recording && !notes.holds_key;
  }
  return true;
}

void toggle_record(session::SharedReader& reader) {
  if (reader.counters().recording) {
    reader.ask_record_stop();
  } else {
    reader.ask_record();
  }
}

/// Draws the data of a tick: force, depth, and faults; `words` describe its time.
void draw_tick(const driver::TickRecord& tick, const std::string& words) {
  ImGui::PushTextWrapPos(0);
  const auto& f = tick.f_sent_W;
  Flow flow;
  flow.value(kForceColour, force_text(std::hypot(f[0], f[1], f[2])), "888.88 mN");
  flow.value(kDepthColour, length_text(tick.in_contact ? tick.depth : 0), "888.88 mm");
  const std::string when =
      fmt::format("{:.1f} s, {}", static_cast<double>(tick.time_ns) * 1e-9, words);
  flow.next(ImGui::CalcTextSize("8888.8 s, running").x);
  ImGui::TextDisabled("%s", when.c_str());
  const double heat = *std::max_element(tick.heat.begin(), tick.heat.end());
  if (heat >= driver::HeatGuard::kWarning) {
    ImGui::TextColored(shown_colour(kForceColour),
                       "motors %.0f %% of their heat limit, force reduced", 100 * heat);
  } else if (heat > 0) {
    ImGui::TextDisabled("motors %.0f %% of their heat limit", 100 * heat);
  }
  if (tick.buttons != 0) {
    std::string held = "buttons";
    for (int button = 0; button < 16; ++button) {
      if ((tick.buttons >> button & 1) != 0) held += fmt::format(" {}", button + 1);
    }
    ImGui::TextUnformatted(held.c_str());
  }
  if (tick.fault != driver::Fault::kNone) {
    ImGui::TextColored(shown_colour(kForceColour), "%s",
                       std::string(driver::describe(tick.fault)).c_str());
    // The fault is the first cause; the arm may be unplugged later.
    if (tick.link == driver::LinkState::kLost && tick.fault != driver::Fault::kTransportLost) {
      ImGui::TextColored(shown_colour(kForceColour), "The arm is disconnected.");
    }
  }
  ImGui::PopTextWrapPos();
}

void draw_head(const session::SharedReader& reader, TouchSource& source) {
  const session::SharedScene& scene = reader.scene();
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(scene.name.c_str());
  ImGui::TextDisabled("%s (%s), %.0f Hz%s", scene.arms.front().name.c_str(),
                      scene.arms.front().device.c_str(), 1e9 / static_cast<double>(scene.period_ns),
                      scene.wall_clock || scene.paced ? "" : ", virtual time");
  ImGui::PopTextWrapPos();
  draw_tick(source.moment().tick,
            source.head().live() ? session::name_of(reader.state()) : words_of(source.head()));
}

void draw_recorded_head(TouchSource& source) {
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(source.scene().name.c_str());
  for (const std::string& sentence : source.about()) ImGui::TextDisabled("%s", sentence.c_str());
  ImGui::PopTextWrapPos();
  Comparison* const runs = source.comparison();
  if (runs != nullptr && runs->several()) {
    draw_run_list(*runs);
  } else {
    draw_tick(source.moment().tick, "recorded");
  }
}

constexpr const char* kBackHelp = "Shows the list of scenes. A run that this window started ends";

void draw_buttons(session::SharedReader& reader, const ViewNotes& notes, ViewChoice& choice) {
  Flow flow;
  const auto button = [&](const char* label, const char* what) {
    flow.next(ImGui::CalcTextSize(label).x + 2 * ImGui::GetStyle().FramePadding.x);
    const bool pressed = ImGui::Button(label);
    explain(what);
    return pressed;
  };
  if (notes.start_window && button("Start window", kBackHelp)) choice.back = true;
  if (button(reader.counters().recording ? "Stop recording" : "Record",
             "Records every tick from now on, in the folder where the run was started (R)")) {
    toggle_record(reader);
  }
  if (button("Picture", "Writes a PNG file of the scene (S)")) choice.screenshot = true;
  if (button("?", "Lists the keys (F1)")) choice.help = !choice.help;
  choice.run.draw(reader);
  if (reader.counters().recording) {
    ImGui::PushTextWrapPos(0);
    ImGui::TextColored(shown_colour(kForceColour), "recording");
    ImGui::TextDisabled("%s", reader.recording_path().c_str());
    ImGui::PopTextWrapPos();
  }
}

void draw_plots(TouchSource& source, PlotPanel& panel, float height) {
  const PlayHead& head = source.head();
  const PlotTime time{.looked = head.live() ? std::nullopt : std::optional(head.time()),
                      .recorded = !head.of_a_run(),
                      .period_ns = std::llround(1e9 / source.scene().rate),
                      .duration = source.scene().duration,
                      .compared = source.comparison()};
  if (const auto asked = panel.draw(source.plots(), time, height)) source.head().go(*asked);
}

// `of_a_run`: has a hand that the mouse can move.
void draw_looks(const DrawnScene& scene, bool of_a_run, ViewChoice& choice) {
  PaintChoice& paint = choice.paint;
  Flow flow;
  const auto box = [&](const char* label, bool& on) {
    const ImGuiStyle& style = ImGui::GetStyle();
    flow.next(ImGui::GetFrameHeight() + style.ItemInnerSpacing.x + ImGui::CalcTextSize(label).x);
    return ImGui::Checkbox(label, &on);
  };
  const bool fields = std::any_of(scene.objects.begin(), scene.objects.end(),
                                  [](const DrawnObject& object) { return object.field; });
  if (fields) box("fields", paint.fields);
  box("trail", paint.trail);
  box("normal, friction", paint.marks.contact);
  box("textures", paint.surfaces);
  const bool meets =
      std::any_of(scene.objects.begin(), scene.objects.end(),
                  [](const DrawnObject& object) { return !object.collider.triangles.empty(); });
  if (meets) box("collision", paint.colliders);
  box("arm", paint.marks.arm);
  box("shadows", paint.shadows);
  box("grid", paint.grid);
  bool edges = paint.edges == Edges::kOn;
  if (box("edges", edges)) paint.edges = edges ? Edges::kOn : Edges::kOff;
  box("edge planes", paint.marks.edge_planes);
  bool gouraud = paint.shading == Shading::kGouraud;
  if (box("Gouraud", gouraud)) paint.shading = gouraud ? Shading::kGouraud : Shading::kPhong;
  box("fine", paint.fine);
  bool dark = paint.theme == Theme::kDark;
  if (box("dark", dark)) paint.theme = dark ? Theme::kDark : Theme::kLight;
  if (of_a_run) box("mouse is hand", choice.mouse_is_hand);
}

void draw_status(const session::SharedReader& reader, const ViewNotes& notes) {
  const auto counters = reader.counters();
  ImGui::PushTextWrapPos(0);
  ImGui::TextDisabled("%s; %.0f pictures/s", counted(counters).c_str(),
                      notes.frame_time > 0 ? 1 / notes.frame_time : 0.0);
  ImGui::PopTextWrapPos();
}

/// The content of the panel below its head; each part is a child window that can scroll.
class Parts {
 public:
  Parts(TouchSource& source, ViewChoice& choice) : source_(source), choice_(choice) {}

  void stacked(float height) {
    const float looks = looks_height();
    const float gaps = 4 * ImGui::GetStyle().ItemSpacing.y;
    if (source_.reader() == nullptr) {  // a recording has no knobs
      plots_in(height - looks - gaps);
      ImGui::Separator();
      draw_looks(source_.scene(), false, choice_);
      return;
    }
    const float plots = std::max(kPlotLines * ImGui::GetFontSize(), 0.5F * (height - looks));
    plots_in(plots);
    ImGui::Separator();
    child("knobs", std::max(height - plots - looks - gaps, kKnobLines * ImGui::GetFontSize()),
          [&] { draw_knobs(*source_.reader()); });
    ImGui::Separator();
    draw_looks(source_.scene(), true, choice_);
  }

  void tabbed(float height) {
    if (!ImGui::BeginTabBar("parts")) return;
    const float rest = height - ImGui::GetFrameHeightWithSpacing();
    const auto tab = [&](const char* name, auto content) {
      if (!ImGui::BeginTabItem(name)) return;
      child(name, std::max(rest, 2 * ImGui::GetFontSize()), content);
      ImGui::EndTabItem();
    };
    tab("Plots", [&] { plots_in(std::max(rest, kPlotLinesMin * ImGui::GetFontSize())); });
    if (source_.reader() != nullptr) tab("Knobs", [&] { draw_knobs(*source_.reader()); });
    tab("Show", [&] { draw_looks(source_.scene(), source_.reader() != nullptr, choice_); });
    ImGui::EndTabBar();
  }

  /// Returns whether all parts fit below each other.
  bool fit(float height) const {
    return height > (kPlotLines + kKnobLines) * ImGui::GetFontSize() + looks_height() +
                        4 * ImGui::GetStyle().ItemSpacing.y;
  }

 private:
  // In lines of text: four readable plots, two knobs. Chosen by looking.
  static constexpr float kPlotLines = 15;
  static constexpr float kPlotLinesMin = 11;  // in a tab
  static constexpr float kKnobLines = 7;

  void plots_in(float height) { draw_plots(source_, choice_.plots, height); }
  template <class Content>
  static void child(const char* name, float height, Content content) {
    ImGui::BeginChild(name, {0, height});
    content();
    ImGui::EndChild();
  }
  /// Returns the approximate height of the switches: 75 characters and 13 boxes, line by line.
  static float looks_height() {
    const ImGuiStyle& style = ImGui::GetStyle();
    const float all =
        44 * ImGui::GetFontSize() +
        13 * (ImGui::GetFrameHeight() + style.ItemInnerSpacing.x + style.ItemSpacing.x);
    const float lines = std::ceil(1.12F * all / std::max(1.0F, ImGui::GetContentRegionAvail().x));
    return lines * ImGui::GetFrameHeightWithSpacing();
  }

  TouchSource& source_;
  ViewChoice& choice_;
};

void draw_parts(TouchSource& source, ViewChoice& choice) {
  const float height =
      ImGui::GetContentRegionAvail().y - 2.2F * ImGui::GetTextLineHeightWithSpacing();
  Parts parts(source, choice);
  if (parts.fit(height)) {
    parts.stacked(height);
  } else {
    parts.tabbed(height);
  }
}

}  // namespace

float panel_width(float window_width, float scale) {
  constexpr float kWidth = 380;  // chosen: four switches in a row
  return std::min(kWidth * scale, 0.5F * window_width);
}

void draw_side_panel(const ScreenPart& part, TouchSource& source, const ViewNotes& notes,
                     ViewChoice& choice) {
  session::SharedReader* const reader = source.reader();
  ImGui::SetNextWindowPos({part.x, part.y});
  ImGui::SetNextWindowSize({part.width, part.height});
  // Scrolls if even tabs do not fit.
  ImGui::Begin("panel", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus);
  if (reader != nullptr) {
    draw_head(*reader, source);
    draw_buttons(*reader, notes, choice);
    draw_parts(source, choice);
    draw_status(*reader, notes);
  } else if (source.has_scene()) {
    draw_recorded_head(source);
    if (notes.start_window) {
      if (ImGui::Button("Start window")) choice.back = true;
      explain(kBackHelp);
      ImGui::SameLine();
    }
    if (ImGui::Button("Picture")) choice.screenshot = true;
    ImGui::SameLine();
    if (ImGui::Button("?")) choice.help = !choice.help;
    draw_parts(source, choice);
  } else {
    ImGui::TextDisabled("No run to show.");
  }
  ImGui::End();
}

std::vector<RunKey> listed_keys(const ViewNotes& notes) {
  std::vector<RunKey> keys;
  for (const Key& key : kKeys) {
    if (has_effect(key.when, notes)) keys.push_back({key.key, key.does});
  }
  if (!notes.recording) keys.insert(keys.end(), kRunKeys.begin(), kRunKeys.end());
  return keys;
}

namespace {

void begin_box(const char* name, float x, float y, float pivot_y) {
  ImGui::SetNextWindowPos({x, y}, ImGuiCond_Always, {0.5F, pivot_y});
  ImGui::Begin(name, nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                   ImGuiWindowFlags_NoInputs);
}

// In the middle of the scene, as far as the legend leaves room; below it if there is too little.
void draw_notice(const ScreenPart& part, const ViewNotes& notes) {
  const float margin = ImGui::GetFontSize();
  constexpr float kNarrowest = 16;  // width of the text, in heights of the font; chosen
  const float padding = 2 * ImGui::GetStyle().WindowPadding.x;
  const float legend = notes.legend.width > 0 ? notes.legend.width + margin : 0;
  const bool beside = part.width - legend - 2 * margin - padding > kNarrowest * margin;
  const float left = part.x + margin + (beside ? legend : 0);
  const float room = part.x + part.width - margin - left;
  const float wrap = room - padding;
  const float width = ImGui::CalcTextSize(notes.notice.c_str(), nullptr, false, wrap).x + padding;
  const float middle =
      std::max(part.x + part.width / 2, std::min(left + width / 2, left + room / 2));
  begin_box("notice", middle, part.y + (beside ? 0 : notes.legend.height) + margin, 0);
  ImGui::PushTextWrapPos(wrap + padding / 2);
  ImGui::TextColored(shown_colour(kForceColour), "%s", notes.notice.c_str());
  ImGui::PopTextWrapPos();
  ImGui::End();
}

// Over the scene; in two columns over the window if it is too low for one.
void draw_help(const ScreenPart& part, const ViewNotes& notes) {
  const std::vector<RunKey> keys = listed_keys(notes);
  const float letter = ImGui::GetFontSize();
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {0.5F * letter, 0.2F * letter});
  const float line = ImGui::GetTextLineHeightWithSpacing();
  const bool low = static_cast<float>(keys.size() + 3) * line > part.height;
  const std::size_t in_column = low ? (keys.size() + 1) / 2 : keys.size();
  const float window = ImGui::GetIO().DisplaySize.x;
  begin_box("help", low ? window / 2 : part.x + part.width / 2, part.y + part.height / 2, 0.5F);
  for (std::size_t first = 0; first < keys.size(); first += in_column) {
    if (first > 0) ImGui::SameLine(0, 2 * letter);
    ImGui::BeginGroup();
    const float left = ImGui::GetCursorPosX();
    for (std::size_t i = first; i < std::min(keys.size(), first + in_column); ++i) {
      ImGui::TextColored(shown_colour(kDepthColour), "%s", keys[i].key);
      ImGui::SameLine();
      ImGui::SetCursorPosX(left + 9 * letter);
      ImGui::TextUnformatted(keys[i].does);
    }
    ImGui::EndGroup();
  }
  if (!notes.recording) {
    ImGui::TextUnformatted(
        notes.closing_ends && notes.own_run ? "Closing ends the run: this window started it."
        : notes.closing_ends                ? "Closing ends the run: this window moves its hand."
                                            : "The run continues when the window closes.");
  }
  ImGui::End();
  ImGui::PopStyleVar();
}

}  // namespace

void draw_notices(const ScreenPart& part, const ViewNotes& notes, const ViewChoice& choice) {
  const float middle = part.x + part.width / 2;
  const float margin = ImGui::GetFontSize();
  if (!notes.notice.empty()) draw_notice(part, notes);
  if (!notes.message.empty()) {
    begin_box("message", middle, part.y + part.height - margin, 1);
    ImGui::TextUnformatted(notes.message.c_str());
    ImGui::End();
  }
  if (choice.help) draw_help(part, notes);
}

void take_key(int key, session::SharedReader* reader, ViewChoice& choice) {
  PaintChoice& paint = choice.paint;
  switch (key) {
    case GLFW_KEY_H:
      choice.mouse_is_hand = !choice.mouse_is_hand;
      break;
    case GLFW_KEY_F:
      choice.frame = true;
      break;
    case GLFW_KEY_T:
      choice.to_tip = true;
      break;
    case GLFW_KEY_S:
      choice.screenshot = true;
      break;
    case GLFW_KEY_G:
      paint.shading = paint.shading == Shading::kPhong ? Shading::kGouraud : Shading::kPhong;
      break;
    case GLFW_KEY_E:
      paint.edges = paint.edges == Edges::kOn ? Edges::kOff : Edges::kOn;
      break;
    case GLFW_KEY_P:
      paint.marks.edge_planes = !paint.marks.edge_planes;
      break;
    case GLFW_KEY_A:
      paint.marks.arm = !paint.marks.arm;
      break;
    case GLFW_KEY_C:
      paint.colliders = !paint.colliders;
      break;
    case GLFW_KEY_F1:
    case GLFW_KEY_SLASH:
      choice.help = !choice.help;
      break;
    case GLFW_KEY_ESCAPE:
      choice.help = false;
      break;
    case GLFW_KEY_Q:
      choice.close = true;
      break;
    case GLFW_KEY_SPACE:
      // If the space bar is the enabling input (Content::hold_key), it does not pause.
      if (reader != nullptr && !reader->scene().hold_by_key)
        reader->ask_pause(!reader->pause_asked());
      break;
    case GLFW_KEY_R:
      if (reader != nullptr) toggle_record(*reader);
      break;
    default:
      if (reader == nullptr) break;
      choice.run.take_key(key, ImGui::GetIO().KeyShift, ImGui::GetIO().KeyCtrl, *reader);
      break;
  }
}

}  // namespace thimble::view

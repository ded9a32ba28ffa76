#include "view/side_panel.h"

#include <epoxy/gl.h>
// After the above, which brings OpenGL.
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>

#include "thimble/driver/heat_guard.h"
#include "view/time/time_line.h"

namespace thimble::app::view {
namespace {

/// One key and what it does.
struct Key {
  const char* key;
  const char* does;
};

constexpr std::array kKeys = {Key{"left drag", "turn about the scene"},
                              Key{"right drag", "move along (also shift + left)"},
                              Key{"wheel", "nearer, farther"},
                              Key{"ctrl + left drag", "lead the simulated hand; wheel: push"},
                              Key{"H", "swap the two left drags"},
                              Key{"F", "frame the scene"},
                              Key{"space", "pause, go on; of a recording: play"},
                              Key{"left, right", "a moment back, on (shift: a second)"},
                              Key{"Home, End", "oldest moment; now, or the end"},
                              Key{", .", "slower, faster"},
                              Key{"R", "record, stop recording"},
                              Key{"S", "screenshot"},
                              Key{"G", "Gouraud or Phong shading"},
                              Key{"E", "edges of polygons"},
                              Key{"P", "active triangle and edge planes"},
                              Key{"A", "arm"},
                              Key{"F1", "this help"},
                              Key{"Q", "close"}};

ImVec4 vec(const Colour& colour) {
  return {colour[0], colour[1], colour[2], 1};
}

void toggle_record(session::SharedReader& reader) {
  if (reader.counters().recording) {
    reader.ask_record_stop();
  } else {
    reader.ask_record();
  }
}

/// Draws what a tick was: force, depth, and what is wrong; `words` say when.
void draw_tick(const driver::TickRecord& tick, const std::string& words) {
  const auto& f = tick.f_sent_W;
  ImGui::TextColored(vec(kForceColour), "%5.2f N", std::hypot(f[0], f[1], f[2]));
  ImGui::SameLine(0, 2 * ImGui::GetFontSize());
  ImGui::TextColored(vec(kDepthColour), "%5.2f mm", tick.in_contact ? tick.depth * 1e3 : 0.0);
  ImGui::SameLine(0, 2 * ImGui::GetFontSize());
  ImGui::TextDisabled("%.1f s, %s", static_cast<double>(tick.time_ns) * 1e-9, words.c_str());
  const double heat = *std::max_element(tick.heat.begin(), tick.heat.end());
  if (heat >= driver::HeatGuard::kWarning) {
    ImGui::TextColored(vec(kForceColour), "motors %.0f %% of their heat limit, force lowered",
                       100 * heat);
  } else if (heat > 0) {
    ImGui::TextDisabled("motors %.0f %% of their heat limit", 100 * heat);
  }
  if (tick.fault != driver::Fault::kNone) {
    ImGui::TextColored(vec(kForceColour), "%s", std::string(driver::describe(tick.fault)).c_str());
  }
}

void draw_head(const session::SharedReader& reader, TouchSource& source) {
  const session::SharedScene& scene = reader.scene();
  ImGui::TextUnformatted(scene.name.c_str());
  ImGui::TextDisabled("%s (%s), %.0f Hz%s", scene.arm.name.c_str(), scene.arm.device.c_str(),
                      1e9 / static_cast<double>(scene.period_ns),
                      scene.wall_clock || scene.paced ? "" : ", virtual time");
  draw_tick(source.moment().tick,
            source.head().live() ? session::name_of(reader.state()) : words_of(source.head()));
}

void draw_recorded_head(TouchSource& source) {
  ImGui::TextUnformatted(source.scene().name.c_str());
  ImGui::PushTextWrapPos(0);
  for (const std::string& sentence : source.about()) ImGui::TextDisabled("%s", sentence.c_str());
  ImGui::PopTextWrapPos();
  draw_tick(source.moment().tick, "recorded");
}

void draw_buttons(session::SharedReader& reader, ViewChoice& choice) {
  const bool paused = reader.pause_asked();
  if (ImGui::Button(paused ? "Go on" : "Pause")) reader.ask_pause(!paused);
  explain(reader.scene().wall_clock
              ? "Fades the force out; the arm's time goes on, and its ticks count as paused (space)"
              : "Lets the simulated time stand still, or go on (space)");
  ImGui::SameLine();
  if (ImGui::Button(reader.counters().recording ? "Stop recording" : "Record")) {
    toggle_record(reader);
  }
  explain("Records every tick from now on, into the folder where the run was started (R)");
  ImGui::SameLine();
  if (ImGui::Button("Picture")) choice.screenshot = true;
  explain("Writes a PNG of the scene (S)");
  ImGui::SameLine();
  if (ImGui::Button("?")) choice.help = !choice.help;
  explain("Lists the keys (F1)");
  choice.run.draw(reader);
  if (reader.counters().recording) {
    ImGui::TextColored(vec(kForceColour), "recording");
    ImGui::SameLine();
    ImGui::TextDisabled("%s", reader.recording_path().c_str());
  }
}

void draw_plots(TouchSource& source, PlotPanel& panel, float height) {
  const PlayHead& head = source.head();
  const PlotTime time{.looked = head.live() ? std::nullopt : std::optional(head.time()),
                      .recorded = !head.of_a_run(),
                      .period_ns = std::llround(1e9 / source.scene().rate)};
  if (const auto asked = panel.draw(source.plots(), time, height)) source.head().go(*asked);
}

void draw_knobs(session::SharedReader& reader) {
  const auto& knobs = reader.scene().knobs;
  if (knobs.empty()) {
    ImGui::TextDisabled("This run has no knobs.");
    return;
  }
  for (std::size_t i = 0; i < knobs.size(); ++i) {
    const session::SharedScene::Knob& knob = knobs[i];
    ImGui::PushID(static_cast<int>(i));
    double value = reader.knob_wanted(i);
    ImGui::TextUnformatted(knob.name.c_str());
    const float reset = ImGui::CalcTextSize("reset").x + 2 * ImGui::GetStyle().FramePadding.x;
    ImGui::SetNextItemWidth(-reset - ImGui::GetStyle().ItemSpacing.x);
    if (knob_slider(knob, value)) reader.turn_knob(i, value);
    ImGui::SameLine();
    if (ImGui::Button("reset")) reader.turn_knob(i, knob.initial);
    ImGui::PopID();
  }
}

void draw_looks(ViewChoice& choice) {
  PaintChoice& paint = choice.paint;
  bool gouraud = paint.shading == Shading::kGouraud;
  if (ImGui::Checkbox("Gouraud", &gouraud)) {
    paint.shading = gouraud ? Shading::kGouraud : Shading::kPhong;
  }
  ImGui::SameLine();
  bool edges = paint.edges == Edges::kOn;
  if (ImGui::Checkbox("edges", &edges)) paint.edges = edges ? Edges::kOn : Edges::kOff;
  ImGui::SameLine();
  ImGui::Checkbox("edge planes", &paint.marks.edge_planes);
  ImGui::SameLine();
  ImGui::Checkbox("fine", &paint.fine);
  ImGui::Checkbox("arm", &paint.marks.arm);
  ImGui::SameLine();
  ImGui::Checkbox("shadows", &paint.shadows);
  ImGui::SameLine();
  ImGui::Checkbox("grid", &paint.grid);
  ImGui::SameLine();
  ImGui::Checkbox("mouse is hand", &choice.mouse_is_hand);
}

}  // namespace

void draw_side_panel(const ScreenPart& part, TouchSource& source, const ViewNotes& notes,
                     ViewChoice& choice) {
  session::SharedReader* const reader = source.reader();
  ImGui::SetNextWindowPos({part.x, part.y});
  ImGui::SetNextWindowSize({part.width, part.height});
  ImGui::Begin("panel", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus);
  const float plots = std::max(0.48F * part.height, 19 * ImGui::GetFontSize());
  if (reader != nullptr) {
    draw_head(*reader, source);
    draw_buttons(*reader, choice);
    draw_plots(source, choice.plots, plots);
    ImGui::Separator();
    const float rest = ImGui::GetContentRegionAvail().y - 3.4F * ImGui::GetFrameHeightWithSpacing();
    ImGui::BeginChild("knobs", {0, std::max(rest, 3 * ImGui::GetFontSize())});
    draw_knobs(*reader);
    ImGui::EndChild();
    ImGui::Separator();
    draw_looks(choice);
    const auto counters = reader->counters();
    ImGui::TextDisabled("%s; %.0f pictures/s", counted(counters).c_str(),
                        notes.frame_time > 0 ? 1 / notes.frame_time : 0.0);
  } else if (source.has_scene()) {
    draw_recorded_head(source);
    if (ImGui::Button("Picture")) choice.screenshot = true;
    ImGui::SameLine();
    if (ImGui::Button("?")) choice.help = !choice.help;
    const float rest = ImGui::GetContentRegionAvail().y - 2.4F * ImGui::GetFrameHeightWithSpacing();
    draw_plots(source, choice.plots, std::max(rest, 0.5F * plots));
    ImGui::Separator();
    draw_looks(choice);
  } else {
    ImGui::TextDisabled("No run to show.");
  }
  ImGui::End();
}

bool knob_slider(const session::SharedScene::Knob& knob, double& value) {
  // What reaches over more than two powers of ten is turned by its logarithm. There ImGui takes for
  // zero what is below a unit of the format's last digit: so it has digits enough for the least.
  const bool wide = knob.least > 0 && knob.most > 100 * knob.least;
  const int digits =
      wide ? std::max(4, static_cast<int>(std::ceil(1 - std::log10(knob.least)))) : 4;
  const std::string format = "%." + std::to_string(digits) + "g " + knob.unit;
  return ImGui::SliderScalar(
      "##value", ImGuiDataType_Double, &value, &knob.least, &knob.most, format.c_str(),
      ImGuiSliderFlags_AlwaysClamp | (wide ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None));
}

void draw_notices(const ScreenPart& part, const ViewNotes& notes, const ViewChoice& choice) {
  const auto box = [](const char* name, float x, float y, float pivot_y) {
    ImGui::SetNextWindowPos({x, y}, ImGuiCond_Always, {0.5F, pivot_y});
    ImGui::Begin(name, nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                     ImGuiWindowFlags_NoInputs);
  };
  const float middle = part.x + part.width / 2;
  const float margin = ImGui::GetFontSize();
  if (!notes.notice.empty()) {
    box("notice", middle, part.y + margin, 0);
    ImGui::PushTextWrapPos(0.9F * part.width);
    ImGui::TextColored(vec(kForceColour), "%s", notes.notice.c_str());
    ImGui::PopTextWrapPos();
    ImGui::End();
  }
  if (!notes.message.empty()) {
    box("message", middle, part.y + part.height - margin, 1);
    ImGui::TextUnformatted(notes.message.c_str());
    ImGui::End();
  }
  if (choice.help) {
    box("help", middle, part.y + part.height / 2, 0.5F);
    for (const Key& key : kKeys) {
      ImGui::TextColored(vec(kDepthColour), "%s", key.key);
      ImGui::SameLine(10 * ImGui::GetFontSize());
      ImGui::TextUnformatted(key.does);
    }
    for (const RunKey& key : kRunKeys) {
      ImGui::TextColored(vec(kDepthColour), "%s", key.key);
      ImGui::SameLine(10 * ImGui::GetFontSize());
      ImGui::TextUnformatted(key.does);
    }
    ImGui::TextUnformatted(notes.closing_ends ? "Closing ends the run: its hand is in this window."
                                              : "Closing leaves the run on.");
    ImGui::End();
  }
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
      if (reader != nullptr) reader->ask_pause(!reader->pause_asked());
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

}  // namespace thimble::app::view

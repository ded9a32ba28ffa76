#include "view/start/start_page.h"

#include <epoxy/gl.h>
// After the header above, which includes OpenGL.
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>

#include "view/panel_flow.h"
#include "view/run_buttons.h"
#include "view/side_panel.h"
#include "view/start/page_parts.h"

namespace thimble::view {
namespace {

constexpr float kPictureShape = 0.75F;  // height by width of a stored picture, 320 x 240
// In heights of a letter [chosen: five cards in a row of the first window, two in the least].
constexpr float kCardWidth = 8.5F;
constexpr float kPictureHeight = 0.36F;  // of the picture, as a share of the panel's; chosen

constexpr std::array kHands = {"mouse", "keyboard", "gamepad", "SpaceMouse", "path of the scene"};
constexpr std::array kHandHelp = {
    "Drag to move the tip, turn the wheel to push.", "Arrow keys and page up or down move the tip.",
    "The left stick and the triggers move the tip.", "Push the cap of the 3Dconnexion mouse.",
    "The scene moves the hand. Watch."};

ImU32 shown(const Colour& colour, float cover = 1) {
  return ImGui::ColorConvertFloat4ToU32({colour[0], colour[1], colour[2], cover});
}

ImTextureID id_of(unsigned texture) {
  return reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture));
}

const char* word_of(FileKind kind) {
  return kind == FileKind::kRecording ? "recording" : kind == FileKind::kMesh ? "mesh" : "";
}

/// Edits a text of any length.
bool input_text(const char* label, const char* hint, std::string& text) {
  char bytes[4096];
  std::snprintf(bytes, sizeof bytes, "%s", text.c_str());
  const bool entered = ImGui::InputTextWithHint(label, hint, bytes, sizeof bytes,
                                                ImGuiInputTextFlags_EnterReturnsTrue);
  text = bytes;
  return entered;
}

/// A picture, or its place with a word, as wide as `width`.
void draw_picture(const ImVec2& at, float width, const StartEntry& entry, unsigned texture,
                  bool drawn_later) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 end(at.x + width, at.y + kPictureShape * width);
  const float round = ImGui::GetStyle().FrameRounding;
  if (texture != 0) {
    // The stored pictures are light: in the dark theme they are dimmed.
    const bool dark = shown_theme() == Theme::kDark;
    const ImU32 tint = dark ? IM_COL32(205, 210, 216, 255) : IM_COL32_WHITE;
    list.AddImageRounded(id_of(texture), at, end, {0, 0}, {1, 1}, tint, round);
    return;
  }
  const ThemeColours colours = colours_of(shown_theme());
  list.AddRectFilled(at, end, shown(colours.ground), round);
  const char* word = entry.kind == FileKind::kScene && drawn_later ? "..." : word_of(entry.kind);
  const ImVec2 size = ImGui::CalcTextSize(word);
  list.AddText(
      {std::round(0.5F * (at.x + end.x - size.x)), std::round(0.5F * (at.y + end.y - size.y))},
      shown(colours.quiet_text), word);
}

}  // namespace

const StartEntry* StartModel::entry() const {
  if (selected.group >= groups.size()) return nullptr;
  const std::vector<StartEntry>& entries = groups[selected.group].entries;
  return selected.entry < entries.size() ? &entries[selected.entry] : nullptr;
}

void StartModel::set_groups(std::vector<StartGroup> next) {
  const StartEntry* const current = entry();
  const std::filesystem::path file = current != nullptr ? current->file : std::filesystem::path();
  groups = std::move(next);
  if (!select(file)) selected = {};
}

bool StartModel::select(const std::filesystem::path& file) {
  for (std::size_t group = 0; group < groups.size(); ++group) {
    for (std::size_t i = 0; i < groups[group].entries.size(); ++i) {
      if (groups[group].entries[i].file != file) continue;
      selected = {group, i};
      return true;
    }
  }
  return false;
}

std::optional<HandSource> hand_for(const StartModel& model, const StartEntry& entry) {
  return entry.several_arms ? std::nullopt : model.hand;
}

void StartPage::draw_head(StartModel& model) {
  write_title("Thimble");
  ImGui::PushTextWrapPos(0);
  ImGui::TextDisabled("Choose a scene, or drop a scene, a mesh or a recording on this window.");
  ImGui::PopTextWrapPos();
  ImGui::Spacing();
  const ImGuiStyle& style = ImGui::GetStyle();
  const auto width = [&style](const char* label) {
    return ImGui::CalcTextSize(label).x + 2 * style.FramePadding.x + style.ItemSpacing.x;
  };
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - width("Open") -
                          (model.can_browse ? width("Browse...") : 0));
  if (input_text("##path", "path of a file, or a name", model.path)) request_ = StartRequest::kOpen;
  ImGui::SameLine();
  if (ImGui::Button("Open")) request_ = StartRequest::kOpen;
  if (model.can_browse) {
    ImGui::SameLine();
    if (ImGui::Button("Browse...")) request_ = StartRequest::kBrowse;
  }
  if (model.message.empty()) return;
  ImGui::PushTextWrapPos(0);
  ImGui::TextColored(shown_colour(model.message_is_error ? kForceColour : kDepthColour), "%s",
                     model.message.c_str());
  ImGui::PopTextWrapPos();
}

void StartPage::draw_card(const StartEntry& entry, const CardGrid& grid, const CardPlace& place,
                          const PictureOf& picture_of, StartModel& model) {
  const float letter = ImGui::GetFontSize();
  const float inset = 0.4F * letter;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float picture = grid.width - 2 * inset;
  const ImVec2 size(grid.width, kPictureShape * picture + 2.2F * letter + inset);
  ImGui::PushID(static_cast<int>(1000 * place.group + place.entry));
  const bool clicked = ImGui::InvisibleButton("card", size);
  const bool over = ImGui::IsItemHovered();
  if (clicked) {
    model.selected = place;
    if (entry.kind == FileKind::kMesh) request_ = StartRequest::kMakeScene;
  }
  if (over && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) {
    model.selected = place;
    request_ = StartRequest::kRun;
  }
  const bool selected = model.selected == place;
  if (selected && scroll_) ImGui::SetScrollHereY();
  if (ImGui::IsRectVisible(at, {at.x + size.x, at.y + size.y})) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 end(at.x + size.x, at.y + size.y);
    const float round = 1.5F * ImGui::GetStyle().FrameRounding;
    list.AddRectFilled(at, end,
                       ImGui::GetColorU32(over ? ImGuiCol_ButtonHovered : ImGuiCol_FrameBg), round);
    draw_picture({at.x + inset, at.y + inset}, picture, entry, picture_of(entry), true);
    if (selected) {
      list.AddRect(at, end, shown(text_colour(kDepthColour, shown_theme())), round, 0,
                   std::max(2.0F, 0.14F * letter));
    }
    list.PushClipRect(at, {end.x - inset, end.y}, true);
    list.AddText({at.x + 1.5F * inset, at.y + 2 * inset + kPictureShape * picture},
                 ImGui::GetColorU32(ImGuiCol_Text), entry.name.c_str());
    list.PopClipRect();
  }
  ImGui::PopID();
}

void StartPage::draw_cards(const PictureOf& picture_of, StartModel& model) {
  const float letter = ImGui::GetFontSize();
  ImGui::BeginChild("cards", {0, 0});
  const CardGrid grid =
      fit_cards(ImGui::GetContentRegionAvail().x, kCardWidth * letter, 0.75F * letter);
  columns_ = grid.columns;
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {grid.gap, grid.gap});
  for (std::size_t group = 0; group < model.groups.size(); ++group) {
    if (group > 0) ImGui::Dummy({0, 0.2F * letter});
    ImGui::TextDisabled("%s", model.groups[group].title.c_str());
    const std::vector<StartEntry>& entries = model.groups[group].entries;
    for (std::size_t i = 0; i < entries.size(); ++i) {
      if (i % grid.columns != 0) ImGui::SameLine();
      draw_card(entries[i], grid, {group, i}, picture_of, model);
    }
  }
  ImGui::PopStyleVar();
  ImGui::EndChild();
  scroll_ = false;
}

void StartPage::draw_hand(const StartEntry& entry, StartModel& model) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("hand");
  ImGui::SameLine();
  if (entry.several_arms) {
    ImGui::TextDisabled("This scene moves its hands itself.");
    return;
  }
  int chosen = model.hand ? static_cast<int>(*model.hand) : static_cast<int>(kHands.size()) - 1;
  ImGui::SetNextItemWidth(-1);
  if (ImGui::Combo("##hand", &chosen, kHands.data(), static_cast<int>(kHands.size()))) {
    const bool path = chosen == static_cast<int>(kHands.size()) - 1;
    model.hand = path ? std::nullopt : std::optional(static_cast<HandSource>(chosen));
  }
  ImGui::PushTextWrapPos(0);
  ImGui::TextDisabled("%s", kHandHelp[static_cast<std::size_t>(chosen)]);
  ImGui::PopTextWrapPos();
}

void StartPage::draw_mesh(StartModel& model) {
  MeshTouch& touch = model.touch;
  const float label = 6 * ImGui::GetFontSize();
  const auto row = [label](const char* name) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(name);
    ImGui::SameLine(label);
    ImGui::SetNextItemWidth(-1);
  };
  bool changed = false;
  row("size");
  float size = static_cast<float>(1e3 * touch.size);
  if (ImGui::SliderFloat("##size", &size, static_cast<float>(1e3 * kMeshSizeMin),
                         static_cast<float>(1e3 * kMeshSizeMax), "%.0f mm")) {
    touch.size = 1e-3 * static_cast<double>(size);
  }
  changed |= ImGui::IsItemDeactivatedAfterEdit();
  row("stiffness");
  float stiffness = static_cast<float>(touch.stiffness);
  if (ImGui::SliderFloat("##stiffness", &stiffness, static_cast<float>(kMeshStiffnessMin),
                         static_cast<float>(kMeshStiffnessMax), "%.0f N/m")) {
    touch.stiffness = static_cast<double>(stiffness);
  }
  changed |= ImGui::IsItemDeactivatedAfterEdit();
  row("up in the file");
  int up = touch.up - 'x';
  if (ImGui::Combo("##up", &up, "x\0y\0z\0")) {
    touch.up = static_cast<char>('x' + up);
    changed = true;
  }
  if (changed) request_ = StartRequest::kMakeScene;
  row("save as");
  const float button = ImGui::CalcTextSize("Save").x + 2 * ImGui::GetStyle().FramePadding.x +
                       ImGui::GetStyle().ItemSpacing.x;
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - button);
  bool save = input_text("##name", "name of the scene", model.save_name);
  ImGui::SameLine();
  save |= ImGui::Button("Save");
  explain("Writes the scene into your own scenes. No file is replaced.");
  if (save) request_ = StartRequest::kSave;
  ImGui::PushTextWrapPos(0);
  for (const std::string& note : model.notes) ImGui::TextDisabled("%s", note.c_str());
  ImGui::PopTextWrapPos();
}

void StartPage::draw_choice(const PictureOf& picture_of, StartModel& model) {
  const StartEntry* const entry = model.entry();
  const ImGuiStyle& style = ImGui::GetStyle();
  const float height = ImGui::GetContentRegionAvail().y;
  // In a low window, values and buttons have precedence over the picture and the note.
  const bool low = height < 34 * ImGui::GetFontSize();
  const float note = low ? 0 : 3 * ImGui::GetTextLineHeightWithSpacing();
  const float foot =
      main_button_height() + ImGui::GetFrameHeight() + note + 4 * style.ItemSpacing.y;
  ImGui::BeginChild("choice", {0, std::max(height - foot, ImGui::GetFontSize())});
  if (entry != nullptr) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width =
        std::min(ImGui::GetContentRegionAvail().x, kPictureHeight * height / kPictureShape);
    draw_picture(at, width, *entry, picture_of(*entry), true);
    ImGui::Dummy({width, kPictureShape * width});
    write_title(entry->name.c_str());
    ImGui::PushTextWrapPos(0);
    if (!entry->about.empty()) ImGui::TextUnformatted(entry->about.c_str());
    if (!entry->shipped) ImGui::TextDisabled("%s", entry->file.c_str());
    ImGui::PopTextWrapPos();
    ImGui::Spacing();
    if (entry->kind != FileKind::kRecording) draw_hand(*entry, model);
    if (entry->kind == FileKind::kMesh) draw_mesh(model);
  }
  ImGui::EndChild();
  draw_main(entry, model);
  ImGui::Separator();
  ImGui::Checkbox("dark", &model.dark);
  if (low) return;
  ImGui::PushTextWrapPos(0);
  ImGui::TextDisabled(
      "Runs here have a simulated arm. Start a real arm in a terminal: thimble run SCENE --device "
      "auto");
  ImGui::PopTextWrapPos();
}

void StartPage::draw_main(const StartEntry* entry, const StartModel& model) {
  const bool waits = model.starting || model.reading;
  ImGui::BeginDisabled(entry == nullptr || model.reading);
  const char* label = model.starting  ? "Starting... (Cancel)"
                      : model.reading ? "Reading the mesh..."
                      : entry != nullptr && entry->kind == FileKind::kRecording ? "Play"
                                                                                : "Run";
  if (main_button(label)) request_ = waits ? StartRequest::kCancel : StartRequest::kRun;
  ImGui::EndDisabled();
}

void StartPage::take_keys(const std::vector<int>& keys, StartModel& model) {
  const bool ctrl = ImGui::GetIO().KeyCtrl;
  std::vector<std::size_t> sizes;
  for (const StartGroup& group : model.groups) sizes.push_back(group.entries.size());
  const CardPlace before = model.selected;
  for (const int key : keys) {
    switch (key) {
      case GLFW_KEY_LEFT:
      case GLFW_KEY_RIGHT:
        model.selected = moved(model.selected, key == GLFW_KEY_RIGHT ? 1 : -1, 0, columns_, sizes);
        break;
      case GLFW_KEY_UP:
      case GLFW_KEY_DOWN:
        model.selected = moved(model.selected, 0, key == GLFW_KEY_DOWN ? 1 : -1, columns_, sizes);
        break;
      case GLFW_KEY_ENTER:
      case GLFW_KEY_KP_ENTER:
        request_ = StartRequest::kRun;
        break;
      case GLFW_KEY_ESCAPE:
        if (model.starting) request_ = StartRequest::kCancel;
        break;
      case GLFW_KEY_O:
        if (ctrl && model.can_browse) request_ = StartRequest::kBrowse;
        break;
      case GLFW_KEY_V:
        // Pasted outside of the field, too.
        if (const char* text = ctrl ? ImGui::GetClipboardText() : nullptr; text != nullptr) {
          model.path = text;
          request_ = StartRequest::kOpen;
        }
        break;
      default:
        break;
    }
  }
  if (model.selected == before) return;
  scroll_ = true;
  const StartEntry* const entry = model.entry();
  if (entry != nullptr && entry->kind == FileKind::kMesh) request_ = StartRequest::kMakeScene;
}

StartRequest StartPage::draw(const ScreenPart& part, float scale, const std::vector<int>& keys,
                             const PictureOf& picture_of, StartModel& model) {
  request_ = StartRequest::kNone;
  take_keys(keys, model);
  const float panel = panel_width(part.width, scale);
  ImGui::SetNextWindowPos({part.x, part.y});
  ImGui::SetNextWindowSize({part.width - panel, part.height});
  begin_page("scenes of the start window");
  draw_head(model);
  ImGui::Spacing();
  draw_cards(picture_of, model);
  end_page();
  ImGui::SetNextWindowPos({part.x + part.width - panel, part.y});
  ImGui::SetNextWindowSize({panel, part.height});
  ImGui::Begin("choice of the start window", nullptr, kPageFlags);
  draw_choice(picture_of, model);
  ImGui::End();
  return request_;
}

}  // namespace thimble::view

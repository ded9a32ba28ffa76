#include "view/start/wait_page.h"

#include <epoxy/gl.h>
// After the header above, which includes OpenGL.
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>

#include "view/gl/palette.h"
#include "view/start/page_parts.h"

namespace thimble::view {

WaitRequest draw_wait_page(const ScreenPart& part, const std::string& name,
                           const std::string& trouble, const std::vector<int>& keys) {
  WaitRequest request = WaitRequest::kNone;
  for (const int key : keys) {
    if (key == GLFW_KEY_ENTER || key == GLFW_KEY_KP_ENTER) request = WaitRequest::kScenes;
    if (key == GLFW_KEY_Q) request = WaitRequest::kClose;
  }
  ImGui::SetNextWindowPos({part.x, part.y});
  ImGui::SetNextWindowSize({part.width, part.height});
  begin_page("waiting for a run");
  const float letter = ImGui::GetFontSize();
  // In heights of a letter [chosen: a sentence has about 60 letters in a line].
  const float width = std::min(32 * letter, ImGui::GetContentRegionAvail().x);
  const float left = std::max(0.0F, 0.5F * (part.width - width));
  ImGui::SetCursorPos({left, std::max(0.0F, 0.34F * part.height)});  // [chosen: above the middle]
  ImGui::BeginGroup();
  ImGui::PushTextWrapPos(left + width);
  write_title("Thimble");
  ImGui::Spacing();
  if (name.empty()) {
    ImGui::TextUnformatted("This window waits for a run, and shows it when it starts.");
  } else {
    ImGui::TextWrapped("This window waits for the run %s, and shows it when it starts.",
                       name.c_str());
  }
  if (!trouble.empty()) {
    ImGui::PushStyleColor(ImGuiCol_Text, shown_colour(kForceColour));
    ImGui::TextWrapped("%s", trouble.c_str());
    ImGui::PopStyleColor();
  }
  ImGui::Spacing();
  ImGui::TextDisabled("To start it, write in a terminal:");
  if (name.empty()) {
    ImGui::TextUnformatted("thimble run SCENE --view");
  } else {
    // Without a second window.
    ImGui::TextWrapped("thimble run SCENE --clock paced --no-view --name %s", name.c_str());
  }
  ImGui::PopTextWrapPos();
  ImGui::Spacing();
  ImGui::Spacing();
  if (main_button("Scenes (Enter)", std::min(12 * letter, width))) {
    request = WaitRequest::kScenes;
  }
  ImGui::EndGroup();
  end_page();
  return request;
}

}  // namespace thimble::view

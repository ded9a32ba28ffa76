#pragma once

#include <string>
#include <vector>

#include "view/text_style.h"

namespace thimble::view {

/// What the user asked of the page that waits for a run.
enum class WaitRequest {
  kNone,
  kScenes,  ///< The start window.
  kClose,
};

/// Draws the page of a window that waits for the run `name` (empty: any run), and returns the
/// request of the user. `trouble`: why a run of that name cannot be shown; empty: there is none.
/// `keys`: keys pressed since the last picture (GLFW_KEY_...). Call between ImGui's NewFrame and
/// Render.
WaitRequest draw_wait_page(const ScreenPart& part, const std::string& name,
                           const std::string& trouble, const std::vector<int>& keys);

}  // namespace thimble::view

#pragma once

#include <imgui.h>

namespace thimble::view {

/// Flags of the ImGui windows that fill a part of the screen.
inline constexpr ImGuiWindowFlags kPageFlags =
    ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
    ImGuiWindowFlags_NoBringToFrontOnFocus;

/// Begins a page with the background of the start window; its place and size are set before. Call
/// between ImGui's NewFrame and Render, as for the other functions.
void begin_page(const char* name);
void end_page();  ///< Ends it.

/// Writes a line with the larger font, if there is one.
void write_title(const char* text);

/// Draws a wide button in the colour of the depth, for the main action. Returns whether it was
/// pressed. `width`: pixels; -1: the available width.
bool main_button(const char* label, float width = -1);
/// Returns its height, pixels.
float main_button_height();

}  // namespace thimble::view

#pragma once

#include <string>
#include <vector>

#include "view/camera.h"
#include "view/gl/palette.h"
#include "view/touch_marks.h"

struct ImGuiContext;

namespace thimble::view {

/// Sets the style of text, panels and plots of the current ImGui context, `scale` times the usual
/// size (1 for 96 pixels an inch). Real-time: never from the servo thread.
void set_text_style(float scale, Theme theme = Theme::kLight);

/// Returns the theme of the current ImGui context.
Theme shown_theme();

/// A part of a window or picture, in pixels from the upper left corner.
struct ScreenPart {
  float x = 0, y = 0, width = 0, height = 0;
};

/// Draws labels next to their places, with a pale outline that makes them readable on any
/// background. Labels stay within the part of the screen, and do not cover each other. Call between
/// ImGui's NewFrame and Render.
void write_labels(const std::vector<Label>& labels, const Camera& camera, Theme theme,
                  const ScreenPart& part);

/// Draws one line at the lower left of a part, with the name of the scene and the width of the
/// grid.
void write_caption(const std::string& text, Theme theme, const ScreenPart& part);

/// A place on the screen, pixels from the upper left corner.
struct ScreenPlace {
  float x = 0, y = 0;
};

/// Draws one line of text from its upper left corner, with an outline in the background's colour.
void write_rimmed(const ScreenPlace& at, Theme theme, const Colour& colour,
                  const std::string& text);

/// Fills a part with one colour; later content is drawn over it.
void fill_part(const ScreenPart& part, const Colour& colour);

/// ImGui without a window, for text on pictures.
class PictureText {
 public:
  /// Precondition: a context of OpenGL 3.3 is current, and outlives this.
  explicit PictureText(float scale, Theme theme = Theme::kLight);
  PictureText(const PictureText&) = delete;
  PictureText& operator=(const PictureText&) = delete;
  ~PictureText();

  /// Begins a picture of this size, pixels. Until `end`, all text goes to it.
  void begin(int width, int height);
  /// Draws the text since `begin` onto the bound framebuffer.
  void end();

 private:
  ImGuiContext* context_;
};

}  // namespace thimble::view

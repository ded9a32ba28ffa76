#pragma once

#include <string>
#include <vector>

#include "view/camera.h"
#include "view/gl/palette.h"
#include "view/touch_marks.h"

struct ImGuiContext;

namespace thimble::view {

/// Gives text, panels and plots of the current ImGui context their looks, `scale` times as large as
/// on a usual screen (1 for 96 pixels an inch). Real-time: never from the servo thread.
void set_text_style(float scale, Theme theme = Theme::kLight);

/// Returns the theme that the looks of the current ImGui context are of.
Theme shown_theme();

/// A part of a window or picture, in pixels from the upper left corner.
struct ScreenPart {
  float x = 0, y = 0, width = 0, height = 0;
};

/// Writes labels beside their places, with a pale rim so that they are read on anything; none
/// leaves the part of the screen. To be called between ImGui's NewFrame and Render.
void write_labels(const std::vector<Label>& labels, const Camera& camera, Theme theme,
                  const ScreenPart& part);

/// Writes one line at the lower left of a part: what scene it is, and how wide the grid.
void write_caption(const std::string& text, Theme theme, const ScreenPart& part);

/// A place on the screen, pixels from the upper left corner.
struct ScreenPlace {
  float x = 0, y = 0;
};

/// Writes one line from its upper left corner on, with a rim of the background's colour.
void write_rimmed(const ScreenPlace& at, Theme theme, const Colour& colour,
                  const std::string& text);

/// Fills a part with one colour, behind everything else that is written there later.
void fill_part(const ScreenPart& part, const Colour& colour);

/// ImGui without a window, to write on pictures.
class PictureText {
 public:
  /// Precondition: a context of OpenGL 3.3 is current, and outlives this.
  explicit PictureText(float scale, Theme theme = Theme::kLight);
  PictureText(const PictureText&) = delete;
  PictureText& operator=(const PictureText&) = delete;
  ~PictureText();

  /// Begins a picture of this size, pixels. Until `end` all text goes there.
  void begin(int width, int height);
  /// Draws what was asked for since onto the framebuffer that is bound.
  void end();

 private:
  ImGuiContext* context_;
};

}  // namespace thimble::view

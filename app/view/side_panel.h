#pragma once

#include <string>

#include "share/shared_reader.h"
#include "view/playback/plot_panel.h"
#include "view/run_buttons.h"
#include "view/scene_painter.h"
#include "view/touch_source.h"

namespace thimble::view {

/// What the user chose by panel and keys.
struct ViewChoice {
  PaintChoice paint;
  PlotPanel plots;
  bool mouse_is_hand = false;  ///< A left drag leads the hand, and not the camera.
  bool help = false;
  RunButtons run;  ///< Of the run's course.
  // Asked for once; whoever does it sets them back.
  bool frame = true;
  bool screenshot = false;
  bool close = false;
};

/// What the panel says of the window itself.
struct ViewNotes {
  std::string notice;         ///< Above the scene: that the run has ended, say; empty: none.
  std::string message;        ///< Of what was just done; empty: none.
  double frame_time = 0;      ///< s, smoothed
  bool closing_ends = false;  ///< Whether the run ends with this window.
};

/// Returns how wide the panel is in a window, pixels: 380 at scale 1, at most half.
float panel_width(float window_width, float scale);

/// Draws the panel at the window's side: how the run is, force, depth and times over time, the
/// knobs, and what is drawn; of a recording what it is. Where they have no room below each other
/// they are tabs. A click into a plot moves the head of `source`. To be called between ImGui's
/// NewFrame and Render. Real-time: never from the servo thread.
void draw_side_panel(const ScreenPart& part, TouchSource& source, const ViewNotes& notes,
                     ViewChoice& choice);

/// Draws the notice, if there is one, and the help, if it is asked for, over the scene's part.
void draw_notices(const ScreenPart& part, const ViewNotes& notes, const ViewChoice& choice);

/// Does what a key asks for (a GLFW_KEY_...); lists of them stand in the help.
void take_key(int key, session::SharedReader* reader, ViewChoice& choice);

}  // namespace thimble::view

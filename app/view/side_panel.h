#pragma once

#include <string>
#include <vector>

#include "share/shared_reader.h"
#include "view/playback/plot_panel.h"
#include "view/run_buttons.h"
#include "view/scene_painter.h"
#include "view/touch_source.h"

namespace thimble::view {

/// The user's choices by panel and keys.
struct ViewChoice {
  PaintChoice paint;
  PlotPanel plots;
  bool mouse_is_hand = false;  ///< A left drag moves the hand instead of the camera.
  bool help = false;
  RunButtons run;  ///< Control of the run.
  // Requests; the code that executes them resets them.
  bool frame = true;
  bool to_tip = false;  ///< Moves the tip to the centre of the picture.
  bool screenshot = false;
  bool close = false;
  bool back = false;  ///< Opens the start window.
};

/// The notes of the panel about the window itself.
struct ViewNotes {
  std::string notice;         ///< Above the scene, for example that the run has ended; empty: none.
  std::string message;        ///< Message about the last action; empty: none.
  double frame_time = 0;      ///< s, smoothed
  bool closing_ends = false;  ///< Whether the run ends with this window.
  ScreenPart legend;          ///< Part of the scene that the legend covers.
  // What is shown, for the list of keys.
  bool recording = false;     ///< A recording; otherwise a run.
  bool leads = false;         ///< The window moves the hand of the run.
  bool own_run = false;       ///< Whether this window started the run.
  bool start_window = false;  ///< The start window opened this, and can be shown again.
  bool holds_key = false;     ///< The space bar enables the force (--hold-to-run key).
};

/// Returns the panel's width in a window, pixels: 380 at scale 1, at most half of the window.
float panel_width(float window_width, float scale);

/// Draws the panel at the window's side: state of the run, force, depth and times over time, knobs,
/// and drawing options; for a recording its description. If they do not fit below each other, they
/// are tabs. A click into a plot moves the head of `source`. Call between ImGui's NewFrame and
/// Render. Real-time: never from the servo thread.
void draw_side_panel(const ScreenPart& part, TouchSource& source, const ViewNotes& notes,
                     ViewChoice& choice);

/// Returns the keys that have an effect, for the help.
std::vector<RunKey> listed_keys(const ViewNotes& notes);

/// Draws the notice, if any, beside the legend or below it, and the help, if requested, over the
/// scene's part. The help has each key once, and only keys that have an effect.
void draw_notices(const ScreenPart& part, const ViewNotes& notes, const ViewChoice& choice);

/// Handles a key (a GLFW_KEY_...); the help lists them.
void take_key(int key, session::SharedReader* reader, ViewChoice& choice);

}  // namespace thimble::view

#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "thimble/driver/result.h"
#include "view/feedback/touch_thread.h"
#include "view/gl/canvas.h"
#include "view/input/hand_panel.h"
#include "view/scene_mouse.h"
#include "view/scene_painter.h"
#include "view/screen.h"
#include "view/side_panel.h"
#include "view/touch_source.h"
#include "view/window.h"

namespace thimble::view {

/// The content of a window that shows a run or a recording, across pictures. Real-time: never from
/// the servo thread.
class Content {
 public:
  /// Shows `source` on `screen`; both must outlive this.
  Content(Screen& screen, TouchSource& source, const WindowChoice& choice);

  /// Draws one picture into the window.
  driver::Result<void> draw(double frame_time);
  bool wants_to_close() const { return choice_.close; }
  /// Returns whether the user asked, since the last call, for the start window.
  bool take_back() { return std::exchange(choice_.back, false); }
  /// Returns whether the user asked, since the last call, to start an ended run again.
  bool take_run_again() { return choice_.run.take_run_again(); }
  /// Offers the way back to the start window.
  void offer_start_window() { notes_.start_window = true; }
  /// Sets whether this window started the run, so that the run ends with the window.
  void set_own_run(bool own) { notes_.own_run = own; }
  /// Sets whether an ended run can be started again.
  void set_can_run_again(bool can) { choice_.run.set_can_run_again(can); }
  Theme theme() const { return choice_.paint.theme; }
  void show_message(const std::string& message);
  /// Returns whether nothing moves by itself: there is no live run, and nothing plays.
  bool still();

 private:
  void draw_scene(const ScreenPart& part, int below, float ratio);
  void lead_hand(const ScreenPart& part);
  bool arrows_lead() const;
  void hold_key();
  void hold_buttons();
  void begin_run(session::SharedReader& run, bool again);
  void take_picture();

  Screen& screen_;
  TouchSource& source_;
  std::unique_ptr<ScenePainter> painter_;
  std::optional<Canvas> canvas_;
  Camera camera_;
  SceneMouse mouse_;
  HandPanel hand_;
  bool led_ = false;
  bool buttons_held_ = false;
  std::vector<int> keys_;  // pressed since the last picture
  double frame_time_ = 0;  // of the last picture, s
  TouchThread feedback_;
  bool felt_follows_ = false;
  std::string shown_file_;  // scene file of the run that is shown
  ViewChoice choice_;
  ViewNotes notes_;
  std::chrono::steady_clock::time_point message_until_{};
};

}  // namespace thimble::view

#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "share/shared_reader.h"
#include "thimble/driver/result.h"
#include "thimble/session/session.h"
#include "view/gl/offscreen_context.h"
#include "view/live_scene.h"
#include "view/playback/plots.h"
#include "view/scene_painter.h"

namespace thimble::view {

/// A scene that plays on the virtual clock, to take pictures of. It shows the same as a viewer,
/// through the same shared memory, but stops at any tick.
class PlayedScene {
 public:
  /// Loads a scene. The error is that of Session::open. Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<PlayedScene>> open(const std::filesystem::path& scene,
                                                           const session::SessionOptions& options);

  /// Callback for a moment; `last` is the last tick that was.
  using Look = std::function<void(DrawnMoment& moment, const Plots& plots)>;

  /// Plays the scene once and calls `look` for each of these times (s, in order). The tick is the
  /// last one that is no later, or the last of the run. As in a viewer and in a recording
  /// (RecordingView), tip, force and poses are those of the tick. A dent is the last one drawn
  /// (session::DentRecord), at most 16 ms before. Then it ends the recording, if the options
  /// requested one.
  void play(const std::vector<double>& times, const Look& look);

  const DrawnScene& drawn() const { return live_->scene(); }

 private:
  PlayedScene() = default;

  std::unique_ptr<session::Session> session_;
  std::unique_ptr<session::SharedReader> reader_;
  std::unique_ptr<LiveScene> live_;
};

/// Returns the time (s) of the largest force in a scene; half of its duration if there is no force.
/// The error is that of Session::open. Real-time: never from the servo thread.
driver::Result<double> strongest_moment(const std::filesystem::path& scene,
                                        const session::SessionOptions& options);

/// Options of a picture of a scene.
struct ShotChoice {
  int width = 960, height = 640;  ///< pixels
  PaintChoice paint;
  bool plots = false;            ///< Force and depth over time, below the scene.
  bool caption = true;           ///< Text with scene, time and grid.
  std::optional<Camera> camera;  ///< Automatic if empty.
};

/// Draws moments of a scene into pictures. OpenGL objects are kept between pictures.
class ShotPainter {
 public:
  /// Precondition: a context of OpenGL 3.3 is current, and outlives this.
  ShotPainter(const DrawnScene& scene, const ShotChoice& choice, ScenePrograms programs);
  ~ShotPainter();

  /// Frames the scene at this moment, if no camera was chosen.
  void frame_at(const DrawnMoment& moment);
  /// Paints a moment. Frames the camera if it was not framed before.
  Picture paint(const DrawnMoment& moment, const Plots& plots);

  ShotChoice& choice() { return choice_; }
  const Camera& camera() const { return *choice_.camera; }

 private:
  ShotChoice choice_;
  ScenePainter painter_;
  Canvas canvas_;
  std::unique_ptr<PictureText> text_;
  float scale_;
};

}  // namespace thimble::view

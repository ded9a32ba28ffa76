#include "view/start/follow_window.h"

#include <epoxy/gl.h>
// After the header above, which includes OpenGL.
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <cstdint>
#include <memory>

#include "log/logger.h"
#include "view/content/content.h"
#include "view/content/window_loop.h"
#include "view/run_follower.h"
#include "view/start/child_process.h"
#include "view/start/run_again.h"
#include "view/start/start_flow.h"
#include "view/start/start_window.h"
#include "view/start/wait_page.h"

namespace thimble::view {
namespace {

class FollowWindow {
 public:
  FollowWindow(Screen& screen, session::RunAttachment& runs, const FollowSetup& setup,
               const WindowChoice& choice)
      : screen_(screen), runs_(runs), setup_(setup), choice_(choice), follower_(runs) {
    screen_.set_scale(choice.ui_scale);
  }
  ~FollowWindow() {
    if (process_ && !process_->ended())
      scene::terminal().info("The window ends the run {} that it started.", runs_.name());
  }

  driver::Result<AfterPicture> draw(double dt);

 private:
  driver::Result<AfterPicture> draw_waiting(double dt);
  void open_start_window(const std::string& file);
  void step_run();
  void restart();
  bool started_here(const session::SharedReader& reader) const;

  Screen& screen_;
  session::RunAttachment& runs_;
  const FollowSetup& setup_;
  const WindowChoice& choice_;
  RunFollower follower_;
  StartFlow flow_ = StartFlow::waiting();
  std::unique_ptr<ChildProcess> process_;  // of a run that was started again
  std::vector<std::int64_t> pids_;         // of the runs that `setup_.again` describes
  std::vector<ChangedKnob> knobs_;         // to be set in the run that was started again
  std::unique_ptr<Content> content_;
  DrawPicture start_;  // the start window, after the user has opened it
  double awake_ = 0;   // s of pictures without an input that are left
};

void FollowWindow::open_start_window(const std::string& file) {
  start_ = start_window_on(screen_, {.thimble = setup_.thimble, .open = file}, choice_);
}

driver::Result<AfterPicture> FollowWindow::draw_waiting(double dt) {
  constexpr double kDrawnOn = 0.5;  // s of pictures after an input [chosen: as in the start window]
  screen_.begin(choice_.theme);
  int pixels_x = 0;
  int pixels_y = 0;
  glfwGetFramebufferSize(screen_.window(), &pixels_x, &pixels_y);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, pixels_x, pixels_y);
  const Colour ground = colours_of(choice_.theme).sky;
  glClearColor(ground[0], ground[1], ground[2], 1);
  glClear(GL_COLOR_BUFFER_BIT);
  const ImGuiIO& io = ImGui::GetIO();
  const std::vector<int> keys = screen_.take_keys();
  const bool input =
      io.MouseDelta.x != 0 || io.MouseDelta.y != 0 || io.MouseDown[0] || !keys.empty();
  awake_ = input ? kDrawnOn : awake_ - dt;
  const WaitRequest request =
      draw_wait_page({0, 0, io.DisplaySize.x, io.DisplaySize.y}, runs_.name(), runs_.error(), keys);
  screen_.end();
  if (request == WaitRequest::kClose) return AfterPicture::kClose;
  if (request == WaitRequest::kScenes) open_start_window({});
  for (const std::string& file : screen_.take_drops()) open_start_window(file);
  return awake_ > 0 || start_ ? AfterPicture::kMoves : AfterPicture::kStill;
}

/// Returns whether the run is the one that opened this window, or was started again by it.
bool FollowWindow::started_here(const session::SharedReader& reader) const {
  return std::find(pids_.begin(), pids_.end(), reader.scene().pid) != pids_.end();
}

void FollowWindow::step_run() {
  session::SharedReader* const reader = runs_.reader();
  if (process_) {
    if (const auto code = process_->ended()) {
      flow_.run_ended(*code, process_->text());
      process_.reset();
      knobs_.clear();
      if (!flow_.message().empty()) content_->show_message(flow_.message());
    }
  } else {
    flow_.other_run_over(runs_.over());
  }
  if (!knobs_.empty() && reader != nullptr && reader->scene().pid == process_->pid()) {
    turn_knobs(*reader, knobs_);
    knobs_.clear();
  }
  // The first process is the one that opened this window.
  content_->set_own_run(process_ || (reader != nullptr && started_here(*reader) &&
                                     reader->scene().pid != pids_.front()));
  content_->set_can_run_again(!setup_.again.empty() && flow_.run_again() && reader != nullptr &&
                              started_here(*reader));
}

void FollowWindow::restart() {
  const session::SharedReader& reader = *runs_.reader();
  auto started = ChildProcess::start(
      setup_.thimble, run_again_command(setup_.again, reader.scene().file, runs_.name()),
      {.keep_errors = true});
  if (!started) return content_->show_message(started.error().message);
  process_ = std::move(started).value();
  knobs_ = changed_knobs(reader);
  pids_.push_back(process_->pid());
  flow_.run_started();
}

driver::Result<AfterPicture> FollowWindow::draw(double dt) {
  if (start_) return start_(dt);
  if (flow_.stage() == StartStage::kWaiting) {
    follower_.step(dt);
    if (!follower_.has_scene()) return draw_waiting(dt);
    content_ = std::make_unique<Content>(screen_, follower_, choice_);
    pids_.push_back(runs_.reader()->scene().pid);
    flow_.shown();
  }
  step_run();
  if (auto drawn = content_->draw(dt); !drawn) return drawn.error();
  if (content_->wants_to_close()) return AfterPicture::kClose;
  if (content_->take_run_again() && flow_.run_again()) restart();
  return content_->still() && !process_ ? AfterPicture::kStill : AfterPicture::kMoves;
}

}  // namespace

driver::Result<void> show_window(session::RunAttachment& runs, const FollowSetup& setup,
                                 const WindowChoice& choice) {
  auto screen = Screen::open();
  if (!screen) return screen.error();
  FollowWindow window(**screen, runs, setup, choice);
  return draw_until_closed(**screen, choice, [&](double dt) { return window.draw(dt); });
}

}  // namespace thimble::view

#include "view/content/content.h"

#include <epoxy/gl.h>
// After the header above, which includes OpenGL.
#include <GLFW/glfw3.h>
#include <imgui.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "log/logger.h"
#include "view/compare/run_list.h"
#include "view/gl/picture_file.h"
#include "view/overlays/legend.h"
#include "view/overlays/off_picture.h"
#include "view/playback/time_line.h"

namespace thimble::view {
namespace {

constexpr double kMessageSeconds = 4;
constexpr int kButtonKeys = 4;  // keys 1 to 4 [chosen: no arm has more buttons in easy reach]

/// Returns the file name of a picture, from run and time.
std::string picture_name(const std::string& run) {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  char text[32];
  std::strftime(text, sizeof text, "-%Y%m%d-%H%M%S.png", &local);
  return "thimble-" + (run.empty() ? "view" : run) + text;
}

/// Returns whether the renderer is software instead of a graphics card: then a picture of best
/// quality takes 1.6 times as long as necessary (tests/bench/view_bench).
bool software_draws() {
  const auto* words = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  const std::string name = words == nullptr ? "" : words;
  return name.find("llvmpipe") != std::string::npos || name.find("softpipe") != std::string::npos;
}

}  // namespace

Content::Content(Screen& screen, TouchSource& source, const WindowChoice& choice)
    : screen_(screen), source_(source), feedback_(choice.felt) {
  screen_.set_scale(choice.ui_scale);
  choice_.paint.theme = choice.theme;
  choice_.paint.fine = !software_draws();
  hand_.input().choose(choice.hand);
  if (!feedback_.trouble().empty()) {
    scene::logger().warn("{}", feedback_.trouble());
    show_message(feedback_.trouble());
  }
}

bool Content::still() {
  const session::SharedReader* const reader = source_.reader();
  return !source_.head().plays() &&
         (reader == nullptr || reader->state() == session::RunState::kEnded);
}

void Content::show_message(const std::string& message) {
  notes_.message = message;
  message_until_ = std::chrono::steady_clock::now() +
                   std::chrono::milliseconds(static_cast<int>(kMessageSeconds * 1000));
}

void Content::take_picture() {
  const std::string file = picture_name(source_.name());
  const auto written = write_png(canvas_->read(), file, PngColours::kAll);
  show_message(written ? "Picture: " + file : written.error().message);
}

// The mouse has priority while it drags; another source starts the hand again afterwards. While a
// moment of the past is shown, no input moves the hand.
void Content::lead_hand(const ScreenPart& part) {
  session::SharedReader& run = *source_.reader();
  const bool live = source_.head().live();
  const Eigen::Vector3d p_WT(source_.moment().tick.p_WT.data());
  const bool by_mouse = mouse_.hand().holds && live;
  if (by_mouse || !live) hand_.input().let_go();
  const session::SharedScene::Arm& arm = run.scene().arms.front();
  hand_.step(
      keys_, camera_, p_WT, {arm.min_W, arm.max_W}, frame_time_,
      live && !by_mouse && source_.has_moment() && run.state() == session::RunState::kRunning);
  MouseHandTarget hand = by_mouse ? mouse_.hand() : hand_.input().hand();
  hand.holds = hand.holds && live;
  if (hand.holds || led_) {
    run.lead_hand(hand.p_WH, hand.holds);
    led_ = hand.holds;
  }
  if (!live) return;
  // A hand that keys or a cap lead does not leave the picture. The mouse cannot leave it.
  constexpr double kShare = 0.92;  // of the picture's half; chosen: the ring is seen as a whole
  if (hand.holds && !by_mouse) {
    keep_in_picture(camera_, hand.p_WH, static_cast<double>(part.width / part.height), kShare);
  }
  hand_.draw_target(hand, p_WT, camera_, part);
  if (hand_.draw_box(hand.holds, part)) {
    choice_.mouse_is_hand = hand_.input().source() == HandSource::kMouse;
  }
}

// Returns whether the arrow keys move the hand; otherwise they move the time.
bool Content::arrows_lead() const {
  session::SharedReader* const reader = source_.reader();
  return reader != nullptr && reader->scene().hand_by_mouse && source_.head().live() &&
         hand_.input().source() == HandSource::kKeyboard;
}

/// Reports that the space bar is held, if it is the run's enabling input. GLFW releases all keys of
/// a window that loses the focus.
void Content::hold_key() {
  session::SharedReader* const reader = source_.reader();
  if (reader == nullptr || !reader->scene().hold_by_key) return;
  GLFWwindow* const window = screen_.window();
  const bool held = glfwGetKey(window, GLFW_KEY_SPACE) == GLFW_PRESS &&
                    glfwGetWindowAttrib(window, GLFW_FOCUSED) == GLFW_TRUE &&
                    !ImGui::GetIO().WantTextInput;
  if (held) reader->hold_key();
}

/// Holds the buttons of a simulated arm while the keys 1 to 4 are held.
void Content::hold_buttons() {
  session::SharedReader* const reader = source_.reader();
  if (reader == nullptr || !source_.head().live()) return;
  GLFWwindow* const window = screen_.window();
  unsigned held = 0;
  if (glfwGetWindowAttrib(window, GLFW_FOCUSED) == GLFW_TRUE && !ImGui::GetIO().WantTextInput) {
    for (int button = 0; button < kButtonKeys; ++button) {
      if (glfwGetKey(window, GLFW_KEY_1 + button) == GLFW_PRESS) held |= 1U << button;
    }
  }
  if (held != 0 || buttons_held_) reader->hold_buttons(static_cast<std::uint16_t>(held));
  buttons_held_ = held != 0;
}

void Content::draw_scene(const ScreenPart& part, int below, float ratio) {
  const int width = std::max(1, static_cast<int>(part.width * ratio));
  const int height = std::max(1, static_cast<int>(part.height * ratio));
  if (!canvas_ || canvas_->width() != width || canvas_->height() != height) {
    canvas_.emplace(width, height);
  }
  const DrawnMoment& moment = source_.moment();
  if (choice_.frame && source_.has_moment()) {
    camera_ = frame(source_.scene(), moment, canvas_->aspect());
    choice_.frame = false;
  }
  const Eigen::Map<const Eigen::Vector3d> p_WT(moment.tick.p_WT.data());
  if (choice_.to_tip && p_WT.allFinite()) camera_.p_WTarget = p_WT;
  choice_.to_tip = false;
  mouse_.step(camera_, p_WT, part, choice_.mouse_is_hand);
  if (source_.reader() != nullptr && source_.reader()->scene().hand_by_mouse) lead_hand(part);
  const auto labels = painter_->paint(moment, camera_, choice_.paint, *canvas_);
  canvas_->show(0, below);
  const Theme theme = choice_.paint.theme;
  write_labels(labels, camera_, theme, part);
  Legend legend = legend_of(source_.scene(), moment, choice_.paint);
  if (const Comparison* const runs = source_.comparison()) {
    const auto lines = run_lines(*runs);
    legend.lines.insert(legend.lines.begin(), lines.begin(), lines.end());
  }
  notes_.legend = write_legend(legend, theme, part);
  if (source_.has_moment()) draw_arrow_to_tip(camera_, p_WT, theme, part);
  write_caption(choice_.paint.grid ? "grid 10 mm; F1: help" : "F1: help", theme, part);
  if (choice_.screenshot) take_picture();
  choice_.screenshot = false;
}

void Content::begin_run(session::SharedReader& run, bool again) {
  const session::SharedScene& scene = run.scene();
  const bool by_mouse = hand_.input().source() == HandSource::kMouse;
  if (!again) choice_.mouse_is_hand = scene.hand_by_mouse && by_mouse;
  hand_.input().let_go();
  if (scene.hold_by_key) show_message("Hold the space bar in this window to enable forces.");
  if (!by_mouse && !scene.hand_by_mouse) {
    show_message("The hand of this run follows its path. Start the run with --hand to move it.");
  }
  if (!felt_follows_) feedback_.follow(run.name());
  felt_follows_ = true;
  // The run started this window.
  notes_.closing_ends = notes_.own_run || (scene.hand_by_mouse && scene.pid == getppid());
}

driver::Result<void> Content::draw(double frame_time) {
  notes_.frame_time += (notes_.frame_time > 0 ? 0.05 : 1) * (frame_time - notes_.frame_time);
  // The source may have a scene already: then the first picture begins it.
  if (source_.step(frame_time) || (painter_ == nullptr && source_.has_scene())) {
    auto programs = ScenePrograms::make();
    if (!programs) return programs.error();
    painter_ = std::make_unique<ScenePainter>(source_.scene(), std::move(programs).value());
    session::SharedReader* const reader = source_.reader();
    // A restart of the same scene keeps the camera.
    const std::string file = reader != nullptr ? reader->scene().file : std::string();
    const bool again = !file.empty() && file == shown_file_;
    if (!again) choice_.frame = true;
    shown_file_ = file;
    if (reader != nullptr) begin_run(*reader, again);
    glfwSetWindowTitle(screen_.window(), ("Thimble: " + source_.scene().name).c_str());
  }
  screen_.begin(choice_.paint.theme);
  int pixels_x = 0;
  int pixels_y = 0;
  glfwGetFramebufferSize(screen_.window(), &pixels_x, &pixels_y);
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float ratio = size.x > 0 ? static_cast<float>(pixels_x) / size.x : 1;
  const float panel = panel_width(size.x, screen_.scale());
  const float line = painter_ != nullptr ? TimeLine::height(size.x - panel) : 0;
  const ScreenPart scene{0, 0, size.x - panel, size.y - line};
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, pixels_x, pixels_y);
  const Colour ground = colours_of(choice_.paint.theme).ground;
  glClearColor(ground[0], ground[1], ground[2], 1);
  glClear(GL_COLOR_BUFFER_BIT);
  keys_ = screen_.take_keys();
  hold_key();
  hold_buttons();
  frame_time_ = frame_time;
  for (const int key : keys_) {
    if (!TimeLine::take_key(key, source_, !arrows_lead())) take_key(key, source_.reader(), choice_);
  }
  if (painter_ != nullptr && scene.width >= 1 && scene.height >= 1) {
    draw_scene(scene, static_cast<int>(line * ratio), ratio);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, pixels_x, pixels_y);
  notes_.notice = source_.notice();
  if (source_.reader() != nullptr && choice_.run.offers_run_again(*source_.reader())) {
    notes_.notice = "The run has ended. Press B to run it again.";
  }
  if (std::chrono::steady_clock::now() > message_until_) notes_.message.clear();
  draw_side_panel({scene.width, 0, panel, size.y}, source_, notes_, choice_);
  if (const std::string message = choice_.run.take_message(); !message.empty())
    show_message(message);
  if (painter_ != nullptr) {
    const std::string refused = TimeLine::draw({0, scene.height, scene.width, line}, source_);
    if (!refused.empty()) show_message(refused);
  }
  session::SharedReader* const reader = source_.reader();
  notes_.recording = reader == nullptr && source_.has_scene();
  notes_.leads = reader != nullptr && reader->scene().hand_by_mouse;
  notes_.holds_key = reader != nullptr && reader->scene().hold_by_key;
  draw_notices(scene, notes_, choice_);
  screen_.end();
  return {};
}

}  // namespace thimble::view

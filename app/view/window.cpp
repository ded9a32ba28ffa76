#include "view/window.h"

#include <epoxy/gl.h>
// After the above, which brings OpenGL.
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <memory>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "print.h"
#include "view/felt/touch_thread.h"
#include "view/gl/picture_file.h"
#include "view/hand/hand_panel.h"
#include "view/marks/legend.h"
#include "view/run_follower.h"
#include "view/scene_mouse.h"
#include "view/side_panel.h"

namespace thimble::app::view {
namespace {

constexpr double kFrame = 1.0 / 60;  // s
constexpr double kMessageSeconds = 4;

std::string glfw_words() {
  const char* words = nullptr;
  glfwGetError(&words);
  return words == nullptr ? "GLFW gives no reason" : words;
}

/// Names a picture by run and time.
std::string picture_name(const std::string& run) {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  char text[32];
  std::strftime(text, sizeof text, "-%Y%m%d-%H%M%S.png", &local);
  return "thimble-" + (run.empty() ? "view" : run) + text;
}

/// The window with its OpenGL and ImGui; all go with it.
class Screen {
 public:
  static driver::Result<std::unique_ptr<Screen>> open() {
    std::unique_ptr<Screen> screen(new Screen);
    if (glfwInit() == GLFW_FALSE) {
      return driver::Error{"No window: " + glfw_words() +
                           ". Is there a screen? `thimble view --text` needs none."};
    }
    screen->glfw_ = true;
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    screen->window_ = glfwCreateWindow(1280, 800, "Thimble", nullptr, nullptr);
    if (screen->window_ == nullptr) return driver::Error{"No window: " + glfw_words() + "."};
    glfwMakeContextCurrent(screen->window_);
    glfwSwapInterval(1);
    // Heard one by one, so that none is lost where pictures take long.
    glfwSetWindowUserPointer(screen->window_, screen.get());
    glfwSetKeyCallback(screen->window_, [](GLFWwindow* window, int key, int, int action, int) {
      auto* self = static_cast<Screen*>(glfwGetWindowUserPointer(window));
      if (action == GLFW_PRESS) self->keys_.push_back(key);
    });
    ImGui::CreateContext();
    screen->imgui_ = true;
    ImGui_ImplGlfw_InitForOpenGL(screen->window_, true);
    ImGui_ImplOpenGL3_Init("#version 330 core");
    return screen;
  }
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;
  ~Screen() {
    if (imgui_) {
      ImGui_ImplOpenGL3_Shutdown();
      ImGui_ImplGlfw_Shutdown();
      ImGui::DestroyContext();
    }
    if (window_ != nullptr) glfwDestroyWindow(window_);
    if (glfw_) glfwTerminate();
  }

  GLFWwindow* window() { return window_; }
  float scale() const { return scale_; }
  /// Scales text and panel by this from now on; 0: as the monitor is.
  void set_scale(double wanted) { wanted_scale_ = static_cast<float>(wanted); }
  /// Gives the keys pressed since it was asked last, but those typed into a field.
  std::vector<int> take_keys() {
    std::vector<int> keys = std::exchange(keys_, {});
    if (ImGui::GetIO().WantTextInput) keys.clear();
    return keys;
  }

  void begin(Theme theme) {
    glfwPollEvents();
    float x = 1;
    float y = 1;
    glfwGetWindowContentScale(window_, &x, &y);
    const float scale = wanted_scale_ > 0 ? wanted_scale_ : std::max(x, y);
    if (scale != scale_ || theme != theme_) {
      scale_ = scale;
      theme_ = theme;
      ImGui_ImplOpenGL3_DestroyFontsTexture();
      set_text_style(scale_, theme_);
    }
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
  }

  void end() {
    ImGui::Render();
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  }

 private:
  Screen() = default;

  bool glfw_ = false;
  bool imgui_ = false;
  GLFWwindow* window_ = nullptr;
  float scale_ = 0;
  float wanted_scale_ = 0;  // 0: the monitor's
  Theme theme_ = Theme::kLight;
  std::vector<int> keys_;
};

/// Reads what the window shows.
Picture read_window(GLFWwindow* window) {
  Picture picture;
  glfwGetFramebufferSize(window, &picture.width, &picture.height);
  const auto row = 3 * static_cast<std::size_t>(picture.width);
  std::vector<std::uint8_t> upward(row * static_cast<std::size_t>(picture.height));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, picture.width, picture.height, GL_RGB, GL_UNSIGNED_BYTE, upward.data());
  for (auto from = upward.end(); from != upward.begin();) {
    from -= static_cast<std::ptrdiff_t>(row);
    picture.rgb.insert(picture.rgb.end(), from, from + static_cast<std::ptrdiff_t>(row));
  }
  return picture;
}

/// Returns whether the processor draws in place of a graphics card: then a picture as fine as can
/// be takes 2.5 times as long as need be (tests/bench/view_bench).
bool software_draws() {
  const auto* words = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  const std::string name = words == nullptr ? "" : words;
  return name.find("llvmpipe") != std::string::npos || name.find("softpipe") != std::string::npos;
}

/// The window's content from picture to picture.
class Content {
 public:
  Content(Screen& screen, session::RunAttachment& runs, const WindowChoice& choice)
      : screen_(screen), follower_(runs), felt_(choice.felt) {
    screen_.set_scale(choice.ui_scale);
    choice_.paint.theme = choice.theme;
    choice_.paint.fine = !software_draws();
    hand_.input().choose(choice.hand);
    if (!felt_.trouble().empty()) {
      session::print(stderr, "{}\n", felt_.trouble());
      tell(felt_.trouble());
    }
  }

  /// Draws one picture into the window.
  driver::Result<void> draw(double frame_time);
  bool wants_to_close() const { return choice_.close; }
  /// Returns whether nothing moves by itself: there is no run, or it has ended.
  bool still() {
    return follower_.reader() == nullptr ||
           follower_.reader()->state() == session::RunState::kEnded;
  }

 private:
  void draw_scene(const ScreenPart& part, float ratio);
  void lead_hand(const ScreenPart& part);
  void take_picture();
  void tell(const std::string& message);

  Screen& screen_;
  RunFollower follower_;
  std::unique_ptr<ScenePainter> painter_;
  std::optional<Canvas> canvas_;
  bool canvas_fine_ = true;
  Camera camera_;
  SceneMouse mouse_;
  HandPanel hand_;
  bool led_ = false;
  std::vector<int> keys_;  // pressed since the last picture
  double frame_time_ = 0;  // s, of the last picture
  TouchThread felt_;
  bool felt_follows_ = false;
  ViewChoice choice_;
  ViewNotes notes_;
  std::chrono::steady_clock::time_point message_until_{};
};

void Content::tell(const std::string& message) {
  notes_.message = message;
  message_until_ = std::chrono::steady_clock::now() +
                   std::chrono::milliseconds(static_cast<int>(kMessageSeconds * 1000));
}

void Content::take_picture() {
  const std::string file = picture_name(follower_.reader()->name());
  const auto written = write_png(canvas_->read(), file, PngColours::kAll);
  tell(written ? "Picture: " + file : written.error().message);
}

// The mouse has the hand while it drags; what else leads it takes it anew afterwards.
void Content::lead_hand(const ScreenPart& part) {
  session::SharedReader& run = *follower_.reader();
  const Eigen::Vector3d p_WT(follower_.moment().tick.p_WT.data());
  const bool by_mouse = mouse_.hand().holds;
  if (by_mouse) hand_.input().let_go();
  const session::SharedScene::Arm& arm = run.scene().arm;
  hand_.step(keys_, camera_, p_WT, {arm.min_W, arm.max_W}, frame_time_,
             !by_mouse && follower_.has_moment() && run.state() == session::RunState::kRunning);
  const HandWish& hand = by_mouse ? mouse_.hand() : hand_.input().hand();
  if (hand.holds || led_) {
    run.lead_hand(hand.p_WH, hand.holds);
    led_ = hand.holds;
  }
  hand_.draw_target(hand, p_WT, camera_, part);
  if (hand_.draw_box(hand.holds, part)) {
    choice_.mouse_is_hand = hand_.input().source() == HandSource::kMouse;
  }
}

void Content::draw_scene(const ScreenPart& part, float ratio) {
  const int width = std::max(1, static_cast<int>(part.width * ratio));
  const int height = std::max(1, static_cast<int>(part.height * ratio));
  if (!canvas_ || canvas_->width() != width || canvas_->height() != height ||
      canvas_fine_ != choice_.paint.fine) {
    canvas_fine_ = choice_.paint.fine;
    canvas_.emplace(width, height, 0, canvas_fine_ ? Canvas::kSamples : 1);
  }
  const DrawnMoment& moment = follower_.moment();
  if (choice_.frame && follower_.has_moment()) {
    camera_ = frame(follower_.scene(), moment, canvas_->aspect());
    choice_.frame = false;
  }
  const Eigen::Map<const Eigen::Vector3d> p_WT(moment.tick.p_WT.data());
  mouse_.step(camera_, p_WT, part, choice_.mouse_is_hand);
  if (follower_.reader()->scene().hand_by_mouse) lead_hand(part);
  const auto labels = painter_->paint(moment, camera_, choice_.paint, *canvas_);
  canvas_->show(0, 0);
  const Theme theme = choice_.paint.theme;
  write_labels(labels, camera_, theme, part);
  write_legend(legend_of(follower_.scene(), moment, choice_.paint), theme, part);
  write_caption(choice_.paint.grid ? "grid 10 mm; F1: help" : "F1: help", theme, part);
  if (choice_.screenshot) take_picture();
  choice_.screenshot = false;
}

driver::Result<void> Content::draw(double frame_time) {
  notes_.frame_time += (notes_.frame_time > 0 ? 0.05 : 1) * (frame_time - notes_.frame_time);
  if (follower_.step()) {
    auto programs = ScenePrograms::make();
    if (!programs) return programs.error();
    painter_ = std::make_unique<ScenePainter>(follower_.scene(), std::move(programs).value());
    choice_.frame = true;
    const session::SharedScene& scene = follower_.reader()->scene();
    const bool by_mouse = hand_.input().source() == HandSource::kMouse;
    choice_.mouse_is_hand = scene.hand_by_mouse && by_mouse;
    hand_.input().let_go();
    if (!by_mouse && !scene.hand_by_mouse) {
      tell("The hand of this run follows its path: begin it with --hand to lead it.");
    }
    if (!felt_follows_) felt_.follow(follower_.reader()->name());
    felt_follows_ = true;
    notes_.closing_ends = scene.hand_by_mouse && scene.pid == getppid();  // which has opened it
    glfwSetWindowTitle(screen_.window(), ("Thimble: " + follower_.scene().name).c_str());
  }
  screen_.begin(choice_.paint.theme);
  int pixels_x = 0;
  int pixels_y = 0;
  glfwGetFramebufferSize(screen_.window(), &pixels_x, &pixels_y);
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float ratio = size.x > 0 ? static_cast<float>(pixels_x) / size.x : 1;
  const float panel = panel_width(size.x, screen_.scale());
  const ScreenPart scene{0, 0, size.x - panel, size.y};
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, pixels_x, pixels_y);
  const Colour ground = colours_of(choice_.paint.theme).ground;
  glClearColor(ground[0], ground[1], ground[2], 1);
  glClear(GL_COLOR_BUFFER_BIT);
  keys_ = screen_.take_keys();
  frame_time_ = frame_time;
  for (const int key : keys_) take_key(key, follower_.reader(), choice_);
  if (painter_ != nullptr && scene.width >= 1 && scene.height >= 1) draw_scene(scene, ratio);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, pixels_x, pixels_y);
  notes_.notice = follower_.notice();
  if (std::chrono::steady_clock::now() > message_until_) notes_.message.clear();
  draw_side_panel({scene.width, 0, panel, size.y}, follower_.reader(), follower_.moment().tick,
                  follower_.plots(), notes_, choice_);
  draw_notices(scene, notes_, choice_);
  screen_.end();
  return {};
}

}  // namespace

driver::Result<void> show_window(session::RunAttachment& runs, const WindowChoice& choice) {
  auto screen = Screen::open();
  if (!screen) return screen.error();
  GLFWwindow* window = (*screen)->window();
  Content content(**screen, runs, choice);
  const double began = glfwGetTime();
  double last = began;
  while (glfwWindowShouldClose(window) == GLFW_FALSE && !content.wants_to_close()) {
    const double now = glfwGetTime();
    if (auto drawn = content.draw(now - last); !drawn) return drawn.error();
    last = now;
    const bool over = choice.seconds > 0 && now - began > choice.seconds;
    if (over && !choice.last_picture.empty()) {
      const auto written = write_png(read_window(window), choice.last_picture, PngColours::kAll);
      if (!written) return written.error();
    }
    if (over) break;
    glfwSwapBuffers(window);
    // Waiting for a run takes no processor; the mouse and the keys wake it.
    if (content.still()) glfwWaitEventsTimeout(0.25);
    // Where the screen does not set the pace (a remote one, say), this does.
    const double rest = kFrame - (glfwGetTime() - now);
    if (rest > 0.002) std::this_thread::sleep_for(std::chrono::duration<double>(rest - 0.001));
  }
  return {};
}

}  // namespace thimble::app::view

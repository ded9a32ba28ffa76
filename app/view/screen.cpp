#include "view/screen.h"

#include <epoxy/gl.h>
// After the header above, which includes OpenGL.
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "view/text_style.h"

namespace thimble::view {
namespace {

std::string glfw_words() {
  const char* words = nullptr;
  glfwGetError(&words);
  return words == nullptr ? "GLFW reports no reason" : words;
}

}  // namespace

driver::Result<std::unique_ptr<Screen>> Screen::open() {
  std::unique_ptr<Screen> screen(new Screen);
  if (glfwInit() == GLFW_FALSE) {
    return driver::Error{"No window: " + glfw_words() +
                         ". Check that there is a screen. `thimble view --text` needs none."};
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
  // By callback, so that no key is lost while drawing is slow.
  glfwSetWindowUserPointer(screen->window_, screen.get());
  glfwSetKeyCallback(screen->window_, [](GLFWwindow* window, int key, int, int action, int) {
    auto* self = static_cast<Screen*>(glfwGetWindowUserPointer(window));
    if (action != GLFW_PRESS) return;
    self->keys_.push_back(key);
    self->pressed_.push_back(key);
  });
  glfwSetDropCallback(screen->window_, [](GLFWwindow* window, int count, const char** paths) {
    auto* self = static_cast<Screen*>(glfwGetWindowUserPointer(window));
    self->drops_.insert(self->drops_.end(), paths, paths + count);
  });
  ImGui::CreateContext();
  screen->imgui_ = true;
  ImGui_ImplGlfw_InitForOpenGL(screen->window_, true);
  ImGui_ImplOpenGL3_Init("#version 330 core");
  return screen;
}

Screen::~Screen() {
  if (imgui_) {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
  }
  if (window_ != nullptr) glfwDestroyWindow(window_);
  if (glfw_) glfwTerminate();
}

std::vector<int> Screen::take_keys() {
  std::vector<int> keys = std::exchange(keys_, {});
  if (ImGui::GetIO().WantTextInput) keys.clear();
  return keys;
}

std::vector<std::string> Screen::take_drops() {
  return std::exchange(drops_, {});
}

// ImGui before 1.87 sees only which keys are down when a picture begins. A key that was pressed and
// released since the last picture is therefore down in this one.
void Screen::poll_events() {
#if IMGUI_VERSION_NUM < 18700
  ImGuiIO& io = ImGui::GetIO();
  for (const int key : std::exchange(short_, {})) io.KeysDown[key] = false;
  glfwPollEvents();
  for (const int key : std::exchange(pressed_, {})) {
    if (key < 0 || key >= IM_ARRAYSIZE(io.KeysDown) || io.KeysDown[key]) continue;
    io.KeysDown[key] = true;
    short_.push_back(key);
  }
  const auto down = [&io](int left, int right) { return io.KeysDown[left] || io.KeysDown[right]; };
  io.KeyCtrl = down(GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL);
  io.KeyShift = down(GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT);
  io.KeyAlt = down(GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT);
#else
  glfwPollEvents();
  pressed_.clear();
#endif
}

void Screen::begin(Theme theme) {
  poll_events();
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

void Screen::end() {
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

Picture Screen::read() {
  Picture picture;
  glfwGetFramebufferSize(window_, &picture.width, &picture.height);
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

}  // namespace thimble::view

#include "view/content/window_loop.h"

#include <epoxy/gl.h>
// After the header above, which includes OpenGL.
#include <GLFW/glfw3.h>

#include <chrono>
#include <thread>

#include "view/gl/picture_file.h"

namespace thimble::view {
namespace {

constexpr double kFrame = 1.0 / 60;  // s

}  // namespace

driver::Result<void> draw_until_closed(Screen& screen, const WindowChoice& choice,
                                       const DrawPicture& draw) {
  GLFWwindow* window = screen.window();
  const double began = glfwGetTime();
  double last = began;
  auto after = AfterPicture::kMoves;
  while (glfwWindowShouldClose(window) == GLFW_FALSE && after != AfterPicture::kClose) {
    const double now = glfwGetTime();
    const auto drawn = draw(now - last);
    if (!drawn) return drawn.error();
    after = *drawn;
    last = now;
    const bool over = choice.seconds > 0 && now - began > choice.seconds;
    if (over && !choice.last_picture.empty()) {
      const auto written = write_png(screen.read(), choice.last_picture, PngColours::kAll);
      if (!written) return written.error();
    }
    if (over) break;
    glfwSwapBuffers(window);
    // Waiting for a run needs no CPU; input wakes it.
    if (after == AfterPicture::kStill) glfwWaitEventsTimeout(0.25);
    // Limits the rate if the screen does not (a remote one, for example).
    const double rest = kFrame - (glfwGetTime() - now);
    if (rest > 0.002) std::this_thread::sleep_for(std::chrono::duration<double>(rest - 0.001));
  }
  return {};
}

}  // namespace thimble::view

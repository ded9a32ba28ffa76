#include "view/gl/picture_parts.h"

namespace thimble::view {

void paint_apart(const Canvas& canvas, const Eigen::AlignedBox2i& box,
                 const std::function<void()>& within, const std::function<void()>& outside) {
  const int width = canvas.width();
  const int height = canvas.height() - canvas.strip();
  if (box.isEmpty()) return outside();
  const auto part = [&](const std::function<void()>& paint, int left, int low, int right,
                        int high) {
    if (right <= left || high <= low) return;
    glScissor(left, canvas.strip() + low, right - left, high - low);
    paint();
  };
  const Eigen::Vector2i low = box.min();
  const Eigen::Vector2i high = box.max();
  glEnable(GL_SCISSOR_TEST);
  part(within, low.x(), low.y(), high.x(), high.y());
  part(outside, 0, 0, width, low.y());
  part(outside, 0, high.y(), width, height);
  part(outside, 0, low.y(), low.x(), high.y());
  part(outside, high.x(), low.y(), width, high.y());
  glDisable(GL_SCISSOR_TEST);
}

}  // namespace thimble::view

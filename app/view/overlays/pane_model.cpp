#include "view/overlays/pane_model.h"

#include <algorithm>

namespace thimble::view {

PaneModel::PaneModel() {
  glBindVertexArray(*array_);
  glBindBuffer(GL_ARRAY_BUFFER, *vertices_);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
  glBindVertexArray(0);
}

void PaneModel::draw(const std::vector<Pane>& panes, const Camera& camera,
                     const GlProgram& plain) const {
  if (panes.empty()) return;
  // The farthest first, so that each is visible through those before it.
  std::vector<const Pane*> order;
  order.reserve(panes.size());
  for (const Pane& pane : panes) order.push_back(&pane);
  const auto distance = [&](const Pane* pane) {
    const auto& c = pane->corners_W;
    return ((c[0] + c[1] + c[2] + c[3]) / 4 - camera.p_WEye()).squaredNorm();
  };
  std::sort(order.begin(), order.end(),
            [&](const Pane* a, const Pane* b) { return distance(a) > distance(b); });
  glUseProgram(*plain);
  glUniform1f(plain.at("nearer"), 0.0005F);
  const Eigen::Matrix4f place = Eigen::Matrix4f::Identity();
  glUniformMatrix4fv(plain.at("model"), 1, GL_FALSE, place.data());
  const auto paint = [&](const Colour& colour, float cover) {
    glUniform4f(plain.at("paint"), colour[0], colour[1], colour[2], cover);
  };
  glDepthMask(GL_FALSE);
  glBindVertexArray(*array_);
  for (const Pane* pane : order) {
    std::vector<Eigen::Vector3f> corners;
    for (const Eigen::Vector3d& corner : pane->corners_W) corners.push_back(corner.cast<float>());
    glBindBuffer(GL_ARRAY_BUFFER, *vertices_);
    glBufferData(GL_ARRAY_BUFFER, 4 * sizeof(Eigen::Vector3f), corners.data(), GL_STREAM_DRAW);
    paint(pane->colour, 0.38F);
    glDrawArrays(GL_TRIANGLE_FAN, 0, 4);
    paint(pane->colour, 0.9F);
    glDrawArrays(GL_LINE_LOOP, 0, 4);
  }
  glDepthMask(GL_TRUE);
}

}  // namespace thimble::view

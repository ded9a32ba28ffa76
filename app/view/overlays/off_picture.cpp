#include "view/overlays/off_picture.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

namespace thimble::view {
namespace {

constexpr double kNearest =
    0.1;  // of the camera's distance: closer points fill the picture. [chosen]

/// A point as the eye sees it: right, up and away, m.
Eigen::Vector3d seen_from_eye(const Camera& camera, const Eigen::Vector3d& p_W) {
  const Eigen::Vector3d from_eye = p_W - camera.p_WEye();
  return {from_eye.dot(camera.right()), from_eye.dot(camera.up()),
          -from_eye.dot(camera.towards_eye())};
}

}  // namespace

std::optional<BorderArrow> arrow_to(const Camera& camera, const Eigen::Vector3d& p_W, double width,
                                    double height, double margin) {
  if (!p_W.allFinite()) return {};
  const Eigen::Vector3d seen = seen_from_eye(camera, p_W);
  if (seen.z() > 0) {
    const Eigen::Vector2d at = camera.pixel(p_W, width, height);
    if (at.x() >= 0 && at.x() <= width && at.y() >= 0 && at.y() <= height) return {};
  }
  Eigen::Vector2d direction(seen.x(), -seen.y());
  if (!(direction.norm() > 0)) direction = {0, 1};  // exactly behind the eye
  direction.normalize();
  const double right = std::max(1.0, width / 2 - margin);
  const double down = std::max(1.0, height / 2 - margin);
  const double length = std::min(right / std::max(1e-9, std::abs(direction.x())),
                                 down / std::max(1e-9, std::abs(direction.y())));
  return BorderArrow{Eigen::Vector2d(width / 2, height / 2) + length * direction, direction};
}

void keep_in_picture(Camera& camera, const Eigen::Vector3d& p_W, double aspect, double share) {
  if (!p_W.allFinite()) return;
  const Eigen::Vector3d seen = seen_from_eye(camera, p_W);
  if (seen.z() < kNearest * camera.distance) {
    camera.p_WTarget = p_W;
    return;
  }
  const double up = share * seen.z() * std::tan(camera.opening / 2);
  const double right = up * aspect;
  camera.p_WTarget += (seen.x() - std::clamp(seen.x(), -right, right)) * camera.right() +
                      (seen.y() - std::clamp(seen.y(), -up, up)) * camera.up();
}

void draw_arrow_to_tip(const Camera& camera, const Eigen::Vector3d& p_WT, Theme theme,
                       const ScreenPart& part) {
  const float letter = ImGui::GetFontSize();
  const auto arrow =
      arrow_to(camera, p_WT, part.width, part.height, static_cast<double>(1.2F * letter));
  if (!arrow) return;
  const ImVec2 point{part.x + static_cast<float>(arrow->at.x()),
                     part.y + static_cast<float>(arrow->at.y())};
  const auto along_x = static_cast<float>(arrow->direction.x());
  const auto along_y = static_cast<float>(arrow->direction.y());
  const auto corner = [&](float back, float side) {
    return ImVec2{point.x - back * along_x - side * along_y,
                  point.y - back * along_y + side * along_x};
  };
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const Colour colour = text_colour(kTipColour, theme);
  const ImVec2 left = corner(1.5F * letter, 0.7F * letter);
  const ImVec2 right = corner(1.5F * letter, -0.7F * letter);
  list.AddTriangleFilled(point, left, right,
                         ImGui::ColorConvertFloat4ToU32({colour[0], colour[1], colour[2], 1}));
  // The words stay within the picture.
  const char* words = "tip (T)";
  const ImVec2 size = ImGui::CalcTextSize(words);
  const ImVec2 middle = corner(2.6F * letter, 0);
  const float x = std::clamp(middle.x - size.x / 2, part.x + 0.3F * letter,
                             std::max(part.x, part.x + part.width - size.x - 0.3F * letter));
  const float y = std::clamp(middle.y - size.y / 2, part.y + 0.3F * letter,
                             std::max(part.y, part.y + part.height - size.y - 0.3F * letter));
  write_rimmed({std::round(x), std::round(y)}, theme, colour, words);
}

}  // namespace thimble::view

#include "ros2/message_check.h"

#include <algorithm>
#include <cmath>

namespace thimble::ros2 {
namespace {

bool finite(const std::array<double, 3>& v) noexcept {
  return std::all_of(v.begin(), v.end(), [](double x) { return std::isfinite(x); });
}

}  // namespace

MessageVerdict check_message(const std::array<double, 3>& taken,
                             const std::array<double, 3>& beside, std::string_view frame,
                             std::string_view world_frame) noexcept {
  if (!finite(taken) || !finite(beside)) return MessageVerdict::kNotFinite;
  // ROS 1 wrote frame names with a leading slash, and some programs still do.
  if (frame.starts_with('/')) frame.remove_prefix(1);
  if (!frame.empty() && frame != world_frame) return MessageVerdict::kWrongFrame;
  return MessageVerdict::kGood;
}

}  // namespace thimble::ros2

#include "meshes/object_size.h"

#include <fmt/format.h>

#include <algorithm>

namespace thimble::scene {

double reach_of(const Scene& scene) {
  const auto side = [](const ArmFile& arm) {
    return (arm.workspace.max_W - arm.workspace.min_W).maxCoeff();
  };
  double reach = 0;
  for (const SceneArm& arm : scene.arms) reach = std::max(reach, side(arm.arm));
  return reach;
}

std::string unit_advice(const std::string& kind) {
  return kind + " names no unit: set scale: 0.001 if it counts in mm, or size (m).";
}

driver::Result<std::string> judge_size(const SceneObject& object, const ObjectSize& size,
                                       double reach) {
  if (!(reach > 0)) return std::string();
  const double reaches = size.side / reach;
  const bool stated = object.size || object.scale || size.has_unit;
  const double most = stated ? kStatedReachesMax : kReachesMax;
  // Written so that NaN is too large.
  if (reaches <= (stated ? most : kReachesReported)) return std::string();
  const std::string sentence =
      fmt::format("{}: {:.4g} m large, {:.0f} times the reach of the arm ({:.3g} m); ",
                  object.mesh_file.string(), size.side, reaches, reach);
  if (reaches <= most) return sentence + unit_advice(size.kind);
  if (!stated) return driver::Error{sentence + unit_advice(size.kind)};
  return driver::Error{sentence +
                       fmt::format("at most {:.0f} times are supported. Set a smaller {}.", most,
                                   object.size ? "size (m)" : "scale")};
}

}  // namespace thimble::scene

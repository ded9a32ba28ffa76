#include "mesh/file/single_precision.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

namespace thimble::render {

driver::Result<void> SinglePrecision::judge(const TriangleMesh& mesh,
                                            std::vector<std::string>& notes) const {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices) box.extend(vertex);
  const double size = box.isEmpty() ? 0 : box.diagonal().norm();
  const auto single = static_cast<float>(farthest_);
  const double step =
      scale_ *
      static_cast<double>(std::nextafter(single, std::numeric_limits<float>::infinity()) - single);
  if (!(size > 0) || step <= kStepReported * size) return {};
  const std::string sentence = fmt::format(
      "The coordinates are in single precision and reach {:.3g}, where one step is {:.2g}: "
      "{:.2g} of the size of the mesh. Move the mesh to the origin in its program or export it as "
      "OBJ.",
      scale_ * farthest_, step, step / size);
  if (step > kStepMax * size) return driver::Error{sentence};
  notes.push_back(sentence);
  return {};
}

}  // namespace thimble::render

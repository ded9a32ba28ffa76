#include "share/describe/field_samples.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "math/elementary.h"
#include "thimble/render/object_touch.h"

namespace thimble::session {
namespace {

using Eigen::Vector3d;

constexpr int kCoarseSamples =
    24;  // samples along each side of the workspace, to find where a field is felt
constexpr double kFelt =
    0.15;  // fraction of the largest force; the grid covers the region above it [chosen]
constexpr double kSamples = 350;  // about as many as a user can distinguish [chosen]
constexpr int kSideMax = 16;      // 16^3 equals kFieldSamplesMax
static_assert(kSideMax * kSideMax * kSideMax <= kFieldSamplesMax);

/// Fields of a scene, built separately from those that are felt.
class Fields {
 public:
  explicit Fields(const scene::Scene& scene) {
    for (const scene::SceneObject& object : scene.objects) {
      if (object.build_field) fields_.push_back(object.build_field());
    }
  }
  bool empty() const { return fields_.empty(); }
  Vector3d force(const Vector3d& p_W) const {
    driver::DeviceState state;
    state.p_WT = p_W;
    Vector3d sum = Vector3d::Zero();
    for (const auto& field : fields_) sum += field->update(state).f_T_W;
    return sum.allFinite() ? sum : Vector3d::Zero();
  }

 private:
  std::vector<std::unique_ptr<render::ObjectTouch>> fields_;
};

/// Samples the centres of a grid with `counts` cells along the sides of a box.
std::vector<SharedScene::FieldSample> sample(const Fields& fields, const Eigen::AlignedBox3d& box,
                                             const Eigen::Array3i& counts) {
  std::vector<SharedScene::FieldSample> samples;
  const Eigen::Array3d step = box.sizes().array() / counts.cast<double>();
  for (int i = 0; i < counts[0]; ++i) {
    for (int j = 0; j < counts[1]; ++j) {
      for (int k = 0; k < counts[2]; ++k) {
        const Vector3d p_W = box.min() + ((Eigen::Array3d(i, j, k) + 0.5) * step).matrix();
        samples.push_back({p_W, fields.force(p_W)});
      }
    }
  }
  return samples;
}

}  // namespace

std::vector<SharedScene::FieldSample> sample_fields(const scene::Scene& scene) {
  const Fields fields(scene);
  const Eigen::AlignedBox3d workspace(scene.arms.front().arm.workspace.min_W,
                                      scene.arms.front().arm.workspace.max_W);
  if (fields.empty() || workspace.isEmpty() || !workspace.sizes().allFinite()) return {};
  const auto coarse = sample(fields, workspace, Eigen::Array3i::Constant(kCoarseSamples));
  double max_force = 0;
  for (const auto& point : coarse) max_force = std::max(max_force, point.f_W.norm());
  if (!(max_force > 0)) return {};
  Eigen::AlignedBox3d felt;
  const Vector3d half = 0.5 * workspace.sizes() / kCoarseSamples;
  for (const auto& point : coarse) {
    if (point.f_W.norm() < kFelt * max_force) continue;
    felt.extend(Vector3d(point.p_W - half));
    felt.extend(Vector3d(point.p_W + half));
  }
  const double step = math::cbrt(felt.volume() / kSamples);
  const Eigen::Array3i counts =
      (felt.sizes().array() / std::max(step, 1e-6)).round().max(1).min(kSideMax).cast<int>();
  return sample(fields, felt, counts);
}

}  // namespace thimble::session

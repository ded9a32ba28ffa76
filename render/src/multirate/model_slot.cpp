#include "thimble/render/multirate/local_model.h"

#include <string>

namespace thimble::render {
namespace {

using Vector = Eigen::Map<Eigen::Vector3d>;
using Matrix = Eigen::Map<Eigen::Matrix3d>;

}  // namespace

driver::Result<void> ModelSlot::publish(const LocalModel& model) {
  const ModelFlaw flaw = flaw_of(model);
  if (flaw != ModelFlaw::kNone) return driver::Error{std::string(describe(flaw))};
  Words words{};
  Vector(words.p) = model.p_WR;
  Vector(words.f) = model.f_T_W;
  Matrix(words.stiffness) = model.stiffness;
  Vector(words.n) = model.n_W;
  words.damping = model.damping;
  words.time_ns = model.time_ns;
  snapshot_.store(words);
  return {};
}

bool ModelSlot::newest(LocalModel& model) const noexcept {
  Words words;
  // Does not wait for a writer that was interrupted half-way.
  constexpr int kAttempts = 2;
  if (!snapshot_.load(words, kAttempts)) return false;
  model.p_WR = Vector(words.p);
  model.f_T_W = Vector(words.f);
  model.stiffness = Matrix(words.stiffness);
  model.n_W = Vector(words.n);
  model.damping = words.damping;
  model.time_ns = words.time_ns;
  return true;
}

}  // namespace thimble::render

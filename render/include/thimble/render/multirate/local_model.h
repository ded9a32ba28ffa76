#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string_view>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/driver/snapshot.h"

namespace thimble::render {

/// Local model of the force near one place, from a simulation that is too slow for the servo: the
/// force there and its change with the tip's displacement.
///
///     f(p) = f_T_W - stiffness (p - p_WR), as long as it pushes along n_W; else nothing
///
/// The surface is thus the plane on which the force along n_W becomes zero. The tip can leave it
/// between two models, and no model pulls. While the tip is free, publish a model of the nearest
/// surface: a point on it, zero force, and the stiffness that it would have. If no surface is near,
/// publish zeros.
struct LocalModel {
  Eigen::Vector3d p_WR{0, 0, 0};   ///< Reference point, in the world, m.
  Eigen::Vector3d f_T_W{0, 0, 0};  ///< Force on the hand with the tip there, in the world, N.
  /// Decrease of the force with the tip's displacement, -df/dp, N/m: symmetric, without negative
  /// eigenvalues. Apply `without_negative` first to a matrix that has one (at a bulge, where the
  /// normal turns away).
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();
  double damping = 0;            ///< Damping along n_W during contact, N s/m, >= 0.
  Eigen::Vector3d n_W{0, 0, 1};  ///< Unit normal towards the free side.
  /// DeviceState::time_ns of the state for which the model was computed.
  std::int64_t time_ns = 0;
};

/// Flaw of a model.
enum class ModelFlaw : std::uint8_t {
  kNone,
  kNotFinite,     ///< A number is NaN or infinite.
  kNormal,        ///< The normal is not a unit vector.
  kNotSymmetric,  ///< The stiffness is not a symmetric matrix.
  /// The stiffness has a negative eigenvalue: the surface would push the tip away.
  kNegativeStiffness,
  kNegativeDamping,  ///< The damping is below 0.
  /// There is a force but no stiffness along the normal, so the force would never end.
  kNoSurface,
};

/// Returns the first flaw of a model, or kNone; the tolerances are a millionth of its largest
/// number. Real-time: safe.
THIMBLE_EXPORT ModelFlaw flaw_of(const LocalModel& model) noexcept;

/// Returns the meaning of a flaw and the fix, in one sentence. Real-time: safe.
THIMBLE_EXPORT std::string_view describe(ModelFlaw flaw) noexcept;

/// Returns the symmetric matrix nearest to `stiffness` (N/m) without negative eigenvalues. A matrix
/// that is not finite is returned unchanged. Real-time: never from the servo thread.
THIMBLE_EXPORT Eigen::Matrix3d without_negative(const Eigen::Matrix3d& stiffness);

/// Slot through which a slow simulation passes its newest model to the servo: one writer, any
/// number of readers, no lock. It contains no pointers, so it can be in memory shared by two
/// processes.
class THIMBLE_EXPORT ModelSlot {
 public:
  /// Publishes a model. Fails and keeps the previous one if the model has a flaw. Call from one
  /// thread. Real-time: never from the servo thread, because it creates an error text.
  driver::Result<void> publish(const LocalModel& model);

  /// Copies the newest model. Returns false and leaves `model` unchanged if there is none yet or a
  /// write is in progress; the model is then available in the next tick. A model written by another
  /// process is not checked. Real-time: safe; a few hundred instructions.
  bool newest(LocalModel& model) const noexcept;

  /// Returns the number of models published. Real-time: safe.
  std::uint64_t count() const noexcept { return snapshot_.count(); }

 private:
  /// Model as plain numbers for the Snapshot.
  struct Words {
    double p[3], f[3], stiffness[9], damping, n[3];
    std::int64_t time_ns;
  };

  driver::Snapshot<Words> snapshot_;
};

}  // namespace thimble::render

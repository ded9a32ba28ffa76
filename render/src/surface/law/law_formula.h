#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "surface/law/unit.h"
#include "thimble/driver/result.h"

namespace thimble::render {

/// Values of one tick that a formula can use.
struct LawInputs {
  double depth = 0;               ///< Of the tip below the surface, m.
  double approach = 0;            ///< Speed of the tip into the surface, m/s.
  double speed = 0;               ///< Speed of the tip along the surface, m/s.
  double pressure = 0;            ///< Force of the surface's spring along the normal, N.
  double time = 0;                ///< Since the contact began, s.
  Eigen::Vector3d p_OT{0, 0, 0};  ///< Tip in the frame of the object, m: x, y, z.
  Eigen::Vector3d n_O{0, 0, 0};   ///< Normal in the frame of the object: nx, ny, nz.
};

/// Number with a name and a unit that a formula uses.
struct LawParameter {
  std::string name;
  double value = 0;         ///< SI
  std::string unit = {};    ///< SI unit, see `unit_named`.
  double min = 0, max = 0;  ///< Range of the knob; equal: none.
};

/// Compiled formula of a force, N.
///
/// The language is that of muParser: + - * / ^, comparisons, `? :`, min, max, abs, sign, sqrt and
/// the functions of math/elementary.h, the constant pi. Numbers in it have no unit. Compiled once;
/// evaluation does not allocate.
class LawFormula {
 public:
  /// Compiles a formula. The error says what is wrong, and where: unknown names, units that do not
  /// give a force, values that are not finite. Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<LawFormula>> make(
      const std::string& text, const std::vector<LawParameter>& parameters);
  virtual ~LawFormula() = default;

  /// Returns the force, N; NaN if there is none. Real-time: safe.
  virtual double at(const LawInputs& inputs) noexcept = 0;
  /// Returns a parameter by its place in the list, to be changed between two ticks.
  virtual double& parameter(std::size_t place) noexcept = 0;
  /// Returns the largest change of the force with a parameter, N per unit, over the inputs that a
  /// hand reaches. Real-time: never from the servo thread.
  virtual double sensitivity(std::size_t place) = 0;

 protected:
  LawFormula() = default;
};

}  // namespace thimble::render

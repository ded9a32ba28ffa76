#pragma once

#include <Eigen/Core>
#include <concepts>
#include <memory>
#include <type_traits>
#include <utility>

#include "thimble/driver/device_state.h"
#include "thimble/driver/force_law.h"
#include "thimble/render/object_touch.h"

namespace thimble::render {

/// Force field without a surface [BP 2, "continuous vector fields"]: a pure function of the state.
/// `force` returns the force on the hand (N in W) and is Real-time: safe.
template <class F>
concept Field = requires(const F& field, const driver::DeviceState& state) {
  { field.force(state) }
  noexcept->std::convertible_to<Eigen::Vector3d>;
};

/// Field with a potential. `potential` returns its energy at the tip (J), with `force` = -grad of
/// it, so that the safety gate knows the source of its work (EnergyFlow).
template <class F>
concept ConservativeField = Field<F> && requires(const F& field, const driver::DeviceState& state) {
  { field.potential(state) }
  noexcept->std::same_as<double>;
};

/// Field of unknown energy, such as a function of a program.
template <class F>
concept UnknownField = Field<F> && F::kUnknownStorage;

/// Field as an object of a scene. It has no inside and is never in contact.
template <Field F>
class FieldTouch final : public ObjectTouch {
 public:
  explicit FieldTouch(F field) : field_(std::move(field)) {}

  driver::ForceCommand update(const driver::DeviceState& state) noexcept override {
    driver::ForceCommand command;
    command.f_T_W = field_.force(state);
    if constexpr (ConservativeField<F>) command.stored = field_.potential(state);
    if constexpr (UnknownField<F>) command.f_program_W = command.f_T_W;
    return command;
  }
  bool inside(const Eigen::Vector3d&) const noexcept override { return false; }

  void list_settings(LiveSettings& settings) override { list_settings_of(field_, settings); }

  const F& field() const noexcept { return field_; }  ///< Returns the field.

 private:
  F field_;
};

/// Field given by any function of the state.
template <class Function>
requires std::is_nothrow_invocable_r_v<Eigen::Vector3d, const Function&, const driver::DeviceState&>
class FunctionField {
 public:
  static constexpr bool kUnknownStorage = true;  ///< The energy stored by a function is unknown.

  explicit FunctionField(Function function) : function_(std::move(function)) {}

  Eigen::Vector3d force(const driver::DeviceState& state) const noexcept {
    return function_(state);
  }

 private:
  Function function_;
};

/// Returns an object of a scene whose force is a function of the state. Programs use it to add a
/// force law.
///
/// The function is called on the servo thread and must be real-time safe. Its result is not
/// changed: NaN or infinity reaches the safety gate, which gives zero force and latches a fault, so
/// that the error is noticed. Real-time: never from the servo thread.
template <class Function>
std::unique_ptr<ObjectTouch> field_of(Function function) {
  using Own = FunctionField<Function>;
  return std::make_unique<FieldTouch<Own>>(Own(std::move(function)));
}

}  // namespace thimble::render

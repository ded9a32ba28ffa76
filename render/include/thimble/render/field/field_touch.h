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

/// A force that fills the space and needs no surface [BP 2, "continuous vector fields"]: a pure
/// function of the state. `force` gives the force on the hand (N in W) and is Real-time: safe.
template <class F>
concept Field = requires(const F& field, const driver::DeviceState& state) {
  { field.force(state) }
  noexcept->std::convertible_to<Eigen::Vector3d>;
};

/// A field that is the gradient of a potential: `potential` gives its energy at the tip (J), with
/// `force` = -grad of it. So the safety gate knows where its work comes from (EnergyFlow).
template <class F>
concept ConservativeField = Field<F> && requires(const F& field, const driver::DeviceState& state) {
  { field.potential(state) }
  noexcept->std::same_as<double>;
};

/// A field whose energy nobody knows, such as a function of a program.
template <class F>
concept UnknownField = Field<F> && F::kUnknownStorage;

/// A field as an object of a scene. It has no inside and is never in contact.
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

  const F& field() const noexcept { return field_; }  ///< Shows the field.

 private:
  F field_;
};

/// Any function of the state as a field.
template <class Function>
requires std::is_nothrow_invocable_r_v<Eigen::Vector3d, const Function&, const driver::DeviceState&>
class FunctionField {
 public:
  static constexpr bool kUnknownStorage = true;

  explicit FunctionField(Function function) : function_(std::move(function)) {}

  Eigen::Vector3d force(const driver::DeviceState& state) const noexcept {
    return function_(state);
  }

 private:
  Function function_;
};

/// Makes a function of the state an object of a scene: how a program adds a force law of its own.
///
/// The function is called on the servo thread and must keep its rules. What it returns goes on
/// unchanged: NaN or infinity reaches the safety gate, which lets nothing through and latches a
/// fault, because a broken law must not go unnoticed. Real-time: never from the servo thread.
template <class Function>
std::unique_ptr<ObjectTouch> field_of(Function function) {
  using Own = FunctionField<Function>;
  return std::make_unique<FieldTouch<Own>>(Own(std::move(function)));
}

}  // namespace thimble::render

#pragma once

#include <Eigen/Core>
#include <concepts>
#include <cstdint>
#include <type_traits>

#include "thimble/driver/device_state.h"

namespace thimble::driver {

/// What a force law touched in one tick; for readers at the side (viewer, recorder, tests).
struct TouchInfo {
  bool in_contact = false;        ///< True while the tip is held outside an object.
  std::int16_t object = -1;       ///< Which of the scene's objects, -1 for none.
  std::int32_t feature = -1;      ///< Active triangle or other feature of the object, -1 for none.
  double depth = 0;               ///< Penetration depth along the force's normal, m; 0 if none.
  Eigen::Vector3d p_WP{0, 0, 0};  ///< Proxy: the surface point the tip is held at, in the world, m.
  Eigen::Vector3d n_W{0, 0, 0};   ///< Outward unit normal that the force acts along; 0 if none.
  std::uint16_t hops = 0;         ///< Features crossed in this tick.
};

/// What a force law asks for in one tick: nothing reaches the motors except through SafetyGate.
struct ForceCommand {
  Eigen::Vector3d f_T_W{0, 0, 0};  ///< Force that the arm shall exert on the hand, in the world, N.
  TouchInfo touch;                 ///< What the force was made of.
  /// Energy that the law's storages hold now and may give to the hand, J: the potential of fields,
  /// the motion and height of bodies. Only its changes count. The springs of touched surfaces are
  /// not part of it: the gate finds their energy from force and depth. A law without storages
  /// leaves it 0.
  double stored = 0;
  /// Part of `f_T_W` whose storage is not known, because a program outside of the scene asked for
  /// it, N. The gate's energy stage leaves it alone; growing oscillations of it are stopped.
  Eigen::Vector3d f_program_W{0, 0, 0};
};

/// Lets a command ask for a share (0 to 1) of its force. Its storages hold as much less for the
/// hand. Real-time: safe.
inline void scale(ForceCommand& command, double share) noexcept {
  command.f_T_W *= share;
  command.f_program_W *= share;
  command.stored *= share;
}

/// Refers to a force law: any object callable as `ForceCommand law(const DeviceState&) noexcept`.
///
/// A law may also have `void prepare(const DeviceState& expected) const noexcept`, which a loop
/// calls in the time that is left before a tick (ServoSettings::prepare_ns): it reads what the tick
/// will read, so that the tick waits for no memory, and changes nothing.
///
/// It does not own the law; whoever makes a ForceLaw keeps the law alive while the loop runs.
/// Real-time: safe if the law is; one indirect call.
class ForceLaw {
 public:
  /// Takes the law to refer to; of a ForceLaw it is a copy. Real-time: safe.
  template <class Law>
  requires(!std::same_as<std::remove_const_t<Law>, ForceLaw>) explicit ForceLaw(Law& law) noexcept
      : law_(const_cast<void*>(static_cast<const void*>(&law))),
        call_([](void* self, const DeviceState& state) noexcept -> ForceCommand {
          static_assert(noexcept((*static_cast<Law*>(self))(state)),
                        "A force law runs on the servo thread and must be noexcept.");
          return (*static_cast<Law*>(self))(state);
        }) {
    if constexpr (requires(const Law& own, const DeviceState& state) { own.prepare(state); }) {
      prepare_ = [](const void* self, const DeviceState& expected) noexcept {
        static_assert(noexcept(static_cast<const Law*>(self)->prepare(expected)),
                      "A force law runs on the servo thread and must be noexcept.");
        static_cast<const Law*>(self)->prepare(expected);
      };
    }
  }

  /// Asks the law for the force of a tick. Real-time: safe if the law is.
  ForceCommand operator()(const DeviceState& state) const noexcept { return call_(law_, state); }

  /// Lets the law read what it will need in a tick that is expected to be like this; the next force
  /// is the same with it and without. Real-time: safe if the law is.
  void prepare(const DeviceState& expected) const noexcept {
    if (prepare_ != nullptr) prepare_(law_, expected);
  }

 private:
  void* law_;
  ForceCommand (*call_)(void*, const DeviceState&) noexcept;
  void (*prepare_)(const void*, const DeviceState&) noexcept = nullptr;
};

}  // namespace thimble::driver

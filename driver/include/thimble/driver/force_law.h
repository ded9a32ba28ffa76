#pragma once

#include <Eigen/Core>
#include <concepts>
#include <cstdint>
#include <type_traits>

#include "thimble/driver/device_state.h"

namespace thimble::driver {

/// Contact information from one tick, for observers (viewer, recorder, tests).
struct TouchInfo {
  bool in_contact = false;    ///< True if the tip is in contact with an object.
  std::int16_t object = -1;   ///< Number of the object in the scene, -1 for none.
  std::int32_t feature = -1;  ///< Active triangle or other feature of the object, -1 for none.
  double depth = 0;           ///< Depth of the tip along the normal `n_W`, m; 0 if none.
  /// Proxy: the point that stays on the surface while the tip is inside, in the world, m.
  Eigen::Vector3d p_WP{0, 0, 0};
  Eigen::Vector3d n_W{0, 0, 0};  ///< Outward unit normal along which the force acts; 0 if none.
  std::uint16_t hops = 0;        ///< Number of features that the proxy crossed in this tick.
};

/// Force requested by a force law in one tick. Every force reaches the motors through SafetyGate.
struct ForceCommand {
  Eigen::Vector3d f_T_W{0, 0, 0};  ///< Requested force on the hand, in the world, N.
  TouchInfo touch;                 ///< Contact that caused the force.
  /// Energy that the law stores and can return to the hand, J: the potential of fields, and the
  /// kinetic and potential energy of bodies. Only changes of this value are used. It excludes the
  /// springs of touched surfaces, because the gate computes their energy from force and depth. 0
  /// for a law that stores no energy.
  double stored = 0;
  /// Part of `f_T_W` that a program outside of the scene requested, N. Its stored energy is
  /// unknown, so the energy stage of the gate ignores this part. If it oscillates with growing
  /// amplitude, the gate reduces it.
  Eigen::Vector3d f_program_W{0, 0, 0};
};

/// Multiplies the forces and the stored energy of a command by `share`, 0 to 1. Real-time: safe.
inline void scale(ForceCommand& command, double share) noexcept {
  command.f_T_W *= share;
  command.f_program_W *= share;
  command.stored *= share;
}

/// Reference to a force law: any object callable as `ForceCommand law(const DeviceState&)
/// noexcept`.
///
/// A law may also have `void prepare(const DeviceState& expected) const noexcept`. The loop calls
/// it in the time that remains before a tick (ServoSettings::prepare_ns). It prefetches the memory
/// that the tick will read, and changes nothing.
///
/// A ForceLaw does not own the law. The creator of the ForceLaw must keep the law alive while the
/// loop runs. Real-time: safe if the law is; one indirect call.
class ForceLaw {
 public:
  /// Constructs a reference to a law. A ForceLaw itself is copied instead. Real-time: safe.
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

  /// Returns the force of the law for a tick. Real-time: safe if the law is.
  ForceCommand operator()(const DeviceState& state) const noexcept { return call_(law_, state); }

  /// Calls `prepare` of the law, if it has one, before a tick with about the state `expected`. Does
  /// not change the next force. Real-time: safe if the law is.
  void prepare(const DeviceState& expected) const noexcept {
    if (prepare_ != nullptr) prepare_(law_, expected);
  }

 private:
  void* law_;
  ForceCommand (*call_)(void*, const DeviceState&) noexcept;
  void (*prepare_)(const void*, const DeviceState&) noexcept = nullptr;
};

}  // namespace thimble::driver

#pragma once

#include <concepts>
#include <type_traits>

#include "thimble/driver/device_state.h"
#include "thimble/driver/force_command.h"

namespace thimble::driver {

/// Refers to a force law: any object callable as `ForceCommand law(const DeviceState&) noexcept`.
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
        }) {}

  /// Asks the law for the force of a tick. Real-time: safe if the law is.
  ForceCommand operator()(const DeviceState& state) const noexcept { return call_(law_, state); }

 private:
  void* law_;
  ForceCommand (*call_)(void*, const DeviceState&) noexcept;
};

}  // namespace thimble::driver

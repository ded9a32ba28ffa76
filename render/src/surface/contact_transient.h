#pragma once

#include <Eigen/Core>
#include <string_view>

#include "thimble/driver/device_state.h"
#include "thimble/driver/export.h"
#include "thimble/render/effect/effect_table.h"
#include "thimble/render/surface/surface_response.h"

namespace thimble::render {

/// A decaying vibration when the tip meets the surface, which makes it feel harder than its spring
/// ([Kuchenbecker]: event-based haptics).
///
/// At the first tick of a contact the tip approaches with speed v. From then on the force along the
/// normal is changed by gain v exp(-t / decay) sin(2 pi frequency t). t counts ticks, at the middle
/// of each, so a late tick changes nothing. The surface never pulls: the change is at most the
/// force against which it acts. It ends with the contact. A SurfaceStage.
class THIMBLE_EXPORT ContactTransient {
 public:
  static constexpr std::string_view kGroup = "contact";
  static constexpr std::string_view kName = "transient";
  static constexpr EffectOrder kOrder = EffectOrder::kTangential;  // after the spring

  struct Settings {
    double gain = 10;        ///< Amplitude at a speed of 1 m/s, N s/m.
    double frequency = 120;  ///< Hz
    double decay = 0.01;     ///< Time until 1/e of the amplitude is left, s.

    /// Reads `gain`, `frequency` and `decay`. A frequency that the loop cannot render is rejected.
    /// Real-time: never from the servo thread.
    void read(SettingsReader& reader, const EffectContext& context);
  };

  /// Takes settings validated by Settings::read. Real-time: never from the servo thread.
  ContactTransient(const Settings& settings, const EffectContext& context);

  /// See SurfaceStage. Real-time: safe.
  void touch(const driver::DeviceState& state, SurfaceResponse& response) noexcept;
  void leave() noexcept {
    touching_ = false;
    rings_ = false;
  }

  /// Lists the gain. Real-time: never from the servo thread.
  void list_settings(LiveSettings& settings);

 private:
  /// Largest gain, N s/m [chosen: 10 N at a fast tap of 0.2 m/s].
  static constexpr double kGainMax = 50;

  double gain_;
  double first_cos_, first_sin_;  // half a tick after the beginning
  double step_cos_, step_sin_;    // decay and rotation of one tick
  bool touching_ = false;
  bool rings_ = false;
  double amplitude_ = 0;      // N
  double cos_ = 0, sin_ = 0;  // of the vibration, with its decay
};

}  // namespace thimble::render

#include <array>

#include "studies/accuracy/axes/axes.h"

namespace thimble::studies {
namespace {

constexpr std::array kAxes{
    AxisMaker{"tessellation", tessellation_axis},
    AxisMaker{"tessellation_direction", tessellation_direction_axis},
    AxisMaker{"tessellation_jump", tessellation_jump_axis},
    AxisMaker{"profile", profile_axis},
    AxisMaker{"profile_rate", profile_rate_axis},
    AxisMaker{"deformable", deformable_axis},
    AxisMaker{"modes", modes_axis},
    AxisMaker{"rings", rings_axis},
    AxisMaker{"dent_speed", dent_speed_axis},
    AxisMaker{"simulator", simulator_axis},
    AxisMaker{"simulator_speed", simulator_speed_axis},
    AxisMaker{"simulator_smooth", simulator_smooth_axis},
    AxisMaker{"loop_rate", loop_rate_axis},
    AxisMaker{"loop_rate_stiffness", loop_rate_stiffness_axis},
    AxisMaker{"latency", latency_axis},
    AxisMaker{"latency_stiffness", latency_stiffness_axis},
    AxisMaker{"encoder", encoder_axis},
    AxisMaker{"encoder_friction", encoder_friction_axis},
    AxisMaker{"velocity", velocity_axis},
    AxisMaker{"velocity_stiffness", velocity_stiffness_axis},
    AxisMaker{"friction", friction_axis},
    AxisMaker{"friction_stiction", friction_stiction_axis},
    AxisMaker{"hardness", hardness_axis},
    AxisMaker{"search", search_axis},
    AxisMaker{"tracking", tracking_axis},
    AxisMaker{"rigid_body", rigid_body_axis},
    AxisMaker{"collisions", collisions_axis},
    AxisMaker{"safety", safety_axis},
    AxisMaker{"safety_stiffness", safety_stiffness_axis},
    AxisMaker{"safety_noise", safety_noise_axis},
    AxisMaker{"effects", effects_axis},
    AxisMaker{"float", float_axis},
    AxisMaker{"seam", seam_axis},
    AxisMaker{"objects", objects_axis},
    AxisMaker{"tip_radius", tip_radius_axis},
};

}  // namespace

std::span<const AxisMaker> accuracy_axes() {
  return kAxes;
}

}  // namespace thimble::studies

#pragma once

#include "studies/accuracy/accuracy_axis.h"

namespace thimble::studies {

/// Compliance of a wall that feels rigid (24 N/mm), mm/N. Smaller values cannot be distinguished by
/// hand, so every diagram of the stiffest wall is shaded there [PHYSICS 6, after Tan et al.].
inline constexpr double kRigidCompliance = 1 / 24.0;
inline constexpr const char* kRigidWords = "the compliance of a wall that feels rigid (24 N/mm)";

// One function per axis, which makes it without measuring. Real-time: never from the servo thread.

AccuracyAxis tessellation_axis();
AccuracyAxis tessellation_direction_axis();
AccuracyAxis tessellation_jump_axis();
AccuracyAxis profile_axis();
AccuracyAxis profile_rate_axis();
AccuracyAxis deformable_axis();
AccuracyAxis modes_axis();
AccuracyAxis rings_axis();
AccuracyAxis dent_speed_axis();
AccuracyAxis simulator_axis();
AccuracyAxis simulator_speed_axis();
AccuracyAxis simulator_smooth_axis();
AccuracyAxis loop_rate_axis();
AccuracyAxis loop_rate_stiffness_axis();
AccuracyAxis latency_axis();
AccuracyAxis latency_stiffness_axis();
AccuracyAxis encoder_axis();
AccuracyAxis encoder_friction_axis();
AccuracyAxis velocity_axis();
AccuracyAxis velocity_stiffness_axis();
AccuracyAxis friction_axis();
AccuracyAxis friction_stiction_axis();
AccuracyAxis hardness_axis();
AccuracyAxis search_axis();
AccuracyAxis tracking_axis();
AccuracyAxis rigid_body_axis();
AccuracyAxis collisions_axis();
AccuracyAxis safety_axis();
AccuracyAxis safety_stiffness_axis();
AccuracyAxis safety_noise_axis();
AccuracyAxis effects_axis();
AccuracyAxis float_axis();
AccuracyAxis seam_axis();
AccuracyAxis objects_axis();
AccuracyAxis tip_radius_axis();

}  // namespace thimble::studies

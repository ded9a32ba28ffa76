#include "compat/core/channel_layout.h"

#include "compat/core/arm_channel.h"
#include "layout_hash.h"
#include "tick_layout.h"

THIMBLE_LAYOUT_ENUM(thimble::compat::ArmBuild, kSerial, kLinkage, kDelta)
THIMBLE_LAYOUT_ENUM(thimble::compat::ChannelState, kClosed, kWanted, kOpen, kFailed, kLeaving,
                    kEnded)
THIMBLE_LAYOUT(thimble::compat::ArmFacts, name, serial, build, simulated, has_orientation,
               has_gimbal, has_gripper, has_joints, rate, force_max, force_continuous,
               stiffness_max, damping_max, speed_max, rise_max, stall_ns, workspace_min,
               workspace_max)
THIMBLE_LAYOUT(thimble::compat::GateCuts, limited, rise_limited, soft_started, damped)
THIMBLE_LAYOUT(thimble::compat::ArmReading, tick, time_ns, p_WT, v_WT, R_WT, w_WT, q, J_WT, gimbal,
               gripper, counts, buttons, f_client_W, f_asked_W, f_sent_W, heat, cuts, stalled,
               stage, fault, link)
THIMBLE_LAYOUT(thimble::compat::ForceRequest, f_W, torque_W, gripper)
THIMBLE_LAYOUT(thimble::compat::ForceWritten, asked, number)
THIMBLE_LAYOUT(thimble::compat::JointQuestion, q, J_WT, asked, answered)
THIMBLE_LAYOUT(thimble::compat::ArmChannel, name, state, api, trouble, facts, reading, ticks,
               waiting, taken, paced, permitted, force, enabled, enablings, watchdog_ns,
               speed_limit, force_limit, calibrated, regulated, joints)
THIMBLE_LAYOUT(thimble::compat::WrongCall, function, what, count)
THIMBLE_LAYOUT(thimble::compat::Channel, layout, arm_count, requests, arms, wrong_calls_used,
               wrong_calls, torque_requests, gripper_requests, listings)

namespace thimble::compat {

std::uint64_t channel_layout_hash() noexcept {
  static constexpr std::uint64_t kHash = driver::layout_detail::mix(
      driver::layout_detail::mix(driver::layout_hash<Channel>(), std::uint64_t{kServerByte}),
      std::uint64_t{kFirstOwnerByte});
  return kHash;
}

}  // namespace thimble::compat

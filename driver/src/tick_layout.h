#pragma once

#include "layout_hash.h"
#include "thimble/driver/fault.h"
#include "thimble/driver/tick_record.h"

// Layout of the tick record that other processes read.

THIMBLE_LAYOUT_ENUM(thimble::driver::DeviceStage, kIdle, kActive, kFault, kWaiting)
THIMBLE_LAYOUT_ENUM(thimble::driver::Fault, kNone, kTransportLost, kNoReports, kForceNotFinite,
                    kStateNotFinite, kOverSpeed, kLoopStalled, kRefused, kTimeNotMonotonic,
                    kMotorsReversed, kEncoderFrozen, kCountsUnchanged, kOtherArm, kCountsJumped,
                    kSuspended, kOutsideWorkspace)
THIMBLE_LAYOUT_ENUM(thimble::driver::LinkState, kConnected, kSilent, kLost)
THIMBLE_LAYOUT(thimble::driver::TickRecord, tick, time_ns, due_ns, work_ns, counts, q, p_WT, v_WT,
               p_WP, n_W, f_wanted_W, f_sent_W, heat, q_WT, gimbal, gripper, depth, setting_value,
               gain, feature, object, hops, buttons, setting, in_contact, fresh, has_gripper, stage,
               fault, link, home_needed)

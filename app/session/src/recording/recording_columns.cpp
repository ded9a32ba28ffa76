#include "thimble/session/recording.h"

#include <array>
#include <string_view>

#include "thimble/driver/tick_record.h"

namespace thimble::session {
namespace {

using driver::TickRecord;
using Type = RecordingColumn::Type;

// Flags and enums are one byte in memory and in the file.
static_assert(sizeof(bool) == 1 && sizeof(driver::DeviceStage) == 1 && sizeof(driver::Fault) == 1 &&
              sizeof(driver::LinkState) == 1);

constexpr std::array kColumns{
    RecordingColumn{"tick", "1",
                    "number of the tick, from 0; gaps are ticks missing in the recording",
                    Type::kU64, 1, offsetof(TickRecord, tick)},
    RecordingColumn{"time", "ns", "start of the tick, on the loop's clock", Type::kI64, 1,
                    offsetof(TickRecord, time_ns)},
    RecordingColumn{"due", "ns", "scheduled start of the tick", Type::kI64, 1,
                    offsetof(TickRecord, due_ns)},
    RecordingColumn{"work", "ns", "from wake-up to write; 0 in virtual time", Type::kI64, 1,
                    offsetof(TickRecord, work_ns)},
    RecordingColumn{"counts", "1", "encoder counts as received from the arm", Type::kI32, 3,
                    offsetof(TickRecord, counts)},
    RecordingColumn{"q", "rad", "joint angles", Type::kF64, 3, offsetof(TickRecord, q)},
    RecordingColumn{"p_WT", "m", "position of the tip in the world", Type::kF64, 3,
                    offsetof(TickRecord, p_WT)},
    RecordingColumn{"v_WT", "m/s", "estimated velocity of the tip in the world", Type::kF64, 3,
                    offsetof(TickRecord, v_WT)},
    RecordingColumn{"p_WP", "m", "proxy in the world: the contact point on the surface", Type::kF64,
                    3, offsetof(TickRecord, p_WP)},
    RecordingColumn{"n_W", "1", "outward unit normal of the surface at the proxy", Type::kF64, 3,
                    offsetof(TickRecord, n_W)},
    RecordingColumn{"f_wanted_W", "N", "force on the hand requested by the scene", Type::kF64, 3,
                    offsetof(TickRecord, f_wanted_W)},
    RecordingColumn{"f_sent_W", "N", "force that the gate passed to the motors", Type::kF64, 3,
                    offsetof(TickRecord, f_sent_W)},
    RecordingColumn{
        "heat", "1",
        "heat of each motor; 1 is the limit of its winding, 0 if the arm file names none",
        Type::kF64, 3, offsetof(TickRecord, heat), true},
    RecordingColumn{
        "q_WT", "1",
        "quaternion w, x, y, z of the stylus in the world; zeros if the arm reports none",
        Type::kF32, 4, offsetof(TickRecord, q_WT), true},
    RecordingColumn{"gimbal", "rad", "angles of the gimbal's axes; zeros if the arm has none",
                    Type::kF32, 3, offsetof(TickRecord, gimbal), true},
    RecordingColumn{"gripper", "m", "opening of the gripper; 0 if the arm has none", Type::kF32, 1,
                    offsetof(TickRecord, gripper), true},
    RecordingColumn{"gain", "1",
                    "fraction of the scene's force that is requested; below 1 in a pause",
                    Type::kF64, 1, offsetof(TickRecord, gain), true},
    RecordingColumn{"setting_value", "1", "requested value of that setting, in its SI unit",
                    Type::kF64, 1, offsetof(TickRecord, setting_value), true},
    RecordingColumn{"setting", "1",
                    "setting of the scene changed in this tick, numbered from 0 over all objects; "
                    "-1 for none, -2 if a program or a topic gave the force",
                    Type::kI16, 1, offsetof(TickRecord, setting), true},
    RecordingColumn{"depth", "m", "depth of the tip below the surface", Type::kF64, 1,
                    offsetof(TickRecord, depth)},
    RecordingColumn{"feature", "1", "active triangle, -1 for none", Type::kI32, 1,
                    offsetof(TickRecord, feature)},
    RecordingColumn{"object", "1", "object of the scene, numbered from 0; -1 for none", Type::kI16,
                    1, offsetof(TickRecord, object)},
    RecordingColumn{"hops", "1", "triangles crossed in the tick", Type::kU16, 1,
                    offsetof(TickRecord, hops)},
    RecordingColumn{"buttons", "1", "pressed buttons, one bit each", Type::kU16, 1,
                    offsetof(TickRecord, buttons)},
    RecordingColumn{"in_contact", "1", "1 while the tip is held outside an object", Type::kU8, 1,
                    offsetof(TickRecord, in_contact)},
    RecordingColumn{"fresh", "1", "1 if a new report of the arm arrived for this tick", Type::kU8,
                    1, offsetof(TickRecord, fresh)},
    RecordingColumn{"has_gripper", "1", "1 if the arm has a gripper", Type::kU8, 1,
                    offsetof(TickRecord, has_gripper), true},
    RecordingColumn{"stage", "1", "0 idle, 1 active, 2 fault", Type::kU8, 1,
                    offsetof(TickRecord, stage)},
    RecordingColumn{"fault", "1", "0 none; /faults names the others", Type::kU8, 1,
                    offsetof(TickRecord, fault)},
    RecordingColumn{"link", "1", "0 connected, 1 silent, 2 lost", Type::kU8, 1,
                    offsetof(TickRecord, link), true},
    RecordingColumn{
        "home_needed", "1",
        "1 while the arm's counters may be wrong: no force until it was in its home pose",
        Type::kU8, 1, offsetof(TickRecord, home_needed), true},
};

}  // namespace

bool RecordingColumn::by_axis() const noexcept {
  const std::string_view own = name;
  return own == "q" || own == "counts" || own == "heat" || own == "gimbal";
}

std::size_t RecordingColumn::element() const noexcept {
  switch (type) {
    case Type::kU8:
      return 1;
    case Type::kU16:
    case Type::kI16:
      return 2;
    case Type::kI32:
    case Type::kF32:
      return 4;
    case Type::kI64:
    case Type::kU64:
    case Type::kF64:
      return 8;
  }
  return 0;
}

std::span<const RecordingColumn> recording_columns() noexcept {
  return kColumns;
}

}  // namespace thimble::session

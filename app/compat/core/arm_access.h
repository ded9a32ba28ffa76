#pragma once

#include <cstdint>
#include <string>

#include "compat/core/arm_data.h"

namespace thimble::compat {

/// The arms of `thimble exec`, as the libraries that stand in for others' reach them: the only way
/// from a face to an arm. The servo loop, the gate and the arm are in the process of `thimble
/// exec`; what is here reads and writes memory that both share.
///
/// One for the whole process, used by all of its threads. No function throws, hangs or crashes,
/// whatever it is given: an arm that is not open gives false, zeros, or nothing. Nothing of it is
/// for our servo thread; reading and asking for a force take no system call.
namespace arms {

/// Returns how many arms may be opened; 0 where the program was not started by `thimble exec`.
int count() noexcept;

/// Opens an arm, or opens it once more if it is open, and starts its loop; its force is off until
/// `enable_force`. `face`: who asks, for the report ("HDAPI"). Returns an empty text, or what is
/// wrong and what to do. Waits until the arm is there.
std::string open(int arm, const char* face);
/// Closes an arm as often as it was opened; the last time its force goes to zero and it may be
/// opened again. Returns false if it was not open.
bool close(int arm) noexcept;
/// Returns whether an arm is open here.
bool is_open(int arm) noexcept;
/// Returns whether its loop runs. False: `thimble exec` is gone or the run has ended.
bool is_running(int arm) noexcept;
/// Returns what an arm is; before it was opened once, what its arm file says (zeros where a real
/// arm is not chosen yet); zeros beyond `count`. It may not be opened meanwhile by another thread.
const ArmFacts& facts(int arm) noexcept;
/// Returns the name of an arm that need not be open, as `thimble exec` was given it; empty beyond
/// `count`.
std::string name(int arm);

/// Copies what is known after the newest tick. False if the arm is not open; then nothing changes.
bool read(int arm, ArmReading& reading) noexcept;
/// Waits until a tick after `tick` is over. False, after one period of sleep, if there will be
/// none.
bool wait_for_tick(int arm, std::uint64_t tick) noexcept;

/// Asks for a force from the next tick on, until it is asked for another one. It must be renewed
/// at least every `ArmFacts::stall_ns` (or `set_watchdog`), else it counts as zero.
bool ask_force(int arm, const ForceAsked& asked) noexcept;
/// Waits until a tick has taken the force that was asked for last: what paces the loops of others.
/// False, after one period of sleep, if there will be none.
bool wait_until_taken(int arm) noexcept;

/// Says whether ticks that wait for the program wait for the calling thread alone: one that renews
/// the force by itself, while other threads wait for ticks too. Ends by the same thread.
void lead(int arm, bool leads) noexcept;

/// Returns the time that the program lives by, ns since some start: the wall's, or that of the
/// first open arm where ticks wait for the program (`thimble exec --clock virtual`).
std::int64_t now_ns() noexcept;
/// Waits by that time.
void sleep_ns(std::int64_t duration_ns) noexcept;

/// Lets all force through, the program's and the scene's, or none. Switched on it opens slowly
/// (soft start). A simulated arm that is in fault, with the cause over, is activated anew; a real
/// one waits for a person.
bool enable_force(int arm, bool enabled) noexcept;
/// Returns whether force is let through.
bool force_enabled(int arm) noexcept;
/// Sets how long a force counts that is not renewed, ns; above the gate's own, or 0: the gate's.
bool set_watchdog(int arm, std::int64_t watchdog_ns) noexcept;
/// Sets the speed of the tip (m/s) that is a fault; above the gate's own, or 0: the gate's.
bool set_speed_limit(int arm, double speed) noexcept;
/// Sets the largest force (N) that this program may ask for; above the gate's own, or 0: the
/// gate's. A longer one is cut to it.
bool set_force_limit(int arm, double force) noexcept;

/// Notes that a program has calibrated an arm, as its interface asks. It holds beyond `close`, for
/// other programs of the same `thimble exec` too.
bool mark_calibrated(int arm) noexcept;
/// Returns whether one has.
bool is_calibrated(int arm) noexcept;

/// Counts a wrong call for the report and keeps the first words of each function.
void wrong_call(const char* function, const char* what) noexcept;

}  // namespace arms
}  // namespace thimble::compat

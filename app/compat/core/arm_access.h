#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "compat/core/arm_data.h"

namespace thimble::compat {

/// Access to the arms of `thimble exec` for the compatibility libraries. It is their only way to an
/// arm. The servo loop, the gate and the arm are in the process of `thimble exec`; these functions
/// read and write memory shared with it.
///
/// One instance per process, used by all of its threads. No function throws, hangs or crashes,
/// whatever its arguments are. For an arm that is not open, functions return false, zeros or
/// nothing. Not for the servo thread; reading and requesting a force make no system call.
namespace arms {

/// Returns how many arms may be opened; 0 if the program was not started by `thimble exec`.
int count() noexcept;
/// Returns how many arms the library `api` lists: `count`, or 0 if another compatibility library of
/// this process has listed or opened arms before. So a program that searches through several
/// libraries finds each arm once.
int listed(const char* api) noexcept;
/// Returns whether another program, or another library of this one, has an arm open.
bool is_taken(int arm) noexcept;

/// Opens an arm, or opens it once more if it is open, and starts its loop. Its force is off until
/// `enable_force`. `api`: name of the interface for the report ("HDAPI"). Returns an empty text,
/// or the problem and its remedy. Waits until the arm is open.
std::string open(int arm, const char* api);
/// Closes an arm. After as many calls as `open`, its force goes to zero and it may be opened again.
/// Returns false if it was not open.
bool close(int arm) noexcept;
/// Returns whether this process has opened an arm.
bool is_open(int arm) noexcept;
/// Returns whether an arm's loop runs. False: `thimble exec` or the run has ended.
bool is_running(int arm) noexcept;
/// Returns whether an open arm's ticks wait for this program (`thimble exec --clock virtual`).
bool is_paced(int arm) noexcept;
/// Returns the constant properties of an arm. Before the first opening, those of its arm file
/// (zeros if a real arm is not chosen yet); zeros beyond `count`. From any thread.
ArmFacts facts(int arm) noexcept;
/// Returns the name of an arm as passed to `thimble exec`; the arm need not be open. Empty beyond
/// `count`.
std::string name(int arm);

/// Copies the state after the newest tick. False if the arm is not open; then nothing changes.
bool read(int arm, ArmReading& reading) noexcept;
/// Finds the Jacobian d p_WT / d q (m/rad, row by row) at any joint angles (rad). False if the arm
/// is not open or has no joints, or its parts cannot have these angles. Waits for the server.
bool jacobian_at(int arm, const std::array<double, 3>& q, std::array<double, 9>& J_WT) noexcept;
/// Waits until a tick after `tick` is over. If there will be none, returns false after a sleep of
/// one period.
bool wait_for_tick(int arm, std::uint64_t tick) noexcept;

/// Requests a force from the next tick until the next request. It must be renewed at least every
/// `ArmFacts::stall_ns` (or `set_watchdog`), otherwise it counts as zero.
bool ask_force(int arm, const ForceRequest& asked) noexcept;
/// Waits until a tick has taken the last requested force. This paces the loop of the program. If
/// there will be no tick, returns false after a sleep of one period.
bool wait_until_taken(int arm) noexcept;

/// Sets whether only the calling thread permits ticks that wait for the program. For a thread that
/// renews the force while other threads also wait for ticks. The same thread must reset it.
void lead(int arm, bool leads) noexcept;

/// Returns the program's time, ns since some start: wall-clock time, or the time of the first open
/// arm if ticks wait for the program (`thimble exec --clock virtual`).
std::int64_t now_ns() noexcept;
/// Sleeps in that time.
void sleep_ns(std::int64_t duration_ns) noexcept;

/// Enables or disables all force, the program's and the scene's. After it is enabled, it rises
/// slowly (soft start). A simulated arm in fault is activated again if the cause is over; a real
/// one needs a person.
bool enable_force(int arm, bool enabled) noexcept;
/// Returns whether force is enabled.
bool force_enabled(int arm) noexcept;
/// Sets how long a force counts without renewal, ns. Above the gate's limit, or 0: the gate's.
bool set_watchdog(int arm, std::int64_t watchdog_ns) noexcept;
/// Sets the speed of the tip (m/s) that causes a fault. Above the gate's limit, or 0: the gate's.
bool set_speed_limit(int arm, double speed) noexcept;
/// Sets the maximum force (N) of this program; larger forces are limited to it. Above the gate's
/// limit, or 0: the gate's.
bool set_force_limit(int arm, double force) noexcept;

/// Sets whether the program holds or moves the tip by its forces. A simulated hand then yields; a
/// person is not affected.
bool set_regulated(int arm, bool regulated) noexcept;

/// Records that a program has calibrated an arm, as its interface requires. It remains valid after
/// `close`, and for other programs of the same `thimble exec`.
bool mark_calibrated(int arm) noexcept;
/// Returns whether a program has calibrated an arm.
bool is_calibrated(int arm) noexcept;

/// Counts a wrong call for the report and keeps the first message of each function.
void wrong_call(const char* function, const char* what) noexcept;

}  // namespace arms
}  // namespace thimble::compat

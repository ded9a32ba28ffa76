#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "thimble/driver/tick_record.h"
#include "thimble/scene/scene_objects.h"

namespace thimble::session {

/// Says how a replayed run compares with the recorded one: what the scene asked of the arm, tick by
/// tick.
struct ReplayComparison {
  std::uint64_t ticks = 0;
  std::uint64_t differing = 0;         ///< Ticks whose force is not the same to the bit.
  std::optional<std::uint64_t> first;  ///< Number of the first of them.
  double largest = 0;                  ///< Of all differences of force, N.
};

/// Lets a recorded hand touch a scene: each tick's state of the arm, to the bit, is given to the
/// scene's force law in virtual time, and what that answers is compared with what was recorded.
/// `sink` is handed each tick with the new answer in place of the recorded one (what the motors got
/// is the recorded one); it may be empty. Real-time: never from the servo thread.
ReplayComparison replay(std::span<const driver::TickRecord> recorded, scene::SceneObjects& objects,
                        const std::function<void(const driver::TickRecord&)>& sink = {});

/// Tells after which row ticks are missing because the disk was too slow, if any: from there on a
/// replay cannot be the same. Missed periods of the loop are not missing ticks.
std::optional<std::size_t> first_gap(std::span<const driver::TickRecord> recorded);

}  // namespace thimble::session

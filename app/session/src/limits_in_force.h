#pragma once

#include <string>

namespace thimble::session {

class Setup;

/// Returns all active limits of an open arm of a run in one sentence, for the log: force, speed,
/// rise, times, energy stage, walls, enabling input. Real-time: never from the servo thread.
std::string limits_in_force(const Setup& setup, std::size_t arm);

}  // namespace thimble::session

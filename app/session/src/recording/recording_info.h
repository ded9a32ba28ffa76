#pragma once

#include <cstdint>
#include <string>

namespace thimble::session {

/// Says what a recording is of: enough to run the same again.
struct RecordingInfo {
  std::string scene;       ///< Its name.
  std::string scene_file;  ///< Where it was read from.
  std::string scene_text;  ///< The file's text.
  std::string arm;         ///< Its name.
  std::string arm_file;    ///< Where its description was read from.
  std::string arm_text;    ///< The file's text.
  std::string device;      ///< "sim", or the name of the arm on the desk.
  std::string clock;       ///< "virtual" or "wall".
  std::string program;     ///< Version, revision, build type and compiler.
  double rate = 0;         ///< Hz
  std::uint64_t seed = 0;  ///< Of everything random in the simulation.
};

}  // namespace thimble::session

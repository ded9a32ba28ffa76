#pragma once

#include <filesystem>
#include <functional>

#include "session.h"
#include "thimble/driver/discovery.h"

namespace thimble::app {

/// Watches over a real arm at the side of the servo: says when its force is off and why, finds it
/// again by its serial number after it was pulled, and lets forces through again only when the user
/// presses Enter. Real-time: never from the servo thread.
class ReplugWatch {
 public:
  /// Watches `arm`, which `session` drives.
  ReplugWatch(Session& session, const driver::FoundArm& arm, std::filesystem::path firmware);

  /// Looks once; call it a few times a second.
  void step();

 private:
  void search();

  Session& session_;
  driver::FoundArm arm_;
  std::filesystem::path firmware_;
  bool told_ = false;     // the user knows that the force is off
  bool present_ = true;   // the arm is on the wire
  bool offered_ = false;  // a new wire waits for the loop
  int pause_ = 0;         // steps until the next search
};

}  // namespace thimble::app

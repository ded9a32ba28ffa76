#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compat/core/arm_data.h"
#include "compat/haply/service_message.h"

namespace thimble::compat::haply {

/// The arms of `thimble exec` as an Inverse3's service shows them to several programs at once: each
/// is a session, and an arm gets the sum of what its sessions ask for, as the service adds them up
/// [S]. A force counts until its session's next message, for the gate's `stall` at most. An arm
/// without a session that asks for forces has its force off.
///
/// Each message is answered after a tick of every arm that has taken its force; that paces a
/// program's loop, and in virtual time it is what lets the ticks go on. Any thread, one message of
/// a session at a time; never from the servo thread.
class ServedArms {
 public:
  /// Opens all arms. Why one cannot be opened stands in the terminal; it is not listed then.
  void open();
  /// Returns the first message, which tells everything.
  std::string greet(int session) { return message(session, true); }
  /// Does what a message asks for and returns its answer.
  std::string answer(int session, std::string_view text);
  /// Takes the forces of a session away, whose program has left.
  void leave(int session);
  /// Closes all arms.
  void close();

 private:
  struct Asked {
    Eigen::Vector3d f_B{0, 0, 0};  // N
    std::int64_t at_ns = 0;        // on the clock that the program lives by
  };
  struct Arm {
    std::mutex mutex;
    bool open = false;
    std::map<int, Asked> sessions;  // that have asked for a force
  };

  bool is_open(int number);
  bool push(int number, int session, const std::optional<Eigen::Vector3d>& f_B);
  void ask_sum(int number, const Arm& arm) const;
  std::string message(int session, bool full);

  std::array<Arm, kArmsMost> arms_;
};

}  // namespace thimble::compat::haply

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

/// The arms of `thimble exec` as an Inverse3's service shows them to several programs at once. Each
/// program is a session, and an arm gets the sum of the forces of its sessions, as in the original
/// service [S]. A force counts until its session's next message, for at most the gate's `stall`.
/// The force of an arm is off until a session requests forces.
///
/// Each message is answered after a tick of every arm has taken its force. This paces a program's
/// loop, and permits the ticks in virtual time. Any thread, one message of a session at a time;
/// never from the servo thread.
class ServedArms {
 public:
  /// Opens all arms. If one cannot be opened, prints the reason and omits the arm.
  void open();
  /// Returns the first message, with the full state.
  std::string greet(int session) { return message(session, true); }
  /// Executes a message and returns its answer.
  std::string answer(int session, std::string_view text);
  /// Removes the forces of a session whose program has disconnected.
  void leave(int session);
  /// Closes all arms.
  void close();

 private:
  struct Asked {
    Eigen::Vector3d f_B{0, 0, 0};  // N
    std::int64_t at_ns = 0;        // in the program's time
  };
  struct Arm {
    std::mutex mutex;
    bool open = false;
    std::map<int, Asked> sessions;  // sessions that have requested a force
  };

  bool is_open(int number);
  bool push(int number, int session, const std::optional<Eigen::Vector3d>& f_B);
  void ask_sum(int number, const Arm& arm) const;
  std::string message(int session, bool full);

  std::array<Arm, kArmsMax> arms_;
};

}  // namespace thimble::compat::haply

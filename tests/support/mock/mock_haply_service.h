#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "thimble/driver/clock.h"

namespace thimble::support {

/// Behaviour of the mock service for the next messages.
enum class HaplyMischief {
  kNone,
  kSilent,        ///< Sends no answers.
  kLate,          ///< Answers 60 ms late.
  kLeavesOneOut,  ///< Answers only every second message.
  kNan,           ///< A position that is not a JSON number.
  kInfinite,      ///< A number outside the range of a double.
  kMillimetres,   ///< A position that no arm can reach.
  kNull,          ///< A position without a number.
  kGarbage,       ///< Not JSON.
  kHuge,          ///< A message above the size limit.
  kNotReady,      ///< The arm reports that it is not ready.
  kUnplugged,     ///< The arm is no longer in the list.
  kClose,         ///< Closes the WebSocket.
  kDie,           ///< Ends without closing, like a killed process.
};

/// First message of the mock service.
enum class HaplyGreeting {
  kInverse3,      ///< Like the real service.
  kWithGrip,      ///< With a wireless grip in addition to the arm.
  kUncalibrated,  ///< Its arm is not calibrated.
  kInUse,         ///< Another program uses its arm.
  kNoArm,         ///< It has no arm.
  kOther,         ///< JSON of another service.
  kNoJson,        ///< Not JSON.
  kNothing,       ///< Sends nothing.
};

/// Messages and state of the mock.
struct HaplyLog {
  int messages = 0;                      ///< Number of received messages.
  int wrong = 0;                         ///< Messages that violate the published JSON format.
  std::vector<Eigen::Vector3d> taken_B;  ///< Received forces, N.
  Eigen::Vector3d f_T_B{0, 0, 0};        ///< The current force, N; it expires soon.
  Eigen::Vector3d p_BT{0, 0, 0};         ///< Position of its arm, m.
  bool closed_by_client = false;         ///< The client closed the WebSocket correctly.
};

/// A service with Haply's published JSON format, in its own thread, whose arm is a mass on a hand.
/// It listens on 127.0.0.1, on a port that the kernel selects. It uses `clock`, which must outlive
/// it and which any thread may read; without it, real time.
class MockHaplyService {
 public:
  /// `old_spelling`: accepts the force only under "values", as until version 3.4; else under
  /// "vector". `port`: 0 for any.
  explicit MockHaplyService(HaplyGreeting greeting = HaplyGreeting::kInverse3,
                            bool old_spelling = false, std::uint16_t port = 0,
                            const driver::Clock* clock = nullptr);
  ~MockHaplyService();

  std::uint16_t port() const;
  void begin(HaplyMischief mischief);
  /// Moves the hand that holds the arm, m.
  void hand_to(const Eigen::Vector3d& p_BH);
  HaplyLog log() const;
  /// Returns the number of messages that have been handled completely.
  std::uint64_t dealt_with() const;

 private:
  class Server;
  std::unique_ptr<Server> server_;
};

}  // namespace thimble::support

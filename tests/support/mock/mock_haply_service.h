#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "thimble/driver/clock.h"

namespace thimble::support {

/// What the mock service does with the next messages.
enum class HaplyMischief {
  kNone,
  kSilent,        ///< Answers nothing.
  kLate,          ///< Answers 60 ms late.
  kLeavesOneOut,  ///< Answers every second message alone.
  kNan,           ///< A position that is no JSON number.
  kInfinite,      ///< A number that no double holds.
  kMillimetres,   ///< A position that no arm can have.
  kNull,          ///< A position without a number.
  kGarbage,       ///< No JSON.
  kHuge,          ///< A message larger than any.
  kNotReady,      ///< The arm says that it is not ready.
  kUnplugged,     ///< The arm is not in the list any more.
  kClose,         ///< Closes the WebSocket.
  kDie,           ///< Ends without a word, as a killed process does.
};

/// How the mock service greets.
enum class HaplyGreeting {
  kInverse3,      ///< As the service does.
  kWithGrip,      ///< With a wireless grip beside the arm.
  kUncalibrated,  ///< Its arm is not calibrated.
  kInUse,         ///< Another program uses its arm.
  kNoArm,         ///< It has no arm.
  kOther,         ///< JSON of another service.
  kNoJson,        ///< No JSON.
  kNothing,       ///< Says nothing.
};

/// What the mock was told and did.
struct HaplyLog {
  int messages = 0;                      ///< That came.
  int wrong = 0;                         ///< That keep not to the published JSON.
  std::vector<Eigen::Vector3d> taken_B;  ///< Forces that it took, N.
  Eigen::Vector3d f_T_B{0, 0, 0};        ///< The force that stands, N: it keeps none for long.
  Eigen::Vector3d p_BT{0, 0, 0};         ///< Where its arm is, m.
  bool closed_by_client = false;         ///< The WebSocket was closed as it should be.
};

/// A service that keeps to Haply's published JSON, in a thread of its own, with a mass on a hand as
/// its arm. It listens on this computer, on a port that the kernel chooses. It goes by `clock`,
/// which outlives it and which any thread may read; by the time of the world where there is none.
class MockHaplyService {
 public:
  /// `old_spelling`: takes the force under "values", as until 3.4, and knows no other; else under
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
  /// Returns how many messages have come, and all that follows from them has been done.
  std::uint64_t dealt_with() const;

 private:
  class Server;
  std::unique_ptr<Server> server_;
};

}  // namespace thimble::support

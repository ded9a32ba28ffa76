#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "ros2/ros_names.h"
#include "ros2/ros_steps.h"
#include "scene_poses.h"
#include "thimble/driver/clock.h"
#include "thimble/driver/snapshot.h"
#include "thimble/driver/tick_record.h"

namespace thimble::ros2 {

/// What becomes of the forces that come by a topic.
enum class RosForce : std::uint8_t {
  kNone,     ///< No topic is listened to.
  kAdd,      ///< They are added to the scene's.
  kReplace,  ///< They stand in place of the scene's, which is not felt.
};

/// How far the topics of a run go.
enum class RosReach : std::uint8_t {
  kThisComputer,  ///< Programs of this computer find them, and only theirs are heard.
  kUnseen,        ///< The same, and they are not announced.
  kNetwork,       ///< Other computers as well, as Cyclone DDS is configured.
};

/// What the user asked of the topics of a run.
struct RosOptions {
  std::string name_space = {};               ///< "/phantom"; empty: none
  std::string arm_space = {};                ///< "/left", where there are several arms; else empty
  RosStyle style = RosStyle::kPlain;         ///< of names and axes
  std::string world_frame = "world";         ///< name of frame W, in the style's axes
  std::string tip_frame = "tip";             ///< name of frame T
  std::uint32_t domain = 0;                  ///< of DDS
  RosReach reach = RosReach::kThisComputer;  ///< which programs can hear and be heard
  RosForce force = RosForce::kNone;          ///< of the topic of forces
  double force_limit = 0;                    ///< N; 0: the arm's own limit
  std::int64_t stale_ns = 50'000'000;        ///< a force counts for so long
  bool lead_hand = false;                    ///< a topic says where the simulated hand goes
  bool stepped = false;                      ///< virtual time, which a topic moves on
  bool moves_time = true;  ///< of a stepped run: this arm's topics do, and tell the time
};

/// One object of a scene as it is drawn.
struct RosObject {
  std::string name;
  std::vector<std::array<double, 3>> corners_B;  ///< three per triangle, m, in the object's frame
  std::array<float, 3> colour{};                 ///< red, green, blue, 0 to 1
  bool moves = false;                            ///< it stands in the poses
};

/// What the topics tell of a run and does not change.
struct RosScene {
  std::string arm;                  ///< its name, for people; no other arm of the run has it
  std::vector<std::string> joints;  ///< their names; empty: the arm has none
  std::string urdf;                 ///< the arm for robot_description (arm_urdf.h)
  std::vector<RosObject> objects;   ///< in the scene's order
};

/// A force that came by a topic and was found good.
struct RosWrench {
  std::uint64_t number = 0;     ///< from 1
  std::int64_t time_ns = 0;     ///< when it came, on the run's clock
  std::int64_t answers_ns = 0;  ///< its stamp on the run's clock; 0: it has none that tells
  std::array<double, 3> f_W{};  ///< N, as it was asked for
};

/// A place for the simulated hand that came by a topic and was found good.
struct RosHandPlace {
  std::uint64_t number = 0;     ///< from 1
  std::array<double, 3> p_W{};  ///< m
};

/// How many messages came, and what was wrong with them. Any thread reads.
struct RosCounts {
  std::atomic<std::uint64_t> taken{0};        ///< good forces
  std::atomic<std::uint64_t> places{0};       ///< good places of the hand
  std::atomic<std::uint64_t> not_finite{0};   ///< refused
  std::atomic<std::uint64_t> wrong_frame{0};  ///< refused
  std::atomic<std::uint64_t> with_torque{0};  ///< taken, less the torque: no motor is for it
  std::atomic<std::uint64_t> skipped{0};      ///< newer ones stood behind them already
  std::atomic<std::uint64_t> published{0};    ///< ticks that were published
};

/// The way between a run and whoever speaks for it on the wire: no lock in the tick, no library. It
/// outlives both sides.
struct RosChannel {
  const driver::Clock* clock = nullptr;  ///< of the run; any thread may ask it for the time
  /// The newest tick; written by the servo's thread.
  const driver::Snapshot<driver::TickRecord>* tick = nullptr;
  driver::Snapshot<session::ScenePoses> poses;  ///< of what moves; written by the servo's thread
  driver::Snapshot<RosWrench> wrench;           ///< the newest force; by the topics' thread
  driver::Snapshot<RosHandPlace> hand;          ///< the newest place; by the topics' thread
  RosSteps* steps = nullptr;                    ///< of a run that is stepped; else null
  std::size_t arm = 0;                          ///< which of the run's
  RosCounts counts;
};

/// A run's presence on the wire, on a thread of its own; ends with it.
class RosPeer {
 public:
  virtual ~RosPeer() = default;
};

}  // namespace thimble::ros2

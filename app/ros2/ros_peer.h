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

/// Use of the forces received by a topic.
enum class RosForce : std::uint8_t {
  kNone,     ///< No topic is read.
  kAdd,      ///< They are added to the scene's.
  kReplace,  ///< They replace the scene's force.
};

/// Visibility of a run's topics.
enum class RosReach : std::uint8_t {
  kThisComputer,  ///< Only to programs of this computer; only their messages are accepted.
  kUnseen,        ///< The same, without discovery announcements.
  kNetwork,       ///< Also to other computers, as Cyclone DDS is configured.
};

/// Options of a run's topics.
struct RosOptions {
  std::string name_space = {};               ///< "/phantom"; empty: none
  std::string arm_space = {};                ///< "/left", with several arms; otherwise empty
  RosStyle style = RosStyle::kPlain;         ///< convention of names and axes
  std::string world_frame = "world";         ///< name of frame W, in the style's axes
  std::string tip_frame = "tip";             ///< name of frame T
  std::uint32_t domain = 0;                  ///< DDS domain
  RosReach reach = RosReach::kThisComputer;  ///< visibility
  RosForce force = RosForce::kNone;          ///< use of the topic of forces
  double force_limit = 0;                    ///< N; 0: the arm's own limit
  std::int64_t stale_ns = 50'000'000;        ///< maximum age of a force
  bool lead_hand = false;                    ///< a topic sets the simulated hand's target
  bool stepped = false;                      ///< virtual time, advanced by a topic
  bool moves_time = true;  ///< in a stepped run: the topics of this arm advance the time
};

/// One object of a scene for display.
struct RosObject {
  std::string name;
  std::vector<std::array<double, 3>> corners_B;  ///< three per triangle, m, in the object's frame
  std::array<float, 3> colour{};                 ///< red, green, blue, 0 to 1
  bool moves = false;                            ///< it has an entry in the poses
};

/// Constant data of a run for its topics.
struct RosScene {
  std::string arm;                  ///< display name, unique in the run
  std::vector<std::string> joints;  ///< their names; empty: no joints
  std::string urdf;                 ///< the arm for robot_description (arm_urdf.h)
  std::vector<RosObject> objects;   ///< in the scene's order
};

/// A valid force received by a topic.
struct RosWrench {
  std::uint64_t number = 0;     ///< from 1
  std::int64_t time_ns = 0;     ///< time of arrival, on the run's clock
  std::int64_t answers_ns = 0;  ///< its stamp on the run's clock; 0: no usable stamp
  std::array<double, 3> f_W{};  ///< N, as requested
};

/// A valid target of the simulated hand received by a topic.
struct RosHandTarget {
  std::uint64_t number = 0;     ///< from 1
  std::array<double, 3> p_W{};  ///< m
};

/// Counters of messages and their problems. Any thread may read them.
struct RosCounts {
  std::atomic<std::uint64_t> taken{0};         ///< valid forces
  std::atomic<std::uint64_t> hand_targets{0};  ///< valid targets of the hand
  std::atomic<std::uint64_t> not_finite{0};    ///< refused
  std::atomic<std::uint64_t> wrong_frame{0};   ///< refused
  std::atomic<std::uint64_t> with_torque{0};   ///< accepted without the torque: no motor for it
  std::atomic<std::uint64_t> skipped{0};       ///< superseded by newer ones before they were read
  std::atomic<std::uint64_t> published{0};     ///< published ticks
};

/// The connection between a run and its peer on the network: no lock in the tick, no library. It
/// outlives both sides.
struct RosChannel {
  const driver::Clock* clock = nullptr;  ///< clock of the run; any thread may read it
  /// The newest tick; written by the servo thread.
  const driver::Snapshot<driver::TickRecord>* tick = nullptr;
  driver::Snapshot<session::ScenePoses> poses;  ///< of moving objects; by the servo thread
  driver::Snapshot<RosWrench> wrench;           ///< the newest force; written by the topics' thread
  driver::Snapshot<RosHandTarget> hand;         ///< the newest target; by the topics' thread
  RosSteps* steps = nullptr;                    ///< for a stepped run, otherwise null
  std::size_t arm = 0;                          ///< index of the arm in the run
  RosCounts counts;
};

/// A run's presence on the network, with its own thread; ended by the destructor.
class RosPeer {
 public:
  virtual ~RosPeer() = default;
};

}  // namespace thimble::ros2

#include "ros2/ros_latency.h"

#include <unistd.h>

#include <atomic>

#include "ros2/ros_module.h"
#include "ros2/ros_run.h"
#include "thimble/session/servo_thread.h"
#include "thimble/session/session.h"

namespace thimble::ros2 {

driver::Result<session::Histogram> measure_ros_latency(const std::string& scene,
                                                       const std::string& arm_file,
                                                       std::uint32_t domain, double duration) {
  session::SessionOptions asked;
  asked.clock = session::ClockKind::kWall;
  asked.arm_file = arm_file;
  asked.duration = duration;
  auto opened = session::Session::open(scene, asked);
  if (!opened) return opened.error();
  session::Session& session = **opened;
  session::ServoThread servo(true);
  RosOptions options;
  options.name_space = "/thimble_tune_" + std::to_string(getpid());
  options.domain = domain;
  options.force = RosForce::kAdd;
  auto run = RosRun::open(session, options);
  if (!run) return run.error();
  auto echo = open_ros_echo(options);
  if (!echo) return echo.error();
  const std::atomic<bool> stop{false};
  servo.begin(session, stop);
  servo.join();
  const session::Histogram ages = (*run)->law()->ages();
  if (ages.count() == 0) {
    return driver::Error{
        "No force was received from the topics. Check that the loopback interface is up "
        "(ip link set lo up)."};
  }
  return ages;
}

}  // namespace thimble::ros2

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

#include "ros2/ros_run.h"
#include "thimble/session/session.h"

// Opens a scene and runs its first ticks in virtual time, with or without ROS 2 topics, so that
// another program can count their instructions:
//   TOPICS=none|publish|force topics_ticks SCENE TICKS      prints the number of ticks in contact
int main(int argc, char** argv) {
  using namespace thimble;
  const char* const asked = std::getenv("TOPICS");
  if (argc != 3 || asked == nullptr) return 2;
  const std::string part = asked;
  auto opened = session::Session::open(argv[1]);
  if (!opened) {
    std::fprintf(stderr, "%s\n", opened.error().message.c_str());
    return 1;
  }
  session::Session& run = **opened;
  std::unique_ptr<ros2::RosRun> topics;
  if (part != "none") {
    ros2::RosOptions options;
    options.domain = 99;
    if (part == "force") options.force = ros2::RosForce::kAdd;
    auto put = ros2::RosRun::open(run, options);
    if (!put) {
      std::fprintf(stderr, "%s\n", put.error().message.c_str());
      return 1;
    }
    topics = std::move(put).value();
  }
  long contact = 0;
  const long ticks = std::atol(argv[2]);
  for (long tick = 0; tick < ticks; ++tick) {
    if (run.step()) return 1;
    contact += run.ticks().back().in_contact ? 1 : 0;
  }
  std::printf("%ld\n", contact);
  return 0;
}

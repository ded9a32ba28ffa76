// The module thimble-ros2.so: a run's peer that uses Cyclone DDS.
#include <atomic>
#include <chrono>
#include <cstdio>
#include <memory>
#include <thread>

#include "dds/dds.h"
#include "ros2/dds_domain.h"
#include "ros2/dds_writers.h"
#include "ros2/echo_peer.h"
#include "ros2/message_reader.h"
#include "ros2/ros_module.h"
#include "thimble/version.h"

namespace thimble::ros2 {
namespace {

/// Period of the check for a new tick: half that of an arm's tick.
constexpr dds_duration_t kLook_ns = DDS_USECS(500);

class CyclonePeer final : public RosPeer {
 public:
  CyclonePeer(const RosOptions& options, const RosScene& scene, RosChannel& channel)
      : options_(options), scene_(scene), channel_(channel) {}

  /// Returns an error of DDS, or 0.
  dds_return_t begin() {
    if (const dds_return_t opened = domain_.open(options_); opened < 0) return opened;
    participant_ = dds_create_participant(options_.domain, nullptr, nullptr);
    if (participant_ < 0) return participant_;
    writers_ = std::make_unique<DdsWriters>(participant_, options_, scene_);
    if (writers_->error() < 0) return writers_->error();
    taker_ = std::make_unique<MessageReader>(participant_, options_, channel_);
    if (taker_->error() < 0) return taker_->error();
    waitset_ = dds_create_waitset(participant_);
    if (waitset_ < 0) return waitset_;
    if (const dds_return_t attached = taker_->attach(waitset_); attached < 0) return attached;
    thread_ = std::thread([this] { serve(); });
    return 0;
  }

  ~CyclonePeer() override {
    leave_.store(true);
    if (thread_.joinable()) thread_.join();
    if (participant_ > 0) dds_delete(participant_);
  }

 private:
  void serve() {
    while (!leave_.load()) {
      dds_waitset_wait(waitset_, nullptr, 0, kLook_ns);
      taker_->take(world_minus_run_ns());
      if (options_.stepped) {
        publish_steps();
      } else {
        publish_newest();
      }
    }
  }

  /// Returns the difference of the stamps' clock to the run's.
  std::int64_t world_minus_run_ns() const {
    if (options_.stepped) return 0;
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count() -
           channel_.clock->now_ns();
  }

  /// Publishes the newest tick, if there is one; returns whether there was one.
  bool publish_newest() {
    if (!channel_.tick->load(record_) || record_.tick == shown_) return false;
    shown_ = record_.tick;
    channel_.poses.load(poses_);
    writers_->publish(record_, poses_, record_.time_ns + world_minus_run_ns());
    channel_.counts.published.fetch_add(1);
    return true;
  }

  /// Waits for the permitted ticks and publishes the last of them, repeatedly for later readers.
  /// The end of a step is published after all arms have published it.
  void publish_steps() {
    constexpr std::chrono::milliseconds kLook(20), kAgain(100);
    const std::uint64_t done = channel_.steps->wait_for_ticks(kLook);
    const auto now = std::chrono::steady_clock::now();
    if (!channel_.steps->idle() || (done == published_ && now - published_at_ < kAgain)) return;
    if (done == published_) shown_ = UINT64_MAX;
    publish_newest();
    channel_.steps->set_published(channel_.arm, done);
    if (options_.moves_time && !channel_.steps->all_published(done)) return;
    published_ = done;
    published_at_ = now;
    if (options_.moves_time) writers_->publish_step_end(done);
  }

  const RosOptions options_;
  const RosScene scene_;
  RosChannel& channel_;
  DdsDomain domain_;  // must outlive its entities
  dds_entity_t participant_ = 0, waitset_ = 0;
  std::unique_ptr<DdsWriters> writers_;
  std::unique_ptr<MessageReader> taker_;
  driver::TickRecord record_;
  session::ScenePoses poses_;
  std::uint64_t shown_ = UINT64_MAX, published_ = 0;
  std::chrono::steady_clock::time_point published_at_;
  std::atomic<bool> leave_{false};
  std::thread thread_;
};

/// Starts a peer. On failure, writes the error and returns null.
template <class Peer>
RosPeer* begun(std::unique_ptr<Peer> peer, std::uint32_t domain, char* error, std::size_t size) {
  if (const dds_return_t status = peer->begin(); status < 0) {
    std::snprintf(
        error, size,
        "ROS 2 topics of domain %u cannot be opened: Cyclone DDS reports \"%s\". Check that the "
        "loopback interface is up (with --ros-network, the network interfaces and "
        "CYCLONEDDS_URI), and use a domain below 233.",
        domain, dds_strretcode(status));
    return nullptr;
  }
  return peer.release();
}

}  // namespace
}  // namespace thimble::ros2

extern "C" {

extern const char thimble_ros2_version[];
const char thimble_ros2_version[] = THIMBLE_VERSION;

thimble::ros2::RosPeer* thimble_ros2_open(const thimble::ros2::RosOptions& options,
                                          const thimble::ros2::RosScene& scene,
                                          thimble::ros2::RosChannel& channel, char* error,
                                          std::size_t size) {
  using thimble::ros2::CyclonePeer;
  return thimble::ros2::begun(std::make_unique<CyclonePeer>(options, scene, channel),
                              options.domain, error, size);
}

thimble::ros2::RosPeer* thimble_ros2_echo(const thimble::ros2::RosOptions& options, char* error,
                                          std::size_t size) {
  using thimble::ros2::EchoPeer;
  return thimble::ros2::begun(std::make_unique<EchoPeer>(options), options.domain, error, size);
}
}

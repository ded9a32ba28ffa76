#include "ros2/echo_peer.h"

#include <array>

#include "ros2/dds_endpoints.h"
#include "ros2/dds_messages.h"
#include "ros_messages.h"

namespace thimble::ros2 {
namespace {

constexpr int kTaken = 16;  // poses at a time
constexpr dds_duration_t kLook_ns = DDS_MSECS(20);

}  // namespace

EchoPeer::~EchoPeer() {
  leave_.store(true);
  if (thread_.joinable()) thread_.join();
  if (participant_ > 0) dds_delete(participant_);
}

dds_return_t EchoPeer::begin() {
  const RosNames& names = ros_names(options_.style);
  if (const dds_return_t opened = domain_.open(options_); opened < 0) return opened;
  participant_ = dds_create_participant(options_.domain, nullptr, nullptr);
  if (participant_ < 0) return participant_;
  poses_ = make_reader(participant_, geometry_msgs_msg_dds__PoseStamped__desc,
                       dds_topic_name(options_, names.pose), 1);
  if (poses_ < 0) return poses_;
  forces_ = make_writer(participant_, geometry_msgs_msg_dds__WrenchStamped__desc,
                        dds_topic_name(options_, names.force_in));
  if (forces_ < 0) return forces_;
  waitset_ = dds_create_waitset(participant_);
  if (waitset_ < 0) return waitset_;
  dds_set_status_mask(poses_, DDS_DATA_AVAILABLE_STATUS);
  if (const dds_return_t attached = dds_waitset_attach(waitset_, poses_, 0); attached < 0) {
    return attached;
  }
  thread_ = std::thread([this] { serve(); });
  return 0;
}

void EchoPeer::serve() {
  geometry_msgs_msg_dds__WrenchStamped_ answer{};
  answer.header.frame_id = dds_text(options_.world_frame);
  while (!leave_.load()) {
    dds_waitset_wait(waitset_, nullptr, 0, kLook_ns);
    std::array<void*, kTaken> samples{};
    std::array<dds_sample_info_t, kTaken> about{};
    const dds_return_t came = dds_take(poses_, samples.data(), about.data(), kTaken, kTaken);
    for (dds_return_t i = 0; i < came; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (!about[k].valid_data) continue;
      answer.header.stamp =
          static_cast<const geometry_msgs_msg_dds__PoseStamped_*>(samples[k])->header.stamp;
      dds_write(forces_, &answer);
    }
    if (came > 0) dds_return_loan(poses_, samples.data(), came);
  }
}

}  // namespace thimble::ros2

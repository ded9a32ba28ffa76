#include "ros2/type_hashes.h"

#include <array>

namespace thimble::ros2 {
namespace {

struct Named {
  std::string_view dds_name;
  std::string_view hash;
};

// Computed from ros_messages.idl by the recipe of REP 2016 (ros2.type_hashes computes them
// again); those of common_interfaces agree with what ROS 2 Kilted generates.
constexpr std::array<Named, 14> kHashes{{
    {"std_msgs::msg::dds_::String_",
     "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"},
    {"std_msgs::msg::dds_::UInt64_",
     "RIHS01_fbdc52018fc13755dce18024d1a671c856aa8b4aaf63adfb095b608f98e8c943"},
    {"geometry_msgs::msg::dds_::PoseStamped_",
     "RIHS01_10f3786d7d40fd2b54367835614bff85d4ad3b5dab62bf8bca0cc232d73b4cd8"},
    {"geometry_msgs::msg::dds_::TwistStamped_",
     "RIHS01_5f0fcd4f81d5d06ad9b4c4c63e3ea51b82d6ae4d0558f1d475229b1121db6f64"},
    {"geometry_msgs::msg::dds_::WrenchStamped_",
     "RIHS01_8dc3deaf06b2ab281f9f9a742a8961c328ca7cec16e3fd6586d3a5c83fa78f77"},
    {"tf2_msgs::msg::dds_::TFMessage_",
     "RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087"},
    {"sensor_msgs::msg::dds_::JointState_",
     "RIHS01_a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e"},
    {"sensor_msgs::msg::dds_::Joy_",
     "RIHS01_0d356c79cad3401e35ffeb75a96a96e08be3ef896b8b83841d73e890989372c5"},
    {"diagnostic_msgs::msg::dds_::DiagnosticArray_",
     "RIHS01_5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e"},
    {"visualization_msgs::msg::dds_::MarkerArray_",
     "RIHS01_86cb8800b6fb05b5eff1abd7a56f62a5641d3ae9a1c29e78e67e704f1d067dcf"},
    {"rosgraph_msgs::msg::dds_::Clock_",
     "RIHS01_692f7a66e93a3c83e71765d033b60349ba68023a8c689a79e48078bcb5c58564"},
    {"omni_msgs::msg::dds_::OmniButtonEvent_",
     "RIHS01_3d8e3c256b4d68ef6679f98b28e039d4dc1a01fe243d8b286137c73157937d78"},
    {"omni_msgs::msg::dds_::OmniFeedback_",
     "RIHS01_ba84a6b698946ddb497c4d4b2062955836546f699b10724f3357b0a82c41dfff"},
    {"omni_msgs::msg::dds_::OmniState_",
     "RIHS01_72d2b2c0475f4195cc058ba523e490323fd07458f6ba7087048a610e933f9933"},
}};

}  // namespace

std::string_view type_hash(std::string_view dds_name) noexcept {
  for (const Named& one : kHashes) {
    if (one.dds_name == dds_name) return one.hash;
  }
  return {};
}

}  // namespace thimble::ros2

#include "ros2/scene_writer.h"

#include "ros2/dds_endpoints.h"
#include "ros2/dds_messages.h"

namespace thimble::ros2 {
namespace {

constexpr std::int32_t kTriangleList = 11;  // [S ros2/common_interfaces, Marker.msg]
constexpr std::array<double, 4> kNotTurned{1, 0, 0, 0};

}  // namespace

SceneWriter::SceneWriter(dds_entity_t participant, const RosOptions& options, const RosScene& scene)
    : options_(options), scene_(scene) {
  std::vector<std::string> names;
  for (const RosObject& object : scene.objects) names.push_back(object.name);
  frames_ = object_frames(names);
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    if (!scene.objects[i].moves) frames_[i] = options.world_frame;
  }
  if (scene.objects.empty()) return;
  const dds_entity_t writer =
      make_writer(participant, visualization_msgs_msg_dds__MarkerArray__desc,
                  dds_topic_name(options, "objects"), LateReaders::kHearTheLast);
  if (writer < 0) {
    error_ = writer;
    return;
  }
  publish_objects(writer);
}

void SceneWriter::publish_objects(dds_entity_t writer) {
  static const std::string kNothing;
  const std::size_t count = scene_.objects.size();
  std::vector<std::vector<geometry_msgs_msg_dds__Point_>> points(count);
  std::vector<visualization_msgs_msg_dds__Marker_> markers;
  for (std::size_t i = 0; i < count; ++i) {
    const RosObject& object = scene_.objects[i];
    if (object.corners_B.empty()) continue;  // a field, or a mesh on disk
    points[i].reserve(object.corners_B.size());
    for (const auto& [x, y, z] : object.corners_B) points[i].push_back({x, y, z});
    visualization_msgs_msg_dds__Marker_ marker{};
    marker.header.frame_id = dds_text(frames_[i]);
    marker.ns = dds_text(object.name);
    marker.type = kTriangleList;
    // A moving frame already has the axes of the style.
    marker.pose.orientation =
        dds_quaternion(object.moves ? kNotTurned : to_style(options_.style, kNotTurned));
    marker.scale = {1, 1, 1};
    marker.color = {object.colour[0], object.colour[1], object.colour[2], 1};
    marker.frame_locked = object.moves;
    marker.points =
        dds_sequence<dds_sequence_geometry_msgs_msg_dds__Point_>(points[i], points[i].size());
    marker.texture.header.frame_id = dds_text(kNothing);
    for (char** text : {&marker.texture_resource, &marker.texture.format, &marker.text,
                        &marker.mesh_resource, &marker.mesh_file.filename}) {
      *text = dds_text(kNothing);
    }
    markers.push_back(marker);
  }
  visualization_msgs_msg_dds__MarkerArray_ all{};
  all.markers =
      dds_sequence<dds_sequence_visualization_msgs_msg_dds__Marker_>(markers, markers.size());
  error_ = dds_write(writer, &all);
}

std::vector<geometry_msgs_msg_dds__TransformStamped_> SceneWriter::frames(
    const session::ScenePoses& poses, const std_msgs_msg_dds__Header_& header) const {
  std::vector<geometry_msgs_msg_dds__TransformStamped_> frames;
  for (std::uint32_t i = 0; i < poses.count; ++i) {
    const auto object = static_cast<std::size_t>(poses.object[i]);
    if (object >= frames_.size()) continue;
    geometry_msgs_msg_dds__TransformStamped_ frame{};
    frame.header = header;
    frame.child_frame_id = dds_text(frames_[object]);
    frame.transform.translation = dds_vector(to_style(options_.style, poses.pose[i].p_WB));
    frame.transform.rotation = dds_quaternion(to_style(options_.style, poses.pose[i].q_WB));
    frames.push_back(frame);
  }
  return frames;
}

}  // namespace thimble::ros2

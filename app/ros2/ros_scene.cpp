#include "ros2/ros_scene.h"

#include <algorithm>

#include "object_colours.h"
#include "ros2/arm_urdf.h"
#include "setup.h"
#include "thimble/driver/device.h"
#include "thimble/scene/scene_objects.h"

namespace thimble::ros2 {
namespace {

RosObject described(const scene::SceneObjects& objects, std::size_t number,
                    const std::string& name) {
  RosObject object;
  object.name = name;
  object.colour = scene::object_colour(number);
  const auto moving = objects.moving();
  object.moves = std::find(moving.begin(), moving.end(), number) != moving.end();
  const render::TriangleMesh& mesh = objects.mesh_W(number);
  for (const auto& triangle : mesh.triangles) {
    for (const int corner : triangle) {
      const Eigen::Vector3d& p = mesh.vertices[static_cast<std::size_t>(corner)];
      object.corners_B.push_back({p.x(), p.y(), p.z()});
    }
  }
  return object;
}

}  // namespace

RosScene ros_scene(const session::Session& session, const RosOptions& options, std::size_t arm) {
  const session::Setup& setup = session.setup();
  const driver::ArmTraits& traits = session.device(arm).traits();
  RosScene data;
  const std::string in_scene = session.arms() > 1 ? session.arm_name(arm) : std::string();
  data.arm = setup.arm_file(arm).name;
  if (!in_scene.empty()) data.arm = in_scene + " (" + data.arm + ")";
  if (traits.has_joints) data.joints = joint_names(options.style, traits.has_gimbal ? 6 : 3);
  data.urdf = arm_urdf(setup.arm_file(arm), options.world_frame, in_scene);
  if (arm != 0) return data;
  const auto& objects = session.scene().objects;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    data.objects.push_back(described(setup.objects(), i, objects[i].name));
  }
  return data;
}

}  // namespace thimble::ros2

// Touches your own mesh: loads it, sets stiffness and damping of its surface, and strokes it with a
// simulated hand.
//   03_touch_a_mesh [FILE]     any mesh that `thimble mesh` reads, in m
#include <algorithm>
#include <cstdio>
#include <string>

#include "thimble/render/build_object_touch.h"
#include "thimble/render/mesh/mesh_file.h"
#include "thimble/scene/simulated_device.h"

using thimble::driver::DeviceState;
using thimble::driver::TickRecord;
namespace render = thimble::render;

int main(int argc, char** argv) {
  const std::string file = argc > 1 ? argv[1] : THIMBLE_SCENES "/clay_ball.off";
  auto mesh = render::load_mesh(file);
  if (!mesh) {
    std::fprintf(stderr, "%s\n", mesh.error().message.c_str());
    return 1;
  }
  // Move its highest point to 1 mm above the path of the hand.
  Eigen::Vector3d top = mesh->vertices[0];
  for (const Eigen::Vector3d& p : mesh->vertices) {
    if (p.z() > top.z()) top = p;
  }
  for (Eigen::Vector3d& p : mesh->vertices) p += Eigen::Vector3d(0, 0, 0.001) - top;
  // "offset" is smooth: normals are blended over each triangle, and depth is below the curved
  // surface.
  auto built = render::build_object_touch(*mesh, {.tracker = render::TrackerChoice::kOffset},
                                          {.spring = {.stiffness = 800, .damping = 1}});
  if (!built) {
    std::fprintf(stderr, "%s\n", built.error().message.c_str());
    return 1;
  }
  render::ObjectTouch& object = **built;

  auto opened = thimble::scene::SimulatedDevice::open(
      "vintage_phantom",
      {{0.0, {-0.01, 0, 0.02}}, {0.5, {-0.01, 0, -0.002}}, {1.5, {0.01, 0, -0.002}}});
  if (!opened) {
    std::fprintf(stderr, "%s\n", opened.error().message.c_str());
    return 1;
  }
  thimble::scene::SimulatedDevice& arm = **opened;
  if (!arm.device().activate()) return 1;
  auto law = [&](const DeviceState& state) noexcept { return object.update(state); };
  int touching = 0, last = -1, triangles = 0;
  double max_force = 0;
  auto watch = [&](const TickRecord& tick) noexcept {
    if (!tick.in_contact) return;
    ++touching;
    triangles += tick.feature != last;
    last = tick.feature;
    max_force = std::max(max_force, Eigen::Map<const Eigen::Vector3d>(tick.f_sent_W.data()).norm());
  };
  arm.run(1.5, law, watch);
  std::printf("%zu triangles; touched for %d ms over %d of them, at most %.2f N.\n",
              mesh->triangles.size(), touching, triangles, max_force);
  return touching > 0 ? 0 : 1;
}

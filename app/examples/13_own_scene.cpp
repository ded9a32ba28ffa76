// Makes a scene in code, without a YAML file: a mesh from vertices and triangles, a shape with
// friction, and the path of a simulated hand. Runs it and prints the force on each object.
//   13_own_scene [FILE.yaml]     also writes the scene as a file, which `thimble run` accepts
#include <algorithm>
#include <array>
#include <cstdio>

#include "thimble/scene/scene_builder.h"
#include "thimble/session/session.h"

namespace driver = thimble::driver;
namespace scene = thimble::scene;

int complain(const driver::Error& error) {
  std::fprintf(stderr, "%s\n", error.message.c_str());
  return 1;
}

/// Pyramid with a square base, m. Triangles are counter-clockwise from outside.
thimble::render::TriangleMesh pyramid(double side, double height) {
  const double a = side / 2;
  return {.vertices = {{-a, -a, 0}, {a, -a, 0}, {a, a, 0}, {-a, a, 0}, {0, 0, height}},
          .triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}};
}

int main(int argc, char** argv) {
  scene::SceneBuilder desk("desk");
  desk.arm("vintage_phantom").duration(4).seed(1);  // s
  desk.object("pyramid")
      .mesh(pyramid(0.04, 0.03))
      .position({0, -0.03, -0.015})  // m, the centre of its box
      .stiffness(600)                // N/m
      .damping(1);                   // N s/m
  desk.object("ball")
      .sphere(0.025)  // m
      .position({0, 0.03, -0.025})
      .stiffness(500)
      .damping(1)
      .friction("bristle", {{"coefficient", 0.5}});
  desk.hand()
      .at(0, {0, -0.03, 0.03})  // s; m in the world
      .on(1, "pyramid", {0.012, -0.03, 0}, 0.005)
      .at(2, {0, 0, 0.03})
      .on(3, "ball", {0, 0.03, 0}, 0.005)
      .at(4, {0, 0.03, 0.03});

  // A mistake names its object and key: "object 2 'ball': stiffness: expected a number from 0 ...".
  auto run = thimble::session::Session::open(desk);
  if (!run) return complain(run.error());
  (*run)->run();
  std::array<double, 2> strongest{};  // N, by object
  for (const driver::TickRecord& tick : (*run)->ticks()) {
    if (!tick.in_contact || tick.object < 0) continue;
    double& force = strongest[static_cast<std::size_t>(tick.object)];
    force = std::max(force, Eigen::Vector3d(tick.f_sent_W.data()).norm());
  }
  std::printf("Largest force: %.2f N on the pyramid, %.2f N on the ball.\n", strongest[0],
              strongest[1]);
  if (argc > 1) {
    if (auto saved = desk.save(argv[1]); !saved) return complain(saved.error());
  }
  return strongest[0] > 0.5 && strongest[1] > 0.5 ? 0 : 1;
}

// Contact on the largest mesh that fits memory, compared with a closed form.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <utility>

#include "mesh/contact_mesh.h"
#include "search/make_search.h"
#include "support/contact_walk.h"
#include "support/long_form.h"
#include "support/meshes/shapes.h"
#include "support/random.h"
#include "track/god_object.h"
#include "track/mesh_contact.h"
#include "track/packed_contact_in_memory.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

constexpr double kJump = 0.02;                // m; a god-object slides that far in a few ticks
constexpr double kRing = 0.04, kTube = 0.02;  // of a torus about z, m

// Returns the depth (m) below a torus, in closed form.
double depth_below_torus(const Vector3d& p) {
  return kTube - std::hypot(p.head<2>().norm() - kRing, p.z());
}

// Strokes a torus at 0.2 to 1 mm below its surface, at up to 2 m/s, with a jump of `jump` (m) in
// every hundredth tick. Returns the maximum error of the depth, m; -1 if contact is lost.
template <class Contact>
double worst_on_torus(Contact contact, int ticks, double jump) {
  support::Random random(31);
  const auto place = [](double u, double v, double depth) -> Vector3d {
    const double out = kRing + (kTube - depth) * std::cos(v);
    return {out * std::cos(u), out * std::sin(u), (kTube - depth) * std::sin(v)};
  };
  double u = 0, v = 0, heading = 0, worst = 0;
  support::move_tip(contact, place(u, v, -1e-3));
  for (int i = 0; i < ticks; ++i) {
    heading += 0.3 * random.uniform(-1, 1);
    const double step = i % 100 == 99 ? jump : 0.002 * random.uniform(0, 1);
    u += step * std::cos(heading) / kRing;
    v += step * std::sin(heading) / kTube;
    const Vector3d p = place(u, v, 6e-4 + 4e-4 * std::sin(0.01 * i));
    const ContactState& felt = support::move_tip(contact, p);
    if (!felt.touching) return -1;
    worst = std::max(worst, std::abs(felt.depth - depth_below_torus(p)));
  }
  return worst;
}

// At 10^7 triangles of 60 um a tick crosses hundreds of them, and the tip is 15 of them deep; the
// short form has 10^5 triangles and the same path.
TEST(ContactOnATorus, IsAccurateAtTenMillionTriangles) {
  const int across = support::long_form() ? 1600 : 160;
  const auto mesh = std::make_shared<const ContactMesh>(
      ContactMesh::build(support::torus(kRing, kTube, 2 * across, across)).value());
  // Distance of the triangles from the torus, and of the smooth surface above them.
  const double bulge = std::pow(std::numbers::pi * kTube / across, 2) / (2 * kTube) + 1e-6;
  const int ticks = support::long_form() ? 100'000 : 20'000;
  const auto search = make_search(*mesh);
  const std::array<double, 3> worst{
      worst_on_torus(MeshContact(mesh, search), ticks, kJump),
      worst_on_torus(InMemoryContact(PackedSurface::build(*mesh).value()), ticks, kJump),
      worst_on_torus(GodObjectContact(mesh, search), ticks, 0.002)};
  std::printf("  %d triangles: off by %.3g, %.3g and %.3g um, triangles from the torus by %.3g\n",
              mesh->triangle_count(), 1e6 * worst[0], 1e6 * worst[1], 1e6 * worst[2], 1e6 * bulge);
  for (std::size_t i = 0; i < worst.size(); ++i) {
    EXPECT_GE(worst[i], 0) << "contact is lost, way " << i;
    EXPECT_LT(worst[i], 8 * bulge) << "way " << i;
  }
}

}  // namespace
}  // namespace thimble::render

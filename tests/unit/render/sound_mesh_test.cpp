#include "mesh/repair/sound_mesh.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <utility>

#include "mesh/contact_mesh.h"
#include "support/shapes.h"
#include "thimble/render/build_object_touch.h"

// Large meshes are looked at on a thread of their own while contact is built as if they were sound:
// what is wrong with them must be told all the same, and by every way of contact alike.

namespace thimble::render {
namespace {

constexpr TrackerChoice kTrackers[] = {TrackerChoice::kPacked, TrackerChoice::kEdgePlanes,
                                       TrackerChoice::kGodObject, TrackerChoice::kOffset};

TriangleMesh ball() {
  return support::icosphere(4, 0.05);  // 5,120 triangles
}

TriangleMesh inside_out(TriangleMesh mesh) {
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

std::string refusal(const TriangleMesh& mesh, TrackerChoice tracker) {
  ContactChoice choice;
  choice.tracker = tracker;
  const auto touch = build_object_touch(mesh, choice, {});
  return touch ? "" : touch.error().message;
}

TEST(SoundMesh, TellsTheSameOfABrokenMeshWhicheverWayItIsTouched) {
  TriangleMesh hole = ball(), beyond = ball(), nowhere = ball(), doubled = ball(), empty;
  hole.triangles.erase(hole.triangles.begin() + 2000);
  beyond.triangles[3000][1] = 1 << 30;
  nowhere.vertices[100].x() = std::numeric_limits<double>::quiet_NaN();
  doubled.triangles.push_back(doubled.triangles[7]);
  for (const TriangleMesh* mesh : {&hole, &beyond, &nowhere, &doubled, &empty}) {
    ASSERT_FALSE(look_at_mesh(*mesh, true));
    const std::string told = look_at_mesh(*mesh, true).error().message;
    EXPECT_NE(told.find("The mesh "), std::string::npos) << told;
    for (const TrackerChoice tracker : kTrackers) {
      EXPECT_EQ(refusal(*mesh, tracker), told) << static_cast<int>(tracker);
    }
  }
}

TEST(SoundMesh, TurnsALargeMeshThatIsInsideOutForEveryWayOfContact) {
  const TriangleMesh wrong = inside_out(ball());
  ASSERT_TRUE(look_at_mesh(wrong, true));
  EXPECT_TRUE(look_at_mesh(wrong, true)->turned);
  EXPECT_FALSE(look_at_mesh(ball(), true)->turned);
  EXPECT_FALSE(look_at_mesh(wrong, false)) << "unless it may not be turned";
  const auto mesh = ContactMesh::build(wrong);
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->turned_components(), 1u);
  for (const TrackerChoice tracker : kTrackers) {
    ContactChoice choice;
    choice.tracker = tracker;
    auto right = build_object_touch(ball(), choice, {}).value();
    auto turned = build_object_touch(wrong, choice, {}).value();
    driver::DeviceState state;
    for (const double radius : {0.06, 0.0495, 0.049}) {
      state.p_WT = radius * Eigen::Vector3d(0.6, -0.64, 0.48);
      const auto a = right->update(state), b = turned->update(state);
      EXPECT_LT((a.f_T_W - b.f_T_W).norm(), 1e-9) << static_cast<int>(tracker);
      EXPECT_EQ(a.touch.in_contact, radius < 0.0498) << static_cast<int>(tracker);
      EXPECT_EQ(b.touch.in_contact, radius < 0.0498) << static_cast<int>(tracker);
    }
  }
}

}  // namespace
}  // namespace thimble::render

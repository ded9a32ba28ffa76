#include "field/primitive_contact.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>

#include "field/entry_face_contact.h"
#include "support/heap_guard.h"
#include "support/random.h"
#include "thimble/render/build_primitive_touch.h"
#include "thimble/render/field/box.h"
#include "thimble/render/field/half_space.h"
#include "thimble/render/field/sphere.h"
#include "thimble/render/object_touch.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Numbers of the faces.
constexpr std::int32_t kLeft = 0, kRight = 1, kFront = 2, kBack = 3, kBottom = 4, kTop = 5;

driver::DeviceState at(const Vector3d& p_WT, const Vector3d& v_WT = Vector3d::Zero()) {
  driver::DeviceState state;
  state.p_WT = p_WT;
  state.v_WT = v_WT;
  return state;
}

Eigen::Matrix3d random_rotation(support::Random& random) {
  return Eigen::AngleAxisd{random.uniform(-3, 3), random.direction()}.toRotationMatrix();
}

TEST(HalfSpace, PushesWithKxPlusBv) {
  support::Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const HalfSpace wall{.n_W = random.direction(), .p_WO = random.in_box(0.1)};
    ContactForceLaw touch{PrimitiveContact(wall), SpringDamper{1234.5, 6.7}};
    const Vector3d aside = wall.n_W.cross(random.direction());
    const double x = random.uniform(0, 0.01);
    const double v = random.uniform(-0.5, 0.5);
    touch(at(wall.p_WO + 0.02 * wall.n_W + aside));
    const auto command = touch(at(wall.p_WO - x * wall.n_W + aside, -v * wall.n_W + aside));
    const double wanted = std::max(1234.5 * x + 6.7 * v, 0.0);
    EXPECT_LT((command.f_T_W - wanted * wall.n_W).norm(), 1e-12);
    EXPECT_NEAR(command.touch.depth, x, 1e-15);
    EXPECT_LT((command.touch.p_WP - (wall.p_WO + aside)).norm(), 1e-15);
  }
}

TEST(Sphere, PushesAwayFromItsCentreByTheDepth) {
  support::Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const Sphere ball{.p_WO = random.in_box(0.1), .radius = random.uniform(0.01, 0.05)};
    ContactForceLaw touch{PrimitiveContact(ball), SpringDamper{1000, 0}};
    const Vector3d outward = random.direction();
    const double share = random.uniform(0.01, 0.999);
    touch(at(ball.p_WO + 2 * ball.radius * outward));
    const auto command = touch(at(ball.p_WO + share * ball.radius * outward));
    EXPECT_LT(command.f_T_W.cross(outward).norm(), 1e-12);
    EXPECT_NEAR(command.f_T_W.dot(outward), 1000 * ball.radius * (1 - share), 1e-12);
  }
}

TEST(Sphere, KeepsItsLastNormalAtTheVeryCentre) {
  PrimitiveContact contact(Sphere{.p_WO = {0, 0, 0}, .radius = 0.02});
  contact.update(at({0.03, 0, 0}));
  contact.update(at({1e-200, 0, 0}));
  EXPECT_EQ(contact.state().n_W, Vector3d(1, 0, 0));
  contact.update(at({0, 0, 0}));
  EXPECT_EQ(contact.state().n_W, Vector3d(1, 0, 0));
  EXPECT_EQ(contact.state().depth, 0.02);
}

template <class Contact>
void expect_nothing_for_bad_numbers(Contact contact, const Vector3d& outside,
                                    const Vector3d& inside) {
  ContactForceLaw touch(std::move(contact), SpringDamper{1000, 1});
  for (const double bad : {kNan, kInfinity, -kInfinity, 1e300}) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      touch(at(outside));
      EXPECT_TRUE(touch(at(inside)).touch.in_contact);
      Vector3d p = inside;
      p[axis] = bad;
      const auto command = touch(at(p));
      EXPECT_EQ(command.f_T_W, Vector3d::Zero());
      EXPECT_FALSE(command.touch.in_contact);
      // The next tick is a first one: inside, so there is no contact.
      EXPECT_FALSE(touch(at(inside)).touch.in_contact);
    }
  }
  touch(at(outside));
  EXPECT_EQ(touch(at(inside, {kNan, kNan, kNan})).f_T_W, Vector3d::Zero());
}

const Box kCube{.half_sides = {0.02, 0.02, 0.02}};
const Vector3d kAbove{0.001, 0.002, 0.03};
const Vector3d kInTop{0.001, 0.002, 0.019};

TEST(PrimitiveContact, GivesNoForceForNaNOrInfinity) {
  expect_nothing_for_bad_numbers(PrimitiveContact(HalfSpace{}), {0, 0, 0.01}, {0, 0, -0.01});
  expect_nothing_for_bad_numbers(PrimitiveContact(Sphere{.radius = 0.02}), kAbove, kInTop);
  expect_nothing_for_bad_numbers(PrimitiveContact(WedgeBox{kCube}), kAbove, kInTop);
  expect_nothing_for_bad_numbers(EntryFaceContact(kCube), kAbove, kInTop);
}

TEST(PrimitiveContact, DoesNotThrowOutATipThatBeginsInside) {
  ContactForceLaw sphere{PrimitiveContact(Sphere{.radius = 0.02}), SpringDamper{1000, 0}};
  ContactForceLaw wedges{PrimitiveContact(WedgeBox{kCube}), SpringDamper{1000, 0}};
  ContactForceLaw entry{EntryFaceContact(kCube), SpringDamper{1000, 0}};
  for (const double x : {0.005, 0.01, 0.0}) {
    EXPECT_FALSE(sphere(at({x, 0, 0})).touch.in_contact);
    EXPECT_FALSE(wedges(at({x, 0, 0})).touch.in_contact);
    EXPECT_FALSE(entry(at({x, 0, 0})).touch.in_contact);
  }
  for (const Vector3d& p : {kAbove, kInTop}) {
    EXPECT_EQ(sphere(at(p)).touch.in_contact, p == kInTop);
    EXPECT_EQ(wedges(at(p)).touch.in_contact, p == kInTop);
    EXPECT_EQ(entry(at(p)).touch.in_contact, p == kInTop);
  }
}

TEST(WedgeBox, PushesOutOfTheNearestFace) {
  struct Case {
    Vector3d p;
    std::int32_t face;
    double depth;
  };
  // A box of 20 x 30 x 40 mm, places computed by hand.
  const WedgeBox box{{.half_sides = {0.010, 0.015, 0.020}}};
  for (const Case& c :
       {Case{{-0.008, 0, 0}, kLeft, 0.002}, Case{{0.009, 0.013, 0}, kRight, 0.001},
        Case{{0.002, -0.011, 0.010}, kFront, 0.004}, Case{{0.002, 0.0145, 0.019}, kBack, 0.0005},
        Case{{0.001, 0.002, -0.016}, kBottom, 0.004}, Case{{0, 0, 0.0199}, kTop, 0.0001},
        Case{{0, 0, 0}, kRight, 0.010}}) {
    const PrimitivePlace place = box.place(c.p, Vector3d::Zero());
    EXPECT_EQ(place.face, c.face) << c.p.transpose();
    EXPECT_NEAR(place.depth, c.depth, 1e-16);
    EXPECT_EQ(place.n_W, box.normal(c.face));
  }
}

TEST(WedgeBox, KeepsTheForcesStrengthFromWedgeToWedge) {
  const WedgeBox box{kCube};
  // Near the edge between right and top: equally deep below both.
  const auto right = box.place({0.0181, 0, 0.0180}, Vector3d::Zero());
  const auto top = box.place({0.0180, 0, 0.0181}, Vector3d::Zero());
  EXPECT_EQ(right.face, kRight);
  EXPECT_EQ(top.face, kTop);
  EXPECT_EQ(right.depth, top.depth);
  // On the edge and at the corner, depth is exactly 0: no contact.
  EXPECT_EQ(box.place({0.02, 0, 0.02}, Vector3d::Zero()).depth, 0);
  EXPECT_EQ(box.place({0.02, 0.02, 0.02}, Vector3d::Zero()).depth, 0);
}

TEST(WedgeBox, PopsThroughAPlateAtStiffnessTimesHalfItsThickness) {
  // PHYSICS 3: a plate of 2 mm at 1 N/mm is pushed through at 1 N.
  const WedgeBox plate{{.half_sides = {0.05, 0.05, 0.001}}};
  ContactForceLaw touch{PrimitiveContact(plate), SpringDamper{1000, 0}};
  double largest = 0;
  bool popped = false;
  for (double z = 0.002; z > -0.002; z -= 1e-6) {
    const double push = touch(at({0, 0, z})).f_T_W.z();
    largest = std::max(largest, push);
    popped = popped || push < 0;
  }
  EXPECT_NEAR(largest, 1.0, 1.1e-3);
  EXPECT_TRUE(popped);
}

TEST(EntryFaceContact, HoldsTheTipBeforeAPlateAtAnyDepth) {
  const Box plate{.half_sides = {0.05, 0.05, 0.0001}};  // case 23 of PHYSICS 7: 0.2 mm
  support::Random random(3);
  for (const double side : {1.0, -1.0}) {
    ContactForceLaw touch{EntryFaceContact(plate), SpringDamper{1000, 0}};
    touch(at({0, 0, side * 0.001}));
    for (int i = 0; i < 10000; ++i) {
      // Up to 8.5 mm deep, with a tremor far larger than any hand's.
      const double z = side * (0.0001 - random.uniform(1e-6, 0.0085));
      const auto command = touch(at({random.uniform(-0.04, 0.04), random.uniform(-0.04, 0.04), z}));
      ASSERT_NEAR(command.f_T_W.z(), side * 1000 * (0.0001 - side * z), 1e-12);
    }
  }
}

TEST(EntryFaceContact, PushesOutOfTheEntryFace) {
  // The same place, reached by six paths (Fig. 2a: "it is not clear which is appropriate").
  const Vector3d place(0.004, -0.003, 0.005);
  for (std::int32_t face = 0; face < 6; ++face) {
    EntryFaceContact contact(kCube);
    Vector3d outside = place;
    outside[face / 2] = face % 2 == 0 ? -0.03 : 0.03;
    contact.update(at(outside));
    const ContactState& state = contact.update(at(place));
    ASSERT_TRUE(state.touching);
    EXPECT_EQ(state.triangle, face);
    EXPECT_EQ(state.n_W, kCube.normal(face));
    EXPECT_EQ(state.depth, 0.02 - (face % 2 == 0 ? -1 : 1) * place[face / 2]);
  }
}

struct Entry {
  Vector3d from, to;
  std::int32_t face;  // -1: no contact
};

TEST(EntryFaceContact, FastPathEntersTheRightFace) {
  for (const Entry& c : {
           Entry{{0.03, 0, 0.01}, {0.01, 0, 0.015}, kRight},   // slanted, through the right
           Entry{{0.021, 0, 0.03}, {0.01, 0, 0.015}, kTop},    // past x = 20 mm first, enters by z
           Entry{{0.03, 0, 0.021}, {0.015, 0, 0.01}, kRight},  // below z = 20 mm first
           Entry{{0.03, 0, 0.03},
                 {0.01, 0, 0.005},
                 kRight},                                 // below z = 20 mm first, then enters by x
           Entry{{0.03, 0, 0.04}, {0.01, 0, 0.0}, kTop},  // through the edge, steep
           Entry{{0.04, 0, 0.03}, {0.0, 0, 0.01}, kRight},         // through the edge, flat
           Entry{{0.03, 0.03, 0.03}, {0.01, 0.01, 0.01}, kRight},  // the corner: the first
           Entry{{0.03, 0.03, 0.04}, {0.01, 0.01, 0.0}, kTop},     // the corner, steep
           Entry{{0, 0, 0.05}, {0, 0, -0.05}, kTop},  // in and out within the tick: keeps contact
           Entry{{0, 0, 0.05}, {0.1, 0, -0.05}, -1},  // leaves by the side: free
           Entry{{0.03, 0, 0.021}, {0.01, 0, 0.021}, -1},     // over the top
           Entry{{0.03, 0, 0.02}, {0.01, 0, 0.02}, -1},       // along the top's plane
           Entry{{0.0, 0, 0.02}, {0.0, 0, 0.019}, kTop},      // begins on the top face itself
           Entry{{0.02, 0, 0.02}, {0.019, 0, 0.0185}, kTop},  // begins on the edge
           Entry{{0.05, 0, 0}, {0.03, 0, 0}, -1},             // ends before it
           Entry{{0.05, 0, 0}, {0.02, 0, 0}, -1},             // ends on the face: depth 0
           Entry{{0.05, 0, 0.0199999}, {0.0199999, 0, 0}, kRight},
       }) {
    EntryFaceContact contact(kCube);
    contact.update(at(c.from));
    const ContactState& state = contact.update(at(c.to));
    EXPECT_EQ(state.triangle, c.face) << c.from.transpose() << " to " << c.to.transpose();
    EXPECT_EQ(state.touching, c.face >= 0);
  }
}

TEST(EntryFaceContact, ReleasesWithoutAPull) {
  ContactForceLaw touch{EntryFaceContact(kCube), SpringDamper{1000, 0}};
  touch(at({0.018, 0, 0.03}));
  EXPECT_EQ(touch(at({0.018, 0, 0.01})).touch.feature, kTop);
  EXPECT_EQ(touch(at({0.0199, 0, 0.01})).touch.feature, kTop);
  const auto out = touch(at({0.0201, 0, 0.01}));  // out by the right face
  EXPECT_FALSE(out.touch.in_contact);
  EXPECT_EQ(out.f_T_W, Vector3d::Zero());
  EXPECT_EQ(touch(at({0.0199, 0, 0.01})).touch.feature, kRight);  // and enters it again
  EXPECT_FALSE(touch(at({0.021, 0, 0.01})).touch.in_contact);
  EXPECT_FALSE(touch(at({0.01, 0, 0.021})).touch.in_contact);
  EXPECT_TRUE(touch(at({0.01, 0, 0.0199})).touch.in_contact);
  EXPECT_FALSE(touch(at({0.01, 0, 0.02})).touch.in_contact);
}

TEST(EntryFaceContact, EveryPathInsideBeginsContact) {
  support::Random random(4);
  for (int i = 0; i < 20000; ++i) {
    const Box box{.R_WO = random_rotation(random),
                  .p_WO = random.in_box(0.1),
                  .half_sides = {random.uniform(1e-4, 0.05), random.uniform(1e-4, 0.05),
                                 random.uniform(1e-4, 0.05)}};
    const Vector3d to = box.p_WO + box.R_WO * (random.in_box(0.9).cwiseProduct(box.half_sides));
    Vector3d from = random.in_box(0.3);
    if (box.inside(from)) continue;
    EntryFaceContact contact(box);
    contact.update(at(from));
    const ContactState& state = contact.update(at(to));
    ASSERT_TRUE(state.touching);
    ASSERT_GT(state.n_W.dot(from - to), 0);  // the path moved towards the face
    // The face is the one whose plane the path crosses last.
    const Vector3d p_O = box.to_box(from), q_O = box.to_box(to);
    double latest = -1;
    for (Eigen::Index k = 0; k < 3; ++k) {
      if (std::abs(p_O[k]) < box.half_sides[k]) continue;
      latest = std::max(latest, (std::abs(p_O[k]) - box.half_sides[k]) / std::abs(q_O[k] - p_O[k]));
    }
    const Eigen::Index axis = state.triangle / 2;
    ASSERT_NEAR((std::abs(p_O[axis]) - box.half_sides[axis]) / std::abs(q_O[axis] - p_O[axis]),
                latest, 1e-12);
  }
}

// Returns the work of the hand along a straight path, J: halves the path until force and place
// change evenly, which holds inside a wedge.
template <class Shape>
double work_along(const Shape& shape, const Vector3d& from, const Vector3d& to, double& gross) {
  const auto force = [&](const Vector3d& p) -> Vector3d {
    const auto place = shape.place(p, Vector3d::Zero());
    return std::max(place.depth, 0.0) * place.n_W;
  };
  const auto a = shape.place(from, Vector3d::Zero()), b = shape.place(to, Vector3d::Zero());
  const bool even = a.n_W == b.n_W && a.depth > 0 && b.depth > 0;
  if (even || (to - from).norm() < 1e-14) {
    const double work = force((from + to) / 2).dot(to - from);
    gross += std::abs(work);
    return work;
  }
  const Vector3d middle = (from + to) / 2;
  return work_along(shape, from, middle, gross) + work_along(shape, middle, to, gross);
}

TEST(WedgeBox, DoesNoWorkAroundAClosedLoop) {
  support::Random random(5);
  const WedgeBox box{{.R_WO = random_rotation(random), .half_sides = {0.010, 0.015, 0.020}}};
  for (int loop = 0; loop < 20; ++loop) {
    std::vector<Vector3d> corners;
    for (int k = 0; k < 5; ++k) {
      corners.push_back(box.R_WO * random.in_box(0.95).cwiseProduct(box.half_sides));
    }
    double work = 0, gross = 0;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      work += work_along(box, corners[k], corners[(k + 1) % corners.size()], gross);
    }
    EXPECT_LT(std::abs(work), 1e-9 * gross) << loop;
  }
}

TEST(Sphere, DoesNoWorkAroundAClosedLoop) {
  // A smooth closed path inside: the sum over equal steps converges faster than any power.
  const Sphere ball{.p_WO = {0.001, 0.002, 0.003}, .radius = 0.05};
  constexpr int kSteps = 2000;
  double work = 0, gross = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double a = 2 * 3.14159265358979323846 * i / kSteps;
    const Vector3d p(0.02 * std::cos(a), 0.015 * std::sin(a) + 0.01, 0.01 * std::sin(2 * a));
    const Vector3d way(-0.02 * std::sin(a), 0.015 * std::cos(a), 0.02 * std::cos(2 * a));
    const auto place = ball.place(p, Vector3d::Zero());
    work += place.depth * place.n_W.dot(way);
    gross += std::abs(place.depth * place.n_W.dot(way));
  }
  EXPECT_LT(std::abs(work), 1e-9 * gross);
}

TEST(PrimitiveContact, GivesTheSameAnswersAtEveryScale) {
  support::Random random(6);
  // Powers of two, so that the scaling itself has no rounding.
  for (const double scale : {0x1p-20, 0x1p-3, 0x1p10}) {
    for (int i = 0; i < 300; ++i) {
      const Box box{.R_WO = random_rotation(random),
                    .p_WO = random.in_box(0.05),
                    .half_sides = {0.02, 0.01, 0.03}};
      const Box scaled{box.R_WO, scale * box.p_WO, scale * box.half_sides};
      const Sphere ball{.p_WO = box.p_WO, .radius = 0.025};
      EntryFaceContact entry(box), entry_scaled(scaled);
      PrimitiveContact wedges(WedgeBox{box}), wedges_scaled(WedgeBox{scaled});
      PrimitiveContact sphere(ball),
          sphere_scaled(Sphere{.p_WO = scale * ball.p_WO, .radius = scale * ball.radius});
      for (int tick = 0; tick < 20; ++tick) {
        const Vector3d p = random.in_box(0.08);
        const auto same = [&](const ContactState& one, const ContactState& other) {
          ASSERT_EQ(one.triangle, other.triangle);
          ASSERT_EQ(scale * one.depth, other.depth);
          ASSERT_EQ(one.n_W, other.n_W);
          ASSERT_EQ(scale * one.p_WP, other.p_WP);
        };
        same(entry.update(at(p)), entry_scaled.update(at(scale * p)));
        same(wedges.update(at(p)), wedges_scaled.update(at(scale * p)));
        same(sphere.update(at(p)), sphere_scaled.update(at(scale * p)));
      }
    }
  }
}

TEST(PrimitiveTouch, IsBuiltForEveryShapeWithoutAllocation) {
  const std::vector<Primitive> shapes{HalfSpace{.p_WO = {0, 0, 0.02}}, Sphere{.radius = 0.02},
                                      WedgeBox{kCube}, EntryFaceBox{kCube}};
  for (const Primitive& shape : shapes) {
    const auto touch =
        build_primitive_touch(shape, {.spring = {.stiffness = 500, .damping = 0}, .effects = {}});
    driver::ForceCommand command;
    EXPECT_EQ(support::heap_calls_of([&] {
                touch->update(at({0, 0, 0.03}));
                command = touch->update(at({0, 0, 0.018}));
              }),
              0);
    EXPECT_LT((command.f_T_W - Vector3d(0, 0, 1)).norm(), 1e-12);
    EXPECT_TRUE(touch->inside({0, 0, 0.018}));
    EXPECT_FALSE(touch->inside({0, 0, 0.021}));
    EXPECT_FALSE(touch->inside({0, 0, kNan}));
  }
}

}  // namespace
}  // namespace thimble::render

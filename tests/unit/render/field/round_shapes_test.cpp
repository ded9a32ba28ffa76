// Cylinder, cone, capsule and torus: distances, normals, derivatives and entries against
// independent calculations, and the law of their contact.
#include "thimble/render/field/round_shapes.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <typeinfo>
#include <utility>

#include "field/faced_contact.h"
#include "field/primitive_contact.h"
#include "field/round_entry.h"
#include "support/heap_guard.h"
#include "support/random.h"
#include "thimble/driver/device_state.h"

namespace thimble::render {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using support::Random;

constexpr double kPi = std::numbers::pi;

driver::DeviceState at(const Vector3d& p_WT) {
  driver::DeviceState state;
  state.p_WT = p_WT;
  return state;
}

RoundFrame random_frame(Random& random) {
  return {.R_WO = Eigen::AngleAxisd{random.uniform(-3, 3), random.direction()}.toRotationMatrix(),
          .p_WO = random.in_box(0.05)};
}
Cylinder random_cylinder(Random& random) {
  return {random_frame(random), random.uniform(0.004, 0.04), random.uniform(0.002, 0.04)};
}
Cone random_cone(Random& random) {
  return {random_frame(random), random.uniform(0.004, 0.04), random.uniform(0.002, 0.04)};
}
Capsule random_capsule(Random& random) {
  return {random_frame(random), random.uniform(0.004, 0.02), random.uniform(0.001, 0.04)};
}
Torus random_torus(Random& random) {
  const double radius = random.uniform(0.005, 0.04);
  return {random_frame(random), radius, random.uniform(0.1, 0.98) * radius};
}

/// Position of a point in the half-plane of a shape: distance from the axis and height.
Vector2d in_plane(const RoundFrame& frame, const Vector3d& p_W) {
  const Vector3d p_O = frame.R_WO.transpose() * (p_W - frame.p_WO);
  return {std::hypot(p_O.x(), p_O.y()), p_O.z()};
}

/// Returns the distance of a point from a curve s -> profile(s), 0 <= s <= 1: by samples, then by
/// golden sections.
double distance(const Vector2d& p, const std::function<Vector2d(double)>& profile) {
  constexpr int kSamples = 2000;
  const auto far = [&](double s) { return (profile(std::clamp(s, 0.0, 1.0)) - p).norm(); };
  int best = 0;
  for (int i = 1; i <= kSamples; ++i) {
    if (far(1.0 * i / kSamples) < far(1.0 * best / kSamples)) best = i;
  }
  double a = (best - 1.0) / kSamples, b = (best + 1.0) / kSamples;
  constexpr double kGolden = 0.6180339887498949;
  for (int i = 0; i < 60; ++i) {
    const double c = b - kGolden * (b - a), d = a + kGolden * (b - a);
    (far(c) < far(d) ? b : a) = far(c) < far(d) ? d : c;
  }
  return far((a + b) / 2);
}

// Each profile is half of the outline.
Vector2d profile_of(const Capsule& capsule, double s) {
  const double r = capsule.radius, h = capsule.half_height;
  const double arc = r * kPi / 2, all = 2 * arc + 2 * h;
  const double way = s * all;
  if (way < arc) return {r * std::sin(way / r), -h - r * std::cos(way / r)};
  if (way < arc + 2 * h) return {r, way - arc - h};
  return {r * std::cos((way - arc - 2 * h) / r), h + r * std::sin((way - arc - 2 * h) / r)};
}
Vector2d profile_of(const Torus& torus, double s) {
  return {torus.radius + torus.tube * std::cos(2 * kPi * s), torus.tube * std::sin(2 * kPi * s)};
}
Vector2d profile_of(const Cylinder& cylinder, std::int32_t face, double s) {
  const double r = cylinder.radius, h = cylinder.half_height;
  if (face == Cylinder::kSide) return {r, (2 * s - 1) * h};
  return {s * r, face == 0 ? -h : h};
}
Vector2d profile_of(const Cone& cone, std::int32_t face, double s) {
  if (face == Cone::kSide) return {(1 - s) * cone.radius, (2 * s - 1) * cone.half_height};
  return {s * cone.radius, -cone.half_height};
}

bool inside_of(const Cylinder& cylinder, const Vector2d& p) {
  return p.x() < cylinder.radius && std::abs(p.y()) < cylinder.half_height;
}
bool inside_of(const Cone& cone, const Vector2d& p) {
  const double h = cone.half_height;
  return p.y() > -h && p.x() < cone.radius * (h - p.y()) / (2 * h);
}
bool inside_of(const Capsule& capsule, const Vector2d& p) {
  const double h = capsule.half_height, r = capsule.radius;
  return (std::abs(p.y()) < h && p.x() < r) || (p - Vector2d(0, h)).norm() < r ||
         (p - Vector2d(0, -h)).norm() < r;
}
bool inside_of(const Torus& torus, const Vector2d& p) {
  return (p - Vector2d(torus.radius, 0)).norm() < torus.tube;
}

template <class Shape>
void expect_inside(const Shape& shape, Random& random) {
  for (int i = 0; i < 100; ++i) {
    const Vector3d p = shape.p_WO + random.in_box(0.05);
    EXPECT_EQ(shape.inside(p), inside_of(shape, in_plane(shape, p)));
  }
  EXPECT_FALSE(shape.inside(Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())));
}

TEST(RoundShapes, KnowTheirInside) {
  Random random(300);
  for (int i = 0; i < 300; ++i) {
    expect_inside(random_cylinder(random), random);
    expect_inside(random_cone(random), random);
    expect_inside(random_capsule(random), random);
    expect_inside(random_torus(random), random);
  }
}

/// Compares depth and normal of a point with the distance from a profile and with differences.
template <class Place>
void expect_place(const RoundFrame& frame, const Vector3d& p_W, const Place& place,
                  const std::function<Vector2d(double)>& profile) {
  const PrimitivePlace found = place(p_W);
  if (!(found.depth > 1e-4)) return;
  const Vector2d p = in_plane(frame, p_W);
  EXPECT_NEAR(found.depth, distance(p, profile), 1e-9);
  EXPECT_NEAR(found.n_W.norm(), 1, 1e-12);
  constexpr double kStep = 1e-8;
  Vector3d gradient;
  for (int k = 0; k < 3; ++k) {
    const Vector3d step = kStep * Vector3d::Unit(k);
    gradient[k] = (place(p_W + step).depth - place(p_W - step).depth) / (2 * kStep);
  }
  EXPECT_LT((gradient + found.n_W).norm(), 1e-6);
}

TEST(RoundShapes, DepthAndNormalAreThoseOfTheClosestPoint) {
  Random random(200);
  for (int i = 0; i < 200; ++i) {
    const Capsule capsule = random_capsule(random);
    const Torus torus = random_torus(random);
    const auto check = [&](const auto& shape) {
      Vector3d p;
      do {
        p = shape.p_WO + random.in_box(0.05);
        // Not where the closest point is not unique.
      } while (!shape.inside(p) || !(shape.place(p, p).depth < 0.9 * std::min(shape.radius, 1.0)) ||
               in_plane(shape, p).x() < 1e-4);
      const auto place = [&](const Vector3d& q) { return shape.place(q, Vector3d::Zero()); };
      expect_place(shape, p, place, [&](double s) { return profile_of(shape, s); });
    };
    check(capsule);
    check(torus);
    const auto check_faces = [&](const auto& shape, std::int32_t faces) {
      for (int k = 0; k < 20; ++k) {
        const Vector3d p = shape.p_WO + random.in_box(0.05);
        if (in_plane(shape, p).x() < 1e-4) continue;
        for (std::int32_t face = 0; face < faces; ++face) {
          const auto place = [&](const Vector3d& q) {
            return shape.on_face(q, face, Vector3d::Zero());
          };
          // Not within a step of a rim.
          bool holds = true;
          for (int axis = 0; axis < 3; ++axis) {
            for (const double step : {-1e-6, 1e-6}) {
              holds = holds && place(p + step * Vector3d::Unit(axis)).depth > 0;
            }
          }
          if (!holds) continue;
          expect_place(shape, p, place, [&](double s) { return profile_of(shape, face, s); });
        }
      }
    };
    check_faces(random_cylinder(random), 3);
    check_faces(random_cone(random), 2);
  }
}

TEST(RoundShapes, OnTheAxisTheNormalFollowsTheLastOne) {
  Random random(50);
  for (int i = 0; i < 50; ++i) {
    const Capsule capsule = random_capsule(random);
    const Vector3d axis = capsule.R_WO.col(2);
    const Vector3d before = capsule.R_WO * Vector3d(0.6, 0.8, 0);
    const PrimitivePlace place = capsule.place(capsule.p_WO, before);
    EXPECT_NEAR(place.depth, capsule.radius, 1e-15);
    EXPECT_LT((place.n_W - before).norm(), 1e-12);
    EXPECT_NEAR(capsule.place(capsule.p_WO, Vector3d::Zero()).n_W.norm(), 1, 1e-12);
    const Vector3d end = capsule.p_WO + (capsule.half_height + capsule.radius / 2) * axis;
    EXPECT_LT((capsule.place(end, before).n_W - axis).norm(), 1e-12);
    const Torus torus = random_torus(random);
    const Vector3d on_circle = torus.p_WO + torus.radius * torus.R_WO.col(0);
    EXPECT_NEAR(torus.place(on_circle, torus.R_WO.col(2)).depth, torus.tube, 1e-15);
    EXPECT_LT(torus.place(torus.p_WO, Vector3d::Zero()).depth, 0);
  }
}

/// Compares the entry of a path with samples of `inside`.
template <class Shape>
void expect_entry(const Shape& shape, const Vector3d& from, const Vector3d& to, int samples) {
  const SolidEntry entry = shape_solid::first_entry(shape, from, to);
  if (shape.inside(from)) {
    EXPECT_EQ(entry.triangle, -1);
    return;
  }
  double first = -1;
  for (int i = 0; i <= samples && first < 0; ++i) {
    if (shape.inside(from + 1.0 * i / samples * (to - from))) first = 1.0 * i / samples;
  }
  if (entry.triangle < 0) {
    EXPECT_LT(first, 0) << typeid(shape).name() << " is missed at " << first;
    return;
  }
  ASSERT_GE(entry.parameter, 0);
  ASSERT_LE(entry.parameter, 1);
  if (first < 0) {
    // A path that only grazes the shape between two samples.
    bool grazes = false;
    for (int i = -2000; i <= 2000 && !grazes; ++i) {
      const double t = std::clamp(entry.parameter + 1e-3 * i / samples, 0.0, 1.0);
      grazes = shape.inside(from + t * (to - from));
    }
    EXPECT_TRUE(grazes) << typeid(shape).name() << " is not where the path enters it, at "
                        << entry.parameter;
  } else {
    EXPECT_LE(entry.parameter, first + 1e-12);
    // An earlier entry lies between two samples, as deep as a grazing path is.
    const Vector3d before = from + std::max(0.0, entry.parameter - 1e-9) * (to - from);
    const Vector3d behind = from + std::min(1.0, entry.parameter + 1e-9) * (to - from);
    EXPECT_TRUE(!shape.inside(before) || entry.parameter < 1e-8) << typeid(shape).name();
    EXPECT_TRUE(shape.inside(behind) || entry.parameter > first - 1e-8);
  }
}

template <class Shape>
void expect_entries(const Shape& shape, Random& random, int samples) {
  for (int i = 0; i < 20; ++i) {
    const double near = i % 2 == 0 ? 0.06 : 0.02;
    const Vector3d from = shape.p_WO + random.in_box(0.06);
    expect_entry(shape, from, from + random.in_box(near), samples);
    // Along the axes of the shape, through its axis, and from its surface.
    const Vector3d axis = shape.R_WO.col(2), x = shape.R_WO.col(0);
    expect_entry(shape, shape.p_WO + 0.2 * axis + random.uniform(0, 0.04) * x,
                 shape.p_WO - 0.2 * axis + random.uniform(0, 0.04) * x, samples);
    expect_entry(shape, shape.p_WO + 0.2 * axis, shape.p_WO - 0.2 * axis, samples);
    const double height = random.uniform(-0.04, 0.04);
    expect_entry(shape, shape.p_WO + height * axis + 0.2 * x, shape.p_WO + height * axis - 0.2 * x,
                 samples);
  }
}

TEST(RoundShapes, EntriesAreThoseOfADenselySampledPath) {
  Random random(60);
  for (int i = 0; i < 60; ++i) {
    expect_entries(random_cylinder(random), random, 1000);
    expect_entries(random_cone(random), random, 1000);
    expect_entries(random_capsule(random), random, 1000);
    expect_entries(random_torus(random), random, 1000);
  }
}

/// Paths of about a rounding to about the size that end inside.
template <class Shape>
int missed(const Shape& shape, Random& random, int paths) {
  int missed = 0;
  for (int i = 0; i < paths; ++i) {
    Vector3d to = shape.p_WO + random.in_box(0.05), from = shape.p_WO + random.in_box(0.08);
    if (!shape.inside(to) || shape.inside(from)) continue;
    // Halves the path until its begin is just outside.
    const int halvings = static_cast<int>(random.uniform(0, 60));
    for (int k = 0; k < halvings; ++k) {
      const Vector3d middle = (from + to) / 2;
      (shape.inside(middle) ? to : from) = middle;
    }
    const SolidEntry entry = shape_solid::first_entry(shape, from, to);
    if (entry.triangle < 0 || !(entry.parameter >= 0 && entry.parameter <= 1)) ++missed;
  }
  return missed;
}

TEST(RoundShapes, APathThatEndsInsideAlwaysEnters) {
  Random random(100);
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(missed(random_cylinder(random), random, 300), 0);
    EXPECT_EQ(missed(random_cone(random), random, 300), 0);
    EXPECT_EQ(missed(random_capsule(random), random, 300), 0);
    EXPECT_EQ(missed(random_torus(random), random, 300), 0);
  }
}

TEST(RoundShapes, APathAcrossATorusEntersTheNearerSideOfItsRing) {
  const Torus torus{{}, 0.03, 0.01};
  const SolidEntry outer = shape_solid::first_entry(torus, {0.1, 0, 0}, {-0.1, 0, 0});
  EXPECT_EQ(outer.triangle, 0);
  EXPECT_NEAR(outer.parameter, 0.3, 1e-12);
  const SolidEntry inner = shape_solid::first_entry(torus, {0, 0, 0}, {-0.1, 0, 0});
  EXPECT_NEAR(inner.parameter, 0.2, 1e-12);
  EXPECT_EQ(shape_solid::first_entry(torus, {0, 0, 0.1}, {0, 0, -0.1}).triangle, -1);
  EXPECT_EQ(shape_solid::first_entry(torus, {0.03, 0, 0.1}, {0.03, 0, 0.02}).triangle, -1);
}

/// Compares the derivative of the surface point with differences of the proxy.
template <class Contact>
void expect_derivative(const Contact& contact, const Vector3d& p_W) {
  const ClosestSurfacePoint closest = contact.closest(p_W);
  constexpr double kStep = 1e-7;
  Matrix3d J;
  for (int k = 0; k < 3; ++k) {
    Contact ahead = contact, behind = contact;
    const Vector3d step = kStep * Vector3d::Unit(k);
    J.col(k) =
        (ahead.update(at(p_W + step)).p_WP - behind.update(at(p_W - step)).p_WP) / (2 * kStep);
  }
  EXPECT_LT((J - closest.J_MT).norm(), 1e-5 * std::max(1.0, J.norm())) << J << "\n\n"
                                                                       << closest.J_MT;
  EXPECT_LT((closest.fall_W - contact.state().n_W).norm(), 1e-15);
}

template <class Contact, class Shape>
int derivatives(const Shape& shape, Random& random) {
  int found = 0;
  for (int i = 0; i < 50; ++i) {
    Contact contact(shape);
    contact.update(at(shape.p_WO + 0.2 * random.direction()));
    const Vector3d p = shape.p_WO + random.in_box(0.04);
    const ContactState state = contact.update(at(p));
    if (!state.touching || !(state.depth > 1e-5) || in_plane(shape, p).x() < 3e-3) continue;
    if constexpr (requires { shape.tube; }) {
      if (shape.tube - state.depth < 1e-3) continue;
    }
    bool holds = true;  // not within a step of a rim
    for (int k = 0; k < 6; ++k) {
      Contact other = contact;
      const Vector3d step = (k % 2 == 0 ? 1e-6 : -1e-6) * Vector3d::Unit(k / 2);
      holds = holds && other.update(at(p + step)).touching;
    }
    if (!holds) continue;
    expect_derivative(contact, p);
    ++found;
  }
  return found;
}

TEST(RoundShapes, TheDerivativeOfTheSurfacePointIsThatOfTheProxy) {
  Random random(100);
  int found = 0;
  for (int i = 0; i < 100; ++i) {
    found += derivatives<FacedContact<Cylinder>>(random_cylinder(random), random);
    found += derivatives<FacedContact<Cone>>(random_cone(random), random);
    found += derivatives<PrimitiveContact<Capsule>>(random_capsule(random), random);
    found += derivatives<PrimitiveContact<Torus>>(random_torus(random), random);
  }
  EXPECT_GT(found, 2000);
}

TEST(FacedContact, HoldsBeyondTheBackOfAFaceAndReleasesSideways) {
  const Cylinder disc{{}, 0.03, 0.001};
  FacedContact contact(disc);
  contact.update(at({0.01, 0, 0.01}));
  const ContactState& state = contact.update(at({0.01, 0, -0.02}));
  EXPECT_TRUE(state.touching);
  EXPECT_EQ(state.triangle, 1);
  EXPECT_NEAR(state.depth, 0.021, 1e-15);
  EXPECT_EQ(state.n_W, Vector3d(0, 0, 1));
  EXPECT_FALSE(contact.update(at({0.031, 0, -0.02})).touching);
  EXPECT_FALSE(contact.update(at({0.01, 0, -0.02})).touching);
  EXPECT_EQ(contact.update(at({0.01, 0, 0})).triangle, 0);

  FacedContact side(Cylinder{{}, 0.03, 0.02});
  side.update(at({0.04, 0, 0}));
  EXPECT_EQ(side.update(at({0.02, 0, 0.01})).triangle, Cylinder::kSide);
  EXPECT_NEAR(side.state().depth, 0.01, 1e-15);
  EXPECT_LT((side.update(at({0, 0.02, 0.01})).n_W - Vector3d(0, 1, 0)).norm(), 1e-15);
  EXPECT_FALSE(side.update(at({0, 0.02, 0.021})).touching);

  FacedContact cone(Cone{{}, 0.03, 0.02});
  cone.update(at({0.04, 0, 0}));
  EXPECT_EQ(cone.update(at({0.01, 0, -0.01})).triangle, Cone::kSide);
  EXPECT_FALSE(cone.update(at({0, 0, 0.021})).touching);
  EXPECT_EQ(cone.update(at({0, 0, 0.01})).triangle, Cone::kSide);
}

TEST(FacedContact, ATipInsideOnTheFirstTickIsNotThrownOut) {
  FacedContact contact(Cone{{}, 0.03, 0.02});
  EXPECT_FALSE(contact.update(at({0, 0, -0.01})).touching);
  EXPECT_FALSE(contact.update(at({0.001, 0, -0.01})).touching);
  EXPECT_FALSE(contact.update(at({0, 0, -0.03})).touching);
  EXPECT_EQ(contact.update(at({0, 0, -0.01})).triangle, 0);
  EXPECT_FALSE(contact.update(at(Vector3d::Constant(std::nan("")))).touching);
  EXPECT_FALSE(contact.update(at({0, 0, -0.01})).touching);
}

/// Work of a spring of 1 N/m over a smooth closed loop in contact, by the energy that goes in.
template <class Contact>
double share_of_work(Contact contact, const Vector3d& centre, const Vector3d& a, const Vector3d& b,
                     int& in_contact) {
  constexpr int kSteps = 4000;
  double work = 0, in = 0;
  const auto place = [&](int i) {
    const double s = 2 * kPi * i / kSteps;
    return Vector3d(centre + std::cos(s) * a + std::sin(s) * b);
  };
  const ContactState first = contact.update(at(place(0)));
  Vector3d f = first.depth * first.n_W;
  const std::int32_t face = first.triangle;
  for (int i = 1; i <= kSteps; ++i) {
    const ContactState& state = contact.update(at(place(i)));
    if (!state.touching || state.triangle != face) return 0;
    const Vector3d next = state.depth * state.n_W;
    const double done = (f + next).dot(place(i) - place(i - 1)) / 2;
    work += done;
    in += std::max(done, 0.0);
    f = next;
  }
  ++in_contact;
  return in > 0 ? std::abs(work) / in : 0;
}

template <class Contact, class Shape>
void expect_no_work(const Shape& shape, Random& random, int& loops) {
  for (int i = 0; i < 10; ++i) {
    Contact contact(shape);
    contact.update(at(shape.p_WO + 0.2 * random.direction()));
    const Vector3d centre = shape.p_WO + random.in_box(0.02);
    const ContactState state = contact.update(at(centre));
    // Away from the axis, where the closest point jumps.
    double room = std::min(state.depth, in_plane(shape, centre).x());
    if constexpr (requires { shape.tube; }) room = std::min(room, shape.tube - state.depth);
    if (!state.touching || !(room > 1e-3)) continue;
    const Vector3d a = 0.3 * room * random.direction(), b = 0.3 * room * random.direction();
    contact.update(at(centre + a));
    EXPECT_LT(share_of_work(contact, centre, a, b, loops), 1e-6);
  }
}

TEST(RoundShapes, ClosedLoopsDoNoWork) {
  Random random(60);
  int loops = 0;
  for (int i = 0; i < 60; ++i) {
    expect_no_work<FacedContact<Cylinder>>(random_cylinder(random), random, loops);
    expect_no_work<FacedContact<Cone>>(random_cone(random), random, loops);
    expect_no_work<PrimitiveContact<Capsule>>(random_capsule(random), random, loops);
    expect_no_work<PrimitiveContact<Torus>>(random_torus(random), random, loops);
  }
  EXPECT_GT(loops, 200);
}

TEST(RoundShapes, TicksAllocateNothing) {
  Random random(1);
  const auto count = [&](auto contact) {
    return support::heap_calls_of([&] {
      for (int i = 0; i < 1000; ++i) contact.update(at(random.in_box(0.05)));
    });
  };
  EXPECT_EQ(count(FacedContact(random_cylinder(random))), 0);
  EXPECT_EQ(count(FacedContact(random_cone(random))), 0);
  EXPECT_EQ(count(PrimitiveContact(random_capsule(random))), 0);
  EXPECT_EQ(count(PrimitiveContact(random_torus(random))), 0);
}

}  // namespace
}  // namespace thimble::render

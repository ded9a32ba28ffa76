#include "view/touch_marks.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "view/compare/run_colours.h"

namespace thimble::view {
namespace {

constexpr double kThinnest = 0.05;  // N: a hand cannot feel less within the arm's own friction
constexpr double kAlongMin = 0.02;  // N RMS: less is not felt [PHYSICS 6]

using Point = Eigen::Vector3d;

Point point(const std::array<double, 3>& p) {
  return {p[0], p[1], p[2]};
}

/// One arm of a moment.
struct OneArm {
  const driver::TickRecord& tick;
  const std::vector<DrawnRod>& rods;
  bool bent;              ///< The touched object is dented, so that the tip is on its surface.
  double tip_radius = 0;  ///< Of a tip that is a ball, m; 0: a point.
  /// Draws the force through objects: several arms hold objects from all sides.
  bool force_shines = false;
  ArmLook look{};

  Colour arm_colour() const {
    return look.colour ? blended(kArmColour, *look.colour, kArmTint) : kArmColour;
  }
  Colour joint_colour() const {
    return look.colour ? blended(kJointColour, *look.colour, kArmTint) : kJointColour;
  }
  Colour proxy_colour() const { return look.ended ? ended_colour(kProxyColour) : kProxyColour; }
  Colour tip_colour() const { return look.colour.value_or(kTipColour); }
  Colour force_colour() const { return look.colour.value_or(kForceColour); }
  static constexpr float kArmTint = 0.55F;  ///< Share of its colour in an arm. [chosen]
};

void add_arm(const OneArm& moment, TouchMarks& marks) {
  // Typical radius of an arm's tubes, m. The last piece ends in a thin stem, like the rod of a
  // thimble, so that it hides little of the object.
  constexpr double kTube = 0.0026;
  constexpr double kJoint = 0.0042;
  constexpr double kStem = 0.0009;
  constexpr double kStemLength = 0.022;
  const Point tip = point(moment.tick.p_WT);
  for (const auto& [from, to] : moment.rods) {
    const double length = (to - from).norm();
    if ((to - tip).norm() < 1e-6 && length > 2 * kStemLength) {
      const Point along = (to - from) / length;
      const Point neck = to - kStemLength * along;
      const Point shoulder = neck - 0.6 * kStemLength * along;
      marks.solids.push_back(rod(from, shoulder, kTube, moment.arm_colour()));
      marks.solids.push_back(
          cone(shoulder, neck + 0.32 * kStemLength * along, kTube, moment.arm_colour()));
      marks.solids.push_back(rod(shoulder, to, kStem, moment.arm_colour()));
    } else {
      marks.solids.push_back(rod(from, to, kTube, moment.arm_colour()));
    }
    marks.solids.push_back(ball(from, kJoint, moment.joint_colour()));
  }
}

// Adds the stylus of a gimbal: a pen along its x from the tip, with a button on its z side that
// makes a roll visible.
void add_stylus(const OneArm& moment, TouchMarks& marks) {
  constexpr double kPoint = 0.012, kLength = 0.11, kWidth = 0.0045, kButton = 0.0022;  // m
  const Point tip = point(moment.tick.p_WT);
  if (moment.tick.q_WT == driver::TipQuaternion{} || !tip.allFinite()) return;
  const Eigen::Matrix3d R_WT = driver::rotation_of(moment.tick.q_WT);
  const Point along = R_WT.col(0);
  const Point grip = tip + kPoint * along;
  marks.solids.push_back(cone(grip, tip, kWidth, moment.joint_colour()));
  marks.solids.push_back(rod(grip, tip + kLength * along, kWidth, moment.arm_colour()));
  marks.solids.push_back(
      ball(tip + 3 * kPoint * along + kWidth * R_WT.col(2), kButton, moment.tip_colour()));
}

/// Returns where the tip is drawn: at the proxy on a stiff surface; on a dented one, where it is.
Point drawn_tip(const OneArm& moment) {
  return point(moment.tick.in_contact && !moment.bent ? moment.tick.p_WP : moment.tick.p_WT);
}

/// Returns the visible point of contact: where the tip is drawn, or, of a ball, the point of it
/// that touches.
Point touched_point(const OneArm& moment) {
  if (!moment.tick.in_contact || moment.bent) return drawn_tip(moment);
  return drawn_tip(moment) - moment.tip_radius * point(moment.tick.n_W);
}

void add_force(const DrawnScene& scene, const OneArm& moment, double thick, TouchMarks& marks) {
  const Point force = point(moment.tick.f_sent_W);
  const double size = force.norm();
  if (!(size > kThinnest)) return;  // NaN: no arrow
  const Point along = force / size;
  // At the top of a ball, which would hide it.
  const Point from = drawn_tip(moment) + moment.tip_radius * along;
  if (!from.allFinite()) return;
  const double length = std::max(arrow_length(size, scene), 6 * thick);
  const Point neck = from + std::max(length - 5 * thick, 0.4 * length) * along;
  const Point tip = from + length * along;
  for (Solid part : {rod(from, neck, thick, moment.force_colour()),
                     cone(neck, tip, 2.4 * thick, moment.force_colour())}) {
    part.shines_through = moment.force_shines;
    marks.solids.push_back(part);
  }
  marks.labels.push_back({tip, along, fmt::format("{:.2f} N", size), moment.force_colour()});
}

// Adds the normal as a thin arrow of fixed length, and the tangential force (friction, textures) at
// the scale of the force.
void add_contact(const DrawnScene& scene, const OneArm& moment, double thick, TouchMarks& marks) {
  const Point n = point(moment.tick.n_W);
  const Point from = touched_point(moment);
  if (!moment.tick.in_contact || !from.allFinite() || !(std::abs(n.norm() - 1) < 1e-3)) return;
  const auto arrow = [&](const Point& to, double radius, const Colour& colour) {
    const Point neck =
        to - std::min(5 * radius, 0.6 * (to - from).norm()) * (to - from).normalized();
    marks.solids.push_back(rod(from, neck, radius, colour));
    marks.solids.push_back(cone(neck, to, 2.4 * radius, colour));
  };
  arrow(from + 0.2 * size_of(scene) * n, 0.5 * thick, kNormalColour);
  const Point force = point(moment.tick.f_sent_W);
  const Point along = force - force.dot(n) * n;
  const double size = along.norm();
  if (!(size > kAlongMin)) return;  // NaN: no arrow
  const Point tip = from + std::max(arrow_length(size, scene), 6 * thick) / size * along;
  arrow(tip, 0.8 * thick, kFrictionColour);
  marks.labels.push_back({tip, along / size, fmt::format("{:.2f} N", size), kFrictionColour});
}

void add_tip(const OneArm& moment, double thick, TouchMarks& marks) {
  const Point p_WT = point(moment.tick.p_WT);
  if (!p_WT.allFinite()) return;
  const Point centre = drawn_tip(moment);
  if (moment.tip_radius > 0 && centre.allFinite()) {
    marks.solids.push_back(ball(centre, moment.tip_radius, moment.joint_colour()));
  }
  Solid tip = ball(p_WT, 1.8 * thick, moment.tip_colour());
  tip.shines_through = true;
  marks.solids.push_back(tip);
  const Point p_WP = touched_point(moment);
  if (!moment.tick.in_contact || !p_WP.allFinite()) return;
  marks.solids.push_back(ball(p_WP, 1.7 * thick, moment.proxy_colour()));
  if ((centre - p_WT).norm() < 1e-6) return;
  Solid link = rod(p_WT, centre, 0.5 * thick, moment.tip_colour());
  link.shines_through = true;
  marks.solids.push_back(link);
}

/// Returns the triangle on the other side of an edge; -1 if there is none.
std::ptrdiff_t neighbour_of(const render::TriangleMesh& mesh, std::size_t triangle, std::size_t k) {
  const auto& c = mesh.triangles[triangle];
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (mesh.triangles[t][j] == c[(k + 1) % 3] && mesh.triangles[t][(j + 1) % 3] == c[k]) {
        return static_cast<std::ptrdiff_t>(t);
      }
    }
  }
  return -1;
}

// Adds the active triangle and, through each of its edges, the plane half way between its own side
// and its neighbour's, to a depth of the triangle's width.
void add_edge_planes(const DrawnScene& scene, const DrawnMoment& moment, TouchMarks& marks) {
  const auto object = static_cast<std::size_t>(moment.tick.object);
  const auto triangle = static_cast<std::size_t>(moment.tick.feature);
  if (!moment.tick.in_contact || moment.tick.object < 0 || moment.tick.feature < 0 ||
      object >= scene.objects.size() || scene.objects[object].is_placeholder) {
    return;
  }
  const bool shaped = object < moment.shapes.size() && moment.shapes[object] != nullptr;
  const render::TriangleMesh& mesh = shaped ? *moment.shapes[object] : scene.objects[object].mesh;
  if (triangle >= mesh.triangles.size()) return;
  const render::BodyPose pose =
      object < moment.poses.size() ? moment.poses[object] : render::BodyPose{};
  const auto corner = [&](std::size_t t, std::size_t k) {
    return placed(pose, mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][k % 3])]);
  };
  const auto normal = [&](std::size_t t) -> Point {
    return (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0)).stableNormalized();
  };
  const Point n = normal(triangle);
  const double reach = 0.45 * std::sqrt((corner(triangle, 1) - corner(triangle, 0)).norm() *
                                        (corner(triangle, 2) - corner(triangle, 0)).norm());
  const Point lift = 1e-3 * reach * n;
  marks.panes.push_back({{corner(triangle, 0) + lift, corner(triangle, 1) + lift,
                          corner(triangle, 2) + lift, corner(triangle, 2) + lift},
                         kTriangleColour});
  for (std::size_t k = 0; k < 3; ++k) {
    const std::ptrdiff_t other = neighbour_of(mesh, triangle, k);
    const Point half =
        (other < 0 ? n : Point(n + normal(static_cast<std::size_t>(other)))).stableNormalized();
    const Point a = corner(triangle, k);
    const Point b = corner(triangle, k + 1);
    marks.panes.push_back({{a + reach * half, b + reach * half, b - reach * half, a - reach * half},
                           kEdgePlaneColour});
  }
}

}  // namespace

double size_of(const DrawnScene& scene) {
  Eigen::AlignedBox3d box;
  for (const DrawnObject& object : scene.objects) {
    if (object.endless) continue;
    for (const Point& vertex : object.mesh.vertices) box.extend(vertex);
  }
  constexpr double kMin = 0.06;  // m: typical motion of a hand
  constexpr double kMax = 0.3;
  return box.isEmpty() ? kMin : std::clamp(box.diagonal().norm(), kMin, kMax);
}

double arrow_length(double force, const DrawnScene& scene) {
  return 0.5 * size_of(scene) * force / scene.force_limit;
}

TouchMarks mark_touch(const DrawnScene& scene, const DrawnMoment& moment, double eye_distance,
                      const MarkChoice& choice) {
  const double thick = 0.0032 * eye_distance;
  TouchMarks marks;
  const auto add = [&](const OneArm& arm, const std::string& name) {
    if (choice.arm) add_arm(arm, marks);
    if (choice.arm) add_stylus(arm, marks);
    if (choice.force && !arm.look.ended) add_force(scene, arm, thick, marks);
    if (choice.contact && !arm.look.ended) add_contact(scene, arm, thick, marks);
    if (choice.tip) add_tip(arm, thick, marks);
    const Point tip = point(arm.tick.p_WT);
    if (choice.tip && !name.empty() && tip.allFinite()) {
      const Point up(0, 0, 1);
      marks.labels.push_back({tip + 6 * thick * up, up, name, arm.tip_colour()});
    }
  };
  const bool bent = moment.patch.triangle_count > 0 && moment.patch.object == moment.tick.object;
  const bool several = !moment.others.empty();
  add({moment.tick, moment.arm, bent, scene.tip_radius, several, moment.look}, scene.arm_in_scene);
  for (const DrawnArm& other : moment.others) {
    add({other.tick, other.rods, false, scene.tip_radius, several, other.look}, other.name);
  }
  if (choice.edge_planes) add_edge_planes(scene, moment, marks);
  return marks;
}

}  // namespace thimble::view

#include "report/html/page_scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "report/html/light_mesh.h"
#include "report/html/page_rows.h"
#include "share/arm_lines.h"
#include "surface/map/triangle_grid.h"

namespace thimble::report {
namespace {

using Json = nlohmann::ordered_json;
using session::SharedScene;

constexpr std::size_t kArmPicturesMax = 5000;  // of its bars; chosen

const char* name_of(session::SharedKind kind) {
  switch (kind) {
    case session::SharedKind::kMesh:
      return "mesh";
    case session::SharedKind::kShape:
      return "shape";
    case session::SharedKind::kField:
      return "field";
    case session::SharedKind::kPaged:
      return "paged";
  }
  return "mesh";
}

}  // namespace

render::TriangleMesh mesh_of(const SharedScene& scene, const SharedScene::Object& object) {
  render::TriangleMesh mesh;
  const auto vertices = std::span(scene.vertices).subspan(object.first_vertex, object.vertex_count);
  mesh.vertices.assign(vertices.begin(), vertices.end());
  const auto first = static_cast<std::uint32_t>(object.first_vertex);
  for (const auto& [a, b, c] :
       std::span(scene.triangles).subspan(object.first_triangle, object.triangle_count)) {
    mesh.triangles.push_back({static_cast<std::int32_t>(a - first),
                              static_cast<std::int32_t>(b - first),
                              static_cast<std::int32_t>(c - first)});
  }
  return mesh;
}

bool draws_all(const SharedScene& scene) {
  std::size_t all = 0;
  for (const SharedScene::Object& object : scene.objects) all += object.triangle_count;
  return all <= kPageTrianglesMax;
}

namespace {

// Returns whether a mesh is flat: then it represents a plane.
bool is_flat(const render::TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return false;
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices) box.extend(vertex);
  const auto corner = [&](std::size_t k) {
    return mesh.vertices[static_cast<std::size_t>(mesh.triangles.front()[k])];
  };
  const Eigen::Vector3d a = corner(0);
  const Eigen::Vector3d n = (corner(1) - a).cross(corner(2) - a).normalized();
  return std::all_of(mesh.vertices.begin(), mesh.vertices.end(), [&](const Eigen::Vector3d& v) {
    return std::abs((v - a).dot(n)) < 1e-9 * (1 + box.diagonal().norm());
  });
}

void add_mesh(PageBlock& block, const std::string& prefix, const render::TriangleMesh& mesh) {
  std::vector<float> vertices;
  for (const Eigen::Vector3d& v : mesh.vertices) {
    for (const double one : v) vertices.push_back(static_cast<float>(one));
  }
  block.add(prefix + "vertices", vertices);
  if (mesh.vertices.size() <= 65'536) {
    std::vector<std::uint16_t> corners;
    for (const auto& triangle : mesh.triangles) {
      for (const std::int32_t v : triangle) corners.push_back(static_cast<std::uint16_t>(v));
    }
    block.add(prefix + "corners", corners);
    return;
  }
  std::vector<std::uint32_t> corners;
  for (const auto& triangle : mesh.triangles) {
    for (const std::int32_t v : triangle) corners.push_back(static_cast<std::uint32_t>(v));
  }
  block.add(prefix + "corners", corners);
}

/// Returns the map of an object. Its values are on the page as bytes, which a screen can show.
Json page_map(const SharedScene& scene, const SharedScene::Object& object,
              const std::string& prefix, PageBlock& block) {
  const SharedScene::Map& map = object.map;
  const std::size_t count = object.triangle_count * render::grid_points(map.parts);
  std::vector<std::uint8_t> values;
  values.reserve(count);
  for (const float value : std::span(scene.map_values).subspan(map.first_value, count)) {
    values.push_back(static_cast<std::uint8_t>(std::lround(255 * value)));
  }
  block.add(prefix + "map", values);
  return {{"quantity", map.quantity},
          {"unit", map.unit},
          {"min", map.min},
          {"max", map.max},
          {"parts", map.parts}};
}

}  // namespace

void add_bars(const SharedScene::Arm& arm, std::span<const driver::TickRecord> ticks,
              std::int64_t begin_ns, const std::string& prefix, Json& json, PageBlock& block) {
  std::vector<double> times;
  std::vector<float> points;
  std::vector<std::size_t> lines;
  if (!arm.geometry || ticks.empty()) return;
  const std::int64_t lasted = ticks.back().time_ns - ticks.front().time_ns;
  const std::int64_t step = std::max<std::int64_t>(
      session::BodyTrace::kStep_ns, lasted / static_cast<std::int64_t>(kArmPicturesMax));
  std::int64_t next = ticks.front().time_ns;
  for (const driver::TickRecord& tick : ticks) {
    if (tick.time_ns < next) continue;
    next = tick.time_ns + step;
    std::vector<std::size_t> now;
    std::vector<float> own;
    for (const session::ArmLine& line : session::arm_lines(arm, tick)) {
      now.push_back(line.size());
      for (const Eigen::Vector3d& p : line) {
        for (const double one : p) own.push_back(static_cast<float>(one));
      }
    }
    if (times.empty()) lines = now;
    if (now != lines) continue;  // at an unreachable position: nothing to draw
    times.push_back(1e-9 * static_cast<double>(tick.time_ns - begin_ns));
    points.insert(points.end(), own.begin(), own.end());
  }
  json["lines"] = lines;
  block.add(prefix + "bar_t", times);
  block.add(prefix + "bars", points);
}

Json page_mark(const PageMark& mark, std::int64_t begin_ns) {
  return {{"begin", 1e-9 * static_cast<double>(mark.begin_ns - begin_ns)},
          {"end", 1e-9 * static_cast<double>(mark.end_ns - begin_ns)},
          {"kind", name_of(mark.kind)},
          {"words", mark.words}};
}

Json page_figures(std::span<const Figure> figures) {
  Json json = Json::array();
  for (const Figure& figure : figures) {
    json.push_back({{"name", figure.name},
                    {"value", figure.value},
                    {"unit", figure.unit},
                    {"goal", figure.goal},
                    {"met", figure.met()}});
  }
  return json;
}

Json page_objects(const PageTouch& touch, PageBlock& block) {
  Json objects = Json::array();
  std::size_t all = 0;
  for (const SharedScene::Object& object : touch.scene.objects) all += object.triangle_count;
  for (std::size_t i = 0; i < touch.scene.objects.size(); ++i) {
    const SharedScene::Object& object = touch.scene.objects[i];
    const std::string prefix = "object" + std::to_string(i) + ".";
    const render::TriangleMesh mesh = mesh_of(touch.scene, object);
    const bool shaped = std::any_of(touch.left.begin(), touch.left.end(),
                                    [i](const PageShape& shape) { return shape.object == i; });
    // All objects are reduced in proportion; an object that is on the page twice counts twice.
    const std::size_t max_drawn = all <= kPageTrianglesMax
                                      ? mesh.triangles.size()
                                      : kPageTrianglesMax * mesh.triangles.size() / all;
    const render::TriangleMesh drawn = light_mesh(mesh, max_drawn);
    add_mesh(block, prefix, drawn);
    Json map;  // null: none, or its triangles are not those of the drawn mesh
    if (object.map.parts > 0 && drawn.triangles.size() == mesh.triangles.size()) {
      map = page_map(touch.scene, object, prefix, block);
    }
    objects.push_back({{"name", object.name},
                       {"kind", name_of(object.kind)},
                       {"moves", object.moves},
                       {"dents", object.dents},
                       {"endless", object.kind == session::SharedKind::kShape && is_flat(mesh)},
                       {"crease", object.crease_angle},
                       {"triangles", mesh.triangles.size()},
                       {"drawn", drawn.triangles.size()},
                       {"left", shaped}});
    if (!map.is_null()) objects.back()["map"] = std::move(map);
  }
  for (const PageShape& shape : touch.left) {
    add_mesh(block, "object" + std::to_string(shape.object) + ".left.",
             light_mesh(shape.mesh, kPageTrianglesMax));
  }
  return objects;
}

Json page_bodies(const PageTouch& touch, PageBlock& block) {
  if (touch.bodies == nullptr || touch.arms.empty() || touch.arms.front().ticks.empty()) return {};
  const std::int64_t begin = touch.arms.front().ticks.front().time_ns;
  std::vector<double> times;
  for (const std::int64_t time : touch.bodies->times_ns()) {
    times.push_back(1e-9 * static_cast<double>(time - begin));
  }
  std::vector<float> poses;  // x y z of each, then its quaternion w x y z
  for (const render::BodyPose& pose : touch.bodies->poses()) {
    for (const double one : pose.p_WB) poses.push_back(static_cast<float>(one));
    for (const double one : pose.q_WB) poses.push_back(static_cast<float>(one));
  }
  block.add("bodies.t", times);
  block.add("bodies.poses", poses);
  Json json;
  json["objects"] =
      std::vector<std::size_t>(touch.bodies->moving().begin(), touch.bodies->moving().end());
  return json;
}

Json page_dents(const PageTouch& touch, PageBlock& block) {
  if (touch.dents == nullptr || touch.dents->frames().empty() || !draws_all(touch.scene) ||
      touch.arms.empty() || touch.arms.front().ticks.empty()) {
    return {};
  }
  const std::int64_t begin = touch.arms.front().ticks.front().time_ns;
  std::vector<double> times;
  std::vector<std::int16_t> objects;
  std::vector<std::uint32_t> first_points, first_triangles;
  std::vector<std::uint16_t> points_of, triangles_of;
  for (const session::DentTrace::Frame& frame : touch.dents->frames()) {
    times.push_back(1e-9 * static_cast<double>(frame.time_ns - begin));
    objects.push_back(frame.object);
    first_points.push_back(frame.point);
    first_triangles.push_back(frame.triangle);
    points_of.push_back(frame.points);
    triangles_of.push_back(frame.triangles);
  }
  std::vector<float> points;
  for (const auto& p : touch.dents->points()) points.insert(points.end(), p.begin(), p.end());
  std::vector<std::uint16_t> corners;
  for (const auto& t : touch.dents->triangles()) corners.insert(corners.end(), t.begin(), t.end());
  block.add("dents.t", times);
  block.add("dents.object", objects);
  block.add("dents.first_point", first_points);
  block.add("dents.first_triangle", first_triangles);
  block.add("dents.points_of", points_of);
  block.add("dents.triangles_of", triangles_of);
  block.add("dents.points", points);
  std::vector<std::int16_t> normals;
  for (const auto& n : touch.dents->normals()) normals.insert(normals.end(), n.begin(), n.end());
  block.add("dents.normals", normals);
  block.add("dents.corners", corners);
  block.add("dents.sources", touch.dents->sources());
  return {{"frames", times.size()}};
}

Json page_arm(const PageTouch& touch, std::size_t number, PageBlock& block) {
  const PageArm& arm = touch.arms[number];
  const SharedScene::Arm& drawn = touch.scene.arms[number];
  const std::string prefix = "arm" + std::to_string(number) + ".";
  const PageTicks ticks(arm.ticks, arm.periods_ns);
  const auto kept = rows_kept(ticks, kPageRowsMax / touch.arms.size());
  const std::int64_t begin = arm.ticks.empty() ? 0 : arm.ticks.front().time_ns;
  add_rows(block, prefix, ticks, kept, begin);
  Json json{{"name", drawn.in_scene},   {"arm", drawn.name},         {"device", drawn.device},
            {"limit", arm.force_limit}, {"ticks", arm.ticks.size()}, {"rows", kept.size()}};
  for (const Eigen::Vector3d& corner : {drawn.min_W, drawn.max_W}) {
    json["workspace"].push_back({corner.x(), corner.y(), corner.z()});
  }
  add_bars(drawn, arm.ticks, begin, prefix, json, block);
  json["marks"] = Json::array();
  for (const PageMark& mark : arm.marks) json["marks"].push_back(page_mark(mark, begin));
  json["figures"] = page_figures(arm.figures);
  return json;
}

}  // namespace thimble::report

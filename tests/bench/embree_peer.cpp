#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstring>
#include <limits>

#include "bench/peers.h"
#include "mesh/closest_point.h"

namespace thimble::bench {
namespace {

using Eigen::Vector3d;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

class Embree final : public Peer {
 public:
  explicit Embree(const render::TriangleMesh& mesh) {
    device_ = rtcNewDevice("threads=1");
    scene_ = rtcNewScene(device_);
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    vertices_ = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                            RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                            mesh.vertices.size()));
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      for (int i = 0; i < 3; ++i) {
        vertices_[3 * v + static_cast<std::size_t>(i)] = static_cast<float>(mesh.vertices[v][i]);
      }
    }
    triangles_ = static_cast<unsigned*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(unsigned), mesh.triangles.size()));
    std::memcpy(triangles_, mesh.triangles.data(), mesh.triangles.size() * 3 * sizeof(unsigned));
    rtcSetGeometryPointQueryFunction(geometry, nearest_of_one);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_MEDIUM);
    rtcCommitScene(scene_);
  }
  ~Embree() override {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  Embree(const Embree&) = delete;
  Embree& operator=(const Embree&) = delete;

  std::string name() const override { return "embree"; }
  bool has_first_hit() const override { return true; }
  bool has_closest() const override { return true; }
  bool has_follow() const override { return true; }

  double first_hit(const Vector3d& from, const Vector3d& to) override {
    const RTCRayHit ray = cast(from, to);
    return ray.hit.geomID == RTC_INVALID_GEOMETRY_ID ? kNaN : static_cast<double>(ray.ray.tfar);
  }

  double closest(const Vector3d& p, double radius) override {
    RTCPointQuery query{};
    query.x = static_cast<float>(p.x());
    query.y = static_cast<float>(p.y());
    query.z = static_cast<float>(p.z());
    query.radius = static_cast<float>(radius);
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    Search search{this, p, kNaN};
    rtcPointQuery(scene_, &query, &context, nullptr, &search);
    return search.distance;
  }

  // God-object: casts a ray from the last proxy, raised slightly above the surface, to the tip. The
  // new proxy is the tip projected onto the plane of the hit triangle.
  double follow(const Vector3d& p) override {
    const Vector3d from = proxy_ + kLift * normal_;
    const RTCRayHit ray = cast(from, p);
    if (ray.hit.geomID != RTC_INVALID_GEOMETRY_ID) {
      const Vector3d n(static_cast<double>(ray.hit.Ng_x), static_cast<double>(ray.hit.Ng_y),
                       static_cast<double>(ray.hit.Ng_z));
      normal_ = n.normalized();
      anchor_ = from + static_cast<double>(ray.ray.tfar) * (p - from);
    }
    const double depth = normal_.dot(anchor_ - p);
    proxy_ = p + std::max(depth, 0.0) * normal_;
    return depth > 0 ? depth : kNaN;
  }

 private:
  static constexpr double kLift = 1e-5;  // m; single precision has an error of 4e-9 at 0.1 m

  struct Search {
    const Embree* embree;
    Vector3d p;
    double distance;
  };

  RTCRayHit cast(const Vector3d& from, const Vector3d& to) const {
    RTCRayHit ray{};
    ray.ray.org_x = static_cast<float>(from.x());
    ray.ray.org_y = static_cast<float>(from.y());
    ray.ray.org_z = static_cast<float>(from.z());
    ray.ray.dir_x = static_cast<float>(to.x() - from.x());
    ray.ray.dir_y = static_cast<float>(to.y() - from.y());
    ray.ray.dir_z = static_cast<float>(to.z() - from.z());
    ray.ray.tfar = 1;
    ray.ray.mask = ~0u;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene_, &context, &ray);
    return ray;
  }

  Vector3d corner(unsigned triangle, std::size_t k) const {
    const float* v = vertices_ + std::size_t{3} * triangles_[std::size_t{3} * triangle + k];
    return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
  }

  static bool nearest_of_one(RTCPointQueryFunctionArguments* arguments) {
    auto& search = *static_cast<Search*>(arguments->userPtr);
    const unsigned t = arguments->primID;
    const Vector3d q =
        render::closest_point(search.p, search.embree->corner(t, 0), search.embree->corner(t, 1),
                              search.embree->corner(t, 2));
    const double distance = (q - search.p).norm();
    if (!(distance < static_cast<double>(arguments->query->radius))) return false;
    search.distance = distance;
    arguments->query->radius = static_cast<float>(distance);
    return true;
  }

  RTCDevice device_;
  RTCScene scene_;
  float* vertices_;
  unsigned* triangles_;
  Vector3d proxy_{1, 0, 0}, normal_{0, 0, 0}, anchor_{0, 0, 0};
};

}  // namespace

std::unique_ptr<Peer> make_embree(const render::TriangleMesh& mesh) {
  return std::make_unique<Embree>(mesh);
}

}  // namespace thimble::bench

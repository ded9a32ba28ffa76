#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <cmath>
#include <limits>
#include <vector>

#include "bench/peers.h"

namespace thimble::bench {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Tree = CGAL::AABB_tree<
    CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, Triangles::iterator>>>;

class Cgal final : public Peer {
 public:
  explicit Cgal(const render::TriangleMesh& mesh) {
    const auto point = [&mesh](std::int32_t v) {
      const Eigen::Vector3d& p = mesh.vertices[static_cast<std::size_t>(v)];
      return Kernel::Point_3(p.x(), p.y(), p.z());
    };
    for (const auto& [a, b, c] : mesh.triangles) {
      triangles_.emplace_back(point(a), point(b), point(c));
    }
    tree_ = std::make_unique<Tree>(triangles_.begin(), triangles_.end());
    tree_->build();
    tree_->accelerate_distance_queries();
  }

  std::string name() const override { return "cgal"; }
  bool has_closest() const override { return true; }
  double first_hit(const Eigen::Vector3d&, const Eigen::Vector3d&) override { return NAN; }
  double follow(const Eigen::Vector3d&) override { return NAN; }
  double closest(const Eigen::Vector3d& p, double radius) override {
    const double squared = tree_->squared_distance(Kernel::Point_3(p.x(), p.y(), p.z()));
    return squared <= radius * radius ? std::sqrt(squared) : NAN;
  }

 private:
  Triangles triangles_;
  std::unique_ptr<Tree> tree_;
};

}  // namespace

std::unique_ptr<Peer> make_cgal(const render::TriangleMesh& mesh) {
  return std::make_unique<Cgal>(mesh);
}

}  // namespace thimble::bench

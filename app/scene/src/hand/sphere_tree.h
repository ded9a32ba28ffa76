#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

namespace thimble::scene {

/// A tree of spheres, asked which of them are near a point. The answers are those of a look at all
/// of them, to the bit. Real-time: never from the servo thread.
class SphereTree {
 public:
  /// A sphere, m.
  struct Sphere {
    Eigen::Vector3d center{0, 0, 0};
    double radius = 0;
    std::size_t number = 0;  ///< Its place among those that the tree was made of.

    double distance(const Eigen::Vector3d& p) const { return (center - p).norm(); }
  };

  /// Takes the spheres and numbers them in their order. O(n log n), however they lie.
  explicit SphereTree(std::vector<Sphere> spheres);

  /// Returns how far the nearest far side of a sphere is from a point (m); infinite without
  /// spheres.
  double nearest_far_side(const Eigen::Vector3d& p) const;

  /// Writes the numbers of all spheres that come within `reach` (m) of a point, in rising order.
  void find_within(const Eigen::Vector3d& p, double reach, std::vector<std::size_t>& found) const;

 private:
  // What is asked one by one, not cut further.
  static constexpr std::size_t kLeaf = 8;

  struct Node {
    Eigen::AlignedBox3d centers;
    double radius_max = 0;
  };

  // Nodes stand as in a heap: the halves of node i are 2 i + 1 and 2 i + 2.
  void build(std::size_t node, std::size_t begin, std::size_t end);
  void look_for_far_side(std::size_t node, std::size_t begin, std::size_t end,
                         const Eigen::Vector3d& p, double& nearest) const;
  void look_within(std::size_t node, std::size_t begin, std::size_t end, const Eigen::Vector3d& p,
                   double reach, std::vector<std::size_t>& found) const;
  double distance(std::size_t node, const Eigen::Vector3d& p) const;

  std::vector<Sphere> spheres_;
  std::vector<Node> nodes_;
};

}  // namespace thimble::scene

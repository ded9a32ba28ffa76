#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

namespace thimble::scene {

/// Tree of spheres for queries near a point. Results are bit-identical to those of a linear search.
/// Real-time: never from the servo thread.
class SphereTree {
 public:
  /// Sphere, m.
  struct Sphere {
    Eigen::Vector3d center{0, 0, 0};
    double radius = 0;
    std::size_t number = 0;  ///< Index among the spheres of the tree.

    double distance(const Eigen::Vector3d& p) const { return (center - p).norm(); }
  };

  /// Constructs a tree of spheres, numbered in their order. O(n log n) for any distribution.
  explicit SphereTree(std::vector<Sphere> spheres);

  /// Returns the smallest distance of a point to the far side of a sphere (m); infinite without
  /// spheres.
  double nearest_far_side(const Eigen::Vector3d& p) const;

  /// Writes the numbers of all spheres within `reach` (m) of a point, in ascending order.
  void find_within(const Eigen::Vector3d& p, double reach, std::vector<std::size_t>& found) const;

 private:
  // Number of spheres in a leaf, which are tested one by one.
  static constexpr std::size_t kLeaf = 8;

  struct Node {
    Eigen::AlignedBox3d centers;
    double radius_max = 0;
  };

  // Nodes are in heap order: the children of node i are 2 i + 1 and 2 i + 2.
  void build(std::size_t node, std::size_t begin, std::size_t end);
  void search_far_side(std::size_t node, std::size_t begin, std::size_t end,
                       const Eigen::Vector3d& p, double& nearest) const;
  void search_within(std::size_t node, std::size_t begin, std::size_t end, const Eigen::Vector3d& p,
                     double reach, std::vector<std::size_t>& found) const;
  double distance(std::size_t node, const Eigen::Vector3d& p) const;

  std::vector<Sphere> spheres_;
  std::vector<Node> nodes_;
};

}  // namespace thimble::scene

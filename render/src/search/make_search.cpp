#include "search/make_search.h"

#include <cstdint>

#include "search/baseline/linear_search.h"
#include "search/grid_search.h"
#include "search/tree_search.h"

namespace thimble::render {
namespace {

// From here on, the tree takes at most the grid's time for a free path: 0.9 of it at 16,384
// triangles, 0.7 at 36,864 (`thimble study accuracy --axis search`); below they are equal. With
// cold caches, the grid takes 0.6 of the tree's time for a segment at 5,000 and 1.0 to 1.1 at
// 10,000, for a closest point 1.0 and 1.2 to 1.5 (bench_contact --cold). With its corners it is
// larger than the second cache there.
constexpr std::int32_t kTreeTrianglesMin = 8000;

template <class Surface>
std::shared_ptr<const ContactSearch> build_search(const Surface& surface,
                                                  std::optional<SearchChoice> choice) {
  if (!choice && surface.triangle_count() < kTreeTrianglesMin) {
    auto grid = std::make_shared<const GridSearch<Surface>>(surface);
    if (grid->even()) return grid;
  }
  switch (choice.value_or(SearchChoice::kTree)) {
    case SearchChoice::kLinear:
      return std::make_shared<const LinearSearchOver<Surface>>(surface);
    case SearchChoice::kGrid:
      return std::make_shared<const GridSearch<Surface>>(surface);
    case SearchChoice::kTree:
      break;
  }
  return std::make_shared<const TreeSearch<Surface>>(surface);
}

}  // namespace

std::shared_ptr<const ContactSearch> make_search(const ContactMesh& mesh,
                                                 std::optional<SearchChoice> choice) {
  return build_search(mesh, choice);
}

std::shared_ptr<const ContactSearch> make_search(const PackedSurface& surface,
                                                 std::optional<SearchChoice> choice) {
  return build_search(surface, choice);
}

std::shared_ptr<ContactSearch> make_moving_search(const ContactMesh& mesh,
                                                  std::optional<SearchChoice> choice) {
  if (choice == SearchChoice::kLinear) return std::make_shared<LinearSearch>(mesh);
  auto tree = std::make_shared<TreeSearch<ContactMesh>>(mesh);
  tree->keep_places();
  return tree;
}

}  // namespace thimble::render

#include "thimble/render/contact/make_search.h"

#include "thimble/render/contact/bvh.h"
#include "thimble/render/contact/grid_search.h"
#include "thimble/render/contact/linear_search.h"

namespace thimble::render {
namespace {

template <class Surface>
std::shared_ptr<const ContactSearch> build_search(const Surface& surface,
                                                  std::optional<SearchChoice> choice) {
  if (!choice) {
    auto grid = std::make_shared<const GridSearch<Surface>>(surface);
    if (grid->even()) return grid;
    choice = SearchChoice::kTree;
  }
  switch (*choice) {
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

std::shared_ptr<const ContactSearch> make_search(const CompactSurface& surface,
                                                 std::optional<SearchChoice> choice) {
  return build_search(surface, choice);
}

}  // namespace thimble::render

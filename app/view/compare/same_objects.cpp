#include "view/compare/same_objects.h"

#include <algorithm>

namespace thimble::view {

bool have_same_objects(const DrawnScene& a, const DrawnScene& b) {
  return std::equal(a.objects.begin(), a.objects.end(), b.objects.begin(), b.objects.end(),
                    [](const DrawnObject& one, const DrawnObject& other) {
                      return one.name == other.name && one.mesh.vertices == other.mesh.vertices &&
                             one.mesh.triangles == other.mesh.triangles;
                    });
}

}  // namespace thimble::view

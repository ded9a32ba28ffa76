#include "meshes/object_tracker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <utility>

namespace thimble::scene {
namespace {

using render::TrackerChoice;

constexpr std::size_t kNamesMax = 3;  // names of one line [chosen: it fits into a terminal]

/// Returns whether the tracker of an object that is a mesh in memory is chosen.
bool is_chosen(const SceneObject& object) {
  return !object.tracker_named && object.contact.tracker == TrackerChoice::kEdgePlanes;
}

}  // namespace

render::SurfaceChoice surface_of(const SceneObject& object) {
  return {.spring = {.stiffness = object.stiffness, .damping = object.damping},
          .effects = object.effects,
          .dent = object.body.dent,
          .shape = object.body.shape};
}

bool mesh_decides_tracker(const SceneObject& object) {
  return !object.shape && !object.build_field && !object.paged && !object.repair &&
         is_chosen(object) && !render::required_tracker(object.contact, surface_of(object));
}

ObjectTracker tracker_of(const SceneObject& object, const ObjectMesh& mesh) {
  ObjectTracker found{.contact = object.contact};
  if (object.contact.tip_radius > 0) return found;
  if (object.sheet_thickness && !object.tracker_named) {
    found.chosen = true;
    found.reason = "a sheet";
    return found;
  }
  if (!is_chosen(object)) return found;
  found.chosen = true;
  if (auto required = render::required_tracker(object.contact, surface_of(object))) {
    found.contact.tracker = required->contact.tracker;
    found.reason = std::move(required->reason);
  } else if (object.repair || !mesh.tracker) {
    found.reason = "its mesh is repaired";
  } else {
    found.contact.tracker = mesh.tracker->contact.tracker;
    found.reason = mesh.tracker->reason;
    if (!found.contact.crease_angle) {
      found.contact.crease_angle = mesh.tracker->contact.crease_angle;
    }
  }
  return found;
}

std::vector<std::string> describe_trackers(const Scene& scene,
                                           std::span<const ObjectTracker> trackers) {
  struct Line {
    std::string end;  // tracker and reason
    std::string names;
    std::size_t objects = 0;
  };
  std::vector<Line> lines;
  for (const ObjectTracker& one : trackers) {
    if (!one.chosen) continue;
    std::string end =
        fmt::format("{} ({})", render::kTrackerNames[static_cast<std::size_t>(one.contact.tracker)],
                    one.reason);
    auto line = std::find_if(lines.begin(), lines.end(),
                             [&end](const Line& other) { return other.end == end; });
    if (line == lines.end()) line = lines.insert(lines.end(), Line{.end = std::move(end)});
    if (line->objects < kNamesMax) {
      line->names += (line->objects > 0 ? ", " : "") + scene.objects[one.object].name;
    }
    ++line->objects;
  }
  std::vector<std::string> texts;
  for (const Line& line : lines) {
    const std::string more =
        line.objects > kNamesMax ? fmt::format(" and {} more", line.objects - kNamesMax) : "";
    texts.push_back(fmt::format("{}{}: {}", line.names, more, line.end));
  }
  return texts;
}

}  // namespace thimble::scene

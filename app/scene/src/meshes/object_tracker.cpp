#include "meshes/object_tracker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>

#include "thimble/render/build_object_touch.h"

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
          .shape = object.body.shape,
          .stiffness_map = object.stiffness_map,
          .friction_map = object.friction_map};
}

bool takes_suitable_tracker(const SceneObject& object) {
  return object.contact.tip_radius == 0 && !object.sheet_thickness && is_chosen(object) &&
         !object.repair && !render::required_tracker(object.contact, surface_of(object));
}

ObjectTracker tracker_of(const SceneObject& object, const std::shared_ptr<const ObjectMesh>& mesh,
                         SharedMeshes& meshes) {
  ObjectTracker found;
  found.contact = object.contact;
  if (object.contact.tip_radius > 0) return found;
  const auto choose = [&found](const render::ContactChoice& contact, const std::string& reason) {
    found.contact = contact;
    found.chosen = true;
    found.reason = reason;
    return found;
  };
  if (object.sheet_thickness && !object.tracker_named) return choose(object.contact, "a sheet");
  if (!is_chosen(object)) return found;
  if (const auto required = render::required_tracker(object.contact, surface_of(object))) {
    return choose(required->contact, required->reason);
  }
  if (object.repair) return choose(object.contact, "its mesh is repaired");
  const auto suitable = meshes.tracker(mesh);
  render::ContactChoice contact = object.contact;
  contact.tracker = suitable->contact.tracker;
  if (contact.crease_angle || !suitable->contact.crease_angle) {
    return choose(contact, suitable->reason);
  }
  contact.crease_angle = suitable->contact.crease_angle;
  return choose(contact, suitable->reason);
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
    const std::optional<double>& crease = one.contact.crease_angle;
    const bool creases = crease && one.contact.tracker == TrackerChoice::kPacked;
    std::string end = fmt::format(
        "{} ({}{})", render::kTrackerNames[static_cast<std::size_t>(one.contact.tracker)],
        one.reason,
        creases ? fmt::format("; edges of more than {:.1f} degrees stay sharp",
                              *crease * 180 / std::numbers::pi)
                : "");
    auto line = std::find_if(lines.begin(), lines.end(),
                             [&end](const Line& other) { return other.end == end; });
    if (line == lines.end()) line = lines.insert(lines.end(), Line{std::move(end), {}, 0});
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

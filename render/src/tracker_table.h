#pragma once

#include <type_traits>
#include <utility>

#include "thimble/render/contact_choice.h"
#include "track/baseline/normal_projection_tracker.h"
#include "track/god_object.h"
#include "track/mesh_contact.h"
#include "track/packed_contact_in_memory.h"

namespace thimble::render {

/// Calls `use` with the contact stage of a tracker as a type (std::type_identity) and returns its
/// result. The only place that maps tracker names to classes. A stage over a ContactMesh is built
/// from mesh and search; OffsetContact also takes normals, InMemoryContact packed triangles.
template <class Use>
auto with_contact_of(TrackerChoice tracker, Use&& use) {
  switch (tracker) {
    case TrackerChoice::kEdgePlanes:
      break;
    case TrackerChoice::kNormalProjection:
      return use(std::type_identity<TrackedContact<NormalProjectionTracker>>());
    case TrackerChoice::kOffset:
      return use(std::type_identity<OffsetContact>());
    case TrackerChoice::kGodObject:
      return use(std::type_identity<GodObjectContact>());
    case TrackerChoice::kPacked:
      return use(std::type_identity<InMemoryContact>());
  }
  return use(std::type_identity<MeshContact>());
}

}  // namespace thimble::render

#include "studies/accuracy/follower.h"

#include <limits>
#include <type_traits>
#include <utility>

#include "mesh/closest_point.h"
#include "mesh/smooth_normals.h"
#include "mesh/triangle_set.h"
#include "track/god_object.h"
#include "track/mesh_contact.h"
#include "track/packed_contact_in_memory.h"
#include "tracker_table.h"

namespace thimble::studies {
namespace {

using Eigen::Vector3d;
using render::ContactMesh;
using render::TrackerChoice;

/// Implements copying of the state.
template <class Self>
class CopiedFollower : public Follower {
 public:
  std::unique_ptr<Follower> copy() const override {
    return std::make_unique<Self>(static_cast<const Self&>(*this));
  }
  void copy_state(const Follower& other) noexcept override {
    static_cast<Self&>(*this) = static_cast<const Self&>(other);
  }
};

/// Follows with a contact of the product.
template <class Contact>
class TrackedFollower final : public CopiedFollower<TrackedFollower<Contact>> {
 public:
  explicit TrackedFollower(Contact contact) : contact_(std::move(contact)) {}

  std::int32_t follow(const Vector3d& p_WT) noexcept override {
    const double before = looks();
    driver::DeviceState state;
    state.p_WT = p_WT;
    const render::ContactState& found = contact_.update(state);
    effort_ = found.hops + looks() - before;
    return found.touching ? found.triangle : -1;
  }
  double effort() const noexcept override { return effort_; }

 private:
  // Returns all looks around and searches so far, as a number of triangles.
  double looks() const noexcept {
    const auto counters = contact_.counters();
    if constexpr (requires { counters.found_near; }) {
      return render::kPatchMax *
             static_cast<double>(counters.found_near + counters.called_back + counters.found_far);
    } else if constexpr (requires { counters.lifts; }) {
      return static_cast<double>(counters.lifts);
    } else {
      return 0;
    }
  }

  Contact contact_;
  double effort_ = 0;
};

/// Searches the nearest triangle in every tick, without memory.
class SearchedFollower final : public CopiedFollower<SearchedFollower> {
 public:
  explicit SearchedFollower(std::shared_ptr<const render::ContactSearch> search)
      : search_(std::move(search)) {}

  std::int32_t follow(const Vector3d& p_WT) noexcept override {
    const auto hit = search_->closest(p_WT, std::numeric_limits<double>::infinity());
    effort_ = hit.distance;  // the farther the surface, the more boxes must be searched
    return hit.triangle;
  }
  double effort() const noexcept override { return effort_; }

 private:
  std::shared_ptr<const render::ContactSearch> search_;
  double effort_ = 0;
};

/// Hops over edge planes from its last triangle, and may search the rings around the final one.
class HoppingFollower final : public CopiedFollower<HoppingFollower> {
 public:
  HoppingFollower(const FollowedSurface& surface, int rings)
      : mesh_(surface.mesh), search_(surface.tree), rings_(rings) {}

  std::int32_t follow(const Vector3d& p_WT) noexcept override {
    effort_ = 0;
    if (begun_ && active_ < 0) active_ = search_->first_entry(p_before_, p_WT).triangle;
    p_before_ = p_WT;
    begun_ = true;
    if (active_ < 0) return -1;
    hop(p_WT);
    if (rings_ > 0) look_around(p_WT);
    return active_;
  }
  double effort() const noexcept override { return effort_; }

 private:
  void hop(const Vector3d& p_WT) noexcept {
    const Vector3d p = p_WT - mesh_->origin();
    for (int hops = 0; hops < render::kHopsMax; ++hops) {
      const render::TriangleCell& cell = mesh_->cell(active_);
      std::size_t worst = 0;
      double min = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const double distance = mesh_->edge_planes(active_)[k].distance(p);
        if (distance < min) {
          min = distance;
          worst = k;
        }
      }
      if (!(min < 0)) return;
      active_ = cell.neighbours[worst];
      effort_ += 1;
    }
  }

  void look_around(const Vector3d& p_WT) noexcept {
    render::TriangleSet<render::kPatchMax> patch;
    patch.add(active_);
    std::size_t begin = 0;
    for (int ring = 0; ring < rings_; ++ring) {
      const std::size_t end = patch.size();
      for (std::size_t i = begin; i < end; ++i) {
        for (const std::int32_t vertex : mesh_->corners(patch[i])) {
          for (const std::int32_t around : mesh_->fan(vertex)) {
            if (!patch.full()) patch.add(around);
          }
        }
      }
      begin = end;
    }
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < patch.size(); ++i) {
      const Vector3d near =
          render::closest_point(p_WT, mesh_->position(patch[i], 0), mesh_->position(patch[i], 1),
                                mesh_->position(patch[i], 2));
      const double distance = (near - p_WT).squaredNorm();
      if (!(distance < nearest)) continue;
      nearest = distance;
      active_ = patch[i];
    }
    effort_ += static_cast<double>(patch.size());
  }

  std::shared_ptr<const ContactMesh> mesh_;
  std::shared_ptr<const render::ContactSearch> search_;
  int rings_;
  std::int32_t active_ = -1;
  Vector3d p_before_{0, 0, 0};
  bool begun_ = false;
  double effort_ = 0;
};

template <class Contact>
std::unique_ptr<Follower> followed_by(Contact contact) {
  return std::make_unique<TrackedFollower<Contact>>(std::move(contact));
}

std::unique_ptr<Follower> make_tracked(const FollowedSurface& surface, TrackerChoice tracker) {
  return render::with_contact_of(tracker, [&]<class Contact>(std::type_identity<Contact>) {
    if constexpr (std::is_same_v<Contact, render::OffsetContact>) {
      const auto normals = std::make_shared<const render::SmoothNormals>(
          *surface.mesh, render::kCreaseAngle, render::NormalWeights::kFitted);
      return followed_by(Contact(surface.mesh, surface.tree, normals));
    } else if constexpr (std::is_same_v<Contact, render::InMemoryContact>) {
      return followed_by(Contact(render::PackedSurface::build(*surface.mesh).value(),
                                 render::SearchChoice::kTree));
    } else {
      return followed_by(Contact(surface.mesh, surface.tree));
    }
  });
}

}  // namespace

std::unique_ptr<Follower> make_follower(const FollowedSurface& surface,
                                        const FollowerChoice& choice) {
  if (choice.tracker) return make_tracked(surface, *choice.tracker);
  if (!choice.search) return std::make_unique<HoppingFollower>(surface, choice.rings);
  return std::make_unique<SearchedFollower>(
      *choice.search == render::SearchChoice::kLinear ? surface.linear : surface.tree);
}

}  // namespace thimble::studies

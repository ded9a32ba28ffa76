#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

#include "search/free_space.h"
#include "thimble/driver/device_state.h"
#include "thimble/driver/force_law.h"
#include "thimble/render/contact_state.h"
#include "thimble/render/object_touch.h"
#include "track/god_object.h"
#include "track/mesh_contact.h"
#include "track/moving_contact.h"
#include "track/path_bounded.h"
#include "world/holding_faces.h"
#include "world_solid.h"

namespace thimble::render {

/// A contact stage whose begin a world can decide.
template <class Contact>
concept BeginsAnywhere = requires(Contact contact, const Eigen::Vector3d& p_W) {
  contact.begin(0, p_W);
  contact.set_free(p_W);
};

namespace law_solid {

template <class Law>
struct BoundedContact : std::false_type {};
template <class Contact, class... Stages>
struct BoundedContact<ContactForceLaw<PathBounded<Contact>, Stages...>>
    : std::bool_constant<BeginsAnywhere<Contact>> {};
template <class Contact, class... Stages>
struct BoundedContact<ContactForceLaw<MovingContact<PathBounded<Contact>>, Stages...>>
    : std::bool_constant<BeginsAnywhere<Contact>> {};

template <class Law>
struct Moves : std::false_type {};
template <class Contact, class... Stages>
struct Moves<ContactForceLaw<MovingContact<Contact>, Stages...>> : std::true_type {};

}  // namespace law_solid

/// A force law that can be a solid of a world.
template <class Law>
concept SolidLaw = law_solid::BoundedContact<Law>::value;

/// WorldSolid over the force law of one object at rest. The contact is not bounded by the path of
/// the tip here; the world bounds the sum.
template <SolidLaw Law>
class LawSolid final : public WorldSolid {
 public:
  /// Keeps a reference: the law must outlive the solid.
  explicit LawSolid(Law& law) noexcept : law_(law) {}

  SolidBox box() const noexcept override {
    if constexpr (kHasMesh) {
      return {contact().mesh().box_min(), contact().mesh().box_max()};
    } else {
      const auto& surface = contact().surface();
      SolidBox box{surface.position(0, 0), surface.position(0, 0)};
      for (std::int32_t t = 0; t < surface.triangle_count(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
          box.min = box.min.cwiseMin(surface.position(t, k));
          box.max = box.max.cwiseMax(surface.position(t, k));
        }
      }
      box.min.array() -= surface.rise();
      box.max.array() += surface.rise();
      return box;
    }
  }
  double rounding() const noexcept override {
    if constexpr (kHasMesh) {
      return contact().mesh().depth_rounding();
    } else {
      return contact().surface().step();
    }
  }
  double stiffness() const noexcept override { return law_.spring_stiffness(); }
  bool changes() const noexcept override { return kMoving; }
  SolidMove begin_tick(const driver::DeviceState&, const Eigen::Vector3d&,
                       bool touching) noexcept override {
    SolidMove move;
    if constexpr (kMoving) {
      move.path = law_.contact().take_path();
      if (move.path > 0) free_space_ = {};
      // The surface has swept over the free proxy.
      const ContactState& found = contact().state();
      if (!touching && found.touching) {
        move.swept_over = found.triangle;
        move.p_WP = found.p_WP;
      }
    }
    return move;
  }
  double end_tick(const Eigen::Vector3d& p_WP, bool touching) noexcept override {
    if constexpr (kMoving) {
      if (!touching) contact().set_free(p_WP);
    }
    return 0;
  }
  bool inside(const Eigen::Vector3d& p_W) const noexcept override {
    return contact().search().inside(p_W);
  }
  SolidEntry first_entry(const Eigen::Vector3d& p_from,
                         const Eigen::Vector3d& p_to) noexcept override {
    const Entry entry = free_space_.first_entry(contact().search(), p_from, p_to);
    if constexpr (!kHasMesh) {
      if (entry.triangle < 0 && contact().surface().rise() > 0) return rise_entry(p_from, p_to);
    }
    return {entry.triangle, entry.parameter};
  }

  const ContactState& begin(std::int32_t triangle, const Eigen::Vector3d& p_WP) noexcept override {
    contact().begin(triangle, p_WP);
    closely_ = false;
    number_ = triangle;
    return contact().state();
  }
  void revive(const Eigen::Vector3d& p_WP) noexcept override {
    if (!closely_) {
      contact().begin(number_, p_WP);
    } else if constexpr (kHasMesh) {
      fallback_->begin(number_, p_WP);
    }
  }
  const ContactState& follow(const Eigen::Vector3d& p_W) noexcept override {
    if (closely_) {
      contact().begin(number_, state_.p_WP);
      closely_ = false;
    }
    const ContactState& found = contact().update(at(p_W));
    if (found.touching) {
      if constexpr (kHasMesh) {
        number_ = found.triangle;
      } else {
        number_ = contact().active();
      }
    }
    return found;
  }
  bool follows_closely() const noexcept override {
    return std::is_same_v<Contact, GodObjectContact>;
  }
  bool is_exact() const noexcept override {
    return std::is_same_v<Contact, GodObjectContact> || std::is_same_v<Contact, MeshContact>;
  }
  const ContactState& follow_closely(const ContactState& last,
                                     const Eigen::Vector3d& p_W) noexcept override {
    if constexpr (kHasMesh) {
      if (!closely_) fallback_->begin(last.triangle, last.p_WP);
      state_ = fallback_->update(at(p_W));
      if (state_.touching) number_ = state_.triangle;
    } else {
      // The plane of the last face, as far as there is material below it.
      state_ = last;
      state_.depth = last.n_W.dot(last.p_WP - p_W);
      state_.p_WP = p_W + state_.depth * last.n_W;
      state_.touching = state_.depth > 0 && inside(state_.p_WP - kBelow * rounding() * last.n_W);
      state_.hops = 0;
    }
    closely_ = true;
    return state_;
  }

  std::size_t holding_faces(std::array<Eigen::Vector3d, 3>& n_W) const noexcept override {
    const auto at = [&](const GodObjectContact& contact) {
      return render::holding_faces(contact.mesh(), contact.place(), contact.state().n_W, n_W);
    };
    if constexpr (std::is_same_v<Contact, GodObjectContact>) {
      if (!closely_) return at(contact());
    }
    if constexpr (kHasMesh) {
      if (closely_) return at(*fallback_);
    }
    return 0;
  }

  driver::ForceCommand feel(const driver::DeviceState& state,
                            const ContactState& felt) noexcept override {
    if constexpr (kMoving) {
      // Its material point refers to the first shape.
      return law_.respond(state, felt, law_.contact());
    } else if constexpr (kHasMesh) {
      if (closely_) return law_.respond(state, felt, *fallback_);
    } else {
      if (closely_) return law_.respond(state, felt, Plane{felt});
    }
    return law_.respond(state, felt, contact());
  }
  void leave() noexcept override { law_.respond({}, {}, contact()); }

  void prepare(const driver::DeviceState& expected) const noexcept override {
    if (!closely_) law_.prepare(expected);
  }
  void prepare_fallback() override {
    if constexpr (kHasMesh) {
      if (fallback_) return;
      fallback_.emplace(
          std::shared_ptr<const ContactMesh>(std::shared_ptr<const void>(), &contact().mesh()),
          std::shared_ptr<const ContactSearch>(std::shared_ptr<const void>(), &contact().search()));
    }
  }

 private:
  static constexpr bool kMoving = law_solid::Moves<Law>::value;

  template <class Held>
  static auto& contact_in(Held& held) noexcept {
    if constexpr (kMoving) {
      return held.contact().contact();
    } else {
      return held.contact();
    }
  }
  using Contact = std::remove_cvref_t<decltype(contact_in(std::declval<Law&>().contact()))>;
  static constexpr bool kHasMesh = requires(const Contact& contact) { contact.mesh(); };
  static constexpr double kBelow = 256;  // roundings; the world's lift is less [contact_world.cpp]

  // Where the smooth surface rises above its triangles, contact begins before they are entered.
  SolidEntry rise_entry(const Eigen::Vector3d& p_from, const Eigen::Vector3d& p_to) noexcept {
    contact().set_free(p_from);
    if (!contact().update(at(p_to)).touching) return {};
    return {.triangle = contact().active(), .parameter = 1};
  }

  // Source of the surface point of a contact that is held by a plane.
  struct Plane {
    const ContactState& contact;
    const ContactState& state() const noexcept { return contact; }
  };

  static driver::DeviceState at(const Eigen::Vector3d& p_W) noexcept {
    driver::DeviceState state;
    state.p_WT = p_W;
    return state;
  }

  Contact& contact() const noexcept { return contact_in(law_.contact()); }

  Law& law_;
  FreeSpace free_space_;
  std::optional<GodObjectContact> fallback_;
  bool closely_ = false;      // whether `fallback_` or the plane holds the contact
  std::int32_t number_ = -1;  // triangle from which the tracker continues
  ContactState state_;        // of `follow_closely`
};

}  // namespace thimble::render

#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "thimble/render/mesh/normal_weights.h"
#include "thimble/render/search/search_choice.h"
#include "thimble/render/track/blend_profile.h"

namespace thimble::render {

// Names of all trackers, searches and normals, so that a scene or a study can select them.
// render/src/track/README.md and render/src/search/README.md describe the uses of each.

/// Tracker: the algorithm that follows the tip over the surface during contact.
enum class TrackerChoice {
  kEdgePlanes,        ///< Edge planes of the paper [BP 4b].
  kNormalProjection,  ///< Earlier method of the paper [BP 4a]; for comparison.
  kOffset,            ///< Smooth cells without gaps, in double precision.
  kGodObject,         ///< Proxy that no face lets through [ZS].
  kPacked,            ///< Smooth cells on compact 64-byte triangles.
};
/// Names of TrackerChoice, in its order.
inline constexpr auto kTrackerNames = std::to_array<std::string_view>({
    "edge_planes", "normal_projection", "offset", "god_object", "compact",  //
});

/// Names of SearchChoice, in its order.
inline constexpr std::array<std::string_view, 3> kSearchNames{"linear", "grid", "tree"};

/// Blending of the normals that are felt.
enum class BlendingChoice { kFlat, kFixedBand, kSizedBand, kPhong };
inline constexpr std::array<std::string_view, 4> kBlendingNames{"flat", "fixed_band", "sized_band",
                                                                "phong"};

/// Names of BlendProfile, in its order.
inline constexpr std::array<std::string_view, 2> kProfileNames{"linear", "smooth"};

/// Names of NormalWeights, in its order.
inline constexpr std::array<std::string_view, 3> kNormalNames{"angle", "round", "fitted"};

/// Contact settings of one object. Empty members get a default that suits the tracker: `compact`
/// and `offset` are smooth (phong, curved depth), the others are flat.
struct ContactChoice {
  TrackerChoice tracker = TrackerChoice::kEdgePlanes;  ///< Tracker.
  /// Search; if empty, chosen for the mesh (make_search).
  std::optional<SearchChoice> search = {};
  /// Blending of the normals; if empty, chosen for the tracker.
  std::optional<BlendingChoice> blending = {};
  /// Weights of the vertex normals; if empty, kFitted. Cannot be used with `compact`, which
  /// supports angle weights only.
  std::optional<NormalWeights> normals = {};
  /// True: depth is measured below the smooth surface; false: below the triangles.
  std::optional<bool> curved_depth = {};
  std::optional<double> crease_angle = {};  ///< Angle above which an edge stays sharp, rad.
  double band = 0.001;                      ///< Width of the band of `fixed_band`, m.
  /// Profile of the normal within a band; linear if empty. Used with `fixed_band` and `sized_band`
  /// only.
  std::optional<BlendProfile> profile = {};
  /// Radius of a tip that is a ball, m; 0: a point. Under a ball, contact is exact: of the other
  /// settings only `search` counts.
  double tip_radius = 0;

  /// Returns whether two settings are equal.
  bool operator==(const ContactChoice&) const = default;
};

}  // namespace thimble::render

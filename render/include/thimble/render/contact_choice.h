#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "thimble/render/mesh/normal_weights.h"
#include "thimble/render/search/search_choice.h"
#include "thimble/render/track/blend_profile.h"

namespace thimble::render {

// Every way to follow and feel a surface, by name, so that a scene or a study can swap them.
// render/src/track/README.md and render/src/search/README.md say what each is good for.

/// How the tip is followed over the surface while it touches.
enum class TrackerChoice {
  kEdgePlanes,        ///< The paper's edge planes [BP 4b].
  kNormalProjection,  ///< What the paper had before [BP 4a]; for comparison.
  kOffset,            ///< Smooth cells without gaps, in double precision.
  kGodObject,         ///< A proxy that no face lets through [ZS].
  kPacked,            ///< Smooth cells on 64-byte packed triangles.
};
/// Names what TrackerChoice says, in its order.
inline constexpr auto kTrackerNames = std::to_array<std::string_view>({
    "edge_planes", "normal_projection", "offset", "god_object", "compact",  //
});

/// Names what SearchChoice says.
inline constexpr std::array<std::string_view, 3> kSearchNames{"linear", "grid", "tree"};

/// Which normal is felt.
enum class BlendingChoice { kFlat, kFixedBand, kSizedBand, kPhong };
inline constexpr std::array<std::string_view, 4> kBlendingNames{"flat", "fixed_band", "sized_band",
                                                                "phong"};

/// Names what BlendProfile says.
inline constexpr std::array<std::string_view, 2> kProfileNames{"linear", "smooth"};

/// Names what NormalWeights says.
inline constexpr std::array<std::string_view, 3> kNormalNames{"angle", "round", "fitted"};

/// How one object is touched. What is left empty is chosen to go with the tracker: `compact` and
/// `offset` are smooth (phong, curved depth), the others are flat.
struct ContactChoice {
  TrackerChoice tracker = TrackerChoice::kEdgePlanes;  ///< How it is followed.
  std::optional<SearchChoice> search = {};      ///< If empty, what suits the mesh (make_search).
  std::optional<BlendingChoice> blending = {};  ///< Which normal is felt; or as suits.
  std::optional<NormalWeights> normals = {};    ///< Of the corners; fitted if empty. Not with
                                                ///< `compact`, which knows means by angle only.
  /// Depth below the smooth surface instead of the triangles.
  std::optional<bool> curved_depth = {};
  std::optional<double> crease_angle = {};  ///< Edges sharper than this stay sharp, rad.
  double band = 0.001;                      ///< Width of the band of `fixed_band`, m.
  /// How the normal turns within a band; linear if empty. With `fixed_band` and `sized_band` only.
  std::optional<BlendProfile> profile = {};

  /// Returns whether two objects are touched in the same way.
  bool operator==(const ContactChoice&) const = default;
};

}  // namespace thimble::render

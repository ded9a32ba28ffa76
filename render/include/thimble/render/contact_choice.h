#pragma once

#include <array>
#include <string_view>

namespace thimble::render {

// Every way to find, follow and feel a surface, by name, so that a scene or a study can swap them.
// render/README.md says what each is good for.

/// Says how the tip is followed over the surface while it touches.
enum class TrackerChoice {
  kEdgePlanes,        ///< The paper's edge planes [BP 4b].
  kNormalProjection,  ///< What the paper had before [BP 4a]; for comparison.
  kOffset,            ///< Smooth cells without gaps, in double precision.
  kGodObject,         ///< A proxy that no face lets through [ZS].
  kCompact,           ///< Smooth cells on 64-byte records: the fast way.
};
inline constexpr std::array<std::string_view, 5> kTrackerNames{"edge_planes", "normal_projection",
                                                               "offset", "god_object", "compact"};

/// Says which normal is felt.
enum class BlendingChoice { kFlat, kFixedBand, kSizedBand, kPhong };
inline constexpr std::array<std::string_view, 4> kBlendingNames{"flat", "fixed_band", "sized_band",
                                                                "phong"};

/// Says how the surface is found while the tip is free.
enum class SearchChoice { kLinear, kVolumeGrid, kBvh };
inline constexpr std::array<std::string_view, 3> kSearchNames{"linear", "volume_grid", "bvh"};

/// Is how one object is touched.
struct ContactChoice {
  TrackerChoice tracker = TrackerChoice::kEdgePlanes;
  BlendingChoice blending = BlendingChoice::kFlat;
  SearchChoice search = SearchChoice::kLinear;
  bool curved_depth = false;  ///< Depth below the smooth surface instead of the triangles.
  double crease_angle = 0;  ///< Edges sharper than this stay sharp, rad; 0: the default of the way.
  double band = 0.001;      ///< Width of the band of `fixed_band`, m.
};

}  // namespace thimble::render

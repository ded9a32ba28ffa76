#pragma once

#include <cstddef>
#include <cstdint>

#include "thimble/driver/snapshot.h"
#include "thimble/driver/tick_record.h"
#include "thimble/render/body_patch.h"
#include "thimble/render/mesh/triangle_mesh.h"
#include "thimble/render/scene_touch.h"
#include "thimble/scene/scene_objects.h"

namespace thimble::session {

/// Keeps what is drawn of a scene's dents: the newest patch for whoever shows the run, and the one
/// of the deepest touch for its report.
class DentRecord {
 public:
  /// Lets a patch be drawn about 60 times a second of loops with this period (ns): that is as fast
  /// as pictures change. Real-time: never from the servo thread.
  explicit DentRecord(std::int64_t period_ns);

  /// Draws if it is time, and tells whether it did. Real-time: safe; some 15 us in one tick of 16.
  bool take(const driver::TickRecord& tick, render::SceneTouch& touch) noexcept;

  /// Gives what was drawn last. On the servo thread.
  const render::BodyPatch& drawn() const noexcept { return patch_; }
  /// Gives the newest patch; any thread may load it.
  const driver::Snapshot<render::BodyPatch>& newest() const noexcept { return newest_; }
  /// Gives the patch of the deepest touch; no triangles if nothing was dented. After the run.
  const render::BodyPatch& deepest() const noexcept { return deepest_; }

 private:
  std::uint64_t every_;
  double depth_ = 0;
  render::BodyPatch patch_{};
  render::BodyPatch deepest_{};
  driver::Snapshot<render::BodyPatch> newest_;
};

/// Gives a mesh (m) with the patch of the object that begins at `place` in place of the triangles
/// it stands for. Real-time: never from the servo thread.
render::TriangleMesh bent(const render::TriangleMesh& mesh, const scene::MeshPlace& place,
                          const render::BodyPatch& patch);

}  // namespace thimble::session

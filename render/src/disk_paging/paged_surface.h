#pragma once

#include <Eigen/Core>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <thread>
#include <vector>

#include "compact_mesh/large_pages.h"
#include "compact_mesh/packed_surface.h"
#include "disk_paging/frame_order.h"
#include "disk_paging/page_file.h"
#include "disk_paging/page_tree.h"
#include "search/contact_search.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/driver/snapshot.h"
#include "thimble/render/page/paging_counters.h"
#include "track/packed_store.h"

namespace thimble::render {

class PageSegment;

/// Settings of the part of a paged surface that is kept in memory around the tip.
struct PagingSettings {
  std::size_t frames = 4096;  ///< Pages in memory at once: 256 MiB. Must be > 0.
  double reach = 0.001;       ///< Distance around the tip within which everything is loaded, m.
  double horizon = 0.02;      ///< Time by which loading looks ahead of the tip's velocity, s: twice
                              ///< a disk's worst seek.
};

/// A surface that has only the pages around the tip in memory [BP 4.1]. A loader reads pages ahead
/// of the tip and drops those it left behind; the servo never waits for it.
///
/// The servo marks its ticks by `begin_tick` and `end_tick` and keeps no pointer beyond a tick. A
/// frame is reused only when all ticks that could have used its page are over.
class THIMBLE_EXPORT PagedSurface {
 public:
  /// Opens a page file; nothing is in memory yet. Fails as PageFile::open does.
  /// Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<PagedSurface>> open(const std::filesystem::path& file,
                                                            const PagingSettings& settings = {});

  PagedSurface(const PagedSurface&) = delete;
  PagedSurface& operator=(const PagedSurface&) = delete;
  /// Stops the loader.
  ~PagedSurface();

  // Functions for the servo: one thread. Real-time: safe.

  /// Begins a tick with queries near the straight line from `p_tip` to `p_place` (W, m), which move
  /// with `v_W` (m/s). `p_place` is the touched place, or for a free tip the begin of a path that
  /// has not been examined.
  void begin_tick(const Eigen::Vector3d& p_tip, const Eigen::Vector3d& p_place,
                  const Eigen::Vector3d& v_W) noexcept;
  /// The same for a tip that is at the place.
  void begin_tick(const Eigen::Vector3d& p_tip, const Eigen::Vector3d& v_W) noexcept {
    begin_tick(p_tip, p_tip, v_W);
  }
  /// Ends a tick: packed triangles found in it may be dropped.
  void end_tick() noexcept;
  /// Sets the number of ticks so far in which a needed page was absent, for `counters`.
  void note_misses(std::uint64_t misses) noexcept {
    misses_.store(misses, std::memory_order_relaxed);
  }

  /// Returns a packed triangle, or nullptr if its page is not in memory. Valid until `end_tick`.
  const PackedTriangle* find(std::int32_t triangle) const noexcept {
    const Frame* const frame = frame_of(triangle / kPageTriangles);
    return frame == nullptr
               ? nullptr
               : &frame->triangles[static_cast<std::size_t>(triangle % kPageTriangles)];
  }

  /// Prefetches the packed triangles around one, all at once: a walk to them would wait for each in
  /// turn. Has no effect if its page is absent.
  void announce(std::int32_t triangle) const noexcept {
    const Frame* const frame = frame_of(triangle / kPageTriangles);
    if (frame == nullptr) return;
    const std::int32_t first = triangle % kPageTriangles / kGroup * kGroup;
    for (std::int32_t i = first; i < first + kGroup; ++i) {
      __builtin_prefetch(&frame->triangles[static_cast<std::size_t>(i)]);
    }
  }
  /// Number of packed triangles in a group: numbers that differ by less are likely near.
  static constexpr std::int32_t kGroup = 16;

  // The following functions use the packed triangles in memory; `complete` is set to whether the
  // result holds for the whole surface.

  /// Returns the first packed triangle that the segment (W, m) crosses from outside to inside.
  FoundEntry first_entry(const Eigen::Vector3d& p_from, const Eigen::Vector3d& p_to) const noexcept;

  /// Returns the packed triangle nearest to a point (W, m) and nearer than `radius` (m), -1 for
  /// none.
  std::int32_t closest(const Eigen::Vector3d& p_W, double radius, bool& complete) const noexcept;

  /// Returns whether a point (W, m) is inside; false if not `complete`. Needs the pages between the
  /// point and the surface nearest to it.
  bool inside(const Eigen::Vector3d& p_W, bool& complete) const noexcept;

  const PagingSettings& settings() const noexcept { return settings_; }
  const PageFile& file() const noexcept { return file_; }  ///< Returns the file.
  std::int32_t triangle_count() const noexcept { return file_.triangle_count(); }
  const Lattice& lattice() const noexcept { return file_.lattice(); }  ///< Returns the lattice.

  // Functions for the loader: one thread. Real-time: never from the servo thread.

  /// Starts a thread that calls `serve` repeatedly.
  void start_loader();

  /// Loads the pages wanted for the tip's last known position and path; returns the number of pages
  /// read. Waits for the end of a tick before it reuses a frame. For callers without a loader
  /// thread.
  std::size_t serve();

  /// Returns whether a point (W, m) is inside, by the parity of crossings on the way out; reads the
  /// pages on that way. False if a coordinate is NaN or beyond `kPositionMax`, or the disk fails.
  bool inside_by_reading(const Eigen::Vector3d& p_W) const;

  PagingCounters counters() const noexcept;
  /// Returns the bytes held in memory once all frames are used.
  std::size_t bytes() const noexcept;

 private:
  static constexpr std::int32_t kAbsent = -1;
  static constexpr std::int32_t kDamaged = -2;  // could not be read; not requested again
  static constexpr std::int32_t kGroups = kPageTriangles / kGroup;

  struct Frame {
    // Leaves the memory untouched: the system provides it when a page is loaded.
    Frame() noexcept {}  // NOLINT(modernize-use-equals-default)

    std::array<PackedTriangle, kPageTriangles> triangles;
    std::array<PageBox, kGroups> boxes;  // box of each group, in steps
    std::int32_t count;
  };
  const Frame* frame_of(std::int32_t page) const noexcept {
    const std::int32_t frame =
        table_[static_cast<std::size_t>(page)].load(std::memory_order_seq_cst);
    return frame < 0 ? nullptr : &frames_[static_cast<std::size_t>(frame)];
  }
  template <class Visit>
  bool visit_crossings(const PageSegment& segment, Visit visit) const noexcept;

  struct Cursor {
    std::array<double, 3> p_tip{};
    std::array<double, 3> p_place{};
    std::array<double, 3> v_W{};
  };

  // Distance beyond `reach` up to which pages are loaded too, as a share of it: until the tip has
  // moved this far, the pages in memory suffice and nothing is searched for. [measured: over 10^7
  // triangles at 0.05 to 0.5 m/s, 0.25 takes 4 to 13 % less time than 0.5]
  static constexpr double kSpare = 0.25;

  PagedSurface(PageFile file, const PagingSettings& settings);
  bool suffices_for(const Cursor& cursor) const noexcept;
  void want(const Cursor& cursor, double reach);
  void want_along(const Eigen::Vector3d& p, const Eigen::Vector3d& way, double reach);
  void mark_wanted(std::int32_t frame);
  std::int32_t free_frame();
  bool load(std::int32_t page, std::int32_t frame);
  void wait_for_ticks_end() const;

  PageFile file_;
  PagingSettings settings_;
  PageTree tree_;
  std::vector<std::atomic<std::int32_t>> table_;  // frame of each page, or kAbsent or kDamaged
  std::vector<Frame, LargePages<Frame>> frames_;

  driver::Snapshot<Cursor> cursor_;
  std::atomic<std::uint64_t> tick_{0};  // odd within a tick

  // Members used only by the loader.
  std::vector<std::int32_t> page_in_frame_;  // -1 if empty
  std::vector<std::uint64_t> wanted_at_;     // round in which a frame's page was last wanted
  FrameOrder order_;                         // frames by that round
  std::vector<std::uint64_t> wanted_in_;     // round in which a page was last wanted
  std::vector<std::pair<double, std::int32_t>> wanted_;
  Cursor loaded_for_;        // position for which all pages within reach and `kSpare` were loaded
  bool all_loaded_ = false;  // whether there is such a position
  std::uint64_t round_ = 0;
  std::atomic<std::uint64_t> loads_{0}, evictions_{0}, failures_{0}, short_of_frames_{0};
  std::atomic<std::uint64_t> misses_{0};
  std::atomic<bool> stop_{false};
  std::thread loader_;
};

}  // namespace thimble::render

#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "report/html/page_block.h"
#include "report/html/page_marks.h"
#include "report/html/shape_steps.h"
#include "share/shared_reader.h"
#include "thimble/driver/result.h"
#include "thimble/session/run_statistics.h"

namespace thimble::web {

/// What the pages of a run that goes on are told: updates, each with all ticks since the one
/// before, kept for a while for whoever comes later or is slow.
///
/// The first update of each connection, and of each that has fallen behind, names the run ("run"):
/// a page of another run must load itself again and show nothing of it.
///
/// An update is, little-endian: the bytes of its JSON and those of its numbers (u32 each), the
/// JSON, the numbers (PageBlock), either filled up to a multiple of 8. A message holds one or more.
///
/// Used by one thread; Real-time: never from the servo thread.
class LiveFeed {
 public:
  /// Ticks that are kept: a minute at 1 kHz, as a stored page has. [chosen]
  static constexpr std::size_t kTicksMost = 60'000;
  /// Bytes that all updates kept may have. [chosen: a minute of a large dent]
  static constexpr std::size_t kBytesMost = 24'000'000;
  /// Bytes of a message, after which no further update is put into it. [chosen: 4 s at 1 kHz]
  static constexpr std::size_t kMessageBytes = 256 * 1024;

  /// Where one page is.
  struct Place {
    std::uint64_t next = 0;   ///< The update that it gets next.
    std::uint64_t ticks = 0;  ///< That it has been sent, or has been told that it lacks.
    bool begun = false;       ///< It has been sent anything.
  };

  /// Keeps the reader, which must outlive this.
  explicit LiveFeed(session::SharedReader& reader);

  /// Returns the page as it is before it is told anything. The error is that of page_text.
  driver::Result<std::string> page(std::uint16_t port) const;

  /// Returns what tells this run from others of the same name: when it began.
  std::string run() const;
  /// Looks what is new and makes an update of it, if there is anything to tell.
  void step();
  /// Returns whether there is a message for a page.
  bool has_message(const Place& place) const noexcept { return !place.begun || place.next < end(); }
  /// Returns the next message for a page: where its place is forgotten, or it has none yet, that
  /// begins with what was before all updates that are kept, and says how many ticks never came.
  std::string message(Place& place) const;

  /// Returns the numbers of the oldest update that is kept and of the next that will be.
  std::uint64_t oldest() const noexcept { return oldest_; }
  std::uint64_t end() const noexcept { return oldest_ + updates_.size(); }  ///< As above.
  /// Returns ticks of the run that nobody could read in time.
  std::uint64_t lost() const noexcept { return lost_; }

 private:
  struct Update {
    std::string bytes;
    std::size_t ticks = 0;
    std::vector<report::ShapeStep> shapes;
    std::size_t dent = 0;  // bytes of it that tell of a dent, at its end; 0: none was drawn
  };

  void take_ticks(nlohmann::ordered_json& json, report::PageBlock& block, Update& update);
  void take_other_arms(nlohmann::ordered_json& json, report::PageBlock& block);
  void take_bodies(nlohmann::ordered_json& json, report::PageBlock& block);
  void take_shapes(nlohmann::ordered_json& json, report::PageBlock& block, Update& update);
  void take_dent(Update& update);
  void add_figures(nlohmann::ordered_json& json);
  void forget();
  std::string base(std::uint64_t lost) const;

  session::SharedReader& reader_;
  bool draws_all_;
  std::vector<driver::TickRecord> ticks_;  // the last one of the update before, and the new ones
  bool has_last_ = false;
  std::uint64_t serial_ = 0;
  std::uint64_t lost_ = 0;
  bool has_begin_ = false;
  std::int64_t begin_ns_ = 0;
  double now_ = 0;  // s, of the newest tick
  std::vector<std::uint64_t> other_ticks_;
  report::MarksAsTheyCome marks_;
  std::unique_ptr<session::RunStatistics> statistics_;
  int until_figures_ = 0;
  std::string told_;  // state and the like, as the last update had it
  std::uint64_t patches_ = 0;
  std::uint64_t shape_moves_ = 0;
  std::vector<render::TriangleMesh> first_, base_, meshes_;  // of objects that are shaped
  std::deque<Update> updates_;
  std::uint64_t oldest_ = 0;
  std::size_t kept_ticks_ = 0, kept_bytes_ = 0;
  std::uint64_t forgotten_ticks_ = 0;
  std::string base_dent_;  // the last one of the updates that are forgotten
  std::unique_ptr<render::BodyPatch> patch_;
};

}  // namespace thimble::web

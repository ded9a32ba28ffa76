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

/// The stream of updates to the pages of a live run. Each update has all ticks since the one
/// before. Updates are kept for a while for pages that connect later or are slow.
///
/// The first update of a connection names the run ("run"), and so does the first one after a page
/// has fallen behind. A page of another run must reload and show nothing of this run.
///
/// Format of an update, little-endian: the size of its JSON and of its numbers (u32 each, bytes),
/// the JSON, the numbers (PageBlock), both padded to a multiple of 8. A message contains one or
/// more updates.
///
/// Used by one thread; Real-time: never from the servo thread.
class LiveFeed {
 public:
  /// Maximum number of ticks kept: a minute at 1 kHz, as a stored page has. [chosen]
  static constexpr std::size_t kTicksMax = 60'000;
  /// Maximum bytes of all updates kept. [chosen: a minute of a large dent]
  static constexpr std::size_t kBytesMax = 24'000'000;
  /// Size of a message, bytes, after which no further update is added to it. [chosen: 4 s at 1 kHz]
  static constexpr std::size_t kMessageBytes = 256 * 1024;

  /// Position of one page in the stream.
  struct Place {
    std::uint64_t next = 0;   ///< The number of its next update.
    std::uint64_t ticks = 0;  ///< Ticks that were sent to it or reported to it as lost.
    bool begun = false;       ///< Whether anything was sent to it.
  };

  /// Keeps the reader, which must outlive this.
  explicit LiveFeed(session::SharedReader& reader);

  /// Returns the page before its first update. The error is that of page_text.
  driver::Result<std::string> page(std::uint16_t port) const;

  /// Returns the start time of the run, which distinguishes it from others of the same name.
  std::string run() const;
  /// Makes an update of what is new in the run, if anything is.
  void step();
  /// Returns whether there is a message for a page.
  bool has_message(const Place& place) const noexcept { return !place.begun || place.next < end(); }
  /// Returns the next message for a page. If the page has no position yet, or its next update is no
  /// longer kept, the message begins with the state before the oldest update. That state contains
  /// the number of lost ticks.
  std::string message(Place& place) const;

  /// Returns the number of the oldest update that is kept, and the number of the next update.
  std::uint64_t oldest() const noexcept { return oldest_; }
  std::uint64_t end() const noexcept { return oldest_ + updates_.size(); }  ///< As above.
  /// Returns the number of ticks of the run that were overwritten before they were read.
  std::uint64_t lost() const noexcept { return lost_; }

 private:
  struct Update {
    std::string bytes;
    std::size_t ticks = 0;
    std::vector<report::ShapeStep> shapes;
    std::size_t dent = 0;  // bytes of `bytes`, at the end, that contain a dent; 0: no dent
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
  std::vector<driver::TickRecord> ticks_;  // the last one of the previous update, and new ones
  bool has_last_ = false;
  std::uint64_t serial_ = 0;
  std::uint64_t lost_ = 0;
  bool has_begin_ = false;
  std::int64_t begin_ns_ = 0;
  double now_ = 0;  // time of the newest tick, s
  std::vector<std::uint64_t> other_ticks_;
  report::LiveMarks marks_;
  std::unique_ptr<session::RunStatistics> statistics_;
  int until_figures_ = 0;
  std::string sent_facts_;  // state and other facts of the run in the last update
  std::uint64_t patches_ = 0;
  std::uint64_t shape_moves_ = 0;
  std::vector<render::TriangleMesh> first_, base_, meshes_;  // of the shaped objects
  std::deque<Update> updates_;
  std::uint64_t oldest_ = 0;
  std::size_t kept_ticks_ = 0, kept_bytes_ = 0;
  std::uint64_t forgotten_ticks_ = 0;
  std::string base_dent_;  // the last dent of the updates that are no longer kept
  std::unique_ptr<render::BodyPatch> patch_;
};

}  // namespace thimble::web

#include "view/compare/recorded_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "text/counted.h"
#include "view/compare/run_colours.h"
#include "view/compare/run_groups.h"
#include "view/compare/same_objects.h"
#include "view/compare/signal_file.h"

namespace thimble::view {
namespace {

namespace fs = std::filesystem;

bool is_same_file(const fs::path& a, const fs::path& b) {
  std::error_code unknown;
  return a == b || fs::equivalent(a, b, unknown);
}

/// Returns the run to which a file belongs, for --scene-of.
driver::Result<std::size_t> run_of_file(const ComparedFiles& files,
                                        const std::vector<std::vector<std::size_t>>& runs) {
  if (files.scene_of.empty()) return std::size_t{0};
  for (std::size_t run = 0; run < runs.size(); ++run) {
    for (const std::size_t file : runs[run]) {
      if (is_same_file(files.recordings[file], files.scene_of)) return run;
    }
  }
  std::string known;
  for (const fs::path& file : files.recordings) {
    known += (known.empty() ? "" : ", ") + file.string();
  }
  return driver::Error{
      fmt::format("--scene-of: {} is none of the shown recordings. Name one of: {}.",
                  files.scene_of.string(), known)};
}

/// Checks that a signal shares some time with the recordings, which last `end` s.
driver::Result<void> check_overlap(const OwnSignals& signals, double end) {
  const double from = signals.time->front();
  const double to = signals.time->back();
  if (to >= 0 && from <= end) return {};
  return driver::Error{
      fmt::format("{}: its times are {:g} to {:g} s, but the recording lasts from 0 to {:g} s. "
                  "Subtract the time "
                  "of the first tick from all times.",
                  signals.file, from, to, end)};
}

}  // namespace

driver::Result<std::unique_ptr<RecordedRuns>> RecordedRuns::open(const ComparedFiles& files) {
  // First, because a long recording takes time.
  std::vector<OwnSignals> signals;
  for (const fs::path& file : files.signals) {
    auto read = read_signals(file);
    if (!read) return read.error();
    signals.push_back(std::move(read).value());
  }
  auto recordings = read_recordings(files.recordings);
  if (!recordings) return recordings.error();
  const auto runs = group_by_run(*recordings, files.recordings);
  if (runs.size() > kRunsMax) {
    return driver::Error{
        fmt::format("RUN: {} recordings were named; a time line shows at most {}. Name fewer.",
                    runs.size(), kRunsMax)};
  }
  const auto drawn = run_of_file(files, runs);
  if (!drawn) return drawn.error();
  std::unique_ptr<RecordedRuns> all(new RecordedRuns);
  auto opened = all->open_runs(files.recordings, std::move(recordings).value(), runs);
  if (!opened) return opened.error();
  if (auto taken = all->take_signals(std::move(signals)); !taken) return taken.error();
  all->comparison_.span = all->axis_.span();
  all->draw_scene_of(*drawn);
  return all;
}

driver::Result<void> RecordedRuns::open_runs(const std::vector<fs::path>& files,
                                             std::vector<session::Recording> recordings,
                                             const std::vector<std::vector<std::size_t>>& runs) {
  std::vector<fs::path> first_files;
  for (const auto& run : runs) first_files.push_back(files[run.front()]);
  const auto names = distinct_names(first_files);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    std::vector<session::Recording> arms;
    for (const std::size_t file : runs[i]) arms.push_back(std::move(recordings[file]));
    auto view = RecordingView::of(std::move(arms));
    if (!view && runs.size() > 1) {
      return driver::Error{first_files[i].string() + ": " + view.error().message};
    }
    if (!view) return view.error();
    views_.push_back(std::move(view).value());
    axis_.add_run(views_.back()->time());
    ComparedRun& run = comparison_.runs.emplace_back();
    run.name = names[i];
    run.colour = kRunColours[i];
    run.plots = &views_.back()->plots();
    run.offset = axis_.offset_of(i);
    run.end = axis_.end_of(i);
  }
  return {};
}

driver::Result<void> RecordedRuns::take_signals(std::vector<OwnSignals> files) {
  const double end = axis_.end_of(axis_.longest());
  for (const OwnSignals& signals : files) {
    if (auto shares = check_overlap(signals, end); !shares) return shares;
    const auto& time = *signals.time;
    axis_.add_signal(time.back());
    const auto early = std::lower_bound(time.begin(), time.end(), 0.0) - time.begin();
    if (early == 0) continue;
    signal_notes_.push_back(fmt::format("{}: {} before the first tick, not shown.",
                                        fs::path(signals.file).filename().string(),
                                        scene::counted(early, "value")));
  }
  comparison_.signals = signals_of(std::move(files), size());
  return {};
}

void RecordedRuns::draw_scene_of(std::size_t run) {
  comparison_.drawn = run;
  about_.clear();
  warnings_.clear();
  const std::string& drawn = comparison_.runs[run].name;
  for (std::size_t i = 0; i < size(); ++i) {
    ComparedRun& other = comparison_.runs[i];
    other.in_picture = have_same_objects(views_[i]->scene(), scene());
    if (other.in_picture) continue;
    warnings_.push_back(
        fmt::format("{}: its scene, {}, has other objects than that of {}, so only its plots are "
                    "drawn. To draw "
                    "its scene instead, use --scene-of, or select it in the list of the window.",
                    other.name, views_[i]->scene().name, drawn));
  }
  for (const std::string& sentence : views_[run]->about()) {
    about_.push_back(comparison_.several() ? drawn + ": " + sentence : sentence);
  }
  about_.insert(about_.end(), signal_notes_.begin(), signal_notes_.end());
}

void RecordedRuns::show(double time, DrawnMoment& moment) {
  const auto look = [&](std::size_t i) {
    const ComparedRun& run = comparison_.runs[i];
    const Colour colour = run.ended ? ended_colour(run.colour) : run.colour;
    return ArmLook{comparison_.several() ? std::optional(colour) : std::nullopt, run.ended};
  };
  for (std::size_t i = 0; i < size(); ++i) {
    comparison_.runs[i].ended = axis_.has_ended(i, time);
    comparison_.runs[i].tick = views_[i]->tick_at_time(axis_.time_in(i, time));
  }
  const std::size_t drawn = comparison_.drawn;
  views_[drawn]->show(axis_.time_in(drawn, time), moment);
  moment.look = look(drawn);
  for (DrawnArm& arm : moment.others) arm.look = look(drawn);
  for (std::size_t i = 0; i < size(); ++i) {
    if (i == drawn || !comparison_.runs[i].in_picture) continue;
    const std::size_t first = moment.others.size();
    views_[i]->add_arms(axis_.time_in(i, time), moment.others);
    for (std::size_t k = first; k < moment.others.size(); ++k) {
      moment.others[k].name.clear();  // the colour distinguishes the recordings
      moment.others[k].look = look(i);
    }
  }
}

double RecordedRuns::time_of_step(double time, int steps) const {
  for (const std::size_t run : {comparison_.drawn, axis_.longest()}) {
    if (axis_.has_ended(run, time)) continue;
    const double at =
        axis_.time_of(run, views_[run]->time_of_step(axis_.time_in(run, time), steps));
    if (steps > 0 ? at > time : at < time) return at;
  }
  return time + steps / scene().rate;
}

}  // namespace thimble::view

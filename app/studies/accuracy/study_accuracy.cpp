#include "studies/accuracy/study_accuracy.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <utility>

#include "log/logger.h"
#include "log/printed_text.h"
#include "log/progress.h"
#include "report/gnuplot.h"
#include "report/picture_style.h"
#include "studies/accuracy/accuracy_axis.h"
#include "studies/accuracy/accuracy_page.h"
#include "studies/accuracy/axis_picture.h"
#include "studies/accuracy/axis_words.h"
#include "studies/accuracy/measure_axis.h"
#include "studies/run_pages.h"
#include "studies/sweep/sweep.h"
#include "studies/sweep/sweep_journal.h"
#include "text/nearest_word.h"
#include "thimble/scene/build_info.h"
#include "thimble/scene/quality.h"
#include "thimble/scene/shipped_files.h"

namespace thimble::studies {
namespace {

driver::Result<std::vector<const AxisMaker*>> named_axes(const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const AxisMaker& maker : accuracy_axes()) known.emplace_back(maker.name);
  for (const std::string& name : names) {
    if (std::count(known.begin(), known.end(), name) == 1) {
      if (std::count(names.begin(), names.end(), name) == 1) continue;
      return driver::Error{"--axis: " + name + " is named twice; name each axis once."};
    }
    std::string message = "--axis: " + name + " is not an axis";
    if (const auto near = scene::nearest_word(name, known)) {
      message += "; did you mean " + *near + "?";
    }
    message += message.ends_with('?') ? " Known are" : "; known are";
    for (const std::string& one : known) message.append(" ").append(one);
    return driver::Error{message + "."};
  }
  std::vector<const AxisMaker*> found;
  for (const AxisMaker& maker : accuracy_axes()) {
    if (names.empty() || std::find(names.begin(), names.end(), maker.name) != names.end()) {
      found.push_back(&maker);
    }
  }
  return found;
}

/// Measures axes one after the other, and writes each to the journal.
class AxisSweep {
 public:
  AxisSweep(const AccuracyChoice& choice, std::vector<AccuracyAxis> axes,
            const std::atomic<bool>& stop)
      : choice_(choice), axes_(std::move(axes)), stop_(stop) {}

  /// Returns the measured axes; fewer if it was stopped.
  driver::Result<std::vector<std::unique_ptr<MeasuredAxis>>> run() {
    std::string key = scene::program_name();
    for (const AccuracyAxis& axis : axes_) key.append(" ").append(axis.name);
    if (choice_.count) key += " counted";
    CellNumbers numbers;
    auto journal = SweepJournal::open(choice_.folder / "accuracy.journal", key, axes_.size(),
                                      choice_.resume, numbers);
    if (!journal) return journal.error();
    MeasureOptions options{.count = choice_.count, .stop = &stop_};
    std::size_t all = 0, done = 0;
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      const auto steps = static_cast<std::size_t>(steps_of(axes_[i], options));
      all += steps;
      done += numbers[i].empty() ? 0 : steps;
    }
    scene::Progress progress("study accuracy",
                             static_cast<double>(done) / static_cast<double>(all));
    options.advance = [&](int steps) {
      done += static_cast<std::size_t>(steps);
      progress.set_share(done, all);
    };
    std::vector<std::unique_ptr<MeasuredAxis>> measured;
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      progress.set_state(axes_[i].name);
      const bool kept = !numbers[i].empty();
      auto axis =
          std::make_unique<MeasuredAxis>(kept ? with_numbers(std::move(axes_[i]), numbers[i])
                                              : measure_axis(std::move(axes_[i]), options));
      if (!axis->complete && !kept) return measured;  // stopped
      if (!axis->complete) return damaged();
      if (!kept) {
        numbers[i] = numbers_of(*axis);
        if (!(*journal)->add(i, numbers[i])) return unwritable();
      }
      if (options.count && !axis->lines.front().points.front().instructions) {
        scene::logger().warn(
            "Instructions are not counted: valgrind is not installed, or it failed.");
        options.count = false;
      }
      measured.push_back(std::move(axis));
    }
    if (auto finished = (*journal)->finish(numbers); !finished) return finished.error();
    return measured;
  }

 private:
  driver::Error damaged() const {
    return {(choice_.folder / "accuracy.journal").string() +
            " belongs to other axes. Remove --resume to start again."};
  }
  driver::Error unwritable() const {
    return {"The journal " + (choice_.folder / "accuracy.journal").string() +
            " cannot be written. Check that the disk has room."};
  }

  const AccuracyChoice& choice_;
  std::vector<AccuracyAxis> axes_;
  const std::atomic<bool>& stop_;
};

/// Writes pages of one touch at each quality, which is a point on every axis, into `folder`.
driver::Result<void> write_runs(const std::filesystem::path& folder) {
  std::error_code status;
  std::filesystem::create_directories(folder, status);
  RunPages pages(folder, "One touch at each quality",
                 "The first three seconds of the scene rubber, as `thimble run rubber --quality "
                 "...` runs it. Each quality is a point on every diagram of the study.");
  const auto scene = scene::find_scene("rubber");
  const std::array<std::pair<scene::Quality, const char*>, 3> qualities{
      {{scene::Quality::kDraft, "the cheapest settings that stay stable"},
       {scene::Quality::kNormal, "as the scene says"},
       {scene::Quality::kReference, "more accurate than can be felt"}}};
  for (const auto& [quality, words] : qualities) {
    if (!scene) break;  // a separate build without the shipped scenes: the list is empty
    session::SessionOptions options;
    options.duration = 3;
    options.rate_factor = scene::rate_factor_of(quality);
    options.adjust = [asked = quality](scene::Scene& changed) {
      scene::apply_quality(asked, changed);
    };
    const std::string name(scene::kQualityNames[static_cast<std::size_t>(quality)]);
    if (auto added = pages.add(*scene, name, words, options); !added) return added;
  }
  return pages.write();
}

}  // namespace

driver::Result<AccuracyReport> study_accuracy(const AccuracyChoice& choice,
                                              const std::atomic<bool>& stop) {
  const std::filesystem::path& folder = choice.folder;
  const auto makers = named_axes(choice.axes);
  if (!makers) return makers.error();
  const bool draws = report::has_gnuplot();
  if (auto made = report::make_picture_folder(folder); !made) return made.error();
  std::vector<AccuracyAxis> axes;
  for (const AxisMaker* maker : *makers) axes.push_back(maker->make());
  const auto measured = AxisSweep(choice, std::move(axes), stop).run();
  if (!measured) return measured.error();
  AccuracyReport report;
  report.stopped = measured->size() < makers->size();
  if (report.stopped) return report;
  std::vector<AxisSection> sections;
  for (const auto& one : *measured) {
    if (report.stopped = stop.load(); report.stopped) return report;
    const MeasuredAxis& axis = *one;
    AxisSection section{.axis = &axis, .pictures = {}};
    if (auto written = report::write_text(csv_of(axis), folder / (axis.axis.name + ".csv"));
        !written) {
      return written.error();
    }
    if (draws) {
      auto drawn = draw_axis(axis, folder);
      if (!drawn) return drawn.error();
      section.pictures = *std::move(drawn);
    }
    sections.push_back(std::move(section));
    for (session::Figure& figure : figures_of(axis)) report.figures.push_back(std::move(figure));
  }
  if (!draws)
    scene::print_format("No pictures: gnuplot is not installed (apt install gnuplot-nox).\n");
  if (auto written = write_runs(folder / "runs"); !written) return written.error();
  if (auto written = write_accuracy_page(sections, folder); !written) return written.error();
  if (auto written = write_accuracy_summary(sections, folder / "summary.json"); !written) {
    return written.error();
  }
  for (const AxisSection& section : sections) {
    scene::print_format("%s\n  %s\n  %s\n", section.axis->axis.title.c_str(),
                        felt_sentence(*section.axis).c_str(),
                        default_sentence(*section.axis).c_str());
  }
  scene::print_format("\n");
  return report;
}

}  // namespace thimble::studies

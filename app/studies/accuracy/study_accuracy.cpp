#include "studies/accuracy/study_accuracy.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <utility>

#include "log/printed_text.h"
#include "report/gnuplot.h"
#include "report/picture_parts.h"
#include "studies/accuracy/accuracy_axis.h"
#include "studies/accuracy/accuracy_page.h"
#include "studies/accuracy/axis_picture.h"
#include "studies/accuracy/axis_words.h"
#include "studies/accuracy/measure_axis.h"
#include "studies/run_pages.h"
#include "thimble/scene/quality.h"
#include "thimble/scene/shipped_files.h"

namespace thimble::app {
namespace {

driver::Result<std::vector<const AxisMaker*>> named_axes(const std::vector<std::string>& names) {
  std::vector<const AxisMaker*> found;
  for (const AxisMaker& maker : accuracy_axes()) {
    if (names.empty() || std::find(names.begin(), names.end(), maker.name) != names.end()) {
      found.push_back(&maker);
    }
  }
  if (names.empty() || found.size() == names.size()) return found;
  std::string message = "--axis: known are";
  for (const AxisMaker& maker : accuracy_axes()) message.append(" ").append(maker.name);
  return driver::Error{message + "; each once."};
}

/// Writes pages of one touch at each quality, which is a point on every axis, into `folder`.
driver::Result<void> write_runs(const std::filesystem::path& folder) {
  std::error_code status;
  std::filesystem::create_directories(folder, status);
  RunPages pages(folder, "One touch at each quality",
                 "The first three seconds of the scene rubber, as `thimble run rubber --quality "
                 "...` runs it: each quality is a point on every diagram of the study.");
  const auto scene = scene::find_scene("rubber");
  const std::array<std::pair<scene::Quality, const char*>, 3> qualities{
      {{scene::Quality::kDraft, "the cheapest that still behaves"},
       {scene::Quality::kNormal, "as the scene says"},
       {scene::Quality::kReference, "beyond what can be felt"}}};
  for (const auto& [quality, words] : qualities) {
    if (!scene) break;  // an own build without the shipped scenes: the list is empty
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

driver::Result<std::vector<Figure>> study_accuracy(const std::vector<std::string>& axes, bool count,
                                                   const std::filesystem::path& folder) {
  const auto makers = named_axes(axes);
  if (!makers) return makers.error();
  const bool draws = has_gnuplot();
  if (auto made = make_picture_folder(folder); !made) return made.error();
  std::vector<std::unique_ptr<MeasuredAxis>> measured;
  std::vector<AxisSection> sections;
  std::vector<Figure> figures;
  bool counted = count;
  for (const AxisMaker* maker : *makers) {
    scene::show_progress("Measuring " + std::string(maker->name));
    measured.push_back(
        std::make_unique<MeasuredAxis>(measure_axis(maker->make(), {.count = counted})));
    const MeasuredAxis& axis = *measured.back();
    AxisSection section{.axis = &axis, .pictures = {}};
    if (counted && !axis.lines.front().points.front().instructions) {
      scene::print_format("Instructions are not counted: valgrind is not installed, or failed.\n");
      counted = false;
    }
    if (auto written = write_text(csv_of(axis), folder / (axis.axis.name + ".csv")); !written) {
      return written.error();
    }
    if (draws) {
      auto drawn = draw_axis(axis, folder);
      if (!drawn) return drawn.error();
      section.pictures = *std::move(drawn);
    }
    sections.push_back(std::move(section));
    for (Figure& figure : figures_of(axis)) figures.push_back(std::move(figure));
  }
  scene::show_progress("");
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
  return figures;
}

}  // namespace thimble::app

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "studies/accuracy/measure_axis.h"
#include "thimble/driver/result.h"

namespace thimble::studies {

/// One section of the page: an axis, and the names of its pictures without ending.
struct AxisSection {
  const MeasuredAxis* axis = nullptr;
  std::vector<std::string> pictures;
};

/// Writes index.html into `folder`, with embedded pictures, without external resources, and
/// readable on a phone. Fails if it cannot be written. Real-time: never from the servo thread.
driver::Result<void> write_accuracy_page(const std::vector<AxisSection>& sections,
                                         const std::filesystem::path& folder);

/// Writes summary.json: for each axis the sentences and figures of the page. Fails if it cannot be
/// written.
driver::Result<void> write_accuracy_summary(const std::vector<AxisSection>& sections,
                                            const std::filesystem::path& file);

}  // namespace thimble::studies

#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "thimble/driver/result.h"
#include "thimble/session/session.h"

namespace thimble::studies {

/// The runs behind a study's figures, for viewing: a page of each in the study's folder, and an
/// index.html that lists and links them. Real-time: never from the servo thread.
class RunPages {
 public:
  /// Total bytes of all pages after which no further one is written. [chosen: ten minutes of touch,
  /// and small enough for mail]
  static constexpr std::uintmax_t kBytesMax = 25'000'000;

  /// Lists runs in the existing `folder` under `title`; `words` describe them.
  RunPages(std::filesystem::path folder, const std::string& title, const std::string& words);

  /// Runs `scene` with `options` in virtual time, writes NAME.html, and lists it with `words`. If
  /// there is no page, because the scene is rejected or a library of the pages is not installed,
  /// the list gives the reason. The error names a file that cannot be written.
  driver::Result<void> add(const std::filesystem::path& scene, const std::string& name,
                           const std::string& words, const session::SessionOptions& options = {});
  /// Lists a file of the folder with `words`, without a page.
  void list(const std::string& file, const std::string& words);
  /// Writes index.html.
  driver::Result<void> write() const;

 private:
  std::filesystem::path folder_;
  std::string text_;
  std::uintmax_t bytes_ = 0;
};

}  // namespace thimble::studies

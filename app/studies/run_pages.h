#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "thimble/driver/result.h"
#include "thimble/session/session.h"

namespace thimble::studies {

/// The runs behind a study's figures, to be looked at: a page of each in the study's folder, and an
/// index.html there that lists and links them. Real-time: never from the servo thread.
class RunPages {
 public:
  /// Bytes of all pages together, after which no further one is written. [chosen: ten minutes of
  /// touch, and what mail still takes]
  static constexpr std::uintmax_t kBytesMost = 25'000'000;

  /// Lists runs in `folder`, which is there, under `title`; `words` say below it what they are.
  RunPages(std::filesystem::path folder, const std::string& title, const std::string& words);

  /// Runs `scene` as `options` say, on the virtual clock, writes NAME.html, and lists it with
  /// `words`. Where there is no page, because the scene is refused or what pages are made of is not
  /// installed, the list says why. The error says which file cannot be written.
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

#include "view/start/thumbnails.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "text_file.h"
#include "text_hash.h"
#include "user_folders.h"
#include "view/gl/picture_file.h"

namespace thimble::view {
namespace {

namespace fs = std::filesystem;

driver::Result<GlTexture> load_texture(const fs::path& file) {
  const auto picture = read_png(file);
  if (!picture) return picture.error();
  GlTexture texture;
  glBindTexture(GL_TEXTURE_2D, *texture);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, picture->width, picture->height, 0, GL_RGB,
               GL_UNSIGNED_BYTE, picture->rgb.data());
  glGenerateMipmap(GL_TEXTURE_2D);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  return texture;
}

}  // namespace

fs::path drawn_picture(const StartEntry& entry) {
  const fs::path& scene = entry.scene;
  const std::string text = scene::text_of(scene);
  if (text.empty()) return {};
  std::error_code status;
  const auto mesh = entry.kind == FileKind::kMesh
                        ? fs::last_write_time(entry.file, status).time_since_epoch().count()
                        : 0;
  const std::string key = fmt::format("{} {} {}", scene.string(), mesh, text);
  return scene::cache_folder() / "pictures" /
         fmt::format("{}-{:016x}.png", scene::as_file_name(scene.stem().string()),
                     scene::text_hash(key));
}

const fs::path& Thumbnails::known_picture(const StartEntry& entry) {
  std::error_code status;
  const auto time = fs::last_write_time(entry.scene, status);
  Known& known = known_[entry.scene];
  if (status) {
    known = {};
  } else if (known.picture.empty() || known.time != time) {
    const fs::path stored = stored_picture(entry.scene);
    known = {time, stored.empty() ? drawn_picture(entry) : stored};
  }
  return known.picture;
}

GLuint Thumbnails::texture(const StartEntry& entry) {
  if (entry.scene.empty()) return 0;
  const fs::path& picture = known_picture(entry);
  if (picture.empty() || unreadable_.contains(picture)) return 0;
  if (const auto found = textures_.find(picture); found != textures_.end()) return *found->second;
  std::error_code status;
  if (fs::exists(picture, status)) {
    auto loaded = load_texture(picture);
    if (loaded) {
      return *textures_.emplace(picture, std::move(loaded).value()).first->second;
    }
    unreadable_.insert(picture);
    return 0;
  }
  const std::pair wanted(entry.scene, picture);
  if (picture != drawn_ && std::find(missing_.begin(), missing_.end(), wanted) == missing_.end()) {
    missing_.push_back(wanted);
  }
  return 0;
}

void Thumbnails::step() {
  if (process_) {
    const auto code = process_->ended();
    if (!code) return;
    if (*code != 0) unreadable_.insert(drawn_);
    process_.reset();
    drawn_.clear();
  }
  if (missing_.empty()) return;
  const auto [scene, picture] = missing_.front();
  missing_.erase(missing_.begin());
  std::error_code status;
  fs::create_directories(picture.parent_path(), status);
  // The file may have changed since.
  const auto now = known_.find(scene);
  if (now == known_.end() || now->second.picture != picture) return;
  std::error_code unknown;
  const fs::path program = fs::read_symlink("/proc/self/exe", unknown);
  auto started = ChildProcess::start(
      program,
      {"shot", scene.string(), "--size", "320x240", "--no-caption", "--output", picture.string()},
      {.quiet = true, .nice = 10});
  if (!started) {
    unreadable_.insert(picture);
    return;
  }
  drawn_ = picture;
  process_ = std::move(started).value();
}

}  // namespace thimble::view

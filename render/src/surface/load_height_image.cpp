#include <png.h>
#include <unistd.h>

#include <csetjmp>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>

#include "surface/height_image.h"
#include "system/regular_file.h"

namespace thimble::render {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

/// A decoded PNG: one 16-bit grey value per pixel, rows from the top.
struct Picture {
  std::size_t width = 0, height = 0;
  std::vector<png_uint_16> grey;
  std::vector<png_bytep> rows;
};

/// Frees libpng's memory, also after libpng has jumped back.
class PngReader {
 public:
  PngReader() : png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, this, &fail, &ignore)) {
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
  }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }

  /// Reads size and kind and requests 16-bit grey. Returns false and sets the message if libpng
  /// fails.
  // No object with a destructor may be in a frame that libpng jumps over, so each step is a
  // separate function.
  bool begin(std::FILE* file) {
    if (png_ == nullptr || info_ == nullptr) return false;
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_init_io(png_, file);
    png_set_user_limits(png_, HeightImage::kSideMax, HeightImage::kSideMax);
    png_read_info(png_, info_);
    png_set_expand_16(png_);
    png_set_strip_alpha(png_);
    // Colours are not refused: libpng's default weights convert them to grey.
    png_set_rgb_to_gray(png_, PNG_ERROR_ACTION_NONE, PNG_RGB_TO_GRAY_DEFAULT,
                        PNG_RGB_TO_GRAY_DEFAULT);
    png_set_swap(png_);  // the file has the high byte first
    png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    return true;
  }
  std::size_t width() const { return png_get_image_width(png_, info_); }
  std::size_t height() const { return png_get_image_height(png_, info_); }
  std::size_t row_bytes() const { return png_get_rowbytes(png_, info_); }

  bool read(Picture& picture) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_read_image(png_, picture.rows.data());
    png_read_end(png_, nullptr);
    return true;
  }

  const char* message() const { return message_; }

 private:
  [[noreturn]] static void fail(png_structp png, png_const_charp text) {
    auto* self = static_cast<PngReader*>(png_get_error_ptr(png));
    std::snprintf(self->message_, sizeof self->message_, "%s", text);
    png_longjmp(png, 1);
  }
  static void ignore(png_structp, png_const_charp) {}

  png_structp png_;
  png_infop info_ = nullptr;
  char message_[200] = "libpng could not be initialised";
};

driver::Error broken(const std::filesystem::path& file, const std::string& why) {
  return driver::Error{file.string() + ": not a readable image (" + why +
                       "); expected a PNG of at most 2048 by 2048 pixels"};
}

}  // namespace

driver::Result<HeightImage> HeightImage::load(const std::filesystem::path& file) {
  // Sixteen bits of every colour and of transparency, uncompressed, plus other contents of a file.
  constexpr std::uint64_t kMaxBytes = 8 * kSideMax * kSideMax + 30'000'000;
  auto regular = driver::RegularFile::open(file);
  if (!regular) return driver::Error{file.string() + ": " + regular.error().message};
  if (regular->size() > kMaxBytes) return broken(file, "it is larger than 64 MB");
  const int descriptor = regular->release();
  const std::unique_ptr<std::FILE, CloseFile> stream(fdopen(descriptor, "rb"));
  if (!stream) {
    close(descriptor);
    return broken(file, "it cannot be opened");
  }
  PngReader reader;
  if (!reader.begin(stream.get())) return broken(file, reader.message());
  Picture picture{.width = reader.width(), .height = reader.height(), .grey = {}, .rows = {}};
  if (reader.row_bytes() != 2 * picture.width) return broken(file, "its pixels are not grey");
  picture.grey.resize(picture.width * picture.height);
  for (std::size_t row = 0; row < picture.height; ++row) {
    picture.rows.push_back(reinterpret_cast<png_bytep>(&picture.grey[row * picture.width]));
  }
  if (!reader.read(picture)) return broken(file, reader.message());
  std::vector<float> values;
  values.reserve(picture.grey.size());
  for (std::size_t row = picture.height; row-- > 0;) {
    for (std::size_t column = 0; column < picture.width; ++column) {
      values.push_back(static_cast<float>(picture.grey[row * picture.width + column]) / 65535);
    }
  }
  return HeightImage(picture.width, picture.height, std::move(values));
}

}  // namespace thimble::render

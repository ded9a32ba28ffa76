#include "view/gl/picture_file.h"

#include <fcntl.h>
#include <png.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <vector>

#include "system/regular_file.h"
#include "view/gl/colour_table.h"

namespace thimble::view {
namespace {

/// Returns libpng's description of a picture.
png_image image_of(const Picture& picture, png_uint_32 format) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(picture.width);
  image.height = static_cast<png_uint_32>(picture.height);
  image.format = format;
  return image;
}

}  // namespace

driver::Result<void> write_png(const Picture& picture, const std::filesystem::path& file,
                               PngColours colours) {
  auto target = output::OutputFile::open(file, output::kPng);
  if (!target) return target.error();
  std::FILE* const out = write_stream(*target);
  if (out == nullptr) return driver::Error{file.string() + " cannot be written."};
  int written = 0;
  if (colours == PngColours::kAll) {
    png_image image = image_of(picture, PNG_FORMAT_RGB);
    written = png_image_write_to_stdio(&image, out, 0, picture.rgb.data(), 0, nullptr);
  } else {
    const ColourTable table({&picture});
    const std::vector<std::uint8_t> numbers = table.numbers(picture);
    png_image image = image_of(picture, PNG_FORMAT_RGB_COLORMAP);
    image.colormap_entries = static_cast<png_uint_32>(table.colours().size());
    written = png_image_write_to_stdio(&image, out, 0, numbers.data(), 0, table.colours().data());
  }
  const bool closed = std::fclose(out) == 0;
  if (written == 0 || !closed) {
    return driver::Error{file.string() + " cannot be written. Check that the disk has room."};
  }
  return target->commit();
}

std::FILE* write_stream(const output::OutputFile& file) {
  const int copy = fcntl(file.descriptor(), F_DUPFD_CLOEXEC, 3);
  if (copy < 0) return nullptr;
  std::FILE* const stream = fdopen(copy, "wb");
  if (stream == nullptr) close(copy);
  return stream;
}

driver::Result<Picture> read_png(const std::filesystem::path& file) {
  constexpr std::uint64_t kMaxBytes = 64'000'000;
  constexpr png_uint_32 kMaxSide = 16384;
  const auto bytes = driver::read_file(file, kMaxBytes);
  if (!bytes) return driver::Error{file.string() + ": " + bytes.error().message};
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&image, bytes->data(), bytes->size()) == 0) {
    return driver::Error{file.string() + ": " + image.message + "."};
  }
  if (image.width > kMaxSide || image.height > kMaxSide) {
    png_image_free(&image);
    return driver::Error{file.string() + ": the picture is larger than 16384 x 16384 pixels."};
  }
  image.format = PNG_FORMAT_RGB;
  Picture picture{static_cast<int>(image.width), static_cast<int>(image.height),
                  std::vector<std::uint8_t>(PNG_IMAGE_SIZE(image))};
  if (png_image_finish_read(&image, nullptr, picture.rgb.data(), 0, nullptr) == 0) {
    return driver::Error{file.string() + ": " + image.message + "."};
  }
  return picture;
}

}  // namespace thimble::view

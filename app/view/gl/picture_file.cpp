#include "view/gl/picture_file.h"

#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <string_view>

#include "view/gl/colour_table.h"

namespace thimble::app::view {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Writes the chunks of a PNG file, animated or not [PNG 3rd edition, W3C]. Written here, for the
/// system's libpng knows no animations.
class PngChunks {
 public:
  explicit PngChunks(const std::filesystem::path& file) : out_(file, std::ios::binary) {
    out_.write("\x89PNG\r\n\x1a\n", 8);
  }

  void begin(const char* name) { chunk_.assign(name, name + 4); }
  void add_byte(std::size_t value) { chunk_.push_back(static_cast<std::uint8_t>(value)); }
  void add_short(std::size_t value) {
    add_byte(value >> 8U);
    add_byte(value);
  }
  void add(std::size_t value) {
    add_short(value >> 16U);
    add_short(value);
  }
  void add(const Bytes& bytes) { chunk_.insert(chunk_.end(), bytes.begin(), bytes.end()); }
  void end() {
    const auto sum = crc32(0, chunk_.data(), static_cast<uInt>(chunk_.size()));
    write_number(chunk_.size() - 4);
    out_.write(reinterpret_cast<const char*>(chunk_.data()),
               static_cast<std::streamsize>(chunk_.size()));
    write_number(sum);
  }
  bool good() {
    out_.flush();
    return out_.good();
  }

 private:
  void write_number(std::size_t value) {
    for (unsigned shift = 32; shift > 0;) {
      shift -= 8;
      out_.put(static_cast<char>((value >> shift) & 255U));
    }
  }

  std::ofstream out_;
  Bytes chunk_;
};

/// Is a part of a picture, in bytes of one or three a pixel.
struct Part {
  int x = 0, y = 0, width = 0, height = 0;
};

/// Packs the rows of a part: numbers of colours as they are, colours as differences upward.
Bytes pack(const Bytes& pixels, int picture_width, std::size_t bytes, const Part& part) {
  Bytes rows;
  const auto at = [&](int x, int y) {
    return bytes * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture_width) +
                    static_cast<std::size_t>(x));
  };
  const std::size_t length = bytes * static_cast<std::size_t>(part.width);
  for (int y = part.y; y < part.y + part.height; ++y) {
    const bool up = bytes == 3 && y > part.y;
    rows.push_back(up ? 2 : 0);
    for (std::size_t i = 0; i < length; ++i) {
      const int before = up ? pixels[at(part.x, y - 1) + i] : 0;
      rows.push_back(static_cast<std::uint8_t>(pixels[at(part.x, y) + i] - before));
    }
  }
  uLongf size = compressBound(static_cast<uLong>(rows.size()));
  Bytes packed(size);
  compress2(packed.data(), &size, rows.data(), static_cast<uLong>(rows.size()), 9);
  packed.resize(size);
  return packed;
}

void write_head(PngChunks& chunks, const Picture& picture, std::size_t colour_type) {
  chunks.begin("IHDR");
  chunks.add(static_cast<std::size_t>(picture.width));
  chunks.add(static_cast<std::size_t>(picture.height));
  for (const std::size_t value :
       {std::size_t{8}, colour_type, std::size_t{0}, std::size_t{0}, std::size_t{0}})
    chunks.add_byte(value);
  chunks.end();
}

void write_colours(PngChunks& chunks, const ColourTable& table) {
  chunks.begin("PLTE");
  for (const auto& colour : table.colours()) chunks.add(Bytes(colour.begin(), colour.end()));
  chunks.end();
}

void write_data(PngChunks& chunks, const Bytes& packed) {
  chunks.begin("IDAT");
  chunks.add(packed);
  chunks.end();
}

void write_end(PngChunks& chunks) {
  chunks.begin("IEND");
  chunks.end();
}

driver::Result<void> finish(PngChunks& chunks, const std::filesystem::path& file) {
  write_end(chunks);
  if (!chunks.good()) return driver::Error{file.string() + " cannot be written."};
  return {};
}

/// Finds the smallest part outside which two pictures are the same; one pixel if all is.
Part difference(const Bytes& before, const Bytes& now, int width, int height) {
  Part part{width, height, 0, 0};
  int right = -1;
  int bottom = -1;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                     static_cast<std::size_t>(x);
      if (before[i] == now[i]) continue;
      part.x = std::min(part.x, x);
      part.y = std::min(part.y, y);
      right = std::max(right, x);
      bottom = std::max(bottom, y);
    }
  }
  if (right < 0) return {0, 0, 1, 1};
  part.width = right - part.x + 1;
  part.height = bottom - part.y + 1;
  return part;
}

}  // namespace

driver::Result<void> write_png(const Picture& picture, const std::filesystem::path& file,
                               PngColours colours) {
  PngChunks chunks(file);
  const Part all{0, 0, picture.width, picture.height};
  if (colours == PngColours::kAll) {
    write_head(chunks, picture, 2);
    write_data(chunks, pack(picture.rgb, picture.width, 3, all));
  } else {
    const ColourTable table({&picture});
    write_head(chunks, picture, 3);
    write_colours(chunks, table);
    write_data(chunks, pack(table.numbers(picture), picture.width, 1, all));
  }
  return finish(chunks, file);
}

driver::Result<void> write_animated_png(const std::vector<Picture>& pictures, double frame_time,
                                        const std::filesystem::path& file) {
  std::vector<const Picture*> all;
  all.reserve(pictures.size());
  for (const Picture& picture : pictures) all.push_back(&picture);
  const ColourTable table(all);
  PngChunks chunks(file);
  write_head(chunks, pictures[0], 3);
  write_colours(chunks, table);
  chunks.begin("acTL");
  chunks.add(pictures.size());
  chunks.add(0);  // for ever
  chunks.end();
  std::size_t number = 0;
  Bytes before;
  for (const Picture& picture : pictures) {
    const Bytes now = table.numbers(picture);
    const Part part = before.empty() ? Part{0, 0, picture.width, picture.height}
                                     : difference(before, now, picture.width, picture.height);
    chunks.begin("fcTL");
    chunks.add(number++);
    for (const int value : {part.width, part.height, part.x, part.y}) {
      chunks.add(static_cast<std::size_t>(value));
    }
    chunks.add_short(static_cast<std::size_t>(std::lround(frame_time * 1000)));
    chunks.add_short(1000);
    chunks.add_byte(0);  // what was drawn stays ...
    chunks.add_byte(0);  // ... and is covered
    chunks.end();
    const Bytes packed = pack(now, picture.width, 1, part);
    if (before.empty()) {
      write_data(chunks, packed);
    } else {
      chunks.begin("fdAT");
      chunks.add(number++);
      chunks.add(packed);
      chunks.end();
    }
    before = now;
  }
  return finish(chunks, file);
}

driver::Result<Picture> read_png(const std::filesystem::path& file) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&image, file.c_str()) == 0) {
    return driver::Error{file.string() + ": " + image.message + "."};
  }
  image.format = PNG_FORMAT_RGB;
  Picture picture{static_cast<int>(image.width), static_cast<int>(image.height),
                  std::vector<std::uint8_t>(PNG_IMAGE_SIZE(image))};
  if (png_image_finish_read(&image, nullptr, picture.rgb.data(), 0, nullptr) == 0) {
    return driver::Error{file.string() + ": " + image.message + "."};
  }
  return picture;
}

}  // namespace thimble::app::view

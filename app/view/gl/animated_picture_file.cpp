#include "view/gl/animated_picture_file.h"

#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csetjmp>
#include <cstdint>
#include <cstdio>
#include <memory>

#include "view/gl/colour_table.h"
#include "view/gl/picture_file.h"

// An animated PNG [PNG 3rd edition, W3C] is a PNG with additional chunks: one with the number of
// pictures, and for each picture its place and its pixels. The system's libpng writes the file and
// its chunks, but does not know these.

namespace thimble::view {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// A chunk of the file.
struct Chunk {
  std::array<png_byte, 4> name{};
  Bytes data;

  explicit Chunk(const char* called) { std::copy_n(called, 4, name.begin()); }
  void add_byte(std::size_t value) { data.push_back(static_cast<std::uint8_t>(value)); }
  void add_short(std::size_t value) {
    add_byte(value >> 8U);
    add_byte(value);
  }
  void add(std::size_t value) {
    add_short(value >> 16U);
    add_short(value);
  }
  void add(const Bytes& bytes) { data.insert(data.end(), bytes.begin(), bytes.end()); }
};

/// Part of a picture, pixels.
struct Part {
  int x = 0, y = 0, width = 0, height = 0;
};

/// Compresses the rows of a part, as colour indices.
Bytes pack(const Bytes& numbers, int picture_width, const Part& part) {
  Bytes rows;
  for (int y = part.y; y < part.y + part.height; ++y) {
    rows.push_back(0);  // no filter: neighbouring indices are unrelated
    const auto from = numbers.begin() + static_cast<std::ptrdiff_t>(y) * picture_width + part.x;
    rows.insert(rows.end(), from, from + part.width);
  }
  uLongf size = compressBound(static_cast<uLong>(rows.size()));
  Bytes packed(size);
  compress2(packed.data(), &size, rows.data(), static_cast<uLong>(rows.size()), 9);
  packed.resize(size);
  return packed;
}

/// Returns the smallest part that contains all differences of two pictures; one pixel if they are
/// equal.
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

/// Duration of a picture, s, as a fraction in the file.
struct DelayFraction {
  std::size_t numerator = 1;
  std::size_t denominator = 1;
};

/// Returns the delay of picture `i`: exact for a whole number of pictures a second. Otherwise it is
/// rounded so that the sum of all delays up to each picture is within half a tenth of a
/// millisecond.
DelayFraction delay_of(double frame_time, std::size_t i) {
  constexpr double kPerSecond = 10'000;
  const double pace = 1 / frame_time;
  if (std::abs(pace - std::round(pace)) < 1e-9 * pace && pace < 65'536) {
    return {1, static_cast<std::size_t>(std::lround(pace))};
  }
  const auto until = [&](std::size_t pictures) {
    return std::llround(kPerSecond * frame_time * static_cast<double>(pictures));
  };
  return {static_cast<std::size_t>(until(i + 1) - until(i)), static_cast<std::size_t>(kPerSecond)};
}

std::vector<Chunk> chunks_of(const std::vector<Picture>& pictures, double frame_time,
                             const ColourTable& table) {
  std::vector<Chunk> chunks;
  Chunk& animation = chunks.emplace_back("acTL");
  animation.add(pictures.size());
  animation.add(std::size_t{0});  // repeat forever
  std::size_t number = 0, shown = 0;
  Bytes before;
  for (const Picture& picture : pictures) {
    Bytes now = table.numbers(picture);
    const Part part = before.empty() ? Part{0, 0, picture.width, picture.height}
                                     : difference(before, now, picture.width, picture.height);
    Chunk& place = chunks.emplace_back("fcTL");
    place.add(number++);
    for (const int value : {part.width, part.height, part.x, part.y}) {
      place.add(static_cast<std::size_t>(value));
    }
    const DelayFraction delay = delay_of(frame_time, shown++);
    place.add_short(delay.numerator);
    place.add_short(delay.denominator);
    place.add_byte(0);  // keep the previous picture
    place.add_byte(0);  // and draw over it
    Chunk& pixels = chunks.emplace_back(before.empty() ? "IDAT" : "fdAT");
    if (!before.empty()) pixels.add(number++);
    pixels.add(pack(now, picture.width, part));
    before = std::move(now);
  }
  chunks.emplace_back("IEND");
  return chunks;
}

/// libpng's state for writing a file.
class PngFile {
 public:
  PngFile() : png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, &ignore)) {
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
  }
  PngFile(const PngFile&) = delete;
  PngFile& operator=(const PngFile&) = delete;
  ~PngFile() { png_destroy_write_struct(&png_, &info_); }

  /// Writes the file. libpng reports errors by longjmp, so no local variable here may need a
  /// destructor.
  bool write(std::FILE* file, const Picture& first, const ColourTable& table,
             const std::vector<Chunk>& chunks) {
    if (png_ == nullptr || info_ == nullptr) return false;
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_init_io(png_, file);
    png_set_IHDR(png_, info_, static_cast<png_uint_32>(first.width),
                 static_cast<png_uint_32>(first.height), 8, PNG_COLOR_TYPE_PALETTE,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    std::array<png_color, PNG_MAX_PALETTE_LENGTH> colours;
    for (std::size_t i = 0; i < table.colours().size(); ++i) {
      const auto& [red, green, blue] = table.colours()[i];
      colours[i] = {red, green, blue};
    }
    png_set_PLTE(png_, info_, colours.data(), static_cast<int>(table.colours().size()));
    png_write_info(png_, info_);
    for (const Chunk& chunk : chunks) {
      png_write_chunk(png_, chunk.name.data(), chunk.data.data(), chunk.data.size());
    }
    return true;
  }

 private:
  static void ignore(png_structp, png_const_charp) {}

  png_structp png_;
  png_infop info_ = nullptr;
};

}  // namespace

driver::Result<void> write_animated_png(const std::vector<Picture>& pictures, double frame_time,
                                        const std::filesystem::path& file) {
  std::vector<const Picture*> all;
  all.reserve(pictures.size());
  for (const Picture& picture : pictures) all.push_back(&picture);
  const ColourTable table(all);
  const std::vector<Chunk> chunks = chunks_of(pictures, frame_time, table);
  auto target = output::OutputFile::open(file, output::kPng);
  if (!target) return target.error();
  std::FILE* const out = write_stream(*target);
  const bool written = out != nullptr && PngFile().write(out, pictures[0], table, chunks);
  const bool closed = out != nullptr && std::fclose(out) == 0;
  if (!written || !closed) {
    return driver::Error{file.string() + " cannot be written. Check that the disk has room."};
  }
  return target->commit();
}

}  // namespace thimble::view

#include "mesh/file/zip_entry.h"

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <optional>

namespace thimble::render {
namespace {

// Reads whole numbers, least byte first; 0 beyond the end.
class ZipNumbers {
 public:
  explicit ZipNumbers(std::string_view bytes) : bytes_(bytes) {}
  std::uint32_t at(std::size_t place, std::size_t size) const {
    std::uint32_t number = 0;
    for (std::size_t i = size; i-- > 0;) {
      const std::size_t here = place + i;
      const auto byte =
          here < bytes_.size() ? static_cast<unsigned char>(bytes_[here]) : std::uint8_t{0};
      number = number << 8 | byte;
    }
    return number;
  }

 private:
  std::string_view bytes_;
};

struct ZipEntry {
  std::uint32_t method = 0, packed = 0, place = 0;
};

std::optional<ZipEntry> find_entry(std::string_view archive, std::string_view ending) {
  const std::size_t end = archive.rfind("PK\5\6");
  if (end == std::string_view::npos) return {};
  const ZipNumbers numbers(archive);
  std::size_t at = numbers.at(end + 16, 4);
  const std::uint32_t count = numbers.at(end + 10, 2);
  for (std::uint32_t i = 0; i < count; ++i) {
    if (at >= archive.size() || archive.substr(at, 4) != "PK\1\2") return {};
    const std::size_t name = numbers.at(at + 28, 2);
    if (archive.substr(at + 46, name).ends_with(ending)) {
      return ZipEntry{numbers.at(at + 10, 2), numbers.at(at + 20, 4), numbers.at(at + 42, 4)};
    }
    at += 46 + name + numbers.at(at + 30, 2) + numbers.at(at + 32, 2);
  }
  return {};
}

std::string inflated(std::string_view packed, std::size_t most) {
  std::string bytes(most, '\0');
  z_stream stream{};
  if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) return {};
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_out = static_cast<uInt>(bytes.size());
  const int status = inflate(&stream, Z_SYNC_FLUSH);
  bytes.resize(stream.total_out);
  inflateEnd(&stream);
  return status == Z_OK || status == Z_STREAM_END || status == Z_BUF_ERROR ? bytes : std::string();
}

}  // namespace

std::string begin_of_zip_entry(std::string_view archive, std::string_view ending,
                               std::size_t most) {
  if (archive.size() > UINT32_MAX) return {};
  const std::optional<ZipEntry> entry = find_entry(archive, ending);
  if (!entry || entry->place >= archive.size()) return {};
  const ZipNumbers numbers(archive);
  const std::size_t data =
      entry->place + 30 + numbers.at(entry->place + 26, 2) + numbers.at(entry->place + 28, 2);
  if (data >= archive.size()) return {};
  const std::string_view packed = archive.substr(data, entry->packed);
  if (entry->method == 0) return std::string(packed.substr(0, most));
  return entry->method == Z_DEFLATED ? inflated(packed, most) : std::string();
}

}  // namespace thimble::render

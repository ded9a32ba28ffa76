#include "mesh/file/package/zip_archive.h"

#include <zlib.h>

#include <algorithm>
#include <cctype>
#include <limits>

namespace thimble::render {
namespace {

using driver::Error;

// Value in the directory if the number is in a ZIP64 field.
constexpr std::uint64_t kInZip64 = 0xffffffff;

// Maximum growth of a byte of deflated data [RFC 1951].
constexpr std::uint64_t kGrowthMax = 1032;

// Reads little-endian integers; 0 beyond the end.
std::uint64_t number_at(std::string_view bytes, std::size_t place, std::size_t size) {
  std::uint64_t number = 0;
  for (std::size_t i = size; i-- > 0;) {
    const std::size_t here = place + i;
    number = number << 8 | (here < bytes.size() ? static_cast<unsigned char>(bytes[here]) : 0);
  }
  return number;
}

bool same_name(std::string_view a, std::string_view b) {
  const auto small = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](char x, char y) { return small(x) == small(y); });
}

driver::Result<std::string> inflated(std::string_view packed, std::uint64_t size) {
  if (packed.size() > std::numeric_limits<uInt>::max() || size > std::numeric_limits<uInt>::max() ||
      size > kGrowthMax * packed.size() + kGrowthMax) {
    return Error{"is damaged: a file in it cannot have the declared size"};
  }
  std::string bytes(size, '\0');
  z_stream stream{};
  if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) return Error{"cannot be unpacked"};
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_out = static_cast<uInt>(bytes.size());
  const int status = inflate(&stream, Z_FINISH);
  const bool whole = status == Z_STREAM_END && stream.total_out == size;
  inflateEnd(&stream);
  if (!whole) return Error{"is damaged: a file in it cannot be unpacked"};
  return bytes;
}

}  // namespace

driver::Result<ZipArchive> ZipArchive::open(std::string_view bytes) {
  ZipArchive archive(bytes);
  const std::size_t end = bytes.rfind("PK\5\6");
  if (end == std::string_view::npos) return Error{"has no directory: it is truncated"};
  std::uint64_t at = number_at(bytes, end + 16, 4);
  std::uint64_t count = number_at(bytes, end + 10, 2);
  constexpr std::size_t kLocator = 20;  // bytes of the ZIP64 locator, right before the end
  if (end >= kLocator && bytes.substr(end - kLocator, 4) == "PK\6\7") {
    const std::uint64_t record = number_at(bytes, end - kLocator + 8, 8);
    if (record < bytes.size() && bytes.substr(record, 4) == "PK\6\6") {
      count = number_at(bytes, record + 32, 8);
      at = number_at(bytes, record + 48, 8);
    }
  }
  for (std::uint64_t i = 0; i < count; ++i) {
    if (at >= bytes.size() || bytes.substr(at, 4) != "PK\1\2") {
      return Error{"has a damaged directory"};
    }
    const std::size_t name = number_at(bytes, at + 28, 2);
    const std::size_t extra = number_at(bytes, at + 30, 2);
    Entry entry{.name = std::string(bytes.substr(std::min(at + 46, bytes.size()), name)),
                .flags = number_at(bytes, at + 8, 2),
                .method = number_at(bytes, at + 10, 2),
                .packed = number_at(bytes, at + 20, 4),
                .size = number_at(bytes, at + 24, 4),
                .place = number_at(bytes, at + 42, 4)};
    for (std::size_t field = at + 46 + name; field + 4 <= at + 46 + name + extra;) {
      const std::size_t length = number_at(bytes, field + 2, 2);
      if (number_at(bytes, field, 2) == 1) {
        std::size_t next = field + 4;
        for (std::uint64_t* number : {&entry.size, &entry.packed, &entry.place}) {
          if (*number != kInZip64) continue;
          *number = number_at(bytes, next, 8);
          next += 8;
        }
      }
      field += 4 + length;
    }
    archive.entries_.push_back(std::move(entry));
    at += 46 + name + extra + number_at(bytes, at + 32, 2);
  }
  return archive;
}

std::vector<std::string> ZipArchive::names() const {
  std::vector<std::string> names;
  for (const Entry& entry : entries_) names.push_back(entry.name);
  return names;
}

const ZipArchive::Entry* ZipArchive::find(std::string_view name) const {
  if (name.starts_with('/')) name.remove_prefix(1);
  const auto found = std::find_if(entries_.begin(), entries_.end(), [name](const Entry& entry) {
    return same_name(entry.name, name);
  });
  return found == entries_.end() ? nullptr : &*found;
}

driver::Result<std::string> ZipArchive::read(std::string_view name) const {
  const Entry* const entry = find(name);
  if (entry == nullptr) return Error{"has no file " + std::string(name)};
  if ((entry->flags & 1) != 0) return Error{"is encrypted"};
  if (entry->place >= bytes_.size() || bytes_.substr(entry->place, 4) != "PK\3\4") {
    return Error{"is damaged: a file in it is not at the offset given in the directory"};
  }
  const std::uint64_t data = entry->place + 30 + number_at(bytes_, entry->place + 26, 2) +
                             number_at(bytes_, entry->place + 28, 2);
  if (data > bytes_.size() || entry->packed > bytes_.size() - data) {
    return Error{"is truncated"};
  }
  const std::string_view packed = bytes_.substr(data, entry->packed);
  if (entry->method == 0) return std::string(packed);
  if (entry->method != Z_DEFLATED) {
    return Error{"uses an unsupported compression (method " + std::to_string(entry->method) + ")"};
  }
  return inflated(packed, entry->size);
}

}  // namespace thimble::render

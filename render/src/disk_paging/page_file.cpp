#include "disk_paging/page_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

#include "compact_mesh/surface_rise.h"
#include "disk_paging/checksum.h"
#include "system/regular_file.h"

namespace thimble::render {
namespace {

static_assert(std::endian::native == std::endian::little, "Page files are little endian.");
static_assert(std::is_trivially_copyable_v<PackedTriangle>);

constexpr std::array<char, 8> kMagic{'T', 'H', 'M', 'B', 'P', 'A', 'G', 'E'};
constexpr std::uint32_t kVersion = 2;
constexpr std::int64_t kAlignment =
    4096;  // alignment of the packed triangles, so that a page covers whole disk pages

struct Header {
  std::array<char, 8> magic = kMagic;
  std::uint32_t version = kVersion;
  std::uint32_t triangle_bytes = sizeof(PackedTriangle);
  std::uint32_t page_triangles = kPageTriangles;
  std::uint32_t sum = 0;  // of all data before the pages, computed while this is 0
  std::int64_t triangle_count = 0;
  std::array<double, 3> origin{};
  double step = 0;
  double rise = 0;  // m
};
static_assert(sizeof(Header) == 72);

std::uint32_t sum_of(Header header, const std::vector<PageBox>& boxes,
                     const std::vector<std::uint64_t>& sums) {
  header.sum = 0;
  std::uint64_t sum = checksum(std::as_bytes(std::span(&header, 1)));
  sum = checksum(std::as_bytes(std::span(boxes)), sum);
  sum = checksum(std::as_bytes(std::span(sums)), sum);
  return static_cast<std::uint32_t>(sum ^ (sum >> 32));
}

std::uint64_t sum_of(std::span<const PackedTriangle> triangles) {
  return checksum(std::as_bytes(triangles));
}

std::int64_t pages_of(std::int64_t triangles) {
  return (triangles + kPageTriangles - 1) / kPageTriangles;
}

std::int64_t records_begin(std::int64_t pages) {
  const std::int64_t end =
      static_cast<std::int64_t>(sizeof(Header)) +
      pages * static_cast<std::int64_t>(sizeof(PageBox) + sizeof(std::uint64_t));
  return (end + kAlignment - 1) / kAlignment * kAlignment;
}

bool write_all(int descriptor, const void* data, std::size_t size, std::int64_t at) noexcept {
  const char* bytes = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = pwrite(descriptor, bytes, size, at);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes += written;
    at += written;
    size -= static_cast<std::size_t>(written);
  }
  return true;
}

bool read_all(int descriptor, void* data, std::size_t size, std::int64_t at) noexcept {
  char* bytes = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t got = pread(descriptor, bytes, size, at);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    bytes += got;
    at += got;
    size -= static_cast<std::size_t>(got);
  }
  return true;
}

driver::Error file_error(const std::filesystem::path& file, const std::string& what) {
  return driver::Error{file.string() + ": " + what};
}

float down(double value) noexcept {
  return std::nextafter(static_cast<float>(value), -std::numeric_limits<float>::infinity());
}

float up(double value) noexcept {
  return std::nextafter(static_cast<float>(value), std::numeric_limits<float>::infinity());
}

/// Returns whether a box is possible for packed triangles, whose corners are integers of 32 bits.
bool can_be(const PageBox& box) {
  constexpr float kFarthest = 0x1p31F;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!(-2 * kFarthest <= box.min[axis] && box.min[axis] <= box.max[axis] &&
          box.max[axis] <= 2 * kFarthest)) {
      return false;
    }
  }
  return true;
}

}  // namespace

PageBox box_of(std::span<const PackedTriangle> triangles) noexcept {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  PageBox box{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
  if (triangles.empty()) return box;
  // Bounds of each corner as integers. Rounding keeps their order, so it is done once at the end.
  using Corners = std::array<std::int32_t, 3>;
  std::array<Corners, 3> low{triangles[0].x, triangles[0].y, triangles[0].z};
  std::array<Corners, 3> high = low;
  const auto include = [](const Corners& x, Corners& least, Corners& greatest) noexcept {
    for (std::size_t k = 0; k < 3; ++k) {
      least[k] = std::min(least[k], x[k]);
      greatest[k] = std::max(greatest[k], x[k]);
    }
  };
  for (const PackedTriangle& packed : triangles) {
    include(packed.x, low[0], high[0]);
    include(packed.y, low[1], high[1]);
    include(packed.z, low[2], high[2]);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.min[axis] = down(*std::min_element(low[axis].begin(), low[axis].end()));
    box.max[axis] = up(*std::max_element(high[axis].begin(), high[axis].end()));
  }
  return box;
}

struct PageFileWriter::State {
  std::filesystem::path file;
  int descriptor = -1;
  Header header;
  std::int64_t written = 0;
  std::vector<PackedTriangle> page;
  std::vector<PageBox> boxes;
  std::vector<std::uint64_t> sums;

  ~State() {
    if (descriptor >= 0) close(descriptor);
  }

  bool flush() {
    if (page.empty()) return true;
    boxes.push_back(box_of(page));
    sums.push_back(sum_of(page));
    header.rise = std::max(header.rise, header.step * rise_above(page));
    const std::int64_t at = records_begin(pages_of(header.triangle_count)) +
                            (written - static_cast<std::int64_t>(page.size())) *
                                static_cast<std::int64_t>(sizeof(PackedTriangle));
    const bool done = write_all(descriptor, page.data(), page.size() * sizeof(PackedTriangle), at);
    page.clear();
    return done;
  }
};

PageFileWriter::PageFileWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}
PageFileWriter::PageFileWriter(PageFileWriter&&) noexcept = default;
PageFileWriter& PageFileWriter::operator=(PageFileWriter&&) noexcept = default;
PageFileWriter::~PageFileWriter() = default;

driver::Result<PageFileWriter> PageFileWriter::create(const std::filesystem::path& file,
                                                      const Lattice& lattice,
                                                      std::int64_t triangle_count) {
  if (triangle_count <= 0 || triangle_count > std::numeric_limits<std::int32_t>::max()) {
    return file_error(file, "a page file holds 1 to 2^31 - 1 triangles, not " +
                                std::to_string(triangle_count) + ".");
  }
  auto state = std::make_unique<State>();
  state->file = file;
  state->header.triangle_count = triangle_count;
  state->header.origin = {lattice.origin.x(), lattice.origin.y(), lattice.origin.z()};
  state->header.step = lattice.step;
  state->page.reserve(kPageTriangles);
  state->descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (state->descriptor < 0) {
    return file_error(file, std::string("it cannot be written (") + std::strerror(errno) + ").");
  }
  return PageFileWriter(std::move(state));
}

driver::Result<void> PageFileWriter::append(std::span<const PackedTriangle> triangles) {
  for (const PackedTriangle& packed : triangles) {
    state_->page.push_back(packed);
    ++state_->written;
    if (state_->page.size() == static_cast<std::size_t>(kPageTriangles) && !state_->flush()) {
      return file_error(state_->file,
                        std::string("writing failed (") + std::strerror(errno) + ").");
    }
  }
  return {};
}

driver::Result<void> PageFileWriter::finish() {
  State& state = *state_;
  if (state.written != state.header.triangle_count) {
    return file_error(state.file, std::to_string(state.written) + " triangles were written, but " +
                                      std::to_string(state.header.triangle_count) +
                                      " were announced.");
  }
  // The header is written last: an unfinished file is not a page file.
  const bool flushed = state.flush();
  const std::size_t boxes_size = state.boxes.size() * sizeof(PageBox);
  state.header.sum = sum_of(state.header, state.boxes, state.sums);
  if (!flushed || !write_all(state.descriptor, state.boxes.data(), boxes_size, sizeof(Header)) ||
      !write_all(state.descriptor, state.sums.data(), state.sums.size() * sizeof(std::uint64_t),
                 static_cast<std::int64_t>(sizeof(Header) + boxes_size)) ||
      !write_all(state.descriptor, &state.header, sizeof(Header), 0)) {
    return file_error(state.file, std::string("writing failed (") + std::strerror(errno) + ").");
  }
  return {};
}

driver::Result<void> write_page_file(const PackedSurface& surface,
                                     const std::filesystem::path& file) {
  auto writer =
      PageFileWriter::create(file, {surface.origin(), surface.step()}, surface.triangle_count());
  if (!writer) return writer.error();
  if (auto done = writer->append(surface.triangles()); !done) return done;
  return writer->finish();
}

bool is_page_file(const std::filesystem::path& file) {
  const std::string head = driver::read_head(file, kMagic.size());
  return std::equal(head.begin(), head.end(), kMagic.begin(), kMagic.end());
}

driver::Result<PageFile> PageFile::open(const std::filesystem::path& file) {
  PageFile opened;
  auto regular = driver::RegularFile::open(file);
  if (!regular) return file_error(file, regular.error().message);
  const auto file_bytes = static_cast<std::int64_t>(regular->size());
  opened.descriptor_ = regular->release();
  Header header;
  if (file_bytes < static_cast<std::int64_t>(sizeof(Header)) ||
      !read_all(opened.descriptor_, &header, sizeof(Header), 0) || header.magic != kMagic) {
    return file_error(file, "not a page file; create one with `thimble mesh page IN OUT`.");
  }
  const Header expected;
  if (header.version != kVersion || header.triangle_bytes != expected.triangle_bytes ||
      header.page_triangles != expected.page_triangles) {
    return file_error(file, "it was written by another version of Thimble; write it again.");
  }
  const bool numbers_can_be = header.triangle_count > 0 &&
                              header.triangle_count <= std::numeric_limits<std::int32_t>::max() &&
                              header.step > 0 && std::isfinite(header.step) && header.rise >= 0 &&
                              std::isfinite(header.rise) &&
                              std::all_of(header.origin.begin(), header.origin.end(),
                                          [](double x) { return std::isfinite(x); });
  if (!numbers_can_be) return file_error(file, "its header is damaged; write it again.");

  const std::int64_t pages = pages_of(header.triangle_count);
  opened.records_at_ = records_begin(pages);
  const std::int64_t size =
      opened.records_at_ +
      header.triangle_count * static_cast<std::int64_t>(sizeof(PackedTriangle));
  if (file_bytes < size) {
    return file_error(file, "it ends after " + std::to_string(file_bytes) + " of " +
                                std::to_string(size) + " bytes; write it again.");
  }
  opened.boxes_.resize(static_cast<std::size_t>(pages));
  opened.sums_.resize(static_cast<std::size_t>(pages));
  const std::size_t boxes_size = opened.boxes_.size() * sizeof(PageBox);
  if (!read_all(opened.descriptor_, opened.boxes_.data(), boxes_size, sizeof(Header)) ||
      !read_all(opened.descriptor_, opened.sums_.data(),
                opened.sums_.size() * sizeof(std::uint64_t),
                static_cast<std::int64_t>(sizeof(Header) + boxes_size))) {
    return file_error(file, "it could not be read.");
  }
  if (sum_of(header, opened.boxes_, opened.sums_) != header.sum) {
    return file_error(file, "its header is damaged; write it again.");
  }
  if (!std::all_of(opened.boxes_.begin(), opened.boxes_.end(), can_be)) {
    return file_error(file, "its boxes are damaged; write it again.");
  }
  opened.whole_ = opened.boxes_.front();
  for (const PageBox& box : opened.boxes_) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      opened.whole_.min[axis] = std::min(opened.whole_.min[axis], box.min[axis]);
      opened.whole_.max[axis] = std::max(opened.whole_.max[axis], box.max[axis]);
    }
  }
  opened.lattice_ = {{header.origin[0], header.origin[1], header.origin[2]}, header.step};
  opened.rise_ = header.rise;
  opened.triangle_count_ = static_cast<std::int32_t>(header.triangle_count);
  return opened;
}

PageFile::PageFile(PageFile&& other) noexcept {
  *this = std::move(other);
}

PageFile& PageFile::operator=(PageFile&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  std::swap(lattice_, other.lattice_);
  std::swap(triangle_count_, other.triangle_count_);
  std::swap(records_at_, other.records_at_);
  std::swap(rise_, other.rise_);
  std::swap(whole_, other.whole_);
  std::swap(boxes_, other.boxes_);
  std::swap(sums_, other.sums_);
  return *this;
}

PageFile::~PageFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

std::int32_t PageFile::read_page(std::int32_t page,
                                 std::span<PackedTriangle> triangles) const noexcept {
  const std::int32_t first = page * kPageTriangles;
  const std::int32_t count = std::min(kPageTriangles, triangle_count_ - first);
  if (page < 0 || count <= 0 || triangles.size() < static_cast<std::size_t>(count)) return 0;
  const std::int64_t at =
      records_at_ + std::int64_t{first} * static_cast<std::int64_t>(sizeof(PackedTriangle));
  if (!read_all(descriptor_, triangles.data(),
                static_cast<std::size_t>(count) * sizeof(PackedTriangle), at)) {
    return 0;
  }
  if (sum_of(triangles.first(static_cast<std::size_t>(count))) !=
      sums_[static_cast<std::size_t>(page)]) {
    return 0;
  }
  // The servo follows neighbours without a check: none may be outside the file.
  const auto end = static_cast<std::uint32_t>(triangle_count_);
  bool valid = true;
  for (std::int32_t i = 0; i < count; ++i) {
    for (const std::int32_t neighbour : triangles[static_cast<std::size_t>(i)].neighbours) {
      valid &= static_cast<std::uint32_t>(neighbour) < end;  // a negative one is large
    }
  }
  return valid ? count : 0;
}

void PageFile::announce_page(std::int32_t page) const noexcept {
  constexpr auto kBytes = static_cast<off_t>(kPageBytes);
  posix_fadvise(descriptor_, records_at_ + page * kBytes, kBytes, POSIX_FADV_WILLNEED);
}

}  // namespace thimble::render

#include "mesh/file/read_in_child.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <utility>
#include <vector>

namespace thimble::render {
namespace {

constexpr int kSecondsMin = 2;
constexpr std::size_t kBytesPerSecond = 500'000;
constexpr std::size_t kMemoryMin = std::size_t{1} << 30;
constexpr std::size_t kMemoryPerByte = 200;

// What the reading process hands over: a sentence that says why not, or what the file says and a
// mesh.
class Parcel {
 public:
  explicit Parcel(std::string bytes = {}) : bytes_(std::move(bytes)) {}

  template <class Item>
  void put(const Item* items, std::size_t count) {
    const std::uint64_t size = count;
    bytes_.append(reinterpret_cast<const char*>(&size), sizeof size);
    bytes_.append(reinterpret_cast<const char*>(items), count * sizeof(Item));
  }
  void put(const std::string& text) { put(text.data(), text.size()); }

  template <class Item>
  std::vector<Item> take() {
    std::uint64_t size = 0;
    std::memcpy(&size, bytes_.data() + at_, sizeof size);
    at_ += sizeof size;
    std::vector<Item> items(size);
    if (size > 0)
      std::memcpy(static_cast<void*>(items.data()), bytes_.data() + at_, size * sizeof(Item));
    at_ += size * sizeof(Item);
    return items;
  }
  std::string take_text() {
    const std::vector<char> text = take<char>();
    return {text.begin(), text.end()};
  }

  std::string& bytes() { return bytes_; }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
};

std::string parcel_of(const driver::Result<TriangleMesh>& mesh, const MeshFileInfo& info) {
  Parcel parcel;
  parcel.put(mesh ? std::string() : mesh.error().message);
  if (!mesh) return parcel.bytes();
  std::string lines;
  for (const std::string& note : info.notes) lines += note + '\n';
  parcel.put(lines);
  const double unit = info.unit.value_or(0);
  parcel.put(&unit, 1);
  parcel.put(&info.up, 1);
  parcel.put(mesh->vertices.data(), mesh->vertices.size());
  parcel.put(mesh->triangles.data(), mesh->triangles.size());
  return std::move(parcel.bytes());
}

}  // namespace

driver::ApartLimits limits_of(std::size_t bytes) {
  return {.seconds = kSecondsMin + static_cast<int>(bytes / kBytesPerSecond),
          .bytes = kMemoryMin + kMemoryPerByte * bytes};
}

driver::Error unreadable(const std::string& kind, const std::string& reason) {
  std::string capitals = kind;
  std::transform(capitals.begin(), capitals.end(), capitals.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return {"this is no " + capitals + " file that can be read (" + reason + ")."};
}

driver::Result<TriangleMesh> read_in_child(const MeshReader& read, const std::string& kind,
                                           const driver::ApartLimits& limits, MeshFileInfo& info) {
  auto done = driver::run_apart(
      [&read] {
        MeshFileInfo found;
        const auto mesh = read(found);
        return parcel_of(mesh, found);
      },
      limits);
  if (!done) return unreadable(kind, "it " + done.error().message);
  Parcel parcel(std::move(done).value());
  if (const std::string error = parcel.take_text(); !error.empty()) return driver::Error{error};
  std::istringstream lines(parcel.take_text());
  for (std::string line; std::getline(lines, line);) info.notes.push_back(line);
  if (const double unit = parcel.take<double>().at(0); unit > 0) info.unit = unit;
  info.up = parcel.take<char>().at(0);
  TriangleMesh mesh;
  mesh.vertices = parcel.take<Eigen::Vector3d>();
  mesh.triangles = parcel.take<std::array<std::int32_t, 3>>();
  return mesh;
}

}  // namespace thimble::render

#include "meshes/cache/mesh_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <utility>
#include <vector>

#include "log/logger.h"
#include "meshes/cache/cache_entry.h"
#include "meshes/cache/cache_folder.h"
#include "meshes/cache/content_hash.h"
#include "meshes/cache/entry_text.h"
#include "thimble/scene/build_info.h"

namespace thimble::scene {
namespace {

namespace fs = std::filesystem;

// Formats that Thimble reads by itself, each from one file.
constexpr std::array<std::string_view, 5> kStoredKinds{"OFF", "OBJ", "STL", "PLY", "3MF"};

std::string small_ending(const fs::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

std::string entry_description(const fs::path& file, std::size_t triangles, std::string_view what) {
  return fmt::format("{}, {} triangles, {}", file.filename().string(), triangles, what);
}

template <class T>
std::span<const std::byte> bytes_in(const std::vector<T>& array) {
  return std::as_bytes(std::span(array));
}

// Reads a whole array of an entry; false if it is damaged.
template <class Array>
bool read_array(const CacheEntry& entry, std::size_t number, Array& to) {
  constexpr std::size_t kSize = sizeof(typename Array::value_type);
  const std::uint64_t bytes = entry.bytes_of(number);
  if (bytes % kSize != 0) return false;
  to.resize(static_cast<std::size_t>(bytes / kSize));
  return entry.read(number, std::as_writable_bytes(std::span(to)));
}

bool names_its_vertices(const render::TriangleMesh& mesh) {
  const auto count = mesh.vertices.size();
  bool valid = !mesh.triangles.empty();
  for (const auto& triangle : mesh.triangles) {
    // A negative number is a very large one.
    for (const std::int32_t v : triangle) valid &= static_cast<std::uint32_t>(v) < count;
  }
  return valid;
}

void warn_unusable(const fs::path& file, const std::string& problem) {
  logger().warn("Mesh cache: {} {}; the mesh is prepared again.", file.string(), problem);
}

// Opens an entry; none if there is none that can be used.
std::optional<CacheEntry> open_entry(const fs::path& file, const std::string& key) {
  auto opened = CacheEntry::open(file, key);
  if (opened) return std::move(opened).value();
  warn_unusable(file, opened.error().message);
  return {};
}

std::string mesh_text_of(const SceneObject& object, const ObjectMesh& mesh,
                         const render::ChosenTracker& tracker) {
  EntryWriter text;
  text.add(entry_description(object.mesh_file, mesh.mesh_W.triangles.size(), "mesh"));
  text.add(mesh.place.scale);
  for (const double x : mesh.place.p_WM) text.add(x);
  text.add(mesh.size.side);
  text.add(mesh.size.kind);
  text.add(mesh.size.has_unit);
  text.add(mesh.is_valid);
  text.add(tracker.contact.tracker);
  text.add(tracker.contact.crease_angle);
  text.add(tracker.reason);
  // Each note begins with the name of the file, which is no part of the key.
  const std::size_t begin = object.mesh_file.string().size();
  text.add(mesh.notes.size());
  for (const std::string& note : mesh.notes) text.add(std::string_view(note).substr(begin));
  return text.bytes();
}

// Reads what `mesh_text_of` has written; false if it is damaged.
bool read_mesh_text(const std::string& bytes, const SceneObject& object, MeshCache::Mesh& stored) {
  EntryReader text(bytes);
  text.text();  // the description
  ObjectMesh& mesh = stored.mesh;
  mesh.place.scale = text.real();
  for (double& x : mesh.place.p_WM) x = text.real();
  mesh.size.side = text.real();
  mesh.size.kind = text.text();
  mesh.size.has_unit = text.flag();
  mesh.is_valid = text.flag();
  stored.tracker.contact.tracker =
      static_cast<render::TrackerChoice>(text.number_below(render::kTrackerNames.size()));
  stored.tracker.contact.crease_angle = text.optional_real();
  stored.tracker.reason = text.text();
  const std::uint64_t notes = text.number();
  for (std::uint64_t i = 0; i < notes && text.good(); ++i) {
    mesh.notes.push_back(object.mesh_file.string() + text.text());
  }
  return text.complete();
}

}  // namespace

std::string MeshCache::key_of(const SceneObject& object) {
  if (object.mesh || object.paged || object.mesh_file.empty() || object.needs_maps()) return {};
  const auto hash = content_hash(object.mesh_file);
  if (!hash) return {};
  EntryWriter key;
  key.add(std::string_view("mesh"));
  key.add(program_name());
  key.add(hash->bytes);
  for (const std::uint64_t sum : hash->sums) key.add(sum);
  // All that load_object_mesh reads of an object. The ending decides if the contents do not.
  key.add(small_ending(object.mesh_file));
  key.add(object.size);
  key.add(object.scale);
  key.add(object.repair);
  key.add(object.sheet_thickness);
  for (const double x : object.R_WO.reshaped()) key.add(x);
  for (const double x : object.p_WO) key.add(x);
  return key.bytes();
}

std::string MeshCache::key_of(const std::string& mesh_key, const render::ContactChoice& contact) {
  // Does not compile if there is another setting.
  const auto& [tracker, search, blending, normals, curved_depth, crease_angle, band, profile,
               tip_radius] = contact;
  EntryWriter key;
  key.add(std::string_view("surface"));
  key.add(mesh_key);
  key.add(tracker);
  key.add(search);
  key.add(blending);
  key.add(normals);
  key.add(curved_depth);
  key.add(crease_angle);
  key.add(band);
  key.add(profile);
  key.add(tip_radius);
  return key.bytes();
}

bool MeshCache::stores(const ObjectMesh& mesh) const {
  return mesh.mesh_W.triangles.size() >= choice_.triangles_min &&
         std::find(kStoredKinds.begin(), kStoredKinds.end(), mesh.size.kind) != kStoredKinds.end();
}

std::optional<MeshCache::Mesh> MeshCache::find_mesh(const SceneObject& object,
                                                    const std::string& key) {
  const fs::path file = entry_file(choice_.folder, key);
  const auto entry = open_entry(file, key);
  if (!entry) return {};
  Mesh stored;
  if (!read_mesh_text(entry->text(), object, stored) ||
      !read_array(*entry, 0, stored.mesh.mesh_W.vertices) ||
      !read_array(*entry, 1, stored.mesh.mesh_W.triangles) ||
      !names_its_vertices(stored.mesh.mesh_W)) {
    warn_unusable(file, "is damaged");
    return {};
  }
  stored.mesh.cache_key = key;
  entry->mark_used();
  logger().info("Mesh cache: {} was read from {}.", object.mesh_file.string(), file.string());
  return stored;
}

void MeshCache::keep_mesh(const SceneObject& object, const ObjectMesh& mesh,
                          const render::ChosenTracker& tracker) {
  const std::array arrays{bytes_in(mesh.mesh_W.vertices), bytes_in(mesh.mesh_W.triangles)};
  keep(mesh.cache_key, mesh_text_of(object, mesh, tracker), arrays);
}

std::optional<render::StillSurface> MeshCache::find_surface(const ObjectMesh& mesh,
                                                            const render::ContactChoice& contact) {
  const std::string key = key_of(mesh.cache_key, contact);
  const fs::path file = entry_file(choice_.folder, key);
  const auto entry = open_entry(file, key);
  if (!entry) return {};
  EntryReader text(entry->text());
  text.text();  // the description
  render::PackedSurface::Frame frame;
  for (double& x : frame.origin) x = text.real();
  for (double* x : {&frame.step, &frame.per_step, &frame.rise}) *x = text.real();
  render::PackedSurface::Triangles triangles;
  render::TreeNodes::Nodes nodes;
  std::optional<render::StillSurface> still;
  if (text.complete() && read_array(*entry, 0, triangles) && read_array(*entry, 1, nodes) &&
      triangles.size() == mesh.mesh_W.triangles.size()) {
    still = render::restore_surface(frame, std::move(triangles), std::move(nodes));
  }
  if (!still) {
    warn_unusable(file, "is damaged");
    return {};
  }
  still->connected = mesh.is_valid;
  entry->mark_used();
  return still;
}

void MeshCache::keep_surface(const fs::path& mesh_file, const ObjectMesh& mesh,
                             const render::ContactChoice& contact,
                             const render::StillSurface& still) {
  const auto stored = render::stored_data(still);
  if (!stored) return;
  EntryWriter text;
  text.add(entry_description(mesh_file, stored->triangles.size(), "packed for compact"));
  for (const double x : stored->frame.origin) text.add(x);
  for (const double x : {stored->frame.step, stored->frame.per_step, stored->frame.rise}) {
    text.add(x);
  }
  const std::array arrays{std::as_bytes(stored->triangles), std::as_bytes(stored->nodes)};
  keep(key_of(mesh.cache_key, contact), text.bytes(), arrays);
}

void MeshCache::keep(const std::string& key, std::string_view text,
                     std::span<const std::span<const std::byte>> arrays) {
  std::uint64_t bytes = key.size() + text.size();
  for (const auto& array : arrays) bytes += array.size();
  if (!writes_ || bytes > choice_.bytes_max) return;
  auto written = make_cache_folder(choice_.folder);
  if (written) written = CacheEntry::write(entry_file(choice_.folder, key), key, text, arrays);
  if (!written) {
    writes_ = false;
    logger().warn("Mesh cache: {}; meshes are not stored.", written.error().message);
    return;
  }
  limit_cache(choice_.folder, choice_.bytes_max);
}

}  // namespace thimble::scene

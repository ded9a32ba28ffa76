#include "thimble/scene/shared_meshes.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <system_error>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "meshes/cache/mesh_cache.h"
#include "meshes/mesh_join.h"
#include "meshes/object_mesh.h"
#include "still_surface.h"
#include "thimble/render/build_object_touch.h"
#include "thimble/scene/scene_file.h"

namespace thimble::scene {
namespace {

using MeshPointer = std::shared_ptr<const render::TriangleMesh>;
using NamedPointers = std::vector<std::pair<std::string, MeshPointer>>;

/// State of a file that detects a change of its contents.
struct FileState {
  std::uintmax_t size = 0;
  std::filesystem::file_time_type changed;

  bool operator==(const FileState&) const = default;
};

FileState state_of(const std::filesystem::path& file) {
  std::error_code absent;  // reported by the reader of the file
  return {std::filesystem::file_size(file, absent), std::filesystem::last_write_time(file, absent)};
}

/// Everything that determines a mesh from a file.
struct MeshKey {
  explicit MeshKey(const SceneObject& object)
      : file(std::filesystem::absolute(object.mesh_file).lexically_normal()),
        state(object.mesh ? FileState() : state_of(file)),
        in_memory(object.mesh ? *object.mesh : nullptr),
        size(object.size),
        scale(object.scale),
        repair(object.repair),
        sheet_thickness(object.sheet_thickness),
        with_maps(object.needs_maps()),
        R_WO(object.R_WO),
        p_WO(object.p_WO) {}

  bool operator==(const MeshKey&) const = default;

  std::filesystem::path file;
  FileState state;
  std::shared_ptr<const render::TriangleMesh> in_memory;
  std::optional<double> size, scale;
  bool repair;
  std::optional<double> sheet_thickness;
  bool with_maps;
  Eigen::Matrix3d R_WO;
  Eigen::Vector3d p_WO;
};

/// Values by key, few enough for a linear search.
template <class Key, class Value>
class HeldMeshes {
 public:
  std::shared_ptr<const Value> find(const Key& key) const {
    const auto found = std::find_if(entries_.begin(), entries_.end(),
                                    [&key](const auto& entry) { return entry.first == key; });
    return found == entries_.end() ? nullptr : found->second;
  }
  std::shared_ptr<const Value> keep(Key key, Value value) {
    return entries_.emplace_back(std::move(key), std::make_shared<const Value>(std::move(value)))
        .second;
  }
  std::size_t size() const { return entries_.size(); }
  /// Returns the first entry, key and value, whose value passes a test; null if none does.
  template <class Test>
  const std::pair<Key, std::shared_ptr<const Value>>* find_if(const Test& test) const {
    const auto found = std::find_if(entries_.begin(), entries_.end(),
                                    [&test](const auto& entry) { return test(*entry.second); });
    return found == entries_.end() ? nullptr : &*found;
  }
  bool holds(const Value* value) const {
    return std::any_of(entries_.begin(), entries_.end(),
                       [value](const auto& entry) { return entry.second.get() == value; });
  }
  void drop_unused() {
    drop_if([](const std::shared_ptr<const Value>& value) { return value.use_count() == 1; });
  }
  template <class Unused>
  void drop_if_key(const Unused& unused) {
    std::erase_if(entries_, [&](const auto& entry) { return unused(entry.first); });
  }
  template <class Unused>
  void drop_if(const Unused& unused) {
    std::erase_if(entries_, [&](const auto& entry) { return unused(entry.second); });
  }

 private:
  std::vector<std::pair<Key, std::shared_ptr<const Value>>> entries_;
};

std::uint64_t hash_of(const render::TriangleMesh& mesh) {
  std::uint64_t hash = mesh.triangles.size();
  for (const Eigen::Vector3d& p : mesh.vertices) {
    // The terms make -0 equal to 0, as for ==.
    for (const double x : {p.x() + 0.0, p.y() + 0.0, p.z() + 0.0}) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15;
      hash ^= hash >> 29;
    }
  }
  return hash;
}

bool same(const render::TriangleMesh& a, const render::TriangleMesh& b) {
  return a.vertices == b.vertices && a.triangles == b.triangles;
}

}  // namespace

struct SharedMeshes::Held {
  /// Returns the tracker that suits a mesh of `files`.
  std::shared_ptr<const render::ChosenTracker> tracker_of(const ObjectMesh* mesh) {
    if (auto found = trackers.find(mesh)) return found;
    return trackers.keep(mesh, render::choose_tracker(mesh->mesh_W));
  }

  std::mutex mutex;
  std::optional<MeshCache> disk;  // none: nothing is stored on disk
  HeldMeshes<MeshKey, ObjectMesh> files;
  HeldMeshes<const ObjectMesh*, render::ChosenTracker> trackers;  // of `files`
  std::unordered_multimap<std::uint64_t, MeshPointer> shapes;     // by `hash_of`
  HeldMeshes<std::vector<MeshPointer>, render::TriangleMesh> joined;
  HeldMeshes<std::pair<MeshPointer, render::ContactChoice>, render::StillSurface> surfaces;
  HeldMeshes<std::pair<std::vector<HandWaypoint>, NamedPointers>, HandRoute> routes;
};

SharedMeshes::SharedMeshes() : held_(std::make_unique<Held>()) {}
SharedMeshes::SharedMeshes(MeshCacheChoice cache) : SharedMeshes() {
  held_->disk.emplace(std::move(cache));
}
SharedMeshes::~SharedMeshes() = default;

std::size_t SharedMeshes::meshes() const {
  const std::scoped_lock lock(held_->mutex);
  return held_->files.size() + held_->shapes.size() + held_->joined.size();
}

std::size_t SharedMeshes::surfaces() const {
  const std::scoped_lock lock(held_->mutex);
  return held_->surfaces.size();
}

void SharedMeshes::drop_unused() {
  const std::scoped_lock lock(held_->mutex);
  // Objects are removed before those that they are made from.
  held_->routes.drop_unused();
  held_->surfaces.drop_if([](const auto& still) { return still->search.use_count() == 1; });
  held_->joined.drop_unused();
  held_->files.drop_unused();
  held_->trackers.drop_if_key([this](const ObjectMesh* mesh) { return !held_->files.holds(mesh); });
  std::erase_if(held_->shapes, [](const auto& shape) { return shape.second.use_count() == 1; });
}

driver::Result<std::shared_ptr<const ObjectMesh>> SharedMeshes::object_mesh(
    const SceneObject& object) {
  const std::scoped_lock lock(held_->mutex);
  MeshKey key(object);
  if (auto found = held_->files.find(key)) return found;
  const std::string cache_key = held_->disk ? MeshCache::key_of(object) : std::string();
  if (!cache_key.empty()) {
    if (auto stored = held_->disk->find_mesh(object, cache_key)) {
      auto kept = held_->files.keep(std::move(key), std::move(stored->mesh));
      held_->trackers.keep(kept.get(), std::move(stored->tracker));
      return kept;
    }
  }
  auto loaded = load_object_mesh(object);
  if (!loaded) return loaded.error();
  // The file may have been written again since the key was made from it.
  if (!cache_key.empty() && held_->disk->stores(*loaded) &&
      MeshCache::key_of(object) == cache_key) {
    loaded->cache_key = cache_key;
  }
  std::optional<render::ChosenTracker> suitable = std::move(loaded->suitable);
  auto kept = held_->files.keep(std::move(key), std::move(loaded).value());
  if (suitable) held_->trackers.keep(kept.get(), *std::move(suitable));
  if (!kept->cache_key.empty()) {
    held_->disk->keep_mesh(object, *kept, *held_->tracker_of(kept.get()));
  }
  return kept;
}

std::shared_ptr<const render::ChosenTracker> SharedMeshes::tracker(
    const std::shared_ptr<const ObjectMesh>& mesh) {
  const std::scoped_lock lock(held_->mutex);
  return held_->tracker_of(mesh.get());
}

MeshPointer SharedMeshes::mesh_like(const render::TriangleMesh& mesh_W) {
  const std::uint64_t hash = hash_of(mesh_W);
  const std::scoped_lock lock(held_->mutex);
  const auto [first, last] = held_->shapes.equal_range(hash);
  for (auto shape = first; shape != last; ++shape) {
    if (same(*shape->second, mesh_W)) return shape->second;
  }
  return held_->shapes.emplace(hash, std::make_shared<const render::TriangleMesh>(mesh_W))->second;
}

MeshPointer SharedMeshes::joined(const std::vector<MeshPointer>& meshes_W) {
  if (meshes_W.size() == 1) return meshes_W.front();
  const std::scoped_lock lock(held_->mutex);
  if (auto found = held_->joined.find(meshes_W)) return found;
  render::TriangleMesh whole;
  for (const MeshPointer& mesh_W : meshes_W) append(*mesh_W, whole);
  return held_->joined.keep(meshes_W, std::move(whole));
}

driver::Result<std::shared_ptr<const render::StillSurface>> SharedMeshes::surface(
    const MeshPointer& mesh_W, const render::ContactChoice& contact) {
  const std::scoped_lock lock(held_->mutex);
  if (auto found = held_->surfaces.find({mesh_W, contact})) return found;
  const auto* of_file = held_->files.find_if(
      [&mesh_W](const ObjectMesh& mesh) { return &mesh.mesh_W == mesh_W.get(); });
  const bool is_stored = of_file != nullptr && !of_file->second->cache_key.empty();
  if (is_stored) {
    if (auto stored = held_->disk->find_surface(*of_file->second, contact)) {
      return held_->surfaces.keep({mesh_W, contact}, *std::move(stored));
    }
  }
  auto made = render::prepare_still_surface(*mesh_W, contact,
                                            of_file != nullptr && of_file->second->is_valid);
  if (!made) return made.error();
  if (is_stored) {
    held_->disk->keep_surface(of_file->first.file, *of_file->second, contact, *made);
  }
  return held_->surfaces.keep({mesh_W, contact}, std::move(made).value());
}

driver::Result<std::shared_ptr<const HandRoute>> SharedMeshes::hand_route(
    const std::vector<HandWaypoint>& waypoints, const NamedPointers& objects) {
  const std::scoped_lock lock(held_->mutex);
  if (auto found = held_->routes.find({waypoints, objects})) return found;
  std::vector<NamedMesh> named;
  for (const auto& [name, mesh_W] : objects) named.push_back({name, mesh_W.get()});
  auto planned = plan_hand(waypoints, named);
  if (!planned) return planned.error();
  return held_->routes.keep({waypoints, objects}, std::move(planned).value());
}

}  // namespace thimble::scene

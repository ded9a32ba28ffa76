// Prepared meshes on disk: what is read from them is bit-identical to what was prepared, and
// nothing that is damaged, foreign or of other settings is used.
#include "meshes/cache/mesh_cache.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "meshes/cache/cache_entry.h"
#include "meshes/cache/cache_folder.h"
#include "meshes/cache/content_hash.h"
#include "setup.h"
#include "support/meshes/shapes.h"
#include "support/run_hash.h"
#include "support/scratch.h"
#include "thimble/render/mesh/mesh_file.h"
#include "thimble/scene/scene_objects.h"
#include "thimble/scene/shared_meshes.h"
#include "thimble/session/session.h"

namespace thimble {
namespace {

namespace fs = std::filesystem;

using scene::CacheEntry;
using scene::MeshCache;
using scene::MeshCacheChoice;
using scene::SceneObject;
using scene::SharedMeshes;

void write_text(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

std::string text_in(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class MeshCacheTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        support::scratch_folder() / ::testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::create_directories(folder_);
    cache_ = folder_ / "cache";
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// Saves a mesh and returns the object of a scene with it.
  SceneObject object_of(const render::TriangleMesh& mesh, const std::string& name = "mesh.off") {
    EXPECT_TRUE(render::save_mesh(mesh, folder_ / name));
    SceneObject object;
    object.name = "part";
    object.mesh_file = folder_ / name;
    object.scale = 1;
    object.stiffness = 500;
    return object;
  }
  MeshCacheChoice choice() const { return {.folder = cache_, .triangles_min = 1}; }

  /// Runs a scene with one object, touched by a hand that moves over it, and returns the hash of
  /// all ticks. `keys` are further keys of the object.
  std::uint64_t hash_of_run(const render::TriangleMesh& mesh, const std::string& keys,
                            const std::shared_ptr<SharedMeshes>& meshes) {
    EXPECT_TRUE(render::save_mesh(mesh, folder_ / "mesh.off"));
    write_text(folder_ / "scene.yaml",
               "name: part\narm: vintage_phantom\nduration: 0.6\nobjects:\n  - {name: part, mesh: "
               "mesh.off, scale: 1, position: [0, 0, -0.03], stiffness: 500, damping: 1" +
                   keys +
                   "}\nhand:\n  path:\n    - {t: 0, at: [0, 0, 0.01]}\n    - {t: 0.2, at: [0.001, "
                   "0, -0.005]}\n    - {t: 0.6, at: [0.012, 0.008, -0.006]}\n");
    auto opened = session::Session::open(folder_ / "scene.yaml", {.meshes = meshes});
    if (!opened) {
      ADD_FAILURE() << opened.error().message;
      return 0;
    }
    (*opened)->run();
    support::RunHash hash;
    std::size_t touched = 0;
    for (const driver::TickRecord& row : (*opened)->ticks()) {
      hash.add(row);
      touched += row.in_contact ? 1 : 0;
    }
    EXPECT_GT(touched, 100U) << "else the test compares nothing";
    return hash.value();
  }
  std::uint64_t hash_with_cache(const render::TriangleMesh& mesh, const std::string& keys,
                                const MeshCacheChoice& cache) {
    return hash_of_run(mesh, keys, std::make_shared<SharedMeshes>(cache));
  }
  std::size_t entries() const { return scene::cache_entries(cache_).size(); }

  /// Prepares an object with the cache. Returns its mesh.
  std::shared_ptr<const scene::ObjectMesh> prepare(const SceneObject& object,
                                                   const MeshCacheChoice& cache) {
    SharedMeshes meshes(cache);
    const auto mesh = meshes.object_mesh(object);
    if (!mesh) {
      ADD_FAILURE() << mesh.error().message;
      return nullptr;
    }
    const std::shared_ptr<const render::TriangleMesh> mesh_W(*mesh, &(*mesh)->mesh_W);
    EXPECT_TRUE(meshes.surface(mesh_W, object.contact));
    return *mesh;
  }

  fs::path folder_, cache_;
};

// Enough triangles for a tree, which is stored.
render::TriangleMesh ball() {
  return support::bumpy_sphere(5, 0.025, 0.001, 300);
}

TEST_F(MeshCacheTest, RunsAreBitIdenticalWithAndWithout) {
  render::TriangleMesh two = ball();  // two parts that overlap
  const auto count = static_cast<std::int32_t>(two.vertices.size());
  for (const Eigen::Vector3d& p : ball().vertices) {
    two.vertices.emplace_back(p + Eigen::Vector3d(0.01, 0, 0));
  }
  for (const auto& [a, b, c] : ball().triangles) {
    two.triangles.push_back({a + count, b + count, c + count});
  }
  render::TriangleMesh inverted = ball();
  for (auto& triangle : inverted.triangles) std::swap(triangle[0], triangle[1]);
  render::TriangleMesh open = ball();
  open.triangles.resize(open.triangles.size() - 3);
  const struct {
    const char* name;
    render::TriangleMesh mesh;
    const char* keys;
    std::size_t entries;  // a surface is stored for compact only
  } cases[] = {
      {"ball, tracker chosen", ball(), "", 2},
      {"ball, compact", ball(), ", contact: {tracker: compact}", 2},
      {"ball, compact, tree", support::icosphere(3, 0.025),
       ", contact: {tracker: compact, search: tree}", 2},
      {"ball, compact, grid", support::icosphere(3, 0.025),
       ", contact: {tracker: compact, search: grid}", 1},
      {"ball, crease", ball(), ", contact: {tracker: compact, crease_degrees: 2}", 2},
      {"ball, edge planes", ball(), ", contact: {tracker: edge_planes}", 1},
      {"ball, offset", ball(), ", contact: {tracker: offset}", 1},
      {"ball, god-object", ball(), ", contact: {tracker: god_object}", 1},
      {"ball, turned", ball(), ", rotate_degrees: [[x, 10], [z, 30]]", 2},
      {"ball, dent", ball(),
       ", contact: {blending: phong}, body: {dent: {stiffness: 300, damping: 0.3}}", 1},
      {"torus", support::torus(0.018, 0.008, 200, 80), ", rotate_degrees: [[x, 90]]", 2},
      {"box", support::box({0.025, 0.025, 0.025}), "", 1},
      {"plate", support::plate(0.05, 0.05, 60), "", 1},
      {"two parts", two, ", contact: {tracker: compact}", 2},
      {"inside out", inverted, ", contact: {tracker: compact}", 2},
      {"open, repaired", open, ", repair: true, contact: {tracker: compact}", 2},
  };
  for (const auto& one : cases) {
    SCOPED_TRACE(one.name);
    const std::uint64_t without = hash_of_run(one.mesh, one.keys, nullptr);
    EXPECT_EQ(hash_with_cache(one.mesh, one.keys, choice()), without) << "while it is written";
    EXPECT_EQ(entries(), one.entries);
    EXPECT_EQ(hash_with_cache(one.mesh, one.keys, choice()), without) << "when it is read";
    EXPECT_EQ(entries(), one.entries);
    fs::remove_all(cache_);
  }
}

TEST_F(MeshCacheTest, StoredMeshAndSurfaceAreUsed) {
  const SceneObject object = [&] {
    SceneObject compact = object_of(ball());
    compact.contact.tracker = render::TrackerChoice::kPacked;
    return compact;
  }();
  const auto made = prepare(object, choice());
  ASSERT_EQ(entries(), 2U);
  // Another mesh and its surface in their place.
  MeshCache cache(choice());
  scene::ObjectMesh other = *made;
  other.mesh_W = support::icosphere(5, 0.01);
  other.notes = {object.mesh_file.string() + ": as stored."};
  cache.keep_mesh(object, other, {.contact = {}, .reason = "stored"});
  const auto still = render::prepare_still_surface(other.mesh_W, object.contact);
  ASSERT_TRUE(still);
  cache.keep_surface(object.mesh_file, other, object.contact, *still);
  SharedMeshes meshes(choice());
  const auto read = meshes.object_mesh(object);
  ASSERT_TRUE(read);
  EXPECT_EQ((*read)->mesh_W.vertices, other.mesh_W.vertices);
  EXPECT_EQ((*read)->mesh_W.triangles, other.mesh_W.triangles);
  EXPECT_EQ((*read)->notes, other.notes);
  EXPECT_EQ(meshes.tracker(*read)->reason, "stored");
  const auto surface = meshes.surface({*read, &(*read)->mesh_W}, object.contact);
  ASSERT_TRUE(surface);
  EXPECT_EQ((*surface)->packed->step(), still->packed->step());
}

TEST_F(MeshCacheTest, FewTrianglesMapsAndOtherFormatsAreNotStored) {
  const SceneObject object = object_of(support::icosphere(2, 0.02));
  prepare(object, {.folder = cache_});
  prepare(object, {.folder = cache_, .triangles_min = 321});
  EXPECT_FALSE(fs::exists(cache_));
  prepare(object, {.folder = cache_, .triangles_min = 320});
  EXPECT_EQ(entries(), 1U);
  SceneObject gltf;
  gltf.mesh_file = fs::path(THIMBLE_SOURCE_DIR) / "tests/data/meshes/box.gltf";
  prepare(gltf, choice());
  EXPECT_EQ(entries(), 1U);
  SceneObject in_memory = object;
  in_memory.mesh = std::make_shared<const render::TriangleMesh>(support::icosphere(1, 0.02));
  EXPECT_EQ(MeshCache::key_of(in_memory), "");
  in_memory = object;
  in_memory.mesh_file = folder_ / "absent.off";
  EXPECT_EQ(MeshCache::key_of(in_memory), "");
}

TEST_F(MeshCacheTest, KeyDependsOnContentsAndEachSetting) {
  const SceneObject object = object_of(support::icosphere(1, 0.02));
  const std::string key = MeshCache::key_of(object);
  ASSERT_FALSE(key.empty());
  const std::vector<std::function<void(SceneObject&)>> changes{
      [](SceneObject& o) { o.size = 0.1; },
      [](SceneObject& o) { o.size = 0.2; },
      [](SceneObject& o) { o.scale.reset(); },
      [](SceneObject& o) { o.scale = 1.5; },
      [](SceneObject& o) { o.repair = true; },
      [](SceneObject& o) { o.sheet_thickness = 0.001; },
      [](SceneObject& o) { o.sheet_thickness = 0.002; },
      [](SceneObject& o) { o.R_WO = Eigen::Vector3d(1, -1, -1).asDiagonal(); },
      [](SceneObject& o) { o.p_WO.x() = 1e-300; },
      [](SceneObject& o) { o.p_WO.y() = 1e-300; },
      [](SceneObject& o) { o.p_WO.z() = -0.0; },
      [this](SceneObject& o) {
        o.mesh_file = object_of(support::icosphere(1, 0.03), "b.off").mesh_file;
      },
      [](SceneObject& o) {
        std::string text = text_in(o.mesh_file);
        char& digit = text[text.size() / 3];
        digit = digit == '1' ? '2' : '1';
        o.mesh_file.replace_extension();
        o.mesh_file += "_changed.off";
        write_text(o.mesh_file, text);
      },
      [](SceneObject& o) {
        const fs::path stl = fs::path(o.mesh_file).replace_extension(".stl");
        fs::copy_file(o.mesh_file, stl, fs::copy_options::overwrite_existing);
        o.mesh_file = stl;
      },
  };
  std::set<std::string> keys{key};
  for (const auto& change : changes) {
    SceneObject changed = object;
    change(changed);
    keys.insert(MeshCache::key_of(changed));
  }
  EXPECT_EQ(keys.size(), changes.size() + 1);
  SceneObject renamed = object;
  renamed.mesh_file = folder_ / "renamed.off";
  fs::copy_file(object.mesh_file, renamed.mesh_file);
  renamed.stiffness = 100;
  renamed.contact.tracker = render::TrackerChoice::kOffset;
  EXPECT_EQ(MeshCache::key_of(renamed), key) << "neither name nor surface counts for the mesh";

  const std::vector<std::function<void(render::ContactChoice&)>> contacts{
      [](auto& c) { c.tracker = render::TrackerChoice::kPacked; },
      [](auto& c) { c.search = render::SearchChoice::kTree; },
      [](auto& c) { c.search = render::SearchChoice::kGrid; },
      [](auto& c) { c.blending = render::BlendingChoice::kFlat; },
      [](auto& c) { c.normals = render::NormalWeights::kAngle; },
      [](auto& c) { c.curved_depth = false; },
      [](auto& c) { c.curved_depth = true; },
      [](auto& c) { c.crease_angle = 0.5; },
      [](auto& c) { c.crease_angle = 0.6; },
      [](auto& c) { c.band = 0.002; },
      [](auto& c) { c.profile = render::BlendProfile::kLinear; },
      [](auto& c) { c.tip_radius = 0.001; },
  };
  std::set<std::string> surfaces{key, MeshCache::key_of(key, {})};
  for (const auto& change : contacts) {
    render::ContactChoice contact;
    change(contact);
    surfaces.insert(MeshCache::key_of(key, contact));
  }
  EXPECT_EQ(surfaces.size(), contacts.size() + 2);
}

/// Returns whether an entry opens and all of its arrays are whole; else the problem.
std::string problem_of(const fs::path& file, const std::string& key) {
  const auto opened = CacheEntry::open(file, key);
  if (!opened) return opened.error().message;
  if (!*opened) return "absent";
  for (std::size_t i = 0; i < CacheEntry::kArraysMax; ++i) {
    std::vector<std::byte> bytes((*opened)->bytes_of(i));
    if (!(*opened)->read(i, bytes)) return "array " + std::to_string(i);
  }
  return "";
}

class CacheEntryTest : public MeshCacheTest {
 protected:
  void SetUp() override {
    MeshCacheTest::SetUp();
    file_ = folder_ / "entry";
    for (std::size_t i = 0; i < 500; ++i) first_.push_back(static_cast<std::byte>(i * i));
    for (std::size_t i = 0; i < 77; ++i) second_.push_back(static_cast<std::byte>(3 * i));
    ASSERT_TRUE(write(first_));
    ASSERT_EQ(problem_of(file_, "key"), "");
  }
  driver::Result<void> write(const std::vector<std::byte>& first) const {
    const std::array<std::span<const std::byte>, 2> arrays{first, second_};
    return CacheEntry::write(file_, "key", "text", arrays);
  }

  fs::path file_;
  std::vector<std::byte> first_, second_;
};

TEST_F(CacheEntryTest, EachChangedByteIsDetected) {
  const std::string whole = text_in(file_);
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (const int flip : {1, 128, 255}) {
      std::string damaged = whole;
      damaged[at] = static_cast<char>(damaged[at] ^ flip);
      write_text(file_, damaged);
      ASSERT_NE(problem_of(file_, "key"), "") << "byte " << at;
    }
  }
}

TEST_F(CacheEntryTest, EachTruncationAndEachLongerFileIsDetected) {
  const std::string whole = text_in(file_);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    write_text(file_, whole.substr(0, size));
    ASSERT_NE(problem_of(file_, "key"), "") << size << " bytes";
  }
  write_text(file_, whole + '\0');
  EXPECT_EQ(problem_of(file_, "key"), "is damaged");
}

TEST_F(CacheEntryTest, OtherVersionByteOrderAndKeyAreRefused) {
  const std::string whole = text_in(file_);
  const auto problem_with = [&](std::size_t at, std::uint32_t number) {
    std::string changed = whole;
    std::memcpy(changed.data() + at, &number, sizeof(number));
    write_text(file_, changed);
    return problem_of(file_, "key");
  };
  EXPECT_EQ(problem_with(8, 2), "has another version or byte order");
  EXPECT_EQ(problem_with(12, 0x04030201), "has another version or byte order");
  EXPECT_EQ(problem_with(0, 0), "is not an entry");
  write_text(file_, whole);
  EXPECT_EQ(problem_of(file_, "kez"), "belongs to another mesh");
  EXPECT_EQ(problem_of(file_, "key2"), "belongs to another mesh");
  EXPECT_EQ(problem_of(folder_ / "none", "key"), "absent");
}

TEST_F(CacheEntryTest, FilesOfOthersLinksAndPipesAreRefused) {
  fs::permissions(file_, fs::perms::others_write, fs::perm_options::add);
  EXPECT_EQ(problem_of(file_, "key"), "can be written by other users");
  ASSERT_TRUE(write(first_));
  if (geteuid() == 0) {
    ASSERT_EQ(chown(file_.c_str(), 1, 1), 0);
    EXPECT_EQ(problem_of(file_, "key"), "can be written by other users");
    ASSERT_TRUE(write(first_));
  }
  fs::create_symlink(file_, folder_ / "link");
  EXPECT_NE(problem_of(folder_ / "link", "key"), "");
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(problem_of(folder_ / "pipe", "key"), "is not a file");
  EXPECT_EQ(problem_of(folder_, "key"), "is not a file");
}

TEST_F(CacheEntryTest, TwoProcessesWriteWholeEntriesAtOnce) {
  constexpr int kRounds = 300;
  std::vector<pid_t> children;
  for (unsigned char child = 1; child <= 2; ++child) {
    const pid_t started = fork();
    ASSERT_GE(started, 0);
    if (started == 0) {
      const std::vector<std::byte> own(5000, static_cast<std::byte>(child));
      bool done = true;
      for (int i = 0; i < kRounds; ++i) done = done && write(own).ok();
      _exit(done ? 0 : 1);
    }
    children.push_back(started);
  }
  for (int i = 0; i < kRounds; ++i) ASSERT_EQ(problem_of(file_, "key"), "");
  for (const pid_t child : children) {
    int status = 1;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0);
  }
  EXPECT_EQ(problem_of(file_, "key"), "");
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& file : fs::directory_iterator(folder_)) ++files;
  EXPECT_EQ(files, 1U) << "no part is left";
}

TEST_F(CacheEntryTest, FullDiskLeavesTheOldEntryAndNoPart) {
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    // A limit on the size of files fails as a full disk does, after a part of the file.
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{1000, 1000};
    setrlimit(RLIMIT_FSIZE, &limit);
    _exit(write(std::vector<std::byte>(5000)).ok() ? 1 : 0);
  }
  int status = 1;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(problem_of(file_, "key"), "");
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& file : fs::directory_iterator(folder_)) ++files;
  EXPECT_EQ(files, 1U);
}

TEST_F(MeshCacheTest, DamagedEntriesAreWrittenAgain) {
  const std::string keys = ", contact: {tracker: compact}";
  const std::uint64_t without = hash_of_run(ball(), keys, nullptr);
  EXPECT_EQ(hash_with_cache(ball(), keys, choice()), without);
  std::vector<std::pair<fs::path, std::string>> whole;
  for (const auto& entry : scene::cache_entries(cache_)) {
    whole.emplace_back(entry.file, text_in(entry.file));
  }
  ASSERT_EQ(whole.size(), 2U);
  for (const auto& [file, text] : whole) {
    // Header, key, text, and the arrays at several places.
    for (std::size_t part = 0; part <= 8; ++part) {
      std::string damaged = text;
      char& byte = damaged[part == 0 ? 20 : (text.size() - 1) * part / 8];
      byte = static_cast<char>(byte ^ 4);
      write_text(file, damaged);
      EXPECT_EQ(hash_with_cache(ball(), keys, choice()), without);
      EXPECT_EQ(text_in(file), text) << "byte of part " << part;
    }
    for (const std::size_t size : {std::size_t{0}, std::size_t{50}, text.size() / 2}) {
      write_text(file, text.substr(0, size));
      EXPECT_EQ(hash_with_cache(ball(), keys, choice()), without);
      EXPECT_EQ(text_in(file), text);
    }
  }
}

// Of right checksums, but with numbers that contact would follow out of memory.
TEST_F(MeshCacheTest, NumbersOutOfRangeAreRefused) {
  SceneObject object = object_of(ball());
  object.contact.tracker = render::TrackerChoice::kPacked;
  const auto made = prepare(object, choice());
  MeshCache cache(choice());
  scene::ObjectMesh wrong = *made;
  wrong.mesh_W.triangles[7][1] = static_cast<std::int32_t>(wrong.mesh_W.vertices.size());
  cache.keep_mesh(object, wrong, {});
  EXPECT_FALSE(cache.find_mesh(object, made->cache_key));
  wrong.mesh_W.triangles[7][1] = -1;
  cache.keep_mesh(object, wrong, {});
  EXPECT_FALSE(cache.find_mesh(object, made->cache_key));

  const auto still = render::prepare_still_surface(made->mesh_W, object.contact);
  ASSERT_TRUE(still);
  const auto stored = render::stored_data(*still);
  ASSERT_TRUE(stored);
  const auto restored = [&](auto&& change) {
    auto frame = stored->frame;
    render::PackedSurface::Triangles triangles(stored->triangles.begin(), stored->triangles.end());
    render::TreeNodes::Nodes nodes(stored->nodes.begin(), stored->nodes.end());
    change(frame, triangles, nodes);
    return render::restore_surface(frame, std::move(triangles), std::move(nodes)).has_value();
  };
  EXPECT_TRUE(restored([](auto&, auto&, auto&) {}));
  EXPECT_FALSE(restored([](auto& frame, auto&, auto&) { frame.step = 0; }));
  EXPECT_FALSE(restored([](auto& frame, auto&, auto&) { frame.origin[1] = NAN; }));
  EXPECT_FALSE(restored([](auto& frame, auto&, auto&) { frame.rise = -1; }));
  EXPECT_FALSE(restored([](auto&, auto& triangles, auto&) { triangles[3].neighbours[2] = -1; }));
  EXPECT_FALSE(restored([](auto&, auto& triangles, auto&) {
    triangles[3].neighbours[2] = static_cast<std::int32_t>(triangles.size());
  }));
  EXPECT_FALSE(restored([](auto&, auto& triangles, auto&) { triangles[3].flags = ~0U; }));
  EXPECT_FALSE(restored([](auto&, auto& triangles, auto&) { triangles.clear(); }));
  EXPECT_FALSE(restored([](auto&, auto&, auto& nodes) { nodes.pop_back(); }));
  EXPECT_FALSE(restored([](auto&, auto&, auto& nodes) { nodes.emplace_back(); }));
}

TEST_F(MeshCacheTest, FolderThatCannotBeWrittenStopsNoRun) {
  const std::uint64_t without = hash_of_run(ball(), "", nullptr);
  write_text(folder_ / "file", "");
  EXPECT_EQ(hash_with_cache(ball(), "", {.folder = folder_ / "file" / "below", .triangles_min = 1}),
            without);
  EXPECT_EQ(hash_with_cache(ball(), "", {.folder = folder_ / "file", .triangles_min = 1}), without);
  EXPECT_EQ(hash_with_cache(ball(), "", {.folder = "/proc/none", .triangles_min = 1}), without);
}

TEST_F(MeshCacheTest, FileThatHasChangedIsPreparedAgain) {
  const auto small = support::icosphere(5, 0.024), large = support::icosphere(5, 0.025);
  const std::uint64_t of_small = hash_with_cache(small, "", choice());
  const std::uint64_t of_large = hash_with_cache(large, "", choice());
  EXPECT_NE(of_small, of_large);
  EXPECT_EQ(of_large, hash_of_run(large, "", nullptr));
  EXPECT_EQ(entries(), 4U);
  EXPECT_EQ(hash_with_cache(small, "", choice()), of_small);
  EXPECT_EQ(entries(), 4U);
}

TEST_F(MeshCacheTest, OldestEntriesAreRemovedAboveTheLimit) {
  fs::create_directories(cache_);
  const auto now = fs::file_time_type::clock::now();
  const auto entry = [&](char digit) {
    fs::path file = cache_ / std::string(32, digit);
    file += ".prepared";
    return file;
  };
  for (const char digit : {'a', '1', 'b', '2'}) write_text(entry(digit), std::string(100, 'x'));
  fs::last_write_time(entry('a'), now - std::chrono::hours(1));
  fs::last_write_time(entry('1'), now - std::chrono::hours(2));
  fs::last_write_time(entry('b'), now - std::chrono::hours(3));
  fs::last_write_time(entry('2'), now - std::chrono::hours(4));
  const fs::path old_part = entry('c').string() + ".1-1.part";
  const fs::path new_part = entry('c').string() + ".2-1.part";
  const fs::path own = cache_ / "notes.txt";
  for (const fs::path& file : {old_part, new_part, own}) write_text(file, std::string(1000, 'x'));
  fs::last_write_time(old_part, now - std::chrono::hours(2));
  fs::last_write_time(own, now - std::chrono::hours(900));
  scene::limit_cache(cache_, 400);
  EXPECT_EQ(entries(), 4U);
  EXPECT_FALSE(fs::exists(old_part));
  EXPECT_TRUE(fs::exists(new_part));
  scene::limit_cache(cache_, 299);
  EXPECT_TRUE(fs::exists(entry('a')) && fs::exists(entry('1')));
  EXPECT_FALSE(fs::exists(entry('b')) || fs::exists(entry('2')));
  scene::limit_cache(cache_, 0);
  EXPECT_EQ(entries(), 0U);
  EXPECT_TRUE(fs::exists(own)) << "other files are left alone";
}

TEST_F(MeshCacheTest, SizeIsLimitedWhileMeshesAreStored) {
  const SceneObject first = object_of(support::icosphere(3, 0.02), "first.off");
  const SceneObject second = object_of(support::icosphere(3, 0.03), "second.off");
  prepare(first, choice());
  const auto stored = scene::cache_entries(cache_);
  ASSERT_EQ(stored.size(), 1U);
  const MeshCacheChoice limited{
      .folder = cache_, .triangles_min = 1, .bytes_max = stored[0].bytes + 100};
  fs::last_write_time(stored[0].file, stored[0].used - std::chrono::hours(1));
  prepare(second, limited);
  EXPECT_EQ(entries(), 1U);
  EXPECT_FALSE(fs::exists(stored[0].file));
  const auto newest = scene::cache_entries(cache_);
  prepare(first, {.folder = cache_, .triangles_min = 1, .bytes_max = 1000});
  EXPECT_TRUE(fs::exists(newest[0].file)) << "one that is too large removes no other";
  // Reading an entry makes it the last one used.
  prepare(first, choice());
  fs::last_write_time(newest[0].file, newest[0].used - std::chrono::hours(1));
  for (const auto& entry : scene::cache_entries(cache_)) {
    fs::last_write_time(entry.file, entry.used - std::chrono::hours(1));
  }
  prepare(second, choice());
  EXPECT_EQ(scene::cache_entries(cache_).front().file, newest[0].file);
  EXPECT_EQ(scene::describe_entry(newest[0].file), "second.off, 1280 triangles, mesh");
}

TEST_F(MeshCacheTest, EnvironmentSelectsTheFolder) {
  const char* const name = "THIMBLE_MESH_CACHE";
  unsetenv(name);
  EXPECT_FALSE(scene::mesh_cache_of_environment());
  EXPECT_EQ(scene::chosen_mesh_cache(), scene::default_mesh_cache());
  setenv(name, "", 1);
  EXPECT_FALSE(scene::mesh_cache_of_environment());
  setenv(name, "0", 1);
  EXPECT_FALSE(scene::mesh_cache_of_environment());
  setenv(name, "1", 1);
  EXPECT_EQ(scene::mesh_cache_of_environment(), scene::default_mesh_cache());
  setenv(name, "relative", 1);
  EXPECT_FALSE(scene::mesh_cache_of_environment());
  setenv(name, cache_.c_str(), 1);
  EXPECT_EQ(scene::mesh_cache_of_environment(), cache_);
  EXPECT_EQ(scene::chosen_mesh_cache(), cache_);
  unsetenv(name);
}

/// Returns the two polynomials word by word, with remainders by division.
std::array<std::uint64_t, 2> slow_sums(const std::string& bytes) {
  __extension__ using Wide = unsigned __int128;
  constexpr std::uint64_t kPrime = (std::uint64_t{1} << 61) - 1;
  std::string padded = bytes;
  padded.resize((bytes.size() + 27) / 28 * 28, '\0');
  std::array<std::uint64_t, 2> sums{};
  for (std::size_t at = 0; at < padded.size(); at += 7) {
    std::uint64_t word = 0;
    std::memcpy(&word, padded.data() + at, 7);
    const std::array<std::uint64_t, 2> constants{0x0d413cccfe779921u, 0x176cf5d0b09954e7u};
    for (std::size_t i = 0; i < 2; ++i) {
      sums[i] = static_cast<std::uint64_t>((Wide{sums[i]} * constants[i] + word) % kPrime);
    }
  }
  return sums;
}

TEST_F(MeshCacheTest, ContentHashIsTheValueOfTwoPolynomials) {
  std::string text;
  std::uint64_t state = 1;
  // Several pieces, with high and low bytes.
  for (std::size_t size : {0UL, 1UL, 6UL, 7UL, 8UL, 27UL, 28UL, 29UL, 1000UL, 2'000'000UL}) {
    while (text.size() < size) {
      state = state * 6364136223846793005u + 1442695040888963407u;
      text += static_cast<char>(state >> 56);
    }
    write_text(folder_ / "bytes", text);
    const auto hash = scene::content_hash(folder_ / "bytes");
    ASSERT_TRUE(hash);
    EXPECT_EQ(hash->bytes, size);
    EXPECT_EQ(hash->sums, slow_sums(text));
  }
  write_text(folder_ / "bytes", std::string(1000, '\xff'));
  EXPECT_EQ(scene::content_hash(folder_ / "bytes")->sums, slow_sums(std::string(1000, '\xff')));
  write_text(folder_ / "bytes", std::string(999, '\xff'));
  EXPECT_NE(scene::content_hash(folder_ / "bytes")->bytes, 1000U);
  EXPECT_FALSE(scene::content_hash(folder_ / "none"));
  EXPECT_FALSE(scene::content_hash(folder_));
}

}  // namespace
}  // namespace thimble

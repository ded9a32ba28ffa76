// Recordings of unknown origin. Whatever an HDF5 file contains, no other file is read. Memory is
// bounded by the size of the file, and a crash of the library is an ordinary error.

#include <gtest/gtest.h>

#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#include <cstring>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "recording/h5_handle.h"
#include "support/scratch.h"
#include "thimble/session/recording.h"

namespace thimble::session {
namespace {

namespace fs = std::filesystem;
using driver::TickRecord;
using session::H5Handle;

constexpr std::size_t kRecordedTicks = 64;
constexpr double kSecret = 12345.678;

const session::RecordingInfo kOrigin{.scene = "box",
                                     .scene_file = "scenes/box.yaml",
                                     .scene_text = "name: box\n",
                                     .arm = "arm",
                                     .arm_file = "arms/arm.yaml",
                                     .arm_text = "name: arm\n",
                                     .device = "sim",
                                     .clock = "virtual",
                                     .program = "test",
                                     .rate = 1000,
                                     .seed = 1};

/// Returns a path at which no file exists.
fs::path scratch_file(const char* name) {
  fs::path path = support::scratch_folder() / name;
  fs::remove(path);
  return path;
}

std::vector<TickRecord> some_ticks() {
  std::vector<TickRecord> ticks(kRecordedTicks);
  for (std::size_t i = 0; i < kRecordedTicks; ++i) {
    ticks[i].tick = i;
    ticks[i].q = {0.1 * static_cast<double>(i), 1, 2};
  }
  return ticks;
}

/// Writes a recording in which `make` creates the column "q".
fs::path with_column(const char* name, const std::function<void(hid_t file)>& make) {
  const fs::path path = scratch_file(name);
  EXPECT_TRUE(session::write_recording(path, kOrigin, some_ticks()));
  const H5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
  EXPECT_GE(H5Ldelete(file.id(), "q", H5P_DEFAULT), 0);
  make(file.id());
  return path;
}

/// Creates a data set of joint angles and writes `rows` rows; `change` sets its storage.
void make_column(hid_t file, const std::function<void(hid_t how)>& change,
                 hsize_t claimed = kRecordedTicks, bool write = true, const char* name = "q") {
  const hsize_t sizes[2] = {claimed, 3};
  const H5Handle space(H5Screate_simple(2, sizes, nullptr), H5Sclose);
  const H5Handle how(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  change(how.id());
  const H5Handle set(
      H5Dcreate2(file, name, H5T_IEEE_F64LE, space.id(), H5P_DEFAULT, how.id(), H5P_DEFAULT),
      H5Dclose);
  ASSERT_TRUE(set.good());
  if (!write) return;
  std::vector<double> values;
  for (const TickRecord& tick : some_ticks())
    values.insert(values.end(), tick.q.begin(), tick.q.end());
  ASSERT_GE(H5Dwrite(set.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
}

void expect_refused(const fs::path& path, const std::string& what) {
  const auto read = session::read_recording(path);
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message.find(what), std::string::npos) << read.error().message;
}

/// Writes a file of numbers that must not appear in a recording.
fs::path secret_file() {
  const fs::path path = scratch_file("secret.bin");
  std::ofstream out(path, std::ios::binary);
  for (std::size_t i = 0; i < 3 * kRecordedTicks; ++i) {
    out.write(reinterpret_cast<const char*>(&kSecret), sizeof kSecret);
  }
  return path;
}

TEST(RecordingOrigin, ColumnInAnotherFileIsRefused) {
  const fs::path secret = secret_file();
  const auto path = with_column("external.h5", [&](hid_t file) {
    make_column(
        file,
        [&](hid_t how) {
          H5Pset_external(how, secret.c_str(), 0, 3 * kRecordedTicks * sizeof(double));
        },
        kRecordedTicks, false);
  });
  expect_refused(path, "column q");
}

TEST(RecordingOrigin, ExternalLinkIsRefused) {
  const fs::path other = scratch_file("other.h5");
  ASSERT_TRUE(session::write_recording(other, kOrigin, some_ticks()));
  const auto path = with_column("external_link.h5", [&](hid_t file) {
    ASSERT_GE(H5Lcreate_external(other.c_str(), "/q", file, "q", H5P_DEFAULT, H5P_DEFAULT), 0);
  });
  expect_refused(path, "column q");
}

TEST(RecordingOrigin, SoftLinkIsRefused) {
  const auto path = with_column("soft_link.h5", [](hid_t file) {
    ASSERT_GE(H5Lcreate_soft("/p_WT", file, "q", H5P_DEFAULT, H5P_DEFAULT), 0);
  });
  expect_refused(path, "column q");
}

TEST(RecordingOrigin, VirtualColumnIsRefused) {
  const fs::path other = scratch_file("source.h5");
  ASSERT_TRUE(session::write_recording(other, kOrigin, some_ticks()));
  const auto path = with_column("virtual.h5", [&](hid_t file) {
    const hsize_t sizes[2] = {kRecordedTicks, 3};
    const H5Handle space(H5Screate_simple(2, sizes, nullptr), H5Sclose);
    make_column(
        file,
        [&](hid_t how) {
          ASSERT_GE(H5Pset_virtual(how, space.id(), other.c_str(), "/q", space.id()), 0);
        },
        kRecordedTicks, false);
  });
  expect_refused(path, "column q");
}

TEST(RecordingOrigin, FilterOfAUserIsRefused) {
  const auto path = with_column("filter.h5", [](hid_t file) {
    make_column(file, [](hid_t how) {
      const hsize_t chunk[2] = {16, 3};
      H5Pset_chunk(how, 2, chunk);
      H5Pset_filter(how, 32004, H5Z_FLAG_OPTIONAL, 0, nullptr);
    });
  });
  expect_refused(path, "column q");
}

TEST(RecordingOrigin, CompressedColumnIsRead) {
  const auto path = with_column("deflated.h5", [](hid_t file) {
    make_column(file, [](hid_t how) {
      const hsize_t chunk[2] = {16, 3};
      H5Pset_chunk(how, 2, chunk);
      H5Pset_shuffle(how);
      H5Pset_deflate(how, 9);
      H5Pset_fletcher32(how);
    });
  });
  const auto read = session::read_recording(path);
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->ticks.size(), kRecordedTicks);
  for (std::size_t i = 0; i < kRecordedTicks; ++i) EXPECT_EQ(read->ticks[i].q, some_ticks()[i].q);
}

/// Makes a recording of a few kilobytes whose header states `claimed` ticks, but which contains
/// none.
fs::path hollow_recording(const char* name, hsize_t claimed, bool chunked) {
  const fs::path path = scratch_file(name);
  EXPECT_TRUE(session::write_recording(path, kOrigin, some_ticks()));
  const H5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
  for (const session::RecordingColumn& column : session::recording_columns()) {
    EXPECT_GE(H5Ldelete(file.id(), column.name, H5P_DEFAULT), 0);
    const hsize_t sizes[2] = {claimed, column.width};
    const int rank = column.width == 1 ? 1 : 2;
    const H5Handle space(H5Screate_simple(rank, sizes, nullptr), H5Sclose);
    const H5Handle how(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    const hsize_t chunk[2] = {1024, column.width};
    if (chunked) H5Pset_chunk(how.id(), rank, chunk);
    const bool floating = column.type == session::RecordingColumn::Type::kF64 ||
                          column.type == session::RecordingColumn::Type::kF32;
    const H5Handle set(H5Dcreate2(file.id(), column.name, floating ? H5T_IEEE_F64LE : H5T_STD_I64LE,
                                  space.id(), H5P_DEFAULT, how.id(), H5P_DEFAULT),
                       H5Dclose);
    EXPECT_TRUE(set.good());
  }
  const H5Handle rows(H5Dopen2(file.id(), "rows", H5P_DEFAULT), H5Dclose);
  EXPECT_GE(H5Dwrite(rows.id(), H5T_NATIVE_HSIZE, H5S_ALL, H5S_ALL, H5P_DEFAULT, &claimed), 0);
  return path;
}

std::size_t peak_kilobytes() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  return static_cast<std::size_t>(used.ru_maxrss);
}

TEST(RecordingOrigin, ClaimsNoMoreTicksThanItStores) {
  for (const bool chunked : {false, true}) {
    const std::size_t before = peak_kilobytes();
    expect_refused(hollow_recording("hollow.h5", 30'000'000, chunked),
                   "states 30000000 ticks, but it does not contain them");
    EXPECT_LT(peak_kilobytes() - before, 100'000U);
  }
}

// As few ticks as would fit into the memory that any recording may use.
TEST(RecordingOrigin, ClaimIsComparedWithTheBytesOfItsTicks) {
  for (const hsize_t claimed : {20'000, 100'000}) {
    expect_refused(hollow_recording("hollow.h5", claimed, false),
                   "states " + std::to_string(claimed) + " ticks, but it does not contain them");
  }
}

// A whole day of ticks in a file of a few kilobytes, which is one hole.
TEST(RecordingOrigin, HoleCountsAsNoTicks) {
  const fs::path path = hollow_recording("hole.h5", 20'000'000, false);
  {
    const H5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    ASSERT_GE(H5Ldelete(file.id(), "tick", H5P_DEFAULT), 0);
    const hsize_t size = 20'000'000;
    const H5Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
    const H5Handle how(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_alloc_time(how.id(), H5D_ALLOC_TIME_EARLY);
    H5Pset_fill_time(how.id(), H5D_FILL_TIME_NEVER);
    const H5Handle set(H5Dcreate2(file.id(), "tick", H5T_STD_U64LE, space.id(), H5P_DEFAULT,
                                  how.id(), H5P_DEFAULT),
                       H5Dclose);
    ASSERT_TRUE(set.good());
  }
  expect_refused(path, "states 20000000 ticks, but it does not contain them");
}

TEST(RecordingOrigin, PipeIsRefused) {
  const fs::path path = scratch_file("pipe.h5");
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  expect_refused(path, "not a regular file");
}

TEST(RecordingOrigin, DeviceIsRefused) {
  expect_refused("/dev/zero", "not a regular file");
}

/// Writes a recording that names another scene file.
session::Recording of_scene(const fs::path& scene) {
  session::RecordingInfo info = kOrigin;
  info.scene_file = scene.string();
  const fs::path path = scratch_file("of_scene.h5");
  EXPECT_TRUE(session::write_recording(path, info, some_ticks()));
  auto read = session::read_recording(path);
  EXPECT_TRUE(read);
  return std::move(read).value();
}

// Without a limit this would use all memory of the machine.
TEST(RecordingOrigin, SceneThatIsADeviceIsNotRead) {
  const session::Recording recording = of_scene("/dev/zero");
  EXPECT_FALSE(session::check_repeatable(recording));
  const auto replayed = session::replay(recording);
  ASSERT_FALSE(replayed);
  EXPECT_NE(replayed.error().message.find("/dev/zero"), std::string::npos)
      << replayed.error().message;
}

TEST(RecordingOrigin, SceneThatIsAPipeIsNotWaitedFor) {
  const fs::path pipe = scratch_file("scene_pipe.yaml");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const session::Recording recording = of_scene(pipe);
  EXPECT_FALSE(session::check_repeatable(recording));
  EXPECT_FALSE(session::replay(recording));
}

// Files to which a scene refers: meshes, pages, pictures, arms and bags.
TEST(RecordingOrigin, FilesOfASceneThatArePipesAreRefused) {
  for (const char* name :
       {"pipe.off", "pipe.stl", "pipe.gltf", "pipe.pages", "pipe.png", "pipe.yaml", "pipe.db3"}) {
    ASSERT_EQ(mkfifo(scratch_file(name).c_str(), 0600), 0);
  }
  const std::string arm = THIMBLE_SOURCE_DIR "/app/arms/vintage_phantom.yaml";
  const std::string path = "hand: {path: [{t: 0, at: [0, 0, 0.05]}, {t: 1, at: [0, 0, 0.04]}]}\n";
  const std::string plain_box =
      "objects: [{name: box, box: {sides: [0.03, 0.03, 0.03]}, "
      "stiffness: 300}]\n";
  const auto object = [&](const std::string& shape) {
    return "name: hostile\narm: " + arm + "\nduration: 1\nobjects: [{name: box, " + shape +
           ", stiffness: 300}]\n" + path;
  };
  std::vector<std::string> scenes;
  for (const char* mesh : {"pipe.off", "pipe.stl", "pipe.gltf", "pipe.pages"}) {
    scenes.push_back(object("mesh: " + std::string(mesh)));
  }
  scenes.push_back(
      object("box: {sides: [0.03, 0.03, 0.03]}, effects: [{texture: height_map, image: pipe.png, "
             "width: 0.01, height: 0.001}]"));
  scenes.push_back("name: hostile\narm: pipe.yaml\nduration: 1\n" + plain_box + path);
  scenes.push_back("name: hostile\narm: " + arm + "\nduration: 1\n" + plain_box +
                   "hand: {bag: pipe.db3}\n");
  for (const std::string& text : scenes) {
    SCOPED_TRACE(text);
    const fs::path scene = scratch_file("hostile.yaml");
    std::ofstream(scene) << text;
    const auto replayed = session::replay(of_scene(scene));
    ASSERT_FALSE(replayed);
    EXPECT_FALSE(replayed.error().message.empty());
  }
}

}  // namespace
}  // namespace thimble::session

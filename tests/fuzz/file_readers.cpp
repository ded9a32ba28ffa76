#include "fuzz/file_readers.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "arm/wire_section.h"
#include "disk_paging/checksum.h"
#include "disk_paging/page_file.h"
#include "mesh/repair/touching_parts.h"
#include "thimble/render/mesh/check_mesh.h"
#include "thimble/render/mesh/mesh_file.h"
#include "thimble/render/mesh/repair_mesh.h"
#include "thimble/render/mesh/thicken_sheets.h"
#include "thimble/scene/arm_file.h"
#include "thimble/scene/scene_file.h"
#include "thimble/scene/scene_objects.h"
#include "thimble/session/recording.h"

namespace thimble::fuzz {
namespace {

using Bytes = std::span<const std::byte>;

void check(bool kept, const char* what) {
  if (kept) return;
  std::fprintf(stderr, "Check of a file reader failed: %s\n", what);
  std::abort();
}

/// Returns a folder of this process, removed at its end: in TMPDIR, or in memory if available,
/// because some disks write a replaced file immediately.
const std::filesystem::path& folder() {
  struct Folder {
    std::filesystem::path path = (std::getenv("TMPDIR") == nullptr && access("/dev/shm", W_OK) == 0
                                      ? "/dev/shm"
                                      : std::filesystem::temp_directory_path()) /
                                 std::filesystem::path("thimble_fuzz_" + std::to_string(getpid()));
    Folder() { std::filesystem::create_directories(path); }
    ~Folder() {
      std::error_code ignored;
      std::filesystem::remove_all(path, ignored);
    }
  };
  static const Folder one;
  return one.path;
}

std::filesystem::path store(Bytes bytes, const char* name) {
  const std::filesystem::path path = folder() / name;
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  return path;
}

template <class T>
bool accepted(const driver::Result<T>& result) {
  if (!result) check(!result.error().message.empty(), "an error has a message");
  return static_cast<bool>(result);
}

bool read_scene_file(Bytes bytes) {
  static const bool arm_beside = std::filesystem::copy_file(
      THIMBLE_SOURCE_DIR "/app/arms/vintage_phantom.yaml", folder() / "arm.yaml");
  check(arm_beside, "the arm file is next to the scene");
  const auto scene = scene::load_scene(store(bytes, "any.yaml"),
                                       {.mesh_folder = THIMBLE_SOURCE_DIR "/tests/data/meshes"});
  if (!accepted(scene)) return false;
  check(std::isfinite(scene->duration) && scene->duration > 0, "a scene has a duration");
  check(std::isfinite(scene->rate) && scene->rate > 0, "a scene has a rate");
  // Patches of a body may take long to build; random scenes are kept small.
  if (scene->objects.size() > 4) return true;
  const auto objects = scene::SceneObjects::build(*scene);
  if (!accepted(objects)) return true;
  render::SceneTouch& touch = (*objects)->touch();
  driver::DeviceState state;
  state.dt = 1e-3;
  state.fresh = true;
  for (const double z : {0.1, 0.01, 0.0, -0.01, 0.1}) {
    ++state.tick;
    state.time_ns += 1'000'000;
    state.v_WT = (Eigen::Vector3d(0.001, 0.002, z) - state.p_WT) / state.dt;
    state.p_WT = {0.001, 0.002, z};
    const driver::ForceCommand command = touch(state);
    // An infinite requested force is the gate's task; this fuzzer checks what a tick executes and
    // reads.
    static_cast<void>(command);
  }
  return true;
}

/// Reads the section `wire` of an arm file; messages of an accepted one can be written and read.
bool read_wire_file(Bytes bytes) {
  const auto wire = scene::load_wire(store(bytes, "any.yaml"));
  if (!accepted(wire)) return false;
  for (const driver::WireLayout* layout : {&(*wire)->report, &(*wire)->command}) {
    driver::WireValues values;
    values.encoders = {1, -2, 3};
    std::array<std::byte, driver::kReportCapacity> message{};
    const std::size_t size = layout->write(values, message);
    check(size > 0 && size <= message.size(), "a message fits its buffer");
    static_cast<void>(layout->read(Bytes(message).first(size), values));
    static_cast<void>(layout->read(bytes, values));
    static_cast<void>(layout->values_of(Bytes(message).first(size)));
  }
  return true;
}

bool read_mesh(Bytes bytes, const char* name) {
  const auto file = store(bytes, name);
  const auto mesh = render::load_mesh(file);
  render::MeshAttributes attributes;
  const auto with_attributes = render::load_mesh_with_attributes(file, attributes);
  if (!accepted(mesh)) return false;
  if (with_attributes) {
    const std::size_t triangles = mesh->triangles.size();
    check(with_attributes->triangles == mesh->triangles, "attributes do not change a mesh");
    check(attributes.uv.empty() || attributes.uv.size() == triangles,
          "texture coordinates belong to triangles");
    check(attributes.colours.empty() || attributes.colours.size() == triangles,
          "colours belong to triangles");
  }
  check(!mesh->triangles.empty(), "a mesh has triangles");
  for (const auto& vertex : mesh->vertices) {
    check(vertex.cwiseAbs().maxCoeff() <= 1e15, "a vertex has valid coordinates");
  }
  for (const auto& triangle : mesh->triangles) {
    for (const std::int32_t corner : triangle) {
      check(corner >= 0 && static_cast<std::size_t>(corner) < mesh->vertices.size(),
            "a triangle has vertices");
    }
  }
  if (mesh->triangles.size() > 2000) return true;
  // What users do with a mesh: check it, repair it, and make sheets of open parts.
  static_cast<void>(render::check_mesh(*mesh));
  static_cast<void>(render::describe(render::find_touching_parts(*mesh)));
  const render::RepairedMesh repaired = render::repair_mesh(*mesh);
  const double size = (repaired.mesh.vertices.empty() ? 0 : repaired.mesh.vertices[0].norm()) + 1;
  static_cast<void>(render::thicken_sheets(repaired.mesh, 0.01 * size));
  return true;
}

std::vector<std::byte> bytes_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::vector<std::byte> bytes(std::filesystem::file_size(path));
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  return bytes;
}

/// Damages a valid file: place (4 bytes, modulo the size of the file), count (1 byte, at most 16),
/// the bytes to write there; repeated.
std::vector<std::byte> damaged(std::vector<std::byte> file, Bytes orders) {
  while (orders.size() > 5) {
    std::uint32_t place = 0;
    std::memcpy(&place, orders.data(), sizeof place);
    std::size_t count = std::to_integer<unsigned>(orders[4]) % 17;
    orders = orders.subspan(5);
    count = std::min(count, orders.size());
    for (std::size_t i = 0; i < count; ++i) file[(place + i) % file.size()] = orders[i];
    orders = orders.subspan(count);
  }
  return file;
}

std::vector<std::byte> sound_pages() {
  const auto mesh = render::load_mesh(THIMBLE_SOURCE_DIR "/tests/data/meshes/box.off");
  check(static_cast<bool>(mesh), "a valid mesh is read");
  const auto surface = render::PackedSurface::build(*mesh, {});
  check(static_cast<bool>(surface), "a valid mesh is packed");
  const std::filesystem::path path = folder() / "sound.pages";
  check(static_cast<bool>(render::write_page_file(*surface, path)), "pages can be written");
  return bytes_of(path);
}

/// Corrects the checksums of a file of one page, so that the code behind them is reached. The
/// places are those of page_file.cpp.
void put_checksums_right(std::vector<std::byte>& file) {
  constexpr std::size_t kHead = 72, kSum = 20, kBox = 24, kRecords = 4096;
  const std::uint64_t page = render::checksum(Bytes(file).subspan(kRecords));
  std::memcpy(file.data() + kHead + kBox, &page, sizeof page);
  std::memset(file.data() + kSum, 0, sizeof(std::uint32_t));
  std::uint64_t sum = render::checksum(Bytes(file).first(kHead));
  sum = render::checksum(Bytes(file).subspan(kHead, kBox), sum);
  sum = render::checksum(Bytes(file).subspan(kHead + kBox, sizeof page), sum);
  const auto folded = static_cast<std::uint32_t>(sum ^ (sum >> 32));
  std::memcpy(file.data() + kSum, &folded, sizeof folded);
}

/// Touches the pages as a scene does.
void touch_pages(const std::filesystem::path& pages) {
  scene::Scene scene;
  scene.rate = 1000;
  scene::SceneObject object;
  object.name = "pages";
  object.mesh_file = pages;
  object.paged = true;
  object.stiffness = 100;
  object.contact.tracker = render::TrackerChoice::kPacked;
  scene.objects.push_back(object);
  const auto objects = scene::SceneObjects::build(scene);
  if (!accepted(objects)) return;
  driver::DeviceState state;
  state.dt = 1e-3;
  state.fresh = true;
  for (const double z : {4.0, 1.51, 1.49, 1.0, 0.5, -0.1}) {
    ++state.tick;
    state.p_WT = {0.1, 0.2, z};
    static_cast<void>((*objects)->touch()(state));
    (*objects)->serve_pages();
  }
}

bool read_pages(Bytes bytes) {
  static const std::vector<std::byte> sound = sound_pages();
  const bool rehash = !bytes.empty() && (std::to_integer<unsigned>(bytes[0]) & 1) != 0;
  std::vector<std::byte> whole = damaged(sound, bytes.empty() ? bytes : bytes.subspan(1));
  if (rehash) put_checksums_right(whole);
  const std::filesystem::path path = store(whole, "any.pages");
  const auto file = render::PageFile::open(path);
  if (!accepted(file)) return false;
  check(file->triangle_count() > 0, "a page file has triangles");
  std::vector<render::PackedTriangle> records(render::kPageTriangles);
  std::int64_t in_all = 0;
  for (std::size_t page = 0; page < file->boxes().size(); ++page) {
    const std::int32_t count = file->read_page(static_cast<std::int32_t>(page), records);
    check(count >= 0 && count <= render::kPageTriangles, "a page fits its buffer");
    in_all += count;
  }
  check(in_all <= file->triangle_count(), "pages hold no more triangles than announced");
  touch_pages(path);
  return true;
}

/// Returns a recording of eight ticks.
std::vector<std::byte> sound_recording() {
  const std::vector<driver::TickRecord> ticks(8);
  session::RecordingInfo info;
  info.scene = "fuzz";
  info.rate = 1000;
  const std::filesystem::path path = folder() / "sound.h5";
  check(static_cast<bool>(session::write_recording(path, info, ticks)),
        "a recording can be written");
  return bytes_of(path);
}

bool read_recording(Bytes bytes) {
  static const std::vector<std::byte> sound = sound_recording();
  const auto recording = session::read_recording(store(damaged(sound, bytes), "any.h5"));
  if (!accepted(recording)) return false;
  check(recording->info.rate > 0, "a recording has a rate");
  for (const driver::TickRecord& tick : recording->ticks) {
    check(!name(tick.fault).empty(), "a tick's fault has a name");
  }
  return true;
}

}  // namespace

bool read_any_file(std::string_view kind, Bytes bytes) {
  if (kind == "scene") return read_scene_file(bytes);
  if (kind == "arm") return accepted(scene::load_arm(store(bytes, "any.yaml")));
  if (kind == "wire") return read_wire_file(bytes);
  if (kind == "off") return read_mesh(bytes, "any.off");
  if (kind == "obj") return read_mesh(bytes, "any.obj");
  if (kind == "stl") return read_mesh(bytes, "any.stl");
  if (kind == "ply") return read_mesh(bytes, "any.ply");
  if (kind == "gltf") return read_mesh(bytes, "any.gltf");
  if (kind == "glb") return read_mesh(bytes, "any.glb");
  if (kind == "3mf") return read_mesh(bytes, "any.3mf");
  if (kind == "dae") return read_mesh(bytes, "any.dae");
  if (kind == "amf") return read_mesh(bytes, "any.amf");
  if (kind == "3ds") return read_mesh(bytes, "any.3ds");
  if (kind == "page") return read_pages(bytes);
  if (kind == "recording") return read_recording(bytes);
  check(false, "the kind of file is known");
  return false;
}

}  // namespace thimble::fuzz

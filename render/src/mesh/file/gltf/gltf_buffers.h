#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "thimble/driver/result.h"

namespace thimble::render {

/// Maximum size of a glTF file, and of a file that it names; the same as for a mesh file, bytes.
inline constexpr std::uint64_t kGltfFileMax = std::uint64_t{4} << 30;

/// Returns a member of a JSON object; null if it is not an object or has no such member.
const nlohmann::json* json_member(const nlohmann::json& object, const char* key);

/// Returns a member that is a non-negative integer; empty if it is absent or anything else.
std::optional<std::size_t> json_index(const nlohmann::json& object, const char* key);

/// Returns an element of the array `key` of a glTF file; null if it does not exist.
const nlohmann::json* gltf_element(const nlohmann::json& gltf, const char* key, std::size_t index);

/// Returns a URI with its percent-encoded bytes decoded [RFC 3986, 2.1].
std::string percent_decoded(std::string_view uri);

/// The numbers of an accessor.
struct GltfNumbers {
  std::vector<double> values;  ///< `columns` for each element.
  bool single = false;         ///< Whether they were in single precision.
};

/// The buffers of a glTF file and the numbers in them. Errors are half a sentence. The referenced
/// data must outlive it. Real-time: never from the servo thread.
class GltfBuffers {
 public:
  /// Takes the JSON of a file, the binary chunk of a GLB file, and the folder of both.
  GltfBuffers(const nlohmann::json& gltf, std::string_view chunk, std::filesystem::path folder)
      : gltf_(gltf), chunk_(chunk), folder_(std::move(folder)) {}

  /// Returns the numbers of an accessor with elements of `columns` numbers; integers are scaled if
  /// the accessor is normalized. Zeros if it names no view, with its sparse values applied.
  driver::Result<GltfNumbers> read(std::size_t accessor, std::size_t columns);

 private:
  /// Location of the elements of a view.
  struct View {
    std::string_view bytes;
    std::size_t stride = 0;  // 0: packed
  };
  driver::Result<std::string_view> buffer(std::size_t index);
  driver::Result<View> view(std::size_t index);
  driver::Result<void> read_view(const nlohmann::json& part, std::size_t type, std::size_t count,
                                 std::size_t columns, bool may_stride, bool normalized,
                                 std::vector<double>& values);
  driver::Result<void> apply_sparse(const nlohmann::json& sparse, std::size_t type,
                                    std::size_t columns, bool normalized,
                                    std::vector<double>& values);

  const nlohmann::json& gltf_;
  std::string_view chunk_;
  std::filesystem::path folder_;
  std::map<std::size_t, std::string> buffers_;             // decoded buffers
  std::map<std::string, std::string, std::less<>> files_;  // files, each read once
};

}  // namespace thimble::render

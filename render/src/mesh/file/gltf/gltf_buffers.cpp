#include "mesh/file/gltf/gltf_buffers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "system/regular_file.h"

namespace thimble::render {
namespace {

using driver::Error;
using Json = nlohmann::json;

// The types of the numbers of an accessor [glTF 2.0, 3.6.2.2].
enum AccessorType : std::size_t {
  kByte = 5120,
  kUnsignedByte = 5121,
  kShort = 5122,
  kUnsignedShort = 5123,
  kUnsignedInt = 5125,
  kFloat = 5126
};

std::size_t size_of(std::size_t type) {
  if (type == kByte || type == kUnsignedByte) return 1;
  if (type == kShort || type == kUnsignedShort) return 2;
  return type == kUnsignedInt || type == kFloat ? 4 : 0;
}

template <class Number>
double number_at(const char* bytes, bool normalized) {
  Number number{};
  std::memcpy(&number, bytes, sizeof number);
  const auto value = static_cast<double>(number);
  if (!normalized || std::numeric_limits<Number>::is_iec559) return value;
  return std::max(value / static_cast<double>(std::numeric_limits<Number>::max()), -1.0);
}

double number_of(std::size_t type, const char* bytes, bool normalized) {
  switch (type) {
    case kByte:
      return number_at<std::int8_t>(bytes, normalized);
    case kUnsignedByte:
      return number_at<std::uint8_t>(bytes, normalized);
    case kShort:
      return number_at<std::int16_t>(bytes, normalized);
    case kUnsignedShort:
      return number_at<std::uint16_t>(bytes, normalized);
    case kUnsignedInt:
      return number_at<std::uint32_t>(bytes, normalized);
    default:
      return number_at<float>(bytes, normalized);
  }
}

int digit_of(char c) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  if (c == '-') c = '+';
  if (c == '_') c = '/';
  const std::size_t digit = kDigits.find(c);
  return digit == std::string_view::npos ? -1 : static_cast<int>(digit);
}

driver::Result<std::string> base64_decoded(std::string_view text) {
  while (text.ends_with('=')) text.remove_suffix(1);
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const int digit = digit_of(c);
    if (digit < 0) return Error{"a data URI is not valid base64"};
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 0xff);
  }
  return bytes;
}

driver::Result<std::string> data_of_uri(std::string_view uri) {
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos) return Error{"a data URI has no data"};
  const std::string_view data = uri.substr(comma + 1);
  if (uri.substr(0, comma).ends_with(";base64")) return base64_decoded(percent_decoded(data));
  return percent_decoded(data);
}

// Returns a name for use in an error message: the file may contain anything.
std::string shown(std::string_view name) {
  std::string text = "\"";
  for (const char c : name.substr(0, 80)) text += c >= ' ' && c < 127 ? c : '?';
  return text + '"';
}

driver::Result<std::string> bytes_of_file(const std::filesystem::path& folder,
                                          const std::string& name) {
  const std::filesystem::path relative(name);
  const bool leaves =
      std::any_of(relative.begin(), relative.end(), [](const auto& step) { return step == ".."; });
  if (relative.empty() || relative.is_absolute() || leaves) {
    return Error{"it refers to a file outside its folder, " + shown(name)};
  }
  auto bytes = driver::read_file(folder / relative, kGltfFileMax);
  if (!bytes) {
    std::string reason = bytes.error().message;
    if (reason.ends_with('.')) reason.pop_back();
    return Error{"it refers to " + shown(name) + ": " + reason};
  }
  return bytes;
}

bool has_scheme(std::string_view uri) {
  const std::size_t colon = uri.find(':');
  return colon != std::string_view::npos && uri.find('/') > colon;
}

}  // namespace

const Json* json_member(const Json& object, const char* key) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

std::optional<std::size_t> json_index(const Json& object, const char* key) {
  const Json* const value = json_member(object, key);
  constexpr double kWholeMax = 9007199254740992;  // 2^53
  if (value == nullptr || !value->is_number()) return std::nullopt;
  const double number = value->get<double>();
  if (!(number >= 0 && number <= kWholeMax) || number != std::floor(number)) return std::nullopt;
  return static_cast<std::size_t>(number);
}

const Json* gltf_element(const Json& gltf, const char* key, std::size_t index) {
  const Json* const array = json_member(gltf, key);
  if (array == nullptr || !array->is_array() || index >= array->size()) return nullptr;
  return &(*array)[index];
}

std::string percent_decoded(std::string_view uri) {
  const auto hex = [](char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
  };
  std::string plain;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const bool coded =
        uri[i] == '%' && i + 2 < uri.size() && hex(uri[i + 1]) >= 0 && hex(uri[i + 2]) >= 0;
    plain += coded ? static_cast<char>(16 * hex(uri[i + 1]) + hex(uri[i + 2])) : uri[i];
    if (coded) i += 2;
  }
  return plain;
}

driver::Result<std::string_view> GltfBuffers::buffer(std::size_t index) {
  const Json* const buffer = gltf_element(gltf_, "buffers", index);
  if (buffer == nullptr) return Error{"buffer " + std::to_string(index) + " does not exist"};
  const auto length = json_index(*buffer, "byteLength");
  if (!length) return Error{"buffer " + std::to_string(index) + " has no length"};
  const auto cut = [&](std::string_view bytes) -> driver::Result<std::string_view> {
    if (bytes.size() >= *length) return bytes.substr(0, *length);
    return Error{"buffer " + std::to_string(index) + " declares " + std::to_string(*length) +
                 " bytes but has " + std::to_string(bytes.size()) + ": it is truncated"};
  };
  const Json* const uri = json_member(*buffer, "uri");
  if (uri == nullptr) {
    if (index == 0 && !chunk_.empty()) return cut(chunk_);
    return Error{"buffer " + std::to_string(index) + " has no data"};
  }
  if (!uri->is_string()) return Error{"buffer " + std::to_string(index) + " has no URI"};
  const auto& name = uri->get_ref<const std::string&>();
  if (name.starts_with("data:")) {
    if (!buffers_.contains(index)) {
      auto data = data_of_uri(name);
      if (!data) return data.error();
      buffers_.emplace(index, std::move(data).value());
    }
    return cut(buffers_.at(index));
  }
  if (has_scheme(name))
    return Error{"it refers to " + shown(name) + "; only files in its folder are read"};
  const std::string file = percent_decoded(name);
  if (!files_.contains(file)) {
    auto bytes = bytes_of_file(folder_, file);
    // Names that were not encoded but contain a per cent sign.
    if (!bytes && file != name) {
      if (auto plain = bytes_of_file(folder_, name)) bytes = std::move(plain);
    }
    if (!bytes) return bytes.error();
    files_.emplace(file, std::move(bytes).value());
  }
  return cut(files_.at(file));
}

driver::Result<GltfBuffers::View> GltfBuffers::view(std::size_t index) {
  const Json* const view = gltf_element(gltf_, "bufferViews", index);
  const std::string name = "buffer view " + std::to_string(index);
  if (view == nullptr) return Error{name + " does not exist"};
  const Json* const extensions = json_member(*view, "extensions");
  for (const char* packed : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
    if (extensions != nullptr && json_member(*extensions, packed) != nullptr) {
      return Error{name + " is compressed with " + packed +
                   ", which is not supported; export the mesh without it"};
    }
  }
  const auto number = json_index(*view, "buffer");
  const auto length = json_index(*view, "byteLength");
  const std::size_t offset = json_index(*view, "byteOffset").value_or(0);
  if (!number || !length) return Error{name + " has no buffer or length"};
  const auto bytes = buffer(*number);
  if (!bytes) return bytes.error();
  if (offset > bytes->size() || *length > bytes->size() - offset) {
    return Error{name + " is not within its buffer"};
  }
  return View{bytes->substr(offset, *length), json_index(*view, "byteStride").value_or(0)};
}

driver::Result<void> GltfBuffers::read_view(const Json& part, std::size_t type, std::size_t count,
                                            std::size_t columns, bool may_stride, bool normalized,
                                            std::vector<double>& values) {
  const auto index = json_index(part, "bufferView");
  if (!index) return Error{"an accessor has no buffer view"};
  const auto found = view(*index);
  if (!found) return found.error();
  const std::size_t offset = json_index(part, "byteOffset").value_or(0);
  const std::size_t size = columns * size_of(type);
  const std::size_t stride = may_stride && found->stride > 0 ? found->stride : size;
  const std::string_view bytes = found->bytes;
  if (count == 0) return {};
  if (offset > bytes.size() || size > bytes.size() - offset ||
      (count - 1) > (bytes.size() - offset - size) / stride) {
    return Error{"an accessor is not within buffer view " + std::to_string(*index)};
  }
  values.resize(count * columns);
  for (std::size_t i = 0; i < count; ++i) {
    const char* const element = bytes.data() + offset + i * stride;
    for (std::size_t column = 0; column < columns; ++column) {
      values[i * columns + column] = number_of(type, element + column * size_of(type), normalized);
    }
  }
  return {};
}

driver::Result<void> GltfBuffers::apply_sparse(const Json& sparse, std::size_t type,
                                               std::size_t columns, bool normalized,
                                               std::vector<double>& values) {
  const auto count = json_index(sparse, "count");
  const Json* const indices = json_member(sparse, "indices");
  const Json* const replaced = json_member(sparse, "values");
  if (!count || indices == nullptr || replaced == nullptr) {
    return Error{"a sparse accessor has no count, indices or values"};
  }
  const std::size_t index_type = json_index(*indices, "componentType").value_or(0);
  if (size_of(index_type) == 0 || index_type == kFloat) {
    return Error{"a sparse accessor has indices of an unknown type"};
  }
  std::vector<double> places, numbers;
  if (auto read = read_view(*indices, index_type, *count, 1, false, false, places); !read) {
    return read;
  }
  if (auto read = read_view(*replaced, type, *count, columns, false, normalized, numbers); !read) {
    return read;
  }
  for (std::size_t i = 0; i < *count; ++i) {
    const auto place = static_cast<std::size_t>(std::max(places[i], 0.0));
    if (place >= values.size() / columns) {
      return Error{"a sparse accessor refers to an element that does not exist"};
    }
    std::copy_n(numbers.begin() + static_cast<std::ptrdiff_t>(i * columns), columns,
                values.begin() + static_cast<std::ptrdiff_t>(place * columns));
  }
  return {};
}

driver::Result<GltfNumbers> GltfBuffers::read(std::size_t accessor, std::size_t columns) {
  const Json* const found = gltf_element(gltf_, "accessors", accessor);
  const std::string name = "accessor " + std::to_string(accessor);
  if (found == nullptr) return Error{name + " does not exist"};
  constexpr std::array<std::pair<std::string_view, std::size_t>, 4> kTypes{
      {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}}};
  const Json* const type = json_member(*found, "type");
  const bool fits =
      type != nullptr && type->is_string() &&
      std::any_of(kTypes.begin(), kTypes.end(), [&](const auto& known) {
        return known.second == columns && known.first == type->get_ref<const std::string&>();
      });
  const std::size_t component = json_index(*found, "componentType").value_or(0);
  const auto count = json_index(*found, "count");
  if (!fits || size_of(component) == 0 || !count) {
    return Error{name + " has an unexpected type"};
  }
  const Json* const normalized = json_member(*found, "normalized");
  const bool scaled = normalized != nullptr && normalized->is_boolean() && normalized->get<bool>();
  GltfNumbers numbers;
  numbers.single = component == kFloat;
  if (json_member(*found, "bufferView") != nullptr) {
    if (auto read = read_view(*found, component, *count, columns, true, scaled, numbers.values);
        !read) {
      return read.error();
    }
  } else {
    constexpr std::size_t kZerosMax = 100'000'000;
    if (*count > kZerosMax) return Error{name + " has too many elements without data"};
    numbers.values.assign(*count * columns, 0.0);
  }
  if (const Json* const sparse = json_member(*found, "sparse")) {
    if (auto put = apply_sparse(*sparse, component, columns, scaled, numbers.values); !put) {
      return put.error();
    }
  }
  return numbers;
}

}  // namespace thimble::render

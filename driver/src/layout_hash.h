#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>
#include <utility>

#include "thimble/driver/snapshot.h"

namespace thimble::driver {

// A hash of the layout of a struct that processes of different builds share: names, types, offsets
// and sizes of its fields, recursively. Two builds with the same hash read the same bytes in the
// same way. A struct is described once, at global scope, by
//
//   THIMBLE_LAYOUT(thimble::some::Struct, first_field, second_field)
//
// and an enumeration by THIMBLE_LAYOUT_ENUM with its enumerators. A field or an enumerator that is
// missing from the description is a compile-time error. The hash is computed at compile time.

/// Fields of a struct or enumerators of an enumeration; specialised by THIMBLE_LAYOUT and
/// THIMBLE_LAYOUT_ENUM.
template <class T>
struct LayoutFields;

namespace layout_detail {

inline constexpr std::uint64_t kBegin = 0xcbf29ce484222325;

/// Mixes a number into a hash: FNV-1a over its bytes [Fowler, Noll, Vo; RFC 9923].
constexpr std::uint64_t mix(std::uint64_t hash, std::uint64_t number) noexcept {
  for (int byte = 0; byte < 8; ++byte) {
    hash = (hash ^ (number >> (8 * byte) & 0xff)) * 0x100000001b3;
  }
  return hash;
}

constexpr std::uint64_t mix(std::uint64_t hash, std::string_view text) noexcept {
  for (const char c : text) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  }
  return mix(hash, text.size());
}

template <class T>
struct Layout {
  static constexpr std::uint64_t hash() noexcept {
    std::uint64_t hash = mix(kBegin, sizeof(T));
    if constexpr (std::is_same_v<T, char>) {
      return mix(hash, "text");  // signedness depends on the processor
    } else if constexpr (std::is_arithmetic_v<T>) {
      hash = mix(hash, std::is_floating_point_v<T> ? "float" : "integer");
      return mix(hash, std::is_same_v<T, bool> ? 2 : std::is_signed_v<T> ? 1 : 0);
    } else if constexpr (std::is_enum_v<T>) {
      hash = mix(hash, Layout<std::underlying_type_t<T>>::hash());
      return LayoutFields<T>::mix_all(hash);
    } else {
      static_assert(std::is_standard_layout_v<T>, "Offsets of the fields must be defined.");
      return LayoutFields<T>::mix_all(hash);
    }
  }
};

template <class T, std::size_t N>
struct Layout<std::array<T, N>> {
  static constexpr std::uint64_t hash() noexcept {
    return mix(mix(mix(kBegin, "array"), N), Layout<T>::hash());
  }
};

template <class T>
struct Layout<std::atomic<T>> {
  static constexpr std::uint64_t hash() noexcept {
    return mix(mix(mix(kBegin, "atomic"), sizeof(std::atomic<T>)), Layout<T>::hash());
  }
};

template <class T>
struct Layout<Snapshot<T>> {
  static constexpr std::uint64_t hash() noexcept {
    return mix(mix(mix(kBegin, "snapshot"), sizeof(Snapshot<T>)), Layout<T>::hash());
  }
};

/// A value that converts to the type of any field.
struct AnyValue {
  template <class T>
  constexpr operator T() const noexcept;  // NOLINT(google-explicit-constructor)
};

template <class T, std::size_t... I>
constexpr bool takes_values(std::index_sequence<I...>) {
  return requires {
    T{(static_cast<void>(I), AnyValue{})...};
  };
}

/// Returns whether an aggregate has exactly `Count` fields: it can be initialised from `Count`
/// values, but not from one more.
template <class T, std::size_t Count>
constexpr bool has_fields() {
  static_assert(std::is_aggregate_v<T>);
  return takes_values<T>(std::make_index_sequence<Count>()) &&
         !takes_values<T>(std::make_index_sequence<Count + 1>());
}

}  // namespace layout_detail

/// Returns the hash of the layout of a type.
template <class T>
constexpr std::uint64_t layout_hash() noexcept {
  return layout_detail::Layout<T>::hash();
}

}  // namespace thimble::driver

// Applies a macro to each of up to 256 arguments [C++20, __VA_OPT__].
#define THIMBLE_LAYOUT_PARENTHESES ()
#define THIMBLE_LAYOUT_SCAN4(...) __VA_ARGS__
#define THIMBLE_LAYOUT_SCAN3(...) \
  THIMBLE_LAYOUT_SCAN4(           \
      THIMBLE_LAYOUT_SCAN4(THIMBLE_LAYOUT_SCAN4(THIMBLE_LAYOUT_SCAN4(__VA_ARGS__))))
#define THIMBLE_LAYOUT_SCAN2(...) \
  THIMBLE_LAYOUT_SCAN3(           \
      THIMBLE_LAYOUT_SCAN3(THIMBLE_LAYOUT_SCAN3(THIMBLE_LAYOUT_SCAN3(__VA_ARGS__))))
#define THIMBLE_LAYOUT_SCAN(...) \
  THIMBLE_LAYOUT_SCAN2(          \
      THIMBLE_LAYOUT_SCAN2(THIMBLE_LAYOUT_SCAN2(THIMBLE_LAYOUT_SCAN2(__VA_ARGS__))))
#define THIMBLE_LAYOUT_EACH(macro, Type, ...) \
  __VA_OPT__(THIMBLE_LAYOUT_SCAN(THIMBLE_LAYOUT_NEXT(macro, Type, __VA_ARGS__)))
#define THIMBLE_LAYOUT_NEXT(macro, Type, one, ...) \
  macro(Type, one)                                 \
      __VA_OPT__(THIMBLE_LAYOUT_AGAIN THIMBLE_LAYOUT_PARENTHESES(macro, Type, __VA_ARGS__))
#define THIMBLE_LAYOUT_AGAIN() THIMBLE_LAYOUT_NEXT

#define THIMBLE_LAYOUT_COUNT(Type, field) +1
#define THIMBLE_LAYOUT_FIELD(Type, field)                 \
  hash = layout_detail::mix(hash, #field);                \
  hash = layout_detail::mix(hash, offsetof(Type, field)); \
  hash = layout_detail::mix(hash, layout_hash<decltype(Type::field)>());
#define THIMBLE_LAYOUT_ENUMERATOR(Type, value) \
  hash = layout_detail::mix(hash, #value);     \
  hash = layout_detail::mix(hash, static_cast<std::uint64_t>(Type::value));
#define THIMBLE_LAYOUT_CASE(Type, value) case Type::value:

/// Describes a struct: its name, then the names of all its fields. At global scope.
#define THIMBLE_LAYOUT(Type, ...)                                                              \
  template <>                                                                                  \
  struct thimble::driver::LayoutFields<Type> {                                                 \
    static_assert(layout_detail::has_fields<Type, 0 THIMBLE_LAYOUT_EACH(THIMBLE_LAYOUT_COUNT,  \
                                                                        Type, __VA_ARGS__)>(), \
                  "The description of " #Type " lacks a field.");                              \
    static constexpr std::uint64_t mix_all(std::uint64_t hash) noexcept {                      \
      THIMBLE_LAYOUT_EACH(THIMBLE_LAYOUT_FIELD, Type, __VA_ARGS__)                             \
      return hash;                                                                             \
    }                                                                                          \
  };

/// Describes an enumeration: its name, then the names of all its enumerators. At global scope.
#define THIMBLE_LAYOUT_ENUM(Type, ...)                                                            \
  template <>                                                                                     \
  struct thimble::driver::LayoutFields<Type> {                                                    \
    /* Without a default: the compiler warns of an enumerator that is missing. */                 \
    static constexpr bool is_known(Type value) noexcept {                                         \
      switch (value) { THIMBLE_LAYOUT_EACH(THIMBLE_LAYOUT_CASE, Type, __VA_ARGS__) return true; } \
      return false;                                                                               \
    }                                                                                             \
    static constexpr std::uint64_t mix_all(std::uint64_t hash) noexcept {                         \
      THIMBLE_LAYOUT_EACH(THIMBLE_LAYOUT_ENUMERATOR, Type, __VA_ARGS__)                           \
      return hash;                                                                                \
    }                                                                                             \
  };

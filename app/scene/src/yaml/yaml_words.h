#pragma once

#include <yaml-cpp/yaml.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace thimble::scene {

// What the reader of maps says of a value: what it expected, what it found, and in which line.
// Nothing here throws. Real-time: never from the servo thread.

/// Returns the line (from 1) of a node, or `fallback` if the parser knows none.
int line_of(const YAML::Node& node, int fallback);

/// Returns a text in quotes, cut to what fits into a line and without control characters.
std::string in_quotes(std::string_view text);

/// Returns what a node is, in words: "a map", or its text in quotes.
std::string found(const YAML::Node& node);

/// Returns a number as a person writes it.
std::string in_words(double number);

/// Returns "a number from `min` to `max` `unit`".
std::string number_in_words(std::string_view unit, double min, double max);

/// Returns the same for three numbers.
std::string three_in_words(std::string_view unit, double min, double max);

/// Returns "a whole number from `min` to `max` `unit`".
std::string whole_in_words(std::string_view unit, std::int64_t min, std::int64_t max);

/// Returns the words of a choice: "a, b or c".
std::string any_of(const std::vector<std::string_view>& choices);

/// Returns whether a node is a scalar that stood without quotes.
bool is_plain_scalar(const YAML::Node& node);

/// Returns the number that a node holds; nothing if it is none.
std::optional<double> to_number(const YAML::Node& node);

/// Returns the whole number that a node holds, written as digits or as a decimal number without a
/// fraction; nothing if it is none or beyond 2^53.
std::optional<std::int64_t> to_whole(const YAML::Node& node);

/// Returns which of the words a node holds; nothing if it is none of them.
std::optional<std::size_t> choice_of(const YAML::Node& node,
                                     const std::vector<std::string_view>& choices);

}  // namespace thimble::scene

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "yaml/yaml_node.h"

namespace thimble::scene {

// Texts for messages about a value: expected, found, and line. No exceptions are thrown. Real-time:
// none of these functions may be called from the servo thread.

/// Returns the line (from 1) of a node, or `fallback` if it is unknown.
int line_of(const YamlNode& node, int fallback);

/// Returns a text in quotes, shortened to fit into a line and without control characters.
std::string in_quotes(std::string_view text);

/// Returns a description of a node: "a map", or its text in quotes.
std::string found(const YamlNode& node);

/// As `found`, for a node that should be a number, true or false. Names the quotes if they alone
/// make it a text.
std::string found_value(const YamlNode& node);

/// Returns a number in its usual notation.
std::string in_words(double number);

/// Returns "a number from `min` to `max` `unit`".
std::string number_in_words(std::string_view unit, double min, double max);

/// Returns the same for three numbers.
std::string three_in_words(std::string_view unit, double min, double max);

/// Returns "a whole number from `min` to `max` `unit`".
std::string whole_in_words(std::string_view unit, std::int64_t min, std::int64_t max);

/// Returns the words of a choice: "a, b or c".
std::string any_of(const std::vector<std::string_view>& choices);

/// Returns whether a node is a scalar without quotes.
bool is_plain_scalar(const YamlNode& node);

/// Returns the number in a text without quotes; empty if it is not a number.
std::optional<double> to_number(std::string_view text);
/// Returns the number in a node; empty if it is not a number.
std::optional<double> to_number(const YamlNode& node);

/// Returns the integer in a text without quotes, as for a node.
std::optional<std::int64_t> to_whole(std::string_view text);
/// Returns the integer in a node, written as digits or as a decimal number without a fraction;
/// empty if it is not an integer or is beyond 2^53.
std::optional<std::int64_t> to_whole(const YamlNode& node);

/// Returns the index of the word in a node; empty if it is none of `choices`.
std::optional<std::size_t> choice_of(const YamlNode& node,
                                     const std::vector<std::string_view>& choices);

}  // namespace thimble::scene

#include "bringup/wire_picture.h"

#include <fmt/core.h>

#include <array>
#include <string_view>
#include <vector>

#include "arm/wire_section.h"

namespace thimble::bringup {
namespace {

using driver::WireFraming;
using driver::WireLayout;
using driver::WireMark;
using driver::WireOp;

std::string name_of(const WireOp& op) {
  return scene::wire_field_name(op.item, op.axis);
}

/// Returns bytes as the arm file writes them, printable ones as text.
std::string mark_text(const WireMark& mark) {
  std::string text;
  for (const std::byte byte : mark.span()) {
    const auto sign = std::to_integer<char>(byte);
    text += sign > ' ' && sign <= '~' ? std::string(1, sign)
            : sign == '\n'            ? "\\n"
            : sign == '\r'            ? "\\r"
            : sign == ' '             ? " "
                                      : fmt::format("<{:02x}>", std::to_integer<unsigned>(byte));
  }
  return text;
}

/// Returns what each byte of a message holds.
std::vector<std::string> owners_of(const WireLayout& layout) {
  std::vector<std::string> owners(layout.size, "-");
  const auto hex = [](std::byte byte) {
    return fmt::format("{:02x}", std::to_integer<unsigned>(byte));
  };
  for (std::size_t i = 0; i < layout.op_count; ++i) {
    const WireOp& op = layout.ops[i];
    if (op.shown_only) continue;
    for (std::size_t k = op.at; k < std::size_t{op.at} + op.bytes && k < owners.size(); ++k) {
      const bool constant = op.item == driver::WireItem::kConstant && op.bytes == 1;
      const std::string own = constant ? fmt::format("={}", op.value) : name_of(op);
      // Several fields in the bits of one byte.
      owners[k] = owners[k] == "-" ? own : owners[k] + '+' + own;
    }
  }
  if (layout.framing == WireFraming::kLength) owners[layout.length_at] = "length";
  for (std::size_t i = 0; i < layout.begin.size; ++i) owners[i] = hex(layout.begin.bytes[i]);
  for (std::size_t i = 0; i < layout.end.size; ++i) {
    owners[layout.size - layout.end.size + i] = hex(layout.end.bytes[i]);
  }
  for (std::size_t i = 0; i < layout.check_bytes; ++i) owners[layout.check_at + i] = "checksum";
  return owners;
}

std::string rows_of(const WireLayout& layout) {
  constexpr std::size_t kRow = 8, kCell = 9;
  const std::vector<std::string> owners = owners_of(layout);
  std::string text;
  for (std::size_t row = 0; row < owners.size(); row += kRow) {
    const std::size_t end = std::min(row + kRow, owners.size());
    std::string numbers = "   ", cells = "  |";
    for (std::size_t i = row; i < end;) {
      std::size_t next = i + 1;
      // A mark and a constant of one byte keep a cell of their own.
      while (next < end && owners[next] == owners[i] && owners[i].size() > 2) ++next;
      for (std::size_t k = i; k < next; ++k) numbers += fmt::format("{:<{}}", k, kCell);
      const std::size_t width = kCell * (next - i) - 1;
      std::string label = owners[i];
      if (label.size() > width) label = label.substr(0, width - 1) + '.';
      cells += fmt::format("{:<{}}|", label, width);
      i = next;
    }
    numbers.erase(numbers.find_last_not_of(' ') + 1);
    text += numbers + '\n' + cells + '\n';
  }
  return text;
}

std::string line_of(const WireLayout& layout) {
  std::string text = "  " + mark_text(layout.begin);
  for (std::size_t i = 0; i < layout.op_count; ++i) {
    if (i > 0) text += mark_text(layout.separator);
    text += '{' + name_of(layout.ops[i]) + '}';
  }
  return text + mark_text(layout.end) + '\n';
}

}  // namespace

std::string picture_of(const WireLayout& layout, const std::string& title) {
  constexpr std::array<std::string_view, 6> kFramings{"fixed size", "header", "text",
                                                      "COBS",       "SLIP",   "length"};
  std::string head = title;
  if (layout.framing == WireFraming::kText) {
    head += ", a line of text";
  } else {
    const bool measured = layout.framing == WireFraming::kLength;
    head += fmt::format(", {} bytes{}, {}", layout.size, measured ? " or more" : "",
                        kFramings[static_cast<std::size_t>(layout.framing)]);
    if (layout.padded > layout.size) head += fmt::format(", padded to {}", layout.padded);
    if (layout.check_bytes > 0) {
      head +=
          fmt::format(", check value of bytes {} to {}", layout.check_from, layout.check_at - 1);
      if (measured) head += " and those that follow";
    }
  }
  return head + '\n' + (layout.framing == WireFraming::kText ? line_of(layout) : rows_of(layout));
}

std::string values_of(const WireLayout& layout, const driver::WireLayoutText& text,
                      std::span<const std::byte> frame) {
  const std::vector<double> values = layout.values_of(frame);
  std::string list;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const WireOp& op = layout.ops[i];
    list += fmt::format("  {:<14} {:.9g}", name_of(op), values[i]);
    if (op.item == driver::WireItem::kErrors) {
      const auto& names = text.fields[i].bit_names;
      for (std::size_t bit = 0; bit < names.size(); ++bit) {
        const bool set = (static_cast<std::uint64_t>(values[i]) >> bit & 1U) != 0;
        if (set && names[bit] != "-") list += ' ' + names[bit];
      }
    }
    list += '\n';
  }
  return list;
}

}  // namespace thimble::bringup

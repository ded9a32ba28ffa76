#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace thimble::usb_test {

/// A report of a board at one pose, and the tip position that its published host program computes.
/// Frame B as in that program: x to the user, y to the user's right, z up.
struct BoardVector {
  std::string_view board;              ///< Name in `thimble plug`.
  std::size_t size;                    ///< Size of a report, bytes.
  std::array<std::int16_t, 3> counts;  ///< Encoders a to c, the first words of the report.
  std::array<double, 3> tip;           ///< Position of the tip, p_BT, m.

  /// Returns the report: words, the low byte first, and zeros up to its size.
  std::vector<std::byte> report() const {
    std::vector<std::byte> bytes(size);
    for (std::size_t i = 0; i < counts.size(); ++i) {
      const auto word = static_cast<std::uint16_t>(counts[i]);
      bytes[2 * i] = static_cast<std::byte>(word & 0xffU);
      bytes[2 * i + 1] = static_cast<std::byte>(word >> 8U);
    }
    return bytes;
  }
};

// Computed by hand from the sources, not by this project's code.
//
// WoodenHaptics, 8 bytes [S CHAI3D's CWoodenDevice.cpp]: A = -2 pi a / 2000 / 16, B = -2 pi b /
// 2000 / 12, C = 90 degrees - 2 pi c / 2000 / 12, r = 0.205 sin B + 0.245 sin C, tip = (r cos A, r
// sin A, 0.080 + 0.205 cos B - 0.245 cos C). So increasing counts of a move the tip towards -y; on
// text-line boards towards +y.
//
// Polhem [S forsslund/hfabapi hfab_api.cpp, hfab_polhem.h; fsusbhapticdevicethread.cpp takes the
// counts of this board as they are]: A = 2 pi (a + 8312) / 4096 / (175 / 28.8534), B = -2 pi (b -
// 10366) / 4096 / (100 / 13.6981), C = 2 pi (c + 19764) / 4096 / (100 / 13.7281); then the two
// circles of its bars are intersected in the plane that A turns.
inline constexpr std::array<BoardVector, 5> kBoardVectors{{
    {"woodenhaptics", 8, {0, 0, 0}, {0.245, 0, 0.285}},
    {"woodenhaptics", 8, {1000, -1500, 700}, {0.3132113822, -0.0623016175, 0.2247476004}},
    {"woodenhaptics", 8, {-1600, -2500, -400}, {0.3504205371, 0.1138585345, 0.2682469083}},
    {"polhem", 14, {-7412, 2000, -3000}, {0.0938268466, 0.0217340816, 0.0913574960}},
    {"polhem-64", 64, {-7412, 2000, -3000}, {0.0938268466, 0.0217340816, 0.0913574960}},
}};

}  // namespace thimble::usb_test

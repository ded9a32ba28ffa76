#pragma once

#include <string>

namespace thimble::usb_test {

/// Prints a copy of the arm file `file` whose simulated arm has other masses, friction and gains
/// (support::hidden_arm_of), drawn by `seed`. With `cables` it also has elastic cables
/// (support::put_cables). Returns 1 and prints an error if the file cannot be read or changed.
int print_hidden_file(const std::string& file, const std::string& seed, bool cables);

/// Compares an arm file written by `thimble identify` with the file of the simulated arm that it
/// identified. `believed` is the file that it started from. Tolerances: mass 3 %, Coulomb friction
/// 5 %, gains 2 %; viscous friction 10 %, or the interval in the file; delay 0.1 ms from
/// `delay_ms`, the delay in the arm's own trace. With elastic cables also the resonance of each
/// motor against its link, with the tip at the world's origin: 5 %. Prints PASS or FAIL and a
/// FIGURE for each; returns the number of failures.
int check_identified(const std::string& arm, const std::string& believed, const std::string& hidden,
                     const std::string& written, const std::string& delay_ms);

}  // namespace thimble::usb_test

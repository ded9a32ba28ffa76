#pragma once

#include <string>

namespace thimble::usb_test {

/// Prints an arm file like that of `file` whose simulated arm has other constants of mass,
/// friction and gains (support::hidden_arm_of), drawn by `seed`, and with `cables` also cables that
/// stretch (support::put_cables). Returns 1, with a sentence, if the file cannot be read or
/// changed.
int print_hidden_file(const std::string& file, const std::string& seed, bool cables);

/// Compares an arm file that `thimble identify` wrote out of the one that it believed with the one
/// whose simulated arm it identified: mass to 3 %, Coulomb friction to 5 %, gains to 2 %, viscous
/// friction to 10 % or inside the interval that the file states, the delay to 0.1 ms of `delay_ms`,
/// which the arm's own trace tells, and behind cables that stretch the resonance of each motor
/// against its link, with the tip at the world's origin, to 5 %. Says PASS or FAIL, and a FIGURE
/// for each; returns how many failed.
int check_identified(const std::string& arm, const std::string& believed, const std::string& hidden,
                     const std::string& written, const std::string& delay_ms);

}  // namespace thimble::usb_test

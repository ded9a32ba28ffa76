#include "bringup/wiring_guess.h"

#include <algorithm>

namespace thimble::bringup {

Eigen::Matrix3d WiringGuess::matrix(const Eigen::Vector3d& scale) const {
  Eigen::Matrix3d wiring = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    wiring(i, source[k]) = sign[k] * scale[i] / scale[source[k]];
  }
  return wiring;
}

int WiringGuess::mistakes() const {
  int count = 0;
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    count += (source[k] != i ? 1 : 0) + (sign[k] != 1 ? 1 : 0);
  }
  return count;
}

void for_each_wiring(const std::function<void(const WiringGuess&)>& visit) {
  constexpr std::array<int, 3> kSigns{1, -1, 0};
  WiringGuess guess;
  do {
    for (const int first : kSigns) {
      for (const int second : kSigns) {
        for (const int third : kSigns) {
          guess.sign = {first, second, third};
          visit(guess);
        }
      }
    }
  } while (std::next_permutation(guess.source.begin(), guess.source.end()));
}

WiringGuess guess_wiring(const Eigen::Matrix3d& seen,
                         const std::function<Eigen::Matrix3d(const WiringGuess&)>& expected) {
  // Chosen: one more fault must explain a fiftieth of the measurement.
  constexpr double kPrice = 0.02;
  WiringGuess best;
  double best_score = -2;
  for_each_wiring([&](const WiringGuess& guess) {
    const Eigen::Matrix3d trials = expected(guess);
    const double size = trials.norm() * seen.norm();
    if (!(size > 0)) return;
    const double score = trials.cwiseProduct(seen).sum() / size - kPrice * guess.mistakes();
    if (score <= best_score) return;
    best_score = score;
    best = guess;
  });
  return best;
}

std::string describe_wiring(const WiringGuess& guess, const std::string& what,
                            const std::string& backwards, const std::string& dead) {
  std::string text;
  const auto add_sentence = [&](const std::string& name, const std::string& does) {
    text.append(text.empty() ? "" : " ").append(name).append(" ").append(does);
  };
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const std::string name = what + ' ' + std::to_string(i + 1);
    if (guess.sign[k] == 0) {
      add_sentence(name, dead + '.');
      continue;
    }
    if (guess.source[k] != i) {
      add_sentence(name, "responds as " + std::to_string(guess.source[k] + 1) +
                             " should. They are swapped.");
    }
    if (guess.sign[k] < 0) add_sentence(name, backwards + '.');
  }
  return text;
}

}  // namespace thimble::bringup

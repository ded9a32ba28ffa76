// Selects a mutant at run time. tests/mutate.sh includes this file in front of every source.
// THIMBLE_MUTANT in the environment is the number of the mutant. THIMBLE_MUTANTS_REACHED is a file
// of one byte per mutant, in which a run and its child processes mark the mutants that they reach.
#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <type_traits>

namespace thimble_mutants {

constexpr int kMax = 65536;  // mutants

struct Chosen {
  int one = -1;
  unsigned char* reached = nullptr;
};

inline Chosen choose() noexcept {
  Chosen chosen;
  if (const char* one = std::getenv("THIMBLE_MUTANT")) chosen.one = std::atoi(one);
  if (const char* name = std::getenv("THIMBLE_MUTANTS_REACHED")) {
    const int file = open(name, O_RDWR | O_CLOEXEC);
    void* bytes = mmap(nullptr, kMax, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (bytes == MAP_FAILED) std::abort();
    chosen.reached = static_cast<unsigned char*>(bytes);
    close(file);
  }
  return chosen;
}

inline bool is_chosen(int id) noexcept {
  static const Chosen chosen = choose();
  if (chosen.reached) __atomic_store_n(chosen.reached + id, 1, __ATOMIC_RELAXED);
  return id == chosen.one;
}

// Constants that the compiler evaluates are not mutated.
constexpr bool mutated(int id) noexcept {
  return std::is_constant_evaluated() ? false : is_chosen(id);
}

}  // namespace thimble_mutants

#define THIMBLE_MUTANT(id) ::thimble_mutants::mutated(id)
#define THIMBLE_MUTANT_NOW(id) ::thimble_mutants::is_chosen(id)

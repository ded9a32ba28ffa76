// Calls all functions of all compatibility libraries in random order with random arguments, from
// several threads and from callbacks. Nothing may crash or hang; findings of the sanitizers count.
#include <HD/hd.h>
#include <HL/hl.h>
#include <fcntl.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <thread>
#include <type_traits>
#include <vector>

#include "compat/exec_rig.h"
#include "compat/hd/hd_parameters.h"
#include "drdc.h"
#include "hdPhantom.h"
#include "support/seed.h"

namespace thimble::compat {
namespace {

class Caller;
using Call = std::function<void(Caller&)>;

struct Function {
  std::string name;
  Call call;
};

const std::vector<Function>& all_functions();

/// Makes calls with arguments by their types: valid ones mostly, and the values beyond.
class Caller {
 public:
  explicit Caller(unsigned number)
      : random_(static_cast<std::uint32_t>(support::seed_of(number))) {}

  void call_any() {
    const std::vector<Function>& all = all_functions();
    all[below(static_cast<std::uint32_t>(all.size()))].call(*this);
  }

  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(random_() % n); }

  template <class T>
  T any() {
    if constexpr (std::is_same_v<T, bool>) {
      return below(2) == 0;
    } else if constexpr (std::is_same_v<T, char>) {  // the number of an arm
      return below(8) == 0 ? static_cast<char>(below(256)) : static_cast<char>(below(4)) - char{1};
    } else if constexpr (std::is_floating_point_v<T>) {
      return static_cast<T>(number());
    } else if constexpr (std::is_enum_v<T>) {
      return static_cast<T>(below(3));
    } else if constexpr (std::is_integral_v<T>) {
      return integer<T>();
    } else if constexpr (std::is_function_v<std::remove_pointer_t<T>>) {
      return below(8) == 0 ? nullptr : function<T>();
    } else {
      return below(8) == 0 ? nullptr : buffer<std::remove_pointer_t<T>>();
    }
  }

 private:
  double number() {
    switch (below(12)) {
      case 0:
        return std::nan("");
      case 1:
        return below(2) == 0 ? HUGE_VAL : -HUGE_VAL;
      case 2:
        return 1e308;
      default:
        return 1e-3 * (static_cast<double>(below(2001)) - 1000);
    }
  }
  template <class T>
  T integer() {
    constexpr T kLast = std::numeric_limits<T>::max();
    const auto parameters = hd::parameters();
    switch (below(8)) {
      case 0:
        return below(2) == 0 ? kLast : std::numeric_limits<T>::min();
      case 1:
        return static_cast<T>(random_());
      case 2:
        return static_cast<T>(HD_FORCE_OUTPUT + below(6));
      case 3:
        return static_cast<T>(below(2) == 0 ? 500 : DHD_DEVICE_CUSTOM);
      case 4:
      case 5:
        return static_cast<T>(
            parameters[below(static_cast<std::uint32_t>(parameters.size()))].number);
      default:
        return static_cast<T>(below(4));
    }
  }
  template <class T>
  T function() {
    if constexpr (std::is_same_v<T, HDSchedulerCallback>) {
      return below(2) == 0 ? &Caller::done : &Caller::call_again;
    } else if constexpr (std::is_same_v<T, void* (*)(void*)>) {
      return [](void*) -> void* { return nullptr; };
    } else {
      return [](auto...) {};
    }
  }
  template <class Element>
  Element* buffer() {
    if constexpr (std::is_same_v<Element, const char>) {
      constexpr const char* kTexts[] = {"", "Phantom2", "Default Device", "no such name"};
      return kTexts[below(4)];
    } else if constexpr (std::is_void_v<Element>) {
      return buffer<std::byte>();
    } else {
      using Plain = std::remove_const_t<Element>;
      static thread_local Plain values[256];  // chosen: above all that a function may write
      if constexpr (std::is_arithmetic_v<Plain>) {
        for (int i = 0; i < 16; ++i) values[i] = any<Plain>();
      }
      return values;
    }
  }

  static HDCallbackCode HDCALLBACK done(void*) { return HD_CALLBACK_DONE; }
  static HDCallbackCode HDCALLBACK call_again(void*) {
    static thread_local Caller caller(100);
    static thread_local int depth = 0;
    if (depth > 2) return HD_CALLBACK_DONE;
    ++depth;
    caller.call_any();
    --depth;
    return HD_CALLBACK_DONE;
  }

  std::mt19937 random_;
};

/// Reads a result as a program would.
template <class T>
void use(T result) {
  if constexpr (std::is_same_v<T, const char*>) {
    if (result != nullptr) {
      EXPECT_LT(std::strlen(result), 1000u);
    }
  }
}

template <class Result, class... Arguments>
void call(Result (*function)(Arguments...), Caller& caller) {
  if constexpr (std::is_void_v<Result>) {
    function(caller.any<Arguments>()...);
  } else {
    use(function(caller.any<Arguments>()...));
  }
}
// Functions that are exported and not answered.
template <class Result>
void call(Result (*function)(...), Caller& caller) {
  use(function(caller.any<double>(), caller.any<int>()));
}

const std::vector<Function>& all_functions() {
  static const std::vector<Function> all = [] {
    std::vector<Function> functions{
#define THIMBLE_FUNCTION(name) {#name, [](Caller& caller) { call(&name, caller); }},
#include "compat_functions.inc"
#undef THIMBLE_FUNCTION
    };
    for (Function& function : functions) {
      // These last as long as their argument says.
      if (function.name == "dhdSleep" || function.name == "drdSleep") {
        function.call = [](Caller& caller) { dhdSleep(1e-3 * caller.below(3)); };
      } else if (function.name == "drdMoveToPos") {
        function.call = [](Caller& caller) {
          drdMoveToPos(caller.any<double>(), caller.any<double>(), 0, false, caller.any<char>());
        };
      } else if (function.name == "drdMoveTo") {
        function.call = [](Caller& caller) {
          drdMoveTo(caller.any<double*>(), false, caller.any<char>());
        };
      }
    }
    return functions;
  }();
  return all;
}

// One test for all libraries: they share the arms of a program.
TEST(CompatFuzz, AnyCallsFromSeveralThreads) {
  ASSERT_EQ(all_functions().size(), 36u + 76u + 14u + 233u);
  // dhdKbGet reads the end of the input.
  const int nothing = open("/dev/null", O_RDONLY);
  ASSERT_GE(dup2(nothing, STDIN_FILENO), 0);
  close(nothing);
  ExecOptions options = in_step("vintage_phantom");
  options.arms.push_back({.arm_file = "polhem"});
  ExecRig rig(std::move(options));
  constexpr int kCalls = 2000;  // of each thread [chosen: each function six times]
  std::vector<std::thread> threads;
  for (unsigned number = 1; number <= 3; ++number) {
    threads.emplace_back([number] {
      Caller caller(number);
      for (int i = 0; i < kCalls; ++i) caller.call_any();
    });
  }
  for (std::thread& thread : threads) thread.join();
  hdStopScheduler();
  for (int arm = 0; arm < kArmsMax; ++arm) {
    drdClose(static_cast<char>(arm));
    hdDisableDevice(static_cast<HHD>(arm));
    while (arms::close(arm)) {
    }
  }
  while (HD_DEVICE_ERROR(hdGetError())) {
  }
  // The libraries are still usable.
  ASSERT_EQ(hdInitDevice(nullptr), 0u);
  hdEnable(HD_FORCE_OUTPUT);
  const std::array<double, 3> f{0, 0.1, 0};
  for (int i = 0; i < 700; ++i) {
    hdBeginFrame(0);
    hdSetDoublev(HD_CURRENT_FORCE, f.data());
    hdEndFrame(0);
    arms::wait_until_taken(0);
  }
  EXPECT_NEAR(rig.motors.force_W().z(), 0.1, 0.005);
  hdDisableDevice(0);
}

}  // namespace
}  // namespace thimble::compat

#pragma once

#include <stdint.h>

#include "boards/registers.h"

namespace thimble {
namespace firmware {

// Registers of the RP2040 [S RP2040 datasheet, Raspberry Pi, build 2023-06; sections in brackets].

constexpr uintptr_t kResets = 0x4000c000;        // 2.14.3: RESET, RESET_DONE at 8
constexpr uintptr_t kClocks = 0x40008000;        // 2.15.7
constexpr uintptr_t kXosc = 0x40024000;          // 2.16.7
constexpr uintptr_t kPllSys = 0x40028000;        // 2.18.4
constexpr uintptr_t kPllUsb = 0x4002c000;        // 2.18.4
constexpr uintptr_t kIoBank0 = 0x40014000;       // 2.19.6.1: GPIOn_CTRL at 8 n + 4
constexpr uintptr_t kPadsBank0 = 0x4001c000;     // 2.19.6.3: GPIOn at 4 n + 4
constexpr uintptr_t kPsm = 0x40010000;           // 2.13.5: WDSEL at 8
constexpr uintptr_t kSio = 0xd0000000;           // 2.3.1.7
constexpr uintptr_t kTimer = 0x40054000;         // 4.6.5: TIMERAWL at 0x28
constexpr uintptr_t kWatchdogUnit = 0x40058000;  // 4.7.6
constexpr uintptr_t kPwm = 0x40050000;           // 4.5.3: slice n at 0x14 n
constexpr uintptr_t kAdc = 0x4004c000;           // 4.9.6
constexpr uintptr_t kUsbRam = 0x50100000;        // 4.1.3.1
constexpr uintptr_t kUsb = 0x50110000;           // 4.1.4

// Aliases of a register that set or clear bits (2.1.2).
constexpr uintptr_t kSetAlias = 0x2000, kClearAlias = 0x3000;

}  // namespace firmware
}  // namespace thimble

#!/usr/bin/env python3
"""Writes tables.h: the constants of elementary.h, with 440 digits, out of series.

    driver/src/math/make_tables.py > driver/src/math/tables.h

Nothing but Python's own decimal arithmetic is needed. arch.math_tables compares the file with what this writes, and
tests/unit/driver/math/elementary_test.cpp both with MPFR.
"""
from decimal import Decimal, getcontext
from fractions import Fraction

getcontext().prec = 450
DIGITS = Decimal(10) ** -440


def series(first, ratio):
    """The sum of first, first * ratio(1), first * ratio(1) * ratio(2), ..."""
    total, term, n = Decimal(0), Decimal(first), 0
    while abs(term) > DIGITS:
        total += term
        n += 1
        term *= ratio(n)
    return total


def arc_tangent(x):
    """Euler's series, 1755, for any x."""
    y = x * x / (1 + x * x)
    return series(y / x, lambda n: y * 2 * n / (2 * n + 1)) if x else Decimal(0)


PI = 16 * arc_tangent(Decimal(1) / 5) - 4 * arc_tangent(Decimal(1) / 239)  # Machin, 1706
LN2 = series(Decimal(1) / 2, lambda n: Decimal(n) / (2 * (n + 1)))  # sum of 1 / (n 2^n)


def sine(x):
    return series(x, lambda n: -x * x / (2 * n * (2 * n + 1)))


def exponential(x):
    return series(1, lambda n: x / n)


def double(x):
    """The double nearest to x."""
    fraction = Fraction(x)
    return fraction.numerator / fraction.denominator  # Python divides whole numbers with one rounding


def hexadecimal(x):
    if x == 0:
        return "0"
    mantissa, exponent = float.hex(x).split("p")
    digits = mantissa.rstrip("0").rstrip(".")
    return digits + "p" + exponent


def pair(x):
    high = double(x)
    low = double(Decimal(x) - Decimal(high))
    return "{" + hexadecimal(high) + ", " + hexadecimal(low) + "}"


def parts(x, bits, count):
    """x as `count` numbers of `bits` bits each, and a double for the rest."""
    found = []
    for _ in range(count):
        _, exponent = float.hex(double(x)).split("p")
        unit = Decimal(2) ** (int(exponent) - bits + 1)
        part = (x / unit).to_integral_value(rounding="ROUND_FLOOR") * unit
        found.append(hexadecimal(double(part)))
        x -= part
    found.append(hexadecimal(double(x)))
    return found


def listed(name, type_, comment, entries):
    print(f"\n/// {comment}\ninline constexpr {type_} {name}[] = {{")
    for i in range(0, len(entries), 2):
        print("    " + " ".join(entry + "," for entry in entries[i : i + 2]))
    print("};")


print("""#pragma once

// Written by make_tables.py, which says where each number comes from.
// clang-format off

#include <cstdint>

#include "math/double_double.h"

namespace thimble::math {
""".rstrip())
listed("kSines", "DoubleDouble", "sin(pi i / 64), a turn and a quarter: cos(pi i / 64) is the entry 32 further on.",
       [pair(sine(PI * (i % 128) / 64)) if i % 64 else pair(Decimal(0)) for i in range(160)])
listed("kPowers", "DoubleDouble", "2^(i / 64).", [pair(exponential(LN2 * i / 64)) for i in range(64)])
factorials, product = [], Decimal(1)
for n in range(21):
    product *= max(n, 1)
    factorials.append(pair(1 / product))
listed("kInverseFactorials", "DoubleDouble", "1 / n!.", factorials)
listed("kOddInverses", "DoubleDouble", "1 / (2 n + 1).", [pair(Decimal(1) / (2 * n + 1)) for n in range(12)])
listed("kSineStep", "double", "pi / 64 in parts of 28 bits, whose products with 25 bits are exact.", parts(PI / 64, 28, 6))
listed("kPowerStep", "double", "ln(2) / 64 in parts of 35 bits, whose products with 18 bits are exact.",
       parts(LN2 / 64, 35, 3))
listed("kArcs", "double", "atan(i / 8).", [hexadecimal(double(arc_tangent(Decimal(i) / 8))) for i in range(9)])
turn = 1 / (2 * PI)
words = [0] + [int(turn * 2 ** (64 * (i + 1))) % 2**64 for i in range(20)]
listed("kPerTurn", "std::uint64_t", "1 / (2 pi): 64 zeros, and 1280 bits behind the point.",
       [f"0x{word:016x}" for word in words])
for name, comment, value in (("kPi", "pi", PI), ("kHalfPi", "pi / 2", PI / 2), ("kTwoPi", "2 pi", 2 * PI),
                             ("kLn2", "ln(2)", LN2)):
    print(f"\n/// {comment}.\ninline constexpr DoubleDouble {name}{pair(value)};")
print("\n}  // namespace thimble::math")

# SPDX-License-Identifier: MIT
"""passo_math against Python's unbounded integers."""

import math
import random
from collections.abc import Iterator
from typing import Any

import pytest
from cffi import FFI
from passo import random_cases
from passo.compiler import declarations
from passo.toolchain import paths

from tests.helpers.plans import checked_library

SEED = random_cases.seed()
ROUNDS = 20_000
MAX64 = 2**64 - 1
MAX128 = 2**128 - 1


@pytest.fixture(scope="module")
def math_c() -> tuple[FFI, Any]:
    """The planner with passo_math.c, built such that undefined behavior is fatal."""
    ffi = FFI()
    ffi.cdef(declarations([paths.planner / "passo_math.h"]))
    return ffi, ffi.dlopen(str(checked_library()))


class MathC:
    """The C functions with Python's integers on both sides."""

    def __init__(self, ffi: FFI, lib: object) -> None:
        self.ffi, self.lib = ffi, lib

    def wide(self, value: int) -> object:
        return self.ffi.new("struct passo_u128 *", {"high": value >> 64, "low": value & MAX64})[0]

    @staticmethod
    def plain(value: object) -> int:
        return value.high << 64 | value.low

    def add(self, a: int, b: int) -> int:
        return self.plain(self.lib.passo_u128_add(self.wide(a), self.wide(b)))

    def subtract(self, a: int, b: int) -> int:
        return self.plain(self.lib.passo_u128_subtract(self.wide(a), self.wide(b)))

    def shift_left(self, a: int, bits: int) -> int:
        return self.plain(self.lib.passo_u128_shift_left(self.wide(a), bits))

    def less(self, a: int, b: int) -> bool:
        return self.lib.passo_u128_less(self.wide(a), self.wide(b))

    def multiply(self, a: int, b: int) -> int:
        return self.plain(self.lib.passo_multiply(a, b))

    def divide(self, a: int, divisor: int) -> tuple[int, int]:
        remainder = self.ffi.new("uint64_t *", 12345)
        quotient = self.lib.passo_divide(self.wide(a), divisor, remainder)
        assert quotient == self.lib.passo_divide(self.wide(a), divisor, self.ffi.NULL)
        return quotient, remainder[0]

    def isqrt128(self, a: int) -> int:
        return self.lib.passo_isqrt128(self.wide(a))


@pytest.fixture(scope="module")
def c(math_c: tuple[FFI, Any]) -> MathC:
    return MathC(*math_c)


def edges(bits: int) -> list[int]:
    """Values around which carries, digits and signs could go wrong."""
    top = 2**bits - 1
    near_powers = {2**power + offset for power in range(0, bits + 1, 8) for offset in (-2, -1, 0, 1, 2)}
    patterns = {top, top - 1, top // 3, top // 3 * 2, top ^ (2 ** (bits // 2) - 1), 2 ** (bits // 2) - 1}
    # Knuth's divisors whose first estimate is two too large.
    knuth = {0x8000000000000001, 0x80000000FFFFFFFF, 0x7FFFFFFFFFFFFFFF, 0xFFFFFFFF00000001}
    return sorted(value for value in near_powers | patterns | knuth if 0 <= value <= top)


def some(rng: random.Random, bits: int) -> int:
    """A number of any size up to ``bits``, often with long runs of equal bits."""
    value = rng.getrandbits(rng.randint(1, bits))
    for _ in range(rng.choice((0, 0, 1, 2))):
        run = (1 << rng.randint(1, bits)) - 1 << rng.randint(0, bits - 1)
        value = value | run if rng.random() < 0.5 else value & ~run
    return value & (1 << bits) - 1


def pairs(bits_a: int, bits_b: int) -> Iterator[tuple[int, int]]:
    for a in edges(bits_a):
        for b in edges(bits_b):
            yield a, b
    print(f"seed {SEED}")
    rng = random.Random(SEED)
    for _ in range(ROUNDS):
        yield some(rng, bits_a), some(rng, bits_b)


def test_add_subtract_less(c: MathC) -> None:
    for a, b in pairs(128, 128):
        assert c.add(a, b) == a + b & MAX128
        assert c.subtract(a, b) == a - b & MAX128
        assert c.less(a, b) == (a < b)


def test_shift_left(c: MathC) -> None:
    for a in edges(128):
        for bits in range(140):
            assert c.shift_left(a, bits) == a << bits & MAX128


def test_multiply(c: MathC) -> None:
    for a, b in pairs(64, 64):
        assert c.multiply(a, b) == a * b


def test_divide(c: MathC) -> None:
    for a, divisor in pairs(128, 64):
        fits = divisor > 0 and a // divisor <= MAX64
        assert c.divide(a, divisor) == (divmod(a, divisor) if fits else (MAX64, 0))


def test_divide_next_to_multiples(c: MathC) -> None:
    """Cases in which a digit estimate that is off by one would show."""
    for quotient, divisor in pairs(64, 64):
        for a in (quotient * divisor - 1, quotient * divisor, quotient * divisor + divisor - 1):
            if divisor > 0 and a >= 0:
                assert c.divide(a, divisor) == divmod(a, divisor)


def test_mul_div(c: MathC) -> None:
    rng = random.Random(SEED)
    operands = [(a, b, some(rng, 64)) for a, b in pairs(64, 64)]
    operands += [(a, b, divisor) for a in edges(64)[::5] for b in edges(64)[::5] for divisor in edges(64)]
    for a, b, divisor in operands:
        down = a * b // divisor if divisor else MAX64
        up = -(-a * b // divisor) if divisor else MAX64
        assert c.lib.passo_mul_div(a, b, divisor) == min(down, MAX64)
        assert c.lib.passo_mul_div_ceil(a, b, divisor) == min(up, MAX64)


def test_isqrt64(c: MathC) -> None:
    rng = random.Random(SEED)
    roots = [value for value in edges(32)] + [some(rng, 32) for _ in range(ROUNDS)]
    for a in edges(64) + [root * root + offset for root in roots for offset in (-1, 0, 1)]:
        if 0 <= a <= MAX64:
            assert c.lib.passo_isqrt64(a) == math.isqrt(a)


def test_isqrt128(c: MathC) -> None:
    rng = random.Random(SEED)
    roots = edges(64) + [some(rng, 64) for _ in range(ROUNDS)]
    squares = [root * root + offset for root in roots for offset in (-1, 0, 1)]
    for a in edges(128) + squares + [some(rng, 128) for _ in range(ROUNDS)]:
        if 0 <= a <= MAX128:
            assert c.isqrt128(a) == math.isqrt(a)


def test_bits(c: MathC) -> None:
    for a in [
        0,
        *(1 << k for k in range(128)),
        *((1 << k) - 1 for k in range(129)),
        *(3 << k for k in range(126)),
    ]:
        assert c.lib.passo_bits(c.wide(a)) == a.bit_length()

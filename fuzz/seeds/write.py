#!/usr/bin/env python3
"""Writes the seeds that no fuzzer found: plain settings and a few good samples.

python3 fuzz/seeds/write.py

The order of the numbers is that in which src/*.rs asks for them; what a byte means is said
in src/numbers.rs. From here the fuzzer finds the rest.
"""

import pathlib
import struct


def x(value):
    """An ordinary number, in thousandths."""
    return b"\x80" + struct.pack("<h", round(value * 1000))


def numbers(*values):
    return b"".join(map(x, values))


NAN, DT = b"\x05", b"\x00"
ZERO_MOTION = numbers(0, 0, 0)
SHAPE = numbers(0.096, 0.6, 3.871)
CABLE = SHAPE + b"\x01" + numbers(0.998, 7.004, 0.052)
LIMITS = b"\x00" + numbers(-30, 30) + b"\x01" + x(20)
FALLBACK = b"\x03" + x(0)
SAMPLES = [(k * 0.7, k * 0.5) for k in range(6)]


def pid():
    gains = b"\x02\x01" + numbers(30, 18, 2, 0.1, 1) + LIMITS + FALLBACK
    steps = b"".join(b"\xff" + DT + numbers(r, y, 0, 0) for r, y in SAMPLES)
    return gains + gains + steps + b"\xff" + DT + x(1) + NAN + numbers(0, 0)


def adaptive():
    estimator = b"\x01" + x(0.01) + numbers(0.005, 0, 0.5) + b"\x01" + numbers(0.1, 2)
    law = b"\x01\x00" + DT + x(1) + b"\x01" + estimator * 4 + x(20) + b"\x00"
    law += LIMITS + FALLBACK + numbers(24, 8, 0.2)
    steps = b"".join(b"\xff" + DT + numbers(r, r, y, 0.1, 0.2, 0) for r, y in SAMPLES)
    return law + steps


def compensator():
    sample = lambda r: ZERO_MOTION + DT + x(r) + ZERO_MOTION + x(0) + b"\x01"
    return b"\x00" + CABLE + b"\x00\x00" + b"".join(sample(r) for r, _ in SAMPLES)


def hysteresis():
    return b"\x00\x02" + SHAPE + x(0) + numbers(*(r for r, _ in SAMPLES))


def model(term=b"\x02\x02" + numbers(0, 1)):
    sample = lambda r: ZERO_MOTION + DT + numbers(r, 1, 0) + x(0) + b"\x01"
    return b"\x01\x01" + CABLE + b"\x01" + term + b"".join(sample(r) for r, _ in SAMPLES)


def play_in_series():
    return model(b"\x1f" + x(0.5) + b"\x02" + numbers(0, 1))


def inverse():
    return b"\x00" + CABLE + numbers(*(r for r, _ in SAMPLES))


here = pathlib.Path(__file__).parent
for make in (pid, adaptive, compensator, hysteresis, model, inverse):
    (here / make.__name__ / "start").write_bytes(make())
(here / "model" / "play_in_series").write_bytes(play_in_series())

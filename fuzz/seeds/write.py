#!/usr/bin/env python3
"""Writes the seeds that no fuzzer found: plain settings and a few good samples.

python3 fuzz/seeds/write.py

The order of the numbers is that in which src/*.rs asks for them; what a byte means is said
in src/numbers.rs. From here the fuzzer finds the rest.
"""

import gzip
import pathlib
import struct
import zlib


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
LONGEST = x(0.005)
FALLBACK = b"\x03" + x(0)
SAMPLES = [(k * 0.7, k * 0.5) for k in range(6)]


# Gains, an integral limit, a deadband and no period.
GAINS = b"\x02\x01" + numbers(30, 18, 2, 0.1, 1) + b"\x01" + x(20) + b"\x01" + x(0.01) + b"\x00"
GAINS += LIMITS + LONGEST + FALLBACK
# An output that wraps after 6 units needs the weights 1 and 0.
WRAPPED = b"\x02\x02" + numbers(30, 18, 2, 0.1, 1) + b"\x00\x00\x01" + x(6)
WRAPPED += LIMITS + LONGEST + FALLBACK
# At the upper limit, and off.
APPLIED = (b"\x01", b"\x03" + x(0))


def pid(gains=GAINS):
    steps = b"".join(b"\xff" + DT + numbers(r, y, 0, 0) for r, y in SAMPLES)
    told = b"".join(b"\x24" + own + steps for own in APPLIED)
    return gains + gains + steps + told + b"\xff" + DT + x(1) + NAN + numbers(0, 0)


def pid_wrapped():
    return pid(WRAPPED)


def adaptive():
    estimator = b"\x01" + x(0.01) + numbers(0.005, 0, 0.5) + b"\x01" + numbers(0.1, 2)
    law = b"\x01\x00" + DT + x(1) + b"\x01" + estimator * 4 + x(20) + b"\x00\x00\x01"
    law += LIMITS + LONGEST + FALLBACK + numbers(24, 8, 0.2)
    steps = b"".join(b"\xff" + DT + numbers(r, r, y, 0.1, 0.2, 0) for r, y in SAMPLES)
    return law + steps + b"".join(b"\x38" + own + steps for own in APPLIED)


def compensator():
    sample = lambda r: b"\x00\x03" + x(r / 2) + ZERO_MOTION + DT + x(r) + ZERO_MOTION + x(0) + b"\x01"
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


# States at rest are zeros in postcard, but for the count of the estimates theta.
PID_STATE, BOUC_WEN, RATES_STATE, EFFECT_STATE = map(bytes, (23, 9, 23, 1))
ADAPTIVE_STATE = bytes(37) + b"\x02" + bytes(26)
FILTER_STATES = {"low_pass": bytes(5), "biquad": bytes(17), "edge_velocity": bytes(8)}
RELAY_STATE = bytes(6) + b"\x00" + b"\xff\xff\xff\xff\x0f" + bytes(16)
BLOCKS = {
    "low_pass": x(0.01),
    "biquad": b"\x01" + x(20) + numbers(5, 0.001),
    "edge_velocity": numbers(0.5, 0.01, 0.02) + b"\x01" + x(6),
    "relay": numbers(2, 10, 8, 0.5, 8) + b"\x02" + numbers(0.5, 20, 0.005) + b"\x00"
    + numbers(-20, 30) + b"\x00" + FALLBACK,
}
POINTS = b"".join(x(r) + DT for r, _ in SAMPLES)
# Above and below the reference for six samples each.
CYCLES = [k % 12 // 6 * 4 for k in range(60)]


def states():
    samples = b"".join(DT + numbers(r, y, 0, 0) for r, y in SAMPLES)
    points = numbers(*(r for r, _ in SAMPLES))
    cycles = b"".join(DT + x(y) for y in CYCLES)
    return {
        "pid": b"\x00" + PID_STATE + GAINS + samples,
        "adaptive": b"\x01" + ADAPTIVE_STATE + adaptive()[1:],
        "bouc_wen": b"\x02" + BOUC_WEN + SHAPE + points,
        "rates": b"\x03" + RATES_STATE + x(0.01) + b"".join(x(r) + DT for r, _ in SAMPLES),
        "effect": b"\x04" + EFFECT_STATE + b"\x02" + (DT + numbers(*range(10))) * 3,
        "low_pass": b"\x05" + FILTER_STATES["low_pass"] + BLOCKS["low_pass"] + POINTS,
        "biquad": b"\x06" + FILTER_STATES["biquad"] + BLOCKS["biquad"] + POINTS,
        "edge_velocity": b"\x07" + FILTER_STATES["edge_velocity"] + BLOCKS["edge_velocity"] + POINTS,
        "relay": b"\x08" + RELAY_STATE + BLOCKS["relay"] + cycles,
    }


def constructors():
    points = [r for r, _ in SAMPLES]
    return {
        "limits": b"\x00" + numbers(-20, 30, 5, *points),
        "pid": b"\x01\x01" + GAINS + b"\x01" + WRAPPED,
        "adaptive": b"\x01\x00" + adaptive()[1:],
        "plausible": b"\x02" + numbers(-5, 5, 9) + b"\x03\x00\x00"
        + b"".join(x(r) + DT + b"\x01" for r in points),
        "plausible_slow": b"\x02" + numbers(-5, 5, 9) + b"\x03\x01" + x(0.2) + b"\x01" + LONGEST
        + b"".join(x(r) + DT + b"\x01" for r in points),
        "ramp": b"\x03" + numbers(20, 0.01, 0) + b"".join(x(r) + DT for r in points),
        "rates": b"\x04" + numbers(0.01, 0.1, 6) + b"".join(x(r) + DT for r in points),
        "fallback": b"\x05\x14\x04" + x(0),
        # A lead of 2 cells and a half width of 1; a cycle and a half with two samples in a cell.
        "learning": b"\x07" + numbers(4, 30) + b"\x02\x01" + numbers(0.05, 1, 0) + b"\x01"
        + b"".join(b"\x10" + numbers(3, k % 32 / 10) + b"\x01" for k in range(96)),
        "low_pass": b"\x08" + BLOCKS["low_pass"] + POINTS,
        "biquad": b"\x09" + BLOCKS["biquad"] + POINTS,
        "edge_velocity": b"\x0a" + BLOCKS["edge_velocity"] + x(1) + DT
        + b"".join(b"\x00" + x(r) + DT + (b"\x01" + DT) * 30 for r in points),
        "relay": b"\x0b" + BLOCKS["relay"] + b"".join(b"\xff" + DT + x(y) for y in CYCLES),
    }


# Records: the first byte is the options, see src/record.rs.
ROWS = [(k / 64, (k * 7 % 32) / 8, (k * 5 % 32) / 4) for k in range(24)]


def rows(separator=","):
    return "".join(separator.join(map(str, row)) + "\n" for row in ROWS)


def german():
    text = "Prüfstand;3\n\nt;x;f;Öl °C\ns;mm;N;°C\n" + rows(";").replace(".", ",")
    return text + ";;;\nEnde\n"


def times_of_day():
    return "t,x,f\n" + "".join(f"2026-03-01T23:59:{30 + t:06.3f}Z,{x},{f}\n" for t, x, f in ROWS)


def bad_rows():
    return "t,x,f,load\n" + rows().replace("\n", ",1\n") + "1,,1,1\n1,NaN,1,1\n1,1,1,1\n"


def element(kind, data):
    if len(data) <= 4:
        return struct.pack("<HH", kind, len(data)) + data.ljust(4, b"\0")
    return struct.pack("<II", kind, len(data)) + data + bytes(-len(data) % 8)


def matrix(name, kind, dims, data):
    flags = element(6, struct.pack("<II", kind, 0))
    return element(14, flags + element(5, struct.pack("<II", *dims)) + element(1, name) + data)


def doubles(name, values):
    return matrix(name, 6, (len(values), 1), element(9, struct.pack(f"<{len(values)}d", *values)))


def mat(*elements):
    return b"MATLAB 5.0 MAT-file".ljust(124) + b"\0\1IM" + b"".join(elements)


def columns(name=lambda n: n):
    return [doubles(name(n), v) for n, v in zip([b"t", b"x", b"f"], zip(*ROWS))]


def structure():
    names = element(5, struct.pack("<I", 2)) + element(1, b"t\0x\0f\0")
    return matrix(b"run", 2, (1, 1), names + b"".join(columns(lambda n: b"")))


def named_matrix():
    values = [v for column in zip(*ROWS) for v in column]
    data = matrix(b"d", 6, (24, 3), element(2, bytes(int(v * 8) % 256 for v in values)))
    texts = [matrix(b"", 4, (1, 1), element(16, n)) for n in (b"t", b"x", b"f")]
    return mat(data, matrix(b"n", 1, (1, 3), b"".join(texts)))


def packed(data):
    return struct.pack("<II", 15, len(data)) + data


RECORDS = {
    "german_latin_1": b"\0" + german().encode("cp1252"),
    "german_utf_16": b"\0" + german().encode("utf-16"),
    "german_utf_16_be": b"\0" + german().encode("utf-16-be"),
    "times_of_day": b"\0" + times_of_day().encode(),
    "bad_rows": b"\x03" + bad_rows().encode(),
    "difference": b"\x13" + bad_rows().encode(),
    "header_line": b"\x07a,b\n" + bad_rows().encode(),
    "gzip": b"\0" + gzip.compress(german().encode(), mtime=0),
    "mat_vectors": b"\0" + mat(*columns()),
    "mat_compressed": b"\0" + mat(*(packed(zlib.compress(c)) for c in columns())),
    "mat_structure": b"\0" + mat(structure()),
    "mat_matrix": b"\0" + named_matrix(),
}

here = pathlib.Path(__file__).parent
for name, seed in RECORDS.items():
    (here / "record" / name).write_bytes(seed)
# As another writer writes it.
parquet = here / "../../lab/cli/tests/cli/reading/files/tiny.parquet"
(here / "record" / "parquet").write_bytes(b"\0" + parquet.read_bytes())
hdf5 = here / "../../lab/cli/tests/cli/reading/files/tiny_7_3.mat"
(here / "record" / "mat_7_3").write_bytes(b"\0" + hdf5.read_bytes())
cells = here / "../../lab/cli/tests/cli/reading/files/cells_7_3.mat"
for name in ("tiny.xlsx", "tiny.npy"):
    own = here / "../../lab/cli/tests/cli/reading/files" / name
    (here / "record" / name.replace("tiny.", "")).write_bytes(b"\0" + own.read_bytes())
(here / "record" / "mat_7_3_cells").write_bytes(b"\0" + cells.read_bytes())
for make in (pid, adaptive, compensator, hysteresis, model, inverse):
    (here / make.__name__ / "start").write_bytes(make())
(here / "pid" / "wrapped").write_bytes(pid_wrapped())
(here / "model" / "play_in_series").write_bytes(play_in_series())
for make in (states, constructors):
    (here / make.__name__).mkdir(exist_ok=True)
    for name, seed in make().items():
        (here / make.__name__ / name).write_bytes(seed)

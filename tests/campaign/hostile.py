"""Hostile values as Python expressions, and damaged files as bytes."""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np

NUMBERS = (
    "0.0", "-0.0", "1.0", "-1.0", "0.5", "1e-300", "5e-324", "-1e-12", "1e-6", "1e6", "-1e16", "1e154", "1e308",
    "-1.7976931348623157e308", "inf", "-inf", "nan", "3.141592653589793", "-6.283185307179586", "2147483648", "-1",
    "0", "3", "10**30",
)  # fmt: skip
DTYPES = (
    "'f8'",
    "'f4'",
    "'f2'",
    "'longdouble'",
    "'i1'",
    "'i8'",
    "'u8'",
    "'?'",
    "'c16'",
    "'O'",
    "'U3'",
    "'S3'",
    "'M8[s]'",
    "'>f8'",
    "[('x', 'f8')]",
)
OBJECTS = (
    "None",
    "True",
    "''",
    "'nan'",
    "'\\0'",
    "b''",
    "{}",
    "set()",
    "[]",
    "()",
    "[[]]",
    "[None]",
    "object()",
    "bik",
    "int",
    "len",
    "range(7)",
    "iter([1.0])",
    "...",
    "bik.Status.SOLVED",
    "1j",
    "slice(3)",
    "memoryview(b'1234567')",
    "'x' * 100_000",
    "[[[[0.0]]]]",
    "{'a': 1}",
    "float('nan')",
    "np.float64(0.5)",
    "np.int8(3)",
    "np.datetime64('now')",
    "np.ma.masked",
)


def shape(random: np.random.Generator) -> tuple[int, ...]:
    """Draws the shape of an array, often of one that some argument asks for."""
    usual = [(3,), (7,), (4, 4), (3, 3), (1, 4, 4), (5, 7), (2, 3), (6,), (2,), (9, 4, 4), (1, 7)]
    if random.random() < 0.7:
        return usual[random.integers(len(usual))]
    return tuple(int(size) for size in random.choice([0, 1, 2, 3, 4, 7, 100], random.integers(0, 5)))


def array(random: np.random.Generator) -> str:
    """Draws an array: of any type, with strides of its own, read-only, empty, or with entries that are no numbers."""
    size = shape(random)
    fill = str(random.choice(NUMBERS))
    plain = f"np.random.default_rng({random.integers(100)}).uniform(-2, 2, {size})"
    match random.integers(9):
        case 0:
            return f"np.full({size}, {fill})"
        case 1:
            return (
                f"np.zeros({size}).astype({random.choice(DTYPES)})"
                if random.random() < 0.5
                else f"{plain}.astype('{random.choice(['f4', 'f2', 'i4', '>f8', 'O', 'c16', 'U5'])}')"
            )
        case 2:
            return f"np.broadcast_to(np.float64({fill}), {size})"
        case 3:
            return f"np.asfortranarray({plain})"
        case 4:
            last = 2 * size[-1] if size else 1  # twice along one axis alone: along four, memory would not do
            return f"np.zeros({(*size[:-1], last)})[..., ::2]"
        case 5:
            return f"{plain}[{', '.join(['::-1'] * len(size)) or '...'}]"
        case 6:
            return f"{plain}.tolist()"
        case 7:
            return f"np.frombuffer({plain}.tobytes())"
        case _:
            return (
                f"np.where(np.arange({int(np.prod(size))}).reshape({size}) == {random.integers(0, 9)}, {fill}, {plain})"
            )


def value(random: np.random.Generator) -> str:
    """Draws any expression."""
    kind = random.random()
    if kind < 0.45:
        return array(random)
    return str(random.choice(NUMBERS if kind < 0.75 else OBJECTS))


_NUMBER = re.compile(rb"-?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
_WORD = re.compile(rb"[A-Za-z_][\w]*|'[^']*'|\"[^\"]*\"")
_TOLD = (b"nan", b"inf", b"-inf", b"1e400", b"0x10", b"1_0", b"", b"1,5", b"--1", b"9" * 5000, b"true", b"null")
_BYTES = (
    b"\0",
    b"\xff",
    b"\xef\xbb\xbf",
    b"\r",
    b"<!--",
    b"]]>",
    b"&lt;",
    b"&x;",
    b"<![CDATA[",
    b'"',
    b"'",
    b"\xf0\x9f\xa4\x96",
    b"\xed\xa0\x80",
    b"{",
    b"[",
    b"\n\n",
    b"%",
    b"#",
)


def deformed(data: bytes, random: np.random.Generator, hard: bool) -> bytes:
    """Changes a valid file in a few places: its numbers and words, or, hard, its bytes."""
    for _ in range(random.integers(1, 5)):
        data = (_torn if hard and random.random() < 0.6 else _reworded)(data, random)
    return data


def _reworded(data: bytes, random: np.random.Generator) -> bytes:
    """Replaces a number by another one, or a word by another word of the file."""
    pattern = _NUMBER if random.random() < 0.7 else _WORD
    found = list(pattern.finditer(data))
    if not found:
        return data
    chosen = found[random.integers(len(found))]
    new: bytes
    if pattern is _NUMBER:
        numbers = [number.encode() for number in NUMBERS] + list(_TOLD)
        new = numbers[random.integers(len(numbers))]
    else:
        new = found[random.integers(len(found))].group()
    return data[: chosen.start()] + new + data[chosen.end() :]


def _torn(data: bytes, random: np.random.Generator) -> bytes:
    """Cuts, repeats, moves or overwrites a piece."""
    start, end = sorted(random.integers(0, len(data) + 1, 2).tolist())
    end = min(end, start + int(2 ** random.uniform(0, 8)))
    piece = data[start:end]
    tears: list[Callable[[], bytes]] = [
        lambda: data[:start],
        lambda: data[:start] + data[end:],
        lambda: data[:end] + piece + data[end:],
        lambda: data[:end] + piece * int(random.integers(2, 300)) + data[end:],
        lambda: data[:start] + _BYTES[random.integers(len(_BYTES))] + data[start:],
        lambda: data[:start] + random.bytes(len(piece)) + data[end:],
        lambda: data[:start] + piece[::-1] + data[end:],
        lambda: data[end:] + data[:end],
    ]
    return tears[random.integers(len(tears))]()


def forged(stored: bytes, random: np.random.Generator) -> bytes:
    """Stored bytes with a changed payload, and the checksum (FNV-1a) that belongs to it."""
    payload = bytearray(stored[9:])
    for _ in range(random.integers(1, 4)):
        payload[random.integers(len(payload))] = int(
            random.choice([0, 1, 2, 0x7F, 0x80, 0xF0, 0xFF, random.integers(256)])
        )
    if random.random() < 0.2:
        del payload[random.integers(len(payload)) :]
    return stored[:1] + checksum(payload) + payload


def checksum(payload: bytes) -> bytes:
    """The checksum of stored bytes."""
    found = 0xCBF29CE484222325
    for byte in payload:
        found = (found ^ byte) * 0x100000001B3 % 2**64
    return found.to_bytes(8, "little")

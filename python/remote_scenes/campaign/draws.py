"""Numbers that depend on a seed, a name and a counter alone: a new variable changes no other one, and any sample stands by itself.

The hash is BLAKE2b (RFC 7693); Sobol points follow I. M. Sobol 1967 with the direction numbers of S. Joe and F. Y. Kuo,
"Constructing Sobol sequences with better two-dimensional projections", SIAM J. Sci. Comput. 30 (2008), file new-joe-kuo-6.
"""
from __future__ import annotations

import hashlib
from functools import lru_cache

# Polynomial degree, its inner coefficients and the first direction integers, of the dimensions from the second on.
_JOE_KUO = ((1, 0, (1,)), (2, 1, (1, 3)), (3, 1, (1, 3, 1)), (3, 2, (1, 1, 1)), (4, 1, (1, 1, 3, 3)), (4, 4, (1, 3, 5, 13)),
            (5, 2, (1, 1, 5, 5, 17)), (5, 4, (1, 1, 5, 5, 5)), (5, 7, (1, 1, 7, 11, 19)))
SOBOL_DIMENSIONS = len(_JOE_KUO) + 1
_BITS = 32
_SORTED = 1 << 16


def hashed(*parts: object) -> int:
    """64 bits of parts, each of which is written as text."""
    text = "\x1f".join(str(p) for p in parts).encode()
    return int.from_bytes(hashlib.blake2b(text, digest_size=8).digest(), "big")


def unit(*parts: object) -> float:
    """A number within (0, 1), the middle of one of 2^52 cells."""
    return ((hashed(*parts) >> 12) + 0.5) / (1 << 52)


def shuffled(index: int, count: int, *parts: object) -> int:
    """Where `index` goes in a permutation of 0 to count - 1 that the parts choose. Large ones need no memory: a Feistel network of four rounds,
    walked until it is within the range (J. Black and P. Rogaway, "Ciphers with arbitrary finite domains", 2002); in small ones that is no
    good random permutation, so that their numbers are put in the order of their hashes."""
    if count <= _SORTED:
        return _order(count, parts)[index]
    half = ((count - 1).bit_length() + 1) // 2
    mask = (1 << half) - 1
    while True:
        left, right = index >> half, index & mask
        for turn in range(4):
            left, right = right, left ^ (hashed("feistel", turn, right, *parts) & mask)
        index = left << half | right
        if index < count:
            return index


@lru_cache(maxsize=64)
def _order(count: int, parts: tuple[object, ...]) -> tuple[int, ...]:
    return tuple(sorted(range(count), key=lambda i: hashed("order", i, *parts)))


@lru_cache(maxsize=None)
def _directions(dimension: int) -> tuple[int, ...]:
    if dimension == 0:
        return tuple(1 << (_BITS - 1 - i) for i in range(_BITS))
    degree, inner, first = _JOE_KUO[dimension - 1]
    v: list[int] = []
    for i in range(_BITS):
        if i < degree:
            v.append(first[i] << (_BITS - 1 - i))
            continue
        x = v[i - degree] ^ (v[i - degree] >> degree)
        for k in range(1, degree):
            if inner >> (degree - 1 - k) & 1:
                x ^= v[i - k]
        v.append(x)
    return tuple(v)


def sobol(index: int, dimension: int, *parts: object) -> float:
    """A point of a Sobol sequence within (0, 1), with a digital shift that the parts choose."""
    value = 0
    for i, v in enumerate(_directions(dimension)):
        if index >> i & 1:
            value ^= v
    return ((value ^ (hashed("shift", dimension, *parts) >> (64 - _BITS))) + 0.5) / (1 << _BITS)


def latin(index: int, count: int, *parts: object) -> float:
    """A point of a Latin hypercube within (0, 1): each of `count` even strata holds one of the points 0 to count - 1."""
    return (shuffled(index % count, count, "latin", *parts) + unit("within", index, *parts)) / count

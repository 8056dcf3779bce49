"""A sheet of pictures: samples side by side, with their labels drawn upon them, as one PNG."""
from __future__ import annotations

import struct
import zlib
from pathlib import Path
from typing import Any, Sequence

import numpy as np
import numpy.typing as npt

from ..chips import _write_png
from .exports import Image

Pixels = npt.NDArray[np.uint8]
COLUMNS, LEAST = 4, 256
"""Pictures a row, and how large the longer side of one is at least, in whole multiples of its pixels."""
_COLOURS = ((255, 220, 0), (0, 220, 255), (255, 80, 80), (120, 255, 80), (255, 120, 255), (255, 160, 40))


def write_sheet(folder: Path, images: Sequence[Image], path: Path) -> None:
    """images: of the dataset in the folder, in the order in which they are to stand; oriented boxes have a colour a class."""
    tiles = [_tile(folder, image) for image in images]
    if not tiles:
        return
    height, width = max(t.shape[0] for t in tiles), max(t.shape[1] for t in tiles)
    gap, rows = 6, -(-len(tiles) // COLUMNS)
    sheet = np.full((rows * (height + gap) + gap, min(COLUMNS, len(tiles)) * (width + gap) + gap, 3), 40, np.uint8)
    for i, tile in enumerate(tiles):
        y, x = gap + (i // COLUMNS) * (height + gap), gap + (i % COLUMNS) * (width + gap)
        sheet[y:y + tile.shape[0], x:x + tile.shape[1]] = tile
    _write_png(path, sheet)


def _tile(folder: Path, image: Image) -> Pixels:
    pixels = read_png(folder / image.file)
    times = max(1, -(-LEAST // max(pixels.shape[:2])))
    tile = np.repeat(np.repeat(pixels, times, axis=0), times, axis=1)
    for label in image.labels:
        colour = _COLOURS[(label["category_id"] - 1) % len(_COLOURS)]
        corners = [(times * x, times * y) for x, y in label["obb"]]
        for a, b in zip(corners, corners[1:] + corners[:1]):
            _line(tile, a, b, colour)
        # The front: a short line ahead from the middle of the first side.
        if label["obb_of"] == "silhouette":
            middle = tuple((corners[0][i] + corners[1][i]) / 2 for i in (0, 1))
            inner = tuple(middle[i] + 0.2 * ((corners[2][i] + corners[3][i]) / 2 - middle[i]) for i in (0, 1))
            _line(tile, (middle[0], middle[1]), (inner[0], inner[1]), colour)
    return tile


def _line(tile: Pixels, a: tuple[float, float], b: tuple[float, float], colour: tuple[int, int, int]) -> None:
    steps = int(max(abs(b[0] - a[0]), abs(b[1] - a[1]))) + 1
    t = np.linspace(0, 1, 2 * steps)
    x, y = (np.floor(a[i] + t * (b[i] - a[i])).astype(int) for i in (0, 1))
    within = (x >= 0) & (y >= 0) & (x < tile.shape[1]) & (y < tile.shape[0])
    tile[y[within], x[within]] = colour


def read_png(path: Path) -> Pixels:
    """A PNG that this package has written (8 bits, no filter), as [y, x, 3]."""
    data = path.read_bytes()
    packed, header, at = b"", b"", 8
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        header, packed = (body, packed) if kind == b"IHDR" else (header, packed + body if kind == b"IDAT" else packed)
        at += 12 + size
    width, height, _, colour = struct.unpack(">IIBB", header[:10])
    channels = 3 if colour == 2 else 1
    rows: Any = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(height, 1 + width * channels)[:, 1:]
    return np.array(np.broadcast_to(rows.reshape(height, width, channels), (height, width, 3)))

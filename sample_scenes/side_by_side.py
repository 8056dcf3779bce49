#!/usr/bin/env python3
"""Sets PNG pictures beside each other: side_by_side.py OUT.png --height N PICTURE... [--columns N] [--gap N]

The pictures of the samples that show several results are made by this (pictures.csv). Every picture is brought to N pixels of height, by
nearest samples when it grows and by means when it shrinks, and stands in rows of --columns (default: one row) with --gap pixels of white
between (default: 6). PICTURE is FILE[@X,Y,COLUMNS,ROWS][@left]: a part of it, in its own pixels, and turned by 90 degrees to the left. Reads
previews as the programs write them: 8 bits, grey or RGB, not interlaced. Needs Python 3 and its standard library only.
"""
import argparse
import struct
import sys
import zlib


def read(path):
    """Rows of pixels, each three bytes, of a PNG."""
    with open(path, "rb") as f:
        data = f.read()
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        raise SystemExit(f"side_by_side: error: {path} is no PNG")
    at, packed, head = 8, b"", None
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            head = struct.unpack(">IIBBBBB", body)
        elif kind == b"IDAT":
            packed += body
        at += length + 12
    columns, rows, bits, colours, _, _, interlaced = head
    if bits != 8 or colours not in (0, 2) or interlaced:
        raise SystemExit(f"side_by_side: error: {path}: 8 bits, grey or RGB, not interlaced, is what is read")
    width = 3 if colours == 2 else 1
    out = [[line[k:k + 3] if width == 3 else line[k:k + 1] * 3 for k in range(0, len(line), width)]
           for line in lines(zlib.decompress(packed), columns * width, rows, width)]
    return out


def lines(raw, length, rows, width):
    """The rows of bytes under the five filters of PNG (ISO/IEC 15948, clause 9)."""
    before = bytes(length)
    for row in range(rows):
        start = row * (length + 1)
        kind, line = raw[start], bytearray(raw[start + 1:start + 1 + length])
        for k in range(length):
            left, up, corner = line[k - width] if k >= width else 0, before[k], before[k - width] if k >= width else 0
            if kind == 1:
                line[k] = (line[k] + left) & 255
            elif kind == 2:
                line[k] = (line[k] + up) & 255
            elif kind == 3:
                line[k] = (line[k] + (left + up) // 2) & 255
            elif kind == 4:
                near = left + up - corner
                best = min((abs(near - left), 0, left), (abs(near - up), 1, up), (abs(near - corner), 2, corner))
                line[k] = (line[k] + best[2]) & 255
        before = bytes(line)
        yield before


def write(path, picture):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    raw = b"".join(b"\0" + b"".join(row) for row in picture)
    with open(path, "wb") as f:
        f.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", len(picture[0]), len(picture), 8, 2, 0, 0, 0)) +
                chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b""))


def part(name):
    """The picture that FILE[@X,Y,COLUMNS,ROWS][@left] names."""
    path, *changes = name.split("@")
    picture = read(path)
    for change in changes:
        if change == "left":
            picture = [list(column) for column in zip(*picture)][::-1]
            continue
        try:
            x, y, columns, rows = map(int, change.split(","))
        except ValueError:
            raise SystemExit(f"side_by_side: error: '@{change}' of {name} is neither @X,Y,COLUMNS,ROWS nor @left") from None
        if min(x, y) < 0 or min(columns, rows) < 1 or x + columns > len(picture[0]) or y + rows > len(picture):
            raise SystemExit(f"side_by_side: error: @{change} is no part of {path}, which has {len(picture[0])} x {len(picture)} pixels")
        picture = [row[x:x + columns] for row in picture[y:y + rows]]
    return picture


def scaled(picture, height):
    rows, columns = len(picture), len(picture[0])
    width = max(1, round(columns * height / rows))
    if height >= rows:
        across = [x * columns // width for x in range(width)]
        return [[picture[y * rows // height][x] for x in across] for y in range(height)]

    def span(k, of, n):
        return range(k * n // of, max(k * n // of + 1, (k + 1) * n // of))

    def mean(y, x):
        met = [picture[j][i] for j in span(y, height, rows) for i in span(x, width, columns)]
        return bytes(sum(p[c] for p in met) // len(met) for c in range(3))
    return [[mean(y, x) for x in range(width)] for y in range(height)]


def main():
    parser = argparse.ArgumentParser(prog="side_by_side.py", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out")
    parser.add_argument("pictures", nargs="+")
    parser.add_argument("--height", type=int, required=True)
    parser.add_argument("--columns", type=int, default=0)
    parser.add_argument("--gap", type=int, default=6)
    args = parser.parse_args()
    if args.height < 1 or args.columns < 0 or args.gap < 0:
        raise SystemExit("side_by_side: error: --height is 1 or more, --columns and --gap 0 or more")
    all_of = [scaled(part(name), args.height) for name in args.pictures]
    across = args.columns or len(all_of)
    white, strips = b"\xff\xff\xff", []
    for k in range(0, len(all_of), across):
        strips.append([sum(((row if n == 0 else [white] * args.gap + row) for n, row in enumerate(together)), []) for together in zip(*all_of[k:k + across])])
    width = max(len(strip[0]) for strip in strips)
    picture = []
    for n, strip in enumerate(strips):
        picture += [[white] * width for _ in range(args.gap if n else 0)] + [row + [white] * (width - len(row)) for row in strip]
    write(args.out, picture)
    return 0


if __name__ == "__main__":
    sys.exit(main())

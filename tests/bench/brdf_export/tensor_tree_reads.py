#!/usr/bin/env python3
"""tensor_tree_reads.py BIN FILE.sqt [PAIRS [OPTIONS OF --export]]

Exports a BRDF as Radiance's tensor tree, reads the XML with a reader that shares no code with the suite, and compares with the fit over
PAIRS (20000) of directions: l1 as sqt-fit has it. Needs what the package needs (pip install ./python) and its library (target remote_scenes).

The reader follows Radiance's own conventions (G. Ward et al., "A practical framework for sharing and rendering real-world bidirectional
scattering distribution functions", LBNL-6439E, 2013): a tree of 2^rank branches, bit i of a branch the upper half of coordinate i, leaves that
are grids with the first coordinate changing slowest; directions by P. Shirley & K. Chiu's map of the disk onto the square (1997).
"""
import math
import random
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

from pairs import Difference, draw, fitted


def read(path):
    """(rank, tree): a tree is a list of numbers (a grid) or a list of trees."""
    root = ElementTree.parse(path).getroot()
    for element in root.iter():
        element.tag = re.sub(r"{.*}", "", element.tag)
    rank = int(re.search(r"TensorTree(\d)", next(root.iter("IncidentDataStructure")).text)[1])
    tokens = re.findall(r"[{}]|[^\s,{}]+", next(root.iter("ScatteringData")).text)
    stack = [[]]
    for token in tokens:
        if token == "{":
            stack.append([])
        elif token == "}":
            done = stack.pop()
            stack[-1].append(done)
        else:
            stack[-1].append(float(token))
    assert len(stack) == 1 and len(stack[0]) == 1, "braces do not match"
    return rank, stack[0][0]


def square(x, y):
    r, phi = math.hypot(x, y), math.atan2(y, x)
    sector = math.floor((phi + math.pi / 4) / (math.pi / 2)) % 4  # 0: right, 1: up, 2: left, 3: down
    across = ((phi - sector * math.pi / 2 + math.pi) % (2 * math.pi) - math.pi) * r / (math.pi / 4)
    a, b = ((r, across), (-across, r), (-r, -across), (across, -r))[sector]
    return (a + 1) / 2, (b + 1) / 2


def value(rank, tree, out, into):
    if rank == 3:
        turn = math.pi - math.atan2(into[1], into[0])
        c, s = math.cos(turn), math.sin(turn)
        at = [0.5 - 0.5 * math.hypot(into[0], into[1]), *square(c * out[0] - s * out[1], s * out[0] + c * out[1])]
    else:
        at = [*square(-into[0], -into[1]), *square(out[0], out[1])]
    at = [min(max(v, 0), 1 - 1e-9) for v in at]
    while isinstance(tree[0], list):
        branch = 0
        for i, v in enumerate(at):
            branch |= (v >= 0.5) << i
            at[i] = 2 * v - (v >= 0.5)
        tree = tree[branch]
    side = round(len(tree) ** (1 / rank))
    assert side**rank == len(tree), "a grid that is none"
    index = 0
    for v in at:
        index = index * side + int(v * side)
    return tree[index]


def main(binaries, sqt, pairs="20000", *options):
    with tempfile.TemporaryDirectory() as folder:
        command = [binaries + "/sqt-inspect", sqt, "--export", folder + "/x.xml", *options]
        told = subprocess.run(command, capture_output=True, text=True, check=True).stderr
        rank, tree = read(folder + "/x.xml")
    channel = int(re.search(r"channel (\d+) \(", told)[1])
    rng, difference = random.Random(1), Difference()
    asked = [draw(rng) for _ in range(int(pairs))]
    for (out, into, weight), f in zip(asked, fitted(binaries, sqt, asked)):
        difference.add(value(rank, tree, out, into) * into[2], f[channel] * into[2], weight)
    print(told.strip())
    print(f"an independent reader of the tree of rank {rank}: {difference.text()}")


if __name__ == "__main__":
    main(*sys.argv[1:])

#!/usr/bin/env python3
"""Writes scene.yaml: a vehicle under a camouflage net between two trees. Usage: make_scene.py [FOLDER]"""
import math
import random
import sys
from pathlib import Path

NET, CROWN = 2200, 1800  # leaves of the net, of each tree
rng = random.Random(4)


def leaf(at):
    turn = [rng.uniform(-50, 50), rng.uniform(-50, 50), 0]
    return f"  - {{place: leaf, rotate: {{euler_deg: [{turn[0]:.0f}, {turn[1]:.0f}, {turn[2]}]}}, translate: [{at[0]:.3f}, {at[1]:.3f}, {at[2]:.3f}], tag: leaves}}\n"


def net():
    """Leaves on a dome of 9 x 5.4 m, 2.9 m high, flat on top."""
    for _ in range(NET):
        phi, r = rng.uniform(0, 2 * math.pi), math.sqrt(rng.uniform(0, 1))
        height = 2.9 * (1 - r ** 6) + rng.uniform(-0.05, 0.05)
        yield leaf([4.5 * r * math.cos(phi), 2.7 * r * math.sin(phi), max(height, 0.05)])


def crown(east, north):
    for _ in range(CROWN):
        while True:
            x, y, z = (rng.uniform(-1, 1) for _ in range(3))
            if x * x + y * y + z * z <= 1:
                break
        yield leaf([east + 2.2 * x, north + 2.2 * y, 5.5 + 2.6 * z])


SCENE = """scene: 1
name: vehicle
origin: {latitude_deg: 50, longitude_deg: 8}
windows_um: [[1.0, 1.1]]
materials:
  soil: {model: lambert, reflectance: 0.35}
  steel: {model: oren_nayar, reflectance: 0.15, sigma: 0.35}
  net: {model: lambert, reflectance: 0.4, transmittance: 0.3}
  bark: {model: lambert, reflectance: 0.3}
objects:
  ground: {plane: {width: 60, depth: 60}, material: soil}
  hull: {box: {x0: -3, y0: -1.3, z0: 0.45, x1: 3, y1: 1.3, z1: 1.3}, material: steel}
  turret: {box: {x0: -1.2, y0: -0.9, z0: 1.3, x1: 1.1, y1: 0.9, z1: 2.0}, material: steel}
  barrel: {cylinder: {radius: 0.09, height: 2.6, capped: 1}, material: steel}
  wheel: {cylinder: {radius: 0.45, height: 0.35, capped: 1}, material: steel}
  trunk: {cylinder: {radius: 0.18, height: 4.5, capped: 1}, material: bark}
  leaf: {disk: {radius: 0.07}, material: net}
world:
  - {place: ground}
  - {place: hull, tag: vehicle}
  - {place: turret, tag: vehicle}
  - {place: barrel, rotate: {euler_deg: [0, 90, 0]}, translate: [1.1, 0, 1.65], tag: vehicle}
  - {place: trunk, translate: [-4.2, 4.6, 0]}
  - {place: trunk, translate: [4.6, -4.8, 0]}
"""


def main():
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    folder.mkdir(exist_ok=True)
    wheels = "".join(f"  - {{place: wheel, rotate: {{euler_deg: [90, 0, 0]}}, translate: [{x}, {y}, 0.45], tag: vehicle}}\n" for x in (-2.2, 0, 2.2) for y in (-0.95, 1.3))
    (folder / "scene.yaml").write_text(SCENE + wheels + "".join(net()) + "".join(crown(-4.2, 4.6)) + "".join(crown(4.6, -4.8)))


main()

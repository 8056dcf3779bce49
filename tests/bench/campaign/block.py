#!/usr/bin/env python3
"""block.py FOLDER [--samples 100] [--pixels 224] [--paths 16]
Makes samples of one city block (24 houses, 60 trees, two streets) under other suns and airs and with other cars, and prints what all of it took of
the processor, checks and preparation and labels and lists included, over what the renderings alone took (the processes of dirsig-render). The block
is prepared once. The same command goes on where it was ended; what it prints then is of what was missing.

Needs the package on PYTHONPATH and the programs (REMOTE_SCENES_BIN), and numpy, xarray and PyYAML."""
import argparse
import random
import resource
import sys
import time
from pathlib import Path

import yaml

from remote_scenes import campaign
from remote_scenes.campaign import sample as sample_module


def block(folder, samples, pixels, paths):
    """The three texts; returns the campaign's path."""
    dice = random.Random(7)
    materials = {name: {"model": "lambert", "reflectance": value} for name, value in {
        "asphalt": 0.09, "pavement": 0.25, "brick": 0.22, "plaster": 0.45, "slate": 0.12, "tiles": 0.2, "leaves": 0.3, "paint": 0.5, "white": 0.7, "black": 0.05}.items()}
    objects = {"ground": {"plane": {"width": 300, "depth": 300}, "material": "pavement"}, "crown": {"sphere": {"radius": 2}, "material": "leaves"},
               "north_south": {"plane": {"width": 9, "depth": 300}, "material": "asphalt"}, "east_west": {"plane": {"width": 300, "depth": 9}, "material": "asphalt"},
               "body": {"box": {"x0": -0.9, "x1": 0.9, "y0": -2.2, "y1": 2.2, "z0": 0.3, "z1": 1.4}, "material": "paint"},
               "wheels": {"box": {"x0": -0.92, "x1": 0.92, "y0": -1.6, "y1": 1.6, "z0": 0, "z1": 0.6}, "material": "black"}}
    world = [{"place": "ground"}, {"place": "north_south", "translate": [0, 0, 0.01]}, {"place": "east_west", "translate": [0, 0, 0.02]}]
    for i in range(24):
        x, y = (-1) ** i * (10 + 14 * (i // 2 % 3)), (1 if i % 4 < 2 else -1) * (10 + 14 * (i // 6 % 2) + dice.uniform(0, 2))
        objects[f"house {i}"] = {"box": {"x0": -5.5, "x1": 5.5, "y0": -4.5, "y1": 4.5, "z0": 0, "z1": dice.uniform(6, 20)}, "material": dice.choice(["brick", "plaster", "slate", "tiles"])}
        world.append({"place": f"house {i}", "translate": [x, y, 0]})
    for i in range(60):
        world.append({"place": "crown", "translate": [dice.choice([-5.6, 5.6]), -60 + 2 * i, 4]})
    scene = {"scene": 1, "origin": {"latitude_deg": 49.4, "longitude_deg": 8.7, "height_m": 112}, "materials": materials, "objects": objects,
             "groups": {"car": [{"place": "body"}, {"place": "wheels"}]}, "world": world}
    bands = [{"name": name, "center_um": um, "fwhm_um": 0.06} for name, um in (("blue", 0.48), ("green", 0.56), ("red", 0.66), ("nir", 0.84))]
    simulation = {"scene": "block.h5", "sun": {"direction": {"zenith_deg": 40, "azimuth_deg": 180}}, "sky": {"kind": "clear"}, "max_nodes": 8, "sensors": [
        {"kind": "orthographic", "name": "chip", "columns": pixels, "rows": pixels, "gsd_m": 64 / pixels, "center_m": [0, 0], "paths": paths, "bands": bands}]}
    text = {"campaign": 1, "name": "city block", "seed": 11, "samples": samples, "scene": "scene.yaml", "simulation": "simulation.yaml", "vary": {
        "simulation.sun.direction.zenith_deg": {"uniform": [20, 65], "draw": "latin"}, "simulation.sun.direction.azimuth_deg": {"uniform": [100, 260]},
        "simulation.sky.aerosol_optical_depth_500": {"log_uniform": [0.03, 0.5]}, "simulation.sky.water_cm": {"uniform": [0.3, 4]}}, "objects": {"cars": {
            "catalogue": {"car": {"place": "car", "materials": {"paint": {"choice": ["paint", "white", "black"]}}}}, "count": {"integers": [8, 20]},
            "where": {"roads": [[[0, -30], [0, 30]], [[-30, 0], [30, 0]]], "width_m": 9, "lane_m": 2.2}, "spacing_m": 1, "on": "ground"}},
        "picture": {"bands": ["red", "green", "blue"], "range": [0, 160]}, "formats": ["coco", "geojson"], "keep": ["image", "error"]}
    folder.mkdir(parents=True, exist_ok=True)
    for name, tree in (("scene", scene), ("simulation", simulation), ("campaign", text)):
        (folder / f"{name}.yaml").write_text(yaml.safe_dump(tree, sort_keys=False))
    return folder / "campaign.yaml"


def processor_s(who):
    used = resource.getrusage(who)
    return used.ru_utime + used.ru_stime


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--samples", type=int, default=100)
    parser.add_argument("--pixels", type=int, default=224)
    parser.add_argument("--paths", type=int, default=16)
    options = parser.parse_args()
    rendered, run = [], sample_module.run_program

    def timed(name, *more, **named):
        begun = processor_s(resource.RUSAGE_CHILDREN)
        try:
            return run(name, *more, **named)
        finally:
            rendered.append(processor_s(resource.RUSAGE_CHILDREN) - begun)
            print(f"{len(rendered)} renderings, {sum(rendered):.1f} s", file=sys.stderr, flush=True)

    sample_module.run_program = timed  # of samples, dirsig-render alone goes this way
    begun, clock = processor_s(resource.RUSAGE_SELF) + processor_s(resource.RUSAGE_CHILDREN), time.monotonic()
    campaign.run(block(options.folder / "texts", options.samples, options.pixels, options.paths), options.folder / "data", workers=0)
    whole = processor_s(resource.RUSAGE_SELF) + processor_s(resource.RUSAGE_CHILDREN) - begun
    print(f"{len(rendered)} samples: {whole:.2f} s of the processor, of which {sum(rendered):.2f} s are renderings ({sum(rendered) / max(len(rendered), 1):.3f} s each): "
          f"{whole / max(sum(rendered), 1e-9):.4f} times their sum; {time.monotonic() - clock:.0f} s of the clock")
    return 0


if __name__ == "__main__":
    sys.exit(main())

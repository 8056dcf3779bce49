#!/usr/bin/env python3
"""detector.py FOLDER [--chips 500] [--first N] [--test 100] [--workers 1]
Makes chips of vehicles on a parking lot and a street in four visible and near-infrared bands and a thermal one (the scene of sample_scenes/campaigns with
temperatures), trains a small detector on 50 to 400 of them, and prints its average precision on chips of another seed, and on chips whose materials have
other spectra. The same command goes on where it was ended.

The detector: histograms of gradients in 4 x 4 cells (N. Dalal and B. Triggs, CVPR 2005) with means and spreads of the bands about every fourth pixel, a
linear classifier by ridge regression, and maxima of its score. A detection is right when it lies in the oriented box of a vehicle that has none yet; vehicles
of which less than half is seen count neither way. Needs numpy, xarray, PyYAML, the package on PYTHONPATH and the programs (REMOTE_SCENES_BIN)."""
import argparse
import json
import sys
from pathlib import Path

import numpy as np
import yaml

from kit import ROOT
from remote_scenes import campaign
from remote_scenes.campaign.engine import prepare_folder, run_samples
from remote_scenes.envi import read_values

SIZES, REPEATS = (50, 100, 200, 400), 5
STEP, CELL, BINS = 4, 4, 8
TEMPERATURE_K = {"asphalt": 316, "lines": 309, "grass": 301, "leaves": 299, "paint": 312, "white": 306, "silver": 310, "black": 322, "red": 315, "blue": 316, "glass": 308, "tyre": 318}
# W/(m2 sr um), even: blue by day, about 240 K in the window. The sun shines without air.
SKY = {"radiance": {"wavelength_um": [0.3, 0.45, 0.55, 0.65, 0.85, 1.05, 4, 8, 10.5, 13], "value": [70, 75, 50, 35, 15, 8, 0.05, 4, 2.5, 5]}}
OTHER = {"asphalt": 0.17, "lines": 0.4, "grass": {"wavelength_um": [0.4, 0.55, 0.67, 0.75, 1.0], "value": [0.05, 0.12, 0.14, 0.25, 0.32]}, "paint": 0.4, "white": 0.5, "silver": 0.22,
         "black": 0.09, "red": {"wavelength_um": [0.4, 0.55, 0.6, 0.7, 1.0], "value": [0.06, 0.07, 0.2, 0.3, 0.35]}, "glass": 0.1, "tyre": 0.08,
         "blue": {"wavelength_um": [0.4, 0.5, 0.6, 0.7, 1.0], "value": [0.1, 0.4, 0.2, 0.15, 0.5]}}


def texts(folder, samples, seed, other):
    """The three texts; other: with other spectra. Returns the campaign's path."""
    source = ROOT / "sample_scenes/campaigns"
    scene, simulation, text = (yaml.safe_load((source / f"{name}.yaml").read_text()) for name in ("scene", "simulation", "campaign"))
    scene["windows_um"] = [[0.37, 1.05], [8.6, 12.4]]
    for curve in scene["curves"].values():
        curve["outside"] = "hold"
    for name, material in scene["materials"].items():
        material["temperature_k"] = TEMPERATURE_K[name]
        if other:
            new = OTHER["grass" if name == "leaves" else name]
            material["reflectance"] = {**new, "outside": "hold"} if isinstance(new, dict) else new
    simulation["sky"] = SKY
    simulation["sensors"][0]["bands"].append({"name": "tir", "center_um": 10.5, "fwhm_um": 1})
    simulation["sensors"][0]["paths"] = 4
    del simulation["output"]
    vary = text["vary"]
    if other:
        del vary["asphalt"], vary["scene.materials.asphalt.reflectance"]
    # Warmer and cooler days; the vehicles' engines and shades are not modelled.
    for name in ("asphalt", "grass", "white", "black", "silver"):
        vary[f"scene.materials.{name}.temperature_k"] = {"normal": [TEMPERATURE_K[name], 2], "within": [TEMPERATURE_K[name] - 6, TEMPERATURE_K[name] + 6]}
    text |= {"samples": samples, "seed": seed, "formats": ["coco"], "keep": ["image", "error"], "name": "vehicles"}
    folder.mkdir(parents=True, exist_ok=True)
    for name, tree in (("scene", scene), ("simulation", simulation), ("campaign", text)):
        (folder / f"{name}.yaml").write_text(yaml.safe_dump(tree, sort_keys=False))
    return folder / "campaign.yaml"


def chips(folder, samples, first, seed, other, workers):
    """Images (chip, band, y, x) of the first samples and the labels of each; makes what is missing."""
    text = campaign.read_campaign(texts(folder / "texts", samples, seed, other))
    run_samples(text, folder / "data", range(first), workers, prepare_folder(text, folder / "data"), lambda line: print(f"{folder.name}: {line}", file=sys.stderr, flush=True))
    images, labels = [], []
    for i in range(first):
        sample = folder / f"data/samples/{i:06d}"
        images.append(np.array(read_values(sample / "chip.img"), float))
        labels.append(json.loads((sample / "sample.json").read_text())["images"][0]["labels"])
    return np.array(images), labels


def features(image):
    """(places, features) of places every STEP pixels, and the places (x, y)."""
    scaled = (image - image.mean(axis=(1, 2), keepdims=True)) / (image.std(axis=(1, 2), keepdims=True) + 1e-12)
    padded = np.pad(scaled, ((0, 0), (8, 8), (8, 8)), mode="edge")
    gy, gx = np.gradient(padded, axis=(1, 2))
    best = np.hypot(gx, gy).argmax(axis=0)[None]
    gx, gy = (np.take_along_axis(g, best, 0)[0] for g in (gx, gy))
    size, turn = np.hypot(gx, gy), (np.arctan2(gy, gx) % np.pi) * BINS / np.pi
    planes = np.stack([size * (turn.astype(int) % BINS == k) for k in range(BINS)])
    cells = planes.reshape(BINS, planes.shape[1] // CELL, CELL, planes.shape[2] // CELL, CELL).sum(axis=(2, 4))
    means = padded.reshape(len(image), cells.shape[1], CELL, cells.shape[2], CELL).mean(axis=(2, 4))
    out, places = [], []
    for row in range(cells.shape[1] - 3):
        for column in range(cells.shape[2] - 3):
            block = cells[:, row:row + 4, column:column + 4]
            light = means[:, row:row + 4, column:column + 4]
            middle, around = light[:, 1:3, 1:3].mean(axis=(1, 2)), light.mean(axis=(1, 2))
            out.append(np.concatenate([(block / (np.linalg.norm(block) + 1e-9)).ravel(), middle, np.abs(middle - around), light.std(axis=(1, 2)), np.abs(middle), [1]]))
            places.append((column * CELL, row * CELL))
    return np.array(out), np.array(places, float)


def inside(box, places, share=1.0):
    """Which places lie in an oriented box, shrunk to a share of its sides."""
    box = np.array(box, float)
    middle, a, b = box.mean(axis=0), (box[1] - box[0]) / 2, (box[3] - box[0]) / 2
    d = places - middle
    return (np.abs(d @ a) <= share * (a @ a)) & (np.abs(d @ b) <= share * (b @ b))


def seen(label):
    return max(label["occlusion"] or 0, label["truncation"] or 0) <= 0.5


def targets(labels, places):
    """1 in the middle of a vehicle, -1 beyond all, 0 between."""
    out = np.full(len(places), -1.0)
    for label in labels:
        out[inside(label["obb"], places, 1.25)] = 0
    for label in labels:
        out[inside(label["obb"], places, 0.75) & seen(label)] = 1
    return out


def fit(parts, wanted):
    """Ridge regression in which both classes weigh the same."""
    x, y = np.concatenate(parts), np.concatenate(wanted)
    x, y = x[y != 0], y[y != 0]
    weight = np.where(y > 0, 0.5 / max((y > 0).sum(), 1), 0.5 / max((y < 0).sum(), 1))[:, None]
    return np.linalg.solve(x.T @ (weight * x) + 1e-3 * np.eye(x.shape[1]), x.T @ (weight[:, 0] * y))


def average_precision(model, data):
    """Area under precision over recall of all detections of all chips (all points)."""
    found, total = [], 0
    for x, places, labels in data:
        score, free = x @ model, [seen(label) for label in labels]
        total += sum(free)
        left = score > -1.5
        while left.any():
            at = np.flatnonzero(left)[score[left].argmax()]
            left &= np.hypot(*(places - places[at]).T) > 7
            boxes = [i for i, label in enumerate(labels) if inside(label["obb"], places[at:at + 1])[0]]
            mine = [i for i in boxes if free[i]]
            if mine:
                free[mine[0]] = False
            if mine or all(seen(labels[i]) for i in boxes):
                found.append((score[at], bool(mine)))
    right = np.array([r for _, r in sorted(found, reverse=True)])
    precision = np.maximum.accumulate((right.cumsum() / np.arange(1, len(right) + 1))[::-1])[::-1]
    return float((precision * right).sum() / total)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--chips", type=int, default=500)
    parser.add_argument("--first", type=int, help="the first so many of them alone")
    parser.add_argument("--test", type=int, default=100)
    parser.add_argument("--workers", type=int, default=1)
    options = parser.parse_args()
    sets = {}
    first = options.first or options.chips
    for name, count, some, seed, other in (("held out", options.test, options.test, 2, False), ("other spectra", options.test, options.test, 3, True),
                                           ("train", options.chips, first, 1, False)):
        images, labels = chips(options.folder / name.replace(" ", "_"), count, some, seed, other, options.workers)
        sets[name] = [(*features(image), label) for image, label in zip(images, labels)]
    dice = np.random.default_rng(1)
    print("chips   held out         other spectra    (average precision, standard deviation of the choice of chips)")
    for size in (s for s in SIZES if s <= first):
        scores = []
        for _ in range(REPEATS):
            chosen = [sets["train"][i] for i in dice.permutation(first)[:size]]
            model = fit([x for x, _, _ in chosen], [targets(labels, places) for _, places, labels in chosen])
            scores.append([average_precision(model, sets[name]) for name in ("held out", "other spectra")])
        mean, spread = np.mean(scores, axis=0), np.std(scores, axis=0, ddof=1)
        print(f"{size:5d}   " + "   ".join(f"{m:.3f} +- {s:.3f}" for m, s in zip(mean, spread)), flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())

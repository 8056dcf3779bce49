#!/usr/bin/env python3
"""detector.py FOLDER [--chips 500] [--first N] [--test 100] [--workers 1] [--svg FILE]
Makes chips of vehicles on a parking lot and a street in four visible and near-infrared bands and a thermal one (the scene of sample_scenes/campaigns with
temperatures), trains a small detector on 50 to 400 of them, and prints its average precision on chips of another seed, and on chips whose materials have
other spectra. The kind of detector is chosen on chips of a third seed, before the others are looked at. The same command goes on where it was ended.

The detector: histograms of gradients in 4 x 4 cells (N. Dalal and B. Triggs, CVPR 2005) with means of the bands in them about every second pixel, ridge
regression on them or on random rectified features of them (KINDS), and maxima of its score. A detection is right when it lies in the oriented box of a vehicle that has none yet; vehicles
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

SIZES, REPEATS = (50, 100, 200, 400), 3
STEP, CELL, BINS = 2, 4, 8
# Random features (0: none, linear) and ridge.
KINDS = tuple((hidden, ridge) for hidden in (0, 200, 400, 800) for ridge in (1e-3, 1e-2))
# Seed, other spectra.
SETS = {"validation": (4, False), "held out": (2, False), "other spectra": (3, True)}
TESTS = ("held out", "other spectra")
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
    """(places, features) of places every second pixel, and the places (x, y)."""
    scaled = (image - image.mean(axis=(1, 2), keepdims=True)) / (image.std(axis=(1, 2), keepdims=True) + 1e-12)
    padded = np.pad(scaled, ((0, 0), (8, 8 + CELL), (8, 8 + CELL)), mode="edge")
    gy, gx = np.gradient(padded, axis=(1, 2))
    best = np.hypot(gx, gy).argmax(axis=0)[None]
    gx, gy = (np.take_along_axis(g, best, 0)[0] for g in (gx, gy))
    size, turn = np.hypot(gx, gy), (np.arctan2(gy, gx) % np.pi) * BINS / np.pi
    planes = np.concatenate([[size * (turn.astype(int) % BINS == k) for k in range(BINS)], padded])
    out, places = [], []
    for down in range(0, CELL, STEP):
        for right in range(0, CELL, STEP):
            shifted = planes[:, down:planes.shape[1] - CELL + down, right:planes.shape[2] - CELL + right]
            rows, columns = shifted.shape[1] // CELL, shifted.shape[2] // CELL
            cells = shifted.reshape(len(planes), rows, CELL, columns, CELL).mean(axis=(2, 4))
            blocks = np.lib.stride_tricks.sliding_window_view(cells, (4, 4), axis=(1, 2)).reshape(len(planes), -1, 16).transpose(1, 0, 2)
            edges, light = blocks[:, :BINS].reshape(len(blocks), -1), blocks[:, BINS:]
            out.append(np.concatenate([edges / (np.linalg.norm(edges, axis=1, keepdims=True) + 1e-9), (light - light.mean(axis=2, keepdims=True)).reshape(len(blocks), -1),
                                       light.mean(axis=2), light.std(axis=2)], axis=1))
            y, x = np.divmod(np.arange(len(blocks)), columns - 3)
            places.append(np.stack([x * CELL + right, y * CELL + down], axis=1))
    return np.concatenate(out).astype(np.float32), np.concatenate(places).astype(float)


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


class Detector:
    """Ridge regression, on random rectified features (A. Rahimi and B. Recht 2008) where hidden is not 0, in which both classes weigh the same."""

    def __init__(self, parts, wanted, hidden, ridge):
        dice = np.random.default_rng(7)
        # All places of vehicles, and one in sixteen of the others.
        kept = [(y > 0) | ((y < 0) & (dice.random(len(y)) < 1 / 16)) for y in wanted]
        x, y = np.concatenate([p[k] for p, k in zip(parts, kept)]), np.concatenate([w[k] for w, k in zip(wanted, kept)])
        self.mean, self.spread = x.mean(axis=0), x.std(axis=0) + 1e-6
        self.turn = dice.normal(size=(x.shape[1] + 1, hidden)).astype(np.float32) / np.sqrt(x.shape[1]) if hidden else None
        weight = np.where(y > 0, 0.5 / (y > 0).sum(), 0.5 / (y < 0).sum())[:, None].astype(np.float32)
        h = self._hidden(x)
        self.model = np.linalg.solve((h.T @ (weight * h)).astype(float) + ridge * np.eye(h.shape[1]), h.T @ (weight[:, 0] * y))

    def _hidden(self, x):
        x = np.concatenate([(x - self.mean) / self.spread, np.ones((len(x), 1), np.float32)], axis=1).astype(np.float32)
        return x if self.turn is None else np.maximum(x @ self.turn, 0)

    def score(self, x):
        return self._hidden(x) @ self.model


def average_precision(model, data):
    """Area under precision over recall of all detections of all chips (all points)."""
    found, total = [], 0
    for x, places, labels in data:
        score, free = model.score(x), [seen(label) for label in labels]
        total += sum(free)
        left = score > -0.5
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


def curve(rows, path):
    """The table as a picture (SVG): average precision over the number of chips, in factors of two."""
    colours, names = ("#1f77b4", "#d62728"), ("another seed", "other spectra")
    at = lambda size, value: (60 + 110 * np.log2(size / SIZES[0]), 230 - 200 * value)
    parts = [f'<line x1="60" x2="410" y1="{at(50, v)[1]}" y2="{at(50, v)[1]}" stroke="#ddd"/><text x="52" y="{at(50, v)[1] + 4}" text-anchor="end">{v:g}</text>' for v in (0, 0.25, 0.5, 0.75, 1)]
    parts += [f'<text x="{at(size, 0)[0]}" y="248" text-anchor="middle">{size}</text>' for size, _, _ in rows] + ['<text x="235" y="266" text-anchor="middle">chips of training</text>']
    for k, (colour, name) in enumerate(zip(colours, names)):
        points = [at(size, mean[k]) for size, mean, _ in rows]
        parts.append(f'<polyline fill="none" stroke="{colour}" stroke-width="2" points="{" ".join(f"{x:.1f},{y:.1f}" for x, y in points)}"/>')
        parts += [f'<line x1="{x:.1f}" x2="{x:.1f}" y1="{y - 200 * spread[k]:.1f}" y2="{y + 200 * spread[k]:.1f}" stroke="{colour}"/>' for (x, y), (_, _, spread) in zip(points, rows)]
        parts.append(f'<text x="300" y="{190 + 18 * k}" fill="{colour}">{name}</text>')
    path.write_text('<svg xmlns="http://www.w3.org/2000/svg" width="430" height="275" font-family="sans-serif" font-size="12"><rect width="430" height="275" fill="white"/>'
                    '<text x="60" y="18">average precision</text>' + "".join(parts) + "</svg>\n")


def trained(chosen, kind):
    return Detector([x for x, _, _ in chosen], [targets(labels, places) for _, places, labels in chosen], *kind)


def chosen_kind(train, validation, sizes):
    """The kind with the best mean of average precision over the sizes, on the validation chips; prints all."""
    order, found = np.random.default_rng(2).permutation(len(train)), {}
    print("random features, ridge: average precision on the validation chips, by size")
    for kind in KINDS:
        found[kind] = [average_precision(trained([train[i] for i in order[:size]], kind), validation) for size in sizes]
        print(f"{kind[0]:4d}, {kind[1]:g}: " + "  ".join(f"{v:.3f}" for v in found[kind]) + f"  mean {np.mean(found[kind]):.3f}", flush=True)
    best = max(found, key=lambda kind: np.mean(found[kind]))
    print(f"chosen: {best[0]} random features, ridge {best[1]:g}")
    return best


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--chips", type=int, default=500)
    parser.add_argument("--first", type=int, help="the first so many of them alone")
    parser.add_argument("--test", type=int, default=60, help="chips of the validation, and of each test")
    parser.add_argument("--workers", type=int, default=1)
    parser.add_argument("--svg", type=Path, help="the curve as a picture")
    options = parser.parse_args()
    sets = {}
    first = options.first or options.chips
    for name, count, some, seed, other in (*((name, options.test, options.test, *how) for name, how in SETS.items()), ("train", options.chips, first, 1, False)):
        images, labels = chips(options.folder / name.replace(" ", "_"), count, some, seed, other, options.workers)
        sets[name] = [(*features(image), label) for image, label in zip(images, labels)]
    sizes = [s for s in SIZES if s <= first]
    kind = chosen_kind(sets["train"], sets["validation"], sizes)
    dice, rows = np.random.default_rng(1), []
    print("chips   held out         other spectra    (average precision, standard deviation of the choice of chips)")
    for size in sizes:
        scores = []
        for _ in range(REPEATS):
            model = trained([sets["train"][i] for i in dice.permutation(first)[:size]], kind)
            scores.append([average_precision(model, sets[name]) for name in TESTS])
        mean, spread = np.mean(scores, axis=0), np.std(scores, axis=0, ddof=1)
        print(f"{size:5d}   " + "   ".join(f"{m:.3f} +- {s:.3f}" for m, s in zip(mean, spread)), flush=True)
        rows.append((size, mean, spread))
    if options.svg and rows:
        curve(rows, options.svg)
    return 0


if __name__ == "__main__":
    sys.exit(main())

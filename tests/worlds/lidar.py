"""Laser radars in worlds: what their responses must be. A world's sensors give way to one laser radar; its picture is photons by range.

Passive light (bin 0) is left out: sensors of radiance are compared with it in all other relations.
"""
import math
import os
import sys

import change
import rewrite
PULSES, SEE = 8, 0.3  # pulses of a run, each an experiment; rad, of the beam
BIN_NS = 1.0
CELLS, CELL_NS = 18, 13.0  # of pictures: an odd number of bins, so that middles of cells are middles of bins, and of thirds of bins
LIGHT = 299792458.0
PLANCK = 6.62607015e-34


def radar(world, rng, **keys):
    """The world with a laser radar alone, that looks down from among the things."""
    made = world.copy()
    um = made.facts["wavelength"]
    beam = {"kind": "gaussian", "full_angle_1_e2_mrad": round(1000 * SEE * rng.uniform(0.3, 1), 1)}
    at = [round(rng.uniform(-0.1, 0.1), 3), round(rng.uniform(-0.1, 0.1), 3), 3.3]
    sensor = {"kind": "lidar", "name": "radar", "position_m": at, "look_at_m": [round(rng.uniform(-2, 2), 3), round(rng.uniform(-2, 2), 3), round(rng.uniform(-0.5, 0.5), 3)],
              "tasks": [{"start": made.facts.get("times", {}).get("time_s", 0), "pulses": PULSES}],
              "laser": {"wavelength_um": um, "width_um": 1e-4, "pulse_energy_j": 1e-3, "rate_hz": 1e7, "beam": beam},
              "receiver": {"aperture_mm": 20, "field_of_view_mrad": round(1000 * SEE * rng.uniform(0.5, 2), 1)},
              "gate": {"start_ns": 0, "stop_ns": 300, "bin_ns": BIN_NS}, "orders": rng.choice((1, 2, 4, 8)), "paths": 8 * made.facts["paths"]}
    sensor.update(keys)
    made.sim["sensors"] = [sensor]
    return made, sensor


def twice_the_energy(world, rng):
    """Twice the energy: twice the photons in every bin."""
    one, _ = radar(world, rng)
    two = one.copy()
    two.sim["sensors"][0]["laser"]["pulse_energy_j"] *= 2
    return [(2, one), (-1, two)], "twice the energy"


def moved_gate(world, rng):
    """A gate that begins before anything returns, some bins earlier or later, ends later, has other bins: the same light at the same ranges."""
    one, sensor = radar(world, rng)
    two = one.copy()
    gate = two.sim["sensors"][0]["gate"]
    how = rng.choice(("later end", "thirds of bins", "later begin"))
    if how == "later end":
        gate["stop_ns"] = 400
    elif how == "thirds of bins":
        gate["bin_ns"] = BIN_NS / 3
    else:  # what comes before is left out of both
        gate["start_ns"] = 16.0
        sensor["name"] = two.sim["sensors"][0]["name"] = "radar_late"
    return [(1, one), (-1, two)], f"gate: {how}"


def other_start(world, rng):
    """Paths from the laser and paths from the receiver: the same light."""
    one, sensor = radar(world, rng, start_from="laser")
    two = one.copy()
    two.sim["sensors"][0]["start_from"] = "receiver"
    return [(1, one), (-1, two)], "laser first, receiver first"


def same_world(world, rng):
    """The same world in other words, with what does nothing in it, split, regrouped: the same photons."""
    one, _ = radar(world, rng)
    make = rng.choice((change.body_of_nothing, change.bystander, change.regroup, change.split, rewrite.substitute))
    made = make(one.copy(), rng)
    if not made:
        return None
    return [(1, one), (-1, made[0])], f"{make.__name__}: {made[1]}"


def steady_image(world, rng):
    """All bins together are what a camera's pixel sees under a spot lamp of the same beam: pixel area / G# times the radiance."""
    half, pitch, focal, aperture = 0.01, 400e-6, 4e-3, 1e-3  # rad, m
    one, sensor = radar(cold(world), rng, orders=1000, name="radar_sum")
    sensor["laser"]["beam"] = {"kind": "top_hat", "half_angle_mrad": 1000 * half}
    sensor["gate"]["stop_ns"] = 20000
    sensor["receiver"] = {"aperture_mm": 1000 * aperture, "array": {"columns": 1, "rows": 1, "pitch_um": 1e6 * pitch, "focal_length_mm": 1000 * focal}}
    two = one.copy()
    bands = [{"name": "b", "center_um": world.facts["wavelength"], "fwhm_um": 1e-3, "shape": "rectangular"}]
    two.sim["lamps"] = [{"kind": "spot", "position_m": sensor["position_m"], "axis": unit(sensor["position_m"], sensor["look_at_m"]), "intensity": 1e6,
                         "inner_deg": math.degrees(half), "outer_deg": math.degrees(half)}]
    two.sim["sensors"] = [{"kind": "frame_camera", "name": "camera", "columns": 1, "rows": 1, "pitch_um": 1e6 * pitch, "focal_length_mm": 1000 * focal, "bands": bands,
                           "position_m": sensor["position_m"], "look_at_m": sensor["look_at_m"], "up": [0, 1, 0], "truth": [], "paths": PULSES * sensor["paths"]}]
    weight = pitch ** 2 / (1 + 4 * (focal / aperture) ** 2) * math.pi  # A / G#, G# = (1 + 4 F^2) / pi
    photons = sensor["laser"]["pulse_energy_j"] * world.facts["wavelength"] * 1e-6 / (PLANCK * LIGHT)
    scale = photons * weight / (math.pi * math.tan(half) ** 2 * 1e6)
    return [(1 / scale, one), (-1, two, {"camera": "radar_sum"})], "all bins and a camera under a lamp"


def unit(a, b):
    d = [y - x for x, y in zip(a, b)]
    n = math.sqrt(sum(c * c for c in d))
    return [c / n for c in d]


def cold(world):
    """The world with nothing in it that shines of itself."""
    made = world.copy()
    for piece in [*made.scene["materials"].values(), *made.scene["media"].values()]:
        for key in ("temperature_k", "temperature", "thermal"):
            piece.pop(key, None)
        piece["maps"] = [m for m in piece.get("maps", []) if made.scene["maps"][m]["type"] != "temperature"]
        if not piece["maps"]:
            del piece["maps"]
    for key in ("sun", "moon", "sky", "night_sky"):
        made.sim.pop(key, None)
    made.sim["lamps"] = []
    return made


def photons_of(path, picture):
    """-> name, picture(values, errors, degrees): mean photons of the pulses by arrival; bands single and multiple. A bin's light is shared
    linearly by the cells at their middles, which undoes the split between bins. Of NAME_sum: all light in one number; of NAME_late: without the first two cells."""
    sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), "../../python"))
    import numpy as np
    from remote_scenes.lidar import open_response
    found = open_response(path)
    name = os.path.basename(path)[:-len("_response.h5")]
    active = found["bin"].values > 0
    rows, row, value = found.sizes["row"], found["entry_row"].values[active], found["value"].values[active]
    if name.endswith("_sum"):
        sums = np.bincount(row, value[:, :2].sum(axis=1), rows)
        return name, picture([[float(sums.mean())]], [[float(sums.std(ddof=1) / math.sqrt(rows))]], rows - 1)
    at = np.clip(1e9 * found["arrival"].values[active] / CELL_NS - 0.5, 0, CELLS)
    low = np.minimum(np.floor(at).astype(int), CELLS - 1)
    values, errors = [], []
    for c in range(2):
        each = np.zeros((rows, CELLS + 1))
        np.add.at(each, (row, low), value[:, c] * (1 - (at - low)))
        np.add.at(each, (row, low + 1), value[:, c] * (at - low))
        each = each[:, 2 if name.endswith("_late") else 0:CELLS]
        values.append(each.mean(axis=0).tolist())
        errors.append((each.std(axis=0, ddof=1) / math.sqrt(rows)).tolist())
    return name, picture(values, errors, rows - 1)

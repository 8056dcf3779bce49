"""Error against run time of the valley's six instruments, each on a small valley and with few pixels."""
import json
import os
import re
import shutil
import subprocess
import sys

TREES = 2000
BUDGETS = "4,8,16,32"
ARRAY = "sensors.0.instruments.0.arrays.0."
# instrument -> (the band that is shown, settings that make it small)
VIEWS = {
    "thermal": ("thermal", {"sensors.0.columns": 48, "sensors.0.rows": 32, "heat.elements": 1500}),
    "drone": ("green", {"sensors.0.columns": 48, "sensors.0.rows": 27}),
    "strip": ("b025", {ARRAY + "columns": 16, "sensors.0.tasks.0.stop": 43204, "heat.elements": 1500}),
    "satellite": ("red", {"sensors.0.columns": 24, "sensors.0.rows": 20, "heat.elements": 1500}),
    "night": ("green", {ARRAY + "columns": 48, ARRAY + "rows": 28}),
    "canopy": ("near infrared", {"sensors.0.columns": 20, "sensors.0.rows": 20}),
    "forest": ("0.835 um", {"sensors.0.rings": 6, "sensors.0.azimuths": 12, "sensors.0.view_zenith_deg": "[0, 45]"}),
}
# Cells of a goniometer share the paths of a view.
OWN_BUDGETS = {"forest": "1024,4096,16384"}


def first_sensor(text):
    """The text with the first of its sensors alone."""
    start = text.index("\nsensors:")
    at = [m.start() for m in re.finditer(r"^  - kind:", text[start:], re.M)]
    return text[:start + at[1]] if len(at) > 1 else text


def prepare(folder, root, binaries):
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    subprocess.run([sys.executable, f"{root}/sample_scenes/valley/make_scene.py", folder, str(TREES)], check=True)
    subprocess.run([f"{binaries}/sqt-fit", f"{root}/sample_scenes/calibration_range/satin_purple_rgb.bsdf", "-o", "satin.sqt", "-q"], cwd=folder, check=True)
    subprocess.run([f"{binaries}/scene-prep", "scene.yaml", "-o", "scene.h5", "-q"], cwd=folder, check=True, capture_output=True)


def study(name, folder, binaries, reuse):
    band, settings = VIEWS[name]
    out = f"{folder}/study_{name}"
    if not (reuse and os.path.exists(f"{out}/study.json")):
        shutil.rmtree(out, ignore_errors=True)  # of another build: it is not gone on with
        with open(f"{folder}/{name}.yaml") as f:
            text = first_sensor(f.read())
        with open(f"{folder}/study_{name}.yaml", "w") as f:
            f.write(text)
        words = [w for key, value in settings.items() for w in ("--set", f"{key}={value}")]
        done = subprocess.run([f"{binaries}/dirsig-render", f"study_{name}.yaml", "--study", f"study_{name}", "-q", "--study-seeds", "2",
                               "--study-budgets", OWN_BUDGETS.get(name, BUDGETS), *words], cwd=folder, capture_output=True, text=True)
        if done.returncode:
            sys.exit(f"results: {name} of the valley failed:\n{done.stderr[-2000:]}")
    with open(f"{out}/study.json") as f:
        found = json.load(f)
    series = next(s for s in found["series"] if s["name"].endswith(f": {band}"))
    return found, series


def row(name, found, series):
    first, last = series["points"][0], series["points"][-1]
    return (name, VIEWS[name][0], f"{first['budget']:.0f} to {last['budget']:.0f}", f"{100 * first['relative_rmse']:.3g} to {100 * last['relative_rmse']:.3g} %",
            f"{last['seconds']:.2f}", f"{series['slope_paths']:.2f}", "none counted" if last["coverage"] is None else f"{100 * last['coverage']:.1f} %",
            f"{100 * last['flagged_share']:.1f} %", f"{found['smallest_p']:.2g}: " + ("passes" if found["unbiased_at_1_percent_family_wise"] else "FAILS"))


def section(root, table, reuse):
    folder, binaries = f"{root}/build/results/valley", f"{root}/build/release/bin"
    if not (reuse and os.path.exists(f"{folder}/scene.h5")):
        prepare(folder, root, binaries)
    rows = [row(name, *study(name, folder, binaries, reuse)) for name in VIEWS]
    return table(["view", "band", "paths a pixel", "relative RMSE", "wall s of the last, air baked", "slope, paths", "coverage", "flagged", "bias, smallest p"], rows)

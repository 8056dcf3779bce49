"""Temperature of a pasture through a day by `heat:`, beside that of its upwelling longwave: ARM SGP E14, 2019-06-01.

Light, longwave, air, humidity and wind are given as measured; parameters are those of tests/physics/heat/pasture_test.cpp, set there before its first run."""
import csv
import subprocess

import numpy as np

from .pictures import spectra
from .results import Row, judged
from .surface_days import STEFAN_BOLTZMANN, arm_columns, saturation, screen_of

EMISSIVITY = 0.98
SIGMA_K = 1.1  # of 7 W/m2 of longwave up, typical of such radiometers
SCENE = """scene: 1
origin: {latitude_deg: 36.607, longitude_deg: -97.488, height_m: 315}
materials:
  grass:
    model: lambert
    reflectance: {wavelength_um: [0.28, 2.6, 3.5, 50], value: [%(albedo).4f, %(albedo).4f, 0.02, 0.02], outside: hold}
    thermal: {layers: [{thickness_m: 0.05, density_kg_m3: 20, specific_heat_j_kg_k: 3500, conductivity_w_m_k: 0.5},
                       {thickness_m: 1, density_kg_m3: 1000, specific_heat_j_kg_k: %(soil).1f, conductivity_w_m_k: 1}]}
    temperature: {model: heat, convection: constant, still_w_m2_k: 2, wind_j_m3_k: 4.75, wetness: 0.59}
objects: {pasture: {plane: {width: 50, depth: 50}, material: grass}}
world: [{place: pasture}]
"""
SIMULATION = """scene: scene.h5
epoch: 2019-06-01T00:00:00Z
weather: weather.csv
heat: {elements: 1, paths: 256, from: 2019-06-01T00:00:00Z, to: 2019-06-02T00:00:00Z, probes: {middle: [0, 0, 0]}}
sensors: [{kind: orthographic, name: map, columns: 1, rows: 1, gsd_m: 1, center_m: [0, 0], paths: 1, bands: [{name: t, center_um: 10, fwhm_um: 1}]}]
"""


def weather_of(balance, eddies):
    kelvin, vapour = screen_of(balance, eddies)
    humid = np.minimum(1, vapour / saturation(kelvin))
    wind = np.sqrt(eddies["mean_u"]**2 + eddies["mean_v"]**2 + eddies["var_u"] + eddies["var_v"])
    rows = zip(kelvin, humid, wind, eddies["atm_pres"], balance["down_short_hemisp"], balance["down_long"])
    return ("site: 36.607 -97.488 315\nstamps: begin\ntime_utc, air_temperature mean [K], relative_humidity mean [1], wind_speed mean [m/s], pressure mean [kPa], "
            "global [W/m2], longwave_down [W/m2]\n" + "".join("2019-06-01T%02d:%02dZ,%.3f,%.4f,%.3f,%.3f,%.2f,%.3f\n" % (k // 2, k % 2 * 30, *row)
                                                              for k, row in enumerate(rows)))


def solved(context, balance, eddies):
    """Kelvin of the half hours."""
    folder = context.work / "pasture"
    folder.mkdir(parents=True, exist_ok=True)
    sunny = balance["down_short_hemisp"] > 10
    albedo = balance["up_short_hemisp"][sunny].sum() / balance["down_short_hemisp"][sunny].sum()
    soil = 1e3 * np.mean([balance["soil_heat_capacity_%d" % k] for k in (1, 2, 3)])
    (folder / "scene.yaml").write_text(SCENE % {"albedo": albedo, "soil": soil})
    (folder / "sim.yaml").write_text(SIMULATION)
    (folder / "weather.csv").write_text(weather_of(balance, eddies))
    for words in ([str(context.program.parent / "scene-prep"), "scene.yaml", "-o", "scene.h5", "-q"], [str(context.program), "sim.yaml", "--heat-only", "-o", ".", "-q"]):
        done = subprocess.run(words, cwd=folder, capture_output=True, text=True)
        if done.returncode:
            raise RuntimeError("the pasture's temperature was not found:\n%s" % (done.stdout + done.stderr))
    with open(folder / "heat_probes.csv") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    seconds = np.array([float(r[next(k for k in r if k.startswith("time"))]) for r in rows])
    kelvin = np.array([float(r[next(k for k in r if k.startswith("temperature"))]) for r in rows])
    fine = lambda t: np.interp(t, seconds, kelvin)
    return np.array([np.mean(fine(1800 * k + np.arange(0, 1801, 300))) for k in range(48)])


def add(context, folder, result):
    """A row and a picture where ARM's files are there."""
    path = next(iter(sorted(folder.glob("sgpsebs*.csv"))), None)
    if path is None:
        return
    # Rows of the balance end at their stamps; the half hour that lacks at the end is the first one.
    balance = {k: np.roll(v, -1) for k, v in arm_columns(path).items()}
    eddies = arm_columns(folder / path.name.replace("sgpsebs", "sgp30ecor"))
    measured = ((balance["up_long"] - (1 - EMISSIVITY) * balance["down_long"]) / (EMISSIVITY * STEFAN_BOLTZMANN)) ** 0.25
    ours, hours = solved(context, balance, eddies), np.arange(48) / 2 + 0.25
    off = ours - measured
    night = balance["down_short_hemisp"] < 5
    result.rows.append(Row("ARM", "SGP E14, 2019-06-01, ground by `heat:`", "surface temperature, 48 half hours", "light and weather as measured, soil's heat capacity, albedo, grass of FAO 56",
                           "", "K", rest="night %+.1f, day %+.1f K; evaporation is the model's (wetness 0.59): as measured and closed the same test has 1.3 K (docs/theory/heat.md)" % (
                               off[night].mean(), off[~night].mean()), **judged(ours, measured, SIGMA_K + 0 * ours)))
    result.pictures["arm_ground"] = spectra("ARM SGP E14, ground", "h UTC", "K", [("measured", hours, measured, SIGMA_K + 0 * hours), ("ours", hours, ours, None)], True)

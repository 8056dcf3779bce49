"""HyTES over a water pixel from the ER-2, 2019 day 149: brightness temperatures from 7.5 to 12 um with a measured profile.

Fitted: a factor of the water vapour column and the temperature of the water. Emissivity of still water seen straight down, by Fresnel's law from
the indices of Hale & Querry (Appl. Opt. 12, 1973; libs/water/tables). The spectrum is an extract that its makers adjusted by an offset."""
import json
import re
from pathlib import Path

import numpy as np

from .air import Table, along, brightness, gas_error, gaussian_bands, planck
from .pasadena import within
from .pictures import spectra
from .results import Result, Row, columns, judged

GROUND_KM, SENSOR_KM = 1.155, 20.099
WINDOWS = [(8200, 9300), (10000, 11800)]
FITTED = [(8200, 9300), (10000, 11300)]  # beyond 11.3 um see the note
WATER = [1.0, 1.7, 2.5, 3.5]  # g/cm2
TABLE_CM = 20  # width of the builtin gas tables, cm-1


def profile_of(config, out, warmer=0.0):
    """The levels of a MODTRAN input as a profile of ours; formats/profile. Returns its water column, g/cm2. warmer: K, of every level."""
    air = json.loads(config.read_text())["MODTRAN"][0]["MODTRANINPUT"]["ATMOSPHERE"]
    levels = {p["TYPE"]: np.array(p["PROFILE"]) for p in air["PROFILES"]}
    height, pressure, kelvin, water = (levels["PROF_" + k] for k in ("ALTITUDE", "PRESSURE", "TEMPERATURE", "H2O"))
    rows = "".join("%.9g,%.9g,%.9g,%.9g\n" % row for row in zip(height, pressure, kelvin + warmer, water))
    out.write_text("height_km,pressure_hpa,temperature_k,h2o_ppmv\n" + rows)
    mass = 0.622 * 1e-6 * water * pressure / 9.81 * 10  # g/cm2 a unit of ln p
    return float(-np.trapezoid(mass, np.log(pressure)) if hasattr(np, "trapezoid") else -np.trapz(mass, np.log(pressure)))


def emissivity(um):
    table = Path(__file__).resolve().parents[2] / "libs/water/tables/hale_querry.inc"
    rows = np.array([[float(x) for x in re.findall(r"[-+.\de]+", line)] for line in table.read_text().splitlines() if line.startswith("{")])
    index = np.interp(um, rows[:, 0], rows[:, 1]) + 1j * np.interp(um, rows[:, 0], rows[:, 2])
    return 1 - abs((index - 1) / (index + 1)) ** 2


def smoothed(um, values):
    """Means over the width of the gas tables, by a box in wavenumber."""
    wave = 1e4 / um
    near = abs(wave[:, None] - wave) <= TABLE_CM / 2
    return (near * values).sum(1) / near.sum(1)


AIR = {"ozone_du": "300", "ppm": "{co2: 411}", "aerosol": "{model: rural, visibility_km: 50}"}


class Water:
    """air: keys of the atmosphere in place of AIR's, None leaves one out; shift_nm, wider: of the bands; warmer: K, of the profile."""

    def __init__(self, context, name="hytes", air=None, shift_nm=0.0, wider=1.0, warmer=0.0, streams=16):
        folder = context.data / "hytes"
        context.work.mkdir(parents=True, exist_ok=True)
        profile = context.work / (name + "_profile.csv")
        self.given_water = profile_of(next(iter(sorted(folder.glob("tir_*.json"))), folder / "tir.json"), profile, warmer)
        _, self.um, self.width = columns(folder / "hytes_wavelengths.txt", 3)
        nm, radiance = columns(next(iter(sorted(folder.glob("extracted_points_water*.txt"))), folder / "water.txt"), 2)
        at = [int(np.argmin(abs(nm - 1e3 * x))) for x in self.um]
        self.kelvin = brightness(self.um, 10 * radiance[at])
        self.emissivity = emissivity(self.um)
        keys = {**AIR, **(air or {}), **({"water_continuum": "'%s'" % context.continuum} if context.continuum else {})}
        text = "profile: '%s', scene_height_m: 1155" % profile + "".join(", %s: %s" % row for row in keys.items() if row[1])
        self.table = Table(context, name, text, gaussian_bands(1e3 * self.um + shift_nm, 1e3 * wider * self.width),
                           "H2OSTR: %s\nsurface_elevation_km: %g\nobserver_altitude_km: %g\nsolar_zenith: 30\nstreams: %d\ncheck: false\n" % (WATER, GROUND_KM, SENSOR_KM, streams), ())

    def seen(self, water, kelvin):
        """Brightness temperature, and transmittance."""
        at = lambda values: along(values, self.table.axes["H2OSTR"], water)
        up = at(self.table.up())
        ground = self.emissivity * planck(self.um, kelvin) + (1 - self.emissivity) * 10 * at(self.table["thermal_downwelling"])
        return brightness(self.um, 10 * at(self.table["thermal_upwelling"]) + up * ground), up

    def fit(self, windows):
        """Column and temperature of the least rms, by Gauss-Newton with numerical derivatives."""
        at = within(1e3 * self.um, windows)
        state = np.array([self.given_water, 291.0])
        for _ in range(12):
            base = self.seen(*state)[0][at]
            slopes = np.stack([(self.seen(*(state + step))[0][at] - base) / step.sum() for step in np.diag([0.05, 0.1])], 1)
            rest = self.kelvin[at] - base
            step = np.linalg.lstsq(slopes, rest, rcond=None)[0]
            inside = np.clip(state[0] + step[0], WATER[0], WATER[-1] - 0.06) - state[0]
            if inside != step[0]:  # the column ends at a bound: the temperature is the best one there
                step = np.array([inside, slopes[:, 1] @ (rest - slopes[:, 0] * inside) / (slopes[:, 1] @ slopes[:, 1])])
            state = state + step
        return state


def noise(context, um, kelvin):
    """Kelvin, by the published model where it is at hand, else 0."""
    path = next(iter(sorted((context.data / "noise").glob("joint_avirisc_noise*hytes*.txt"))), None)
    if path is None:
        return np.zeros_like(um)
    nm, a, b, c = columns(path, 4)
    radiance = planck(um, kelvin) / 10
    level = abs(np.interp(1e3 * um, nm, a) * np.sqrt(np.maximum(np.interp(1e3 * um, nm, b) + radiance, 0)) + np.interp(1e3 * um, nm, c))
    return level / ((planck(um, kelvin + 0.5) - planck(um, kelvin - 0.5)) / 10)


def rest_of(windows, um, ours, theirs, at):
    cells = []
    for low, high in windows:
        part = at & (1e3 * um >= low) & (1e3 * um <= high)
        cells.append("%.1f-%.1f um %.2f K rms" % (low / 1e3, high / 1e3, np.sqrt(((ours - theirs)[part] ** 2).mean())))
    return "; ".join(cells) + ": bands that the gas tables do not resolve, and the instrument beyond 11.3 um (below)"


def row_of(water, windows, ours, theirs, sigma, state, what):
    at = within(1e3 * water.um, windows)
    found = judged(ours[at], theirs[at], sigma[at])
    bands = "%s um" % ", ".join("%.1f-%.1f" % (low / 1e3, high / 1e3) for low, high in windows)
    return Row("HyTES", "water, ER-2, 20.1 km", "%d bands, %s, %s" % (at.sum(), bands, what), "profile, ozone 300 DU, index of water",
               "water vapour: %.2f times the profile's %.2f g/cm2; water: %.2f K" % (state[0] / water.given_water, water.given_water, state[1]), "K",
               rest=rest_of(windows, water.um, ours, theirs, at), details={"water_g_cm2": float(state[0]), "water_k": float(state[1])}, **found)


def run(context):
    water, result = Water(context), Result()
    state = water.fit(FITTED)
    ours, up = water.seen(*state)
    instrument = noise(context, water.um, water.kelvin)
    # An error of transmittance trades the water's light for that of air which is some 15 K colder.
    gases = gas_error(1e3 * water.um) * 15 + 0 * up
    sigma = np.hypot(instrument, gases)
    result.rows.append(row_of(water, WINDOWS, ours, water.kelvin, sigma, state, "as measured"))
    result.rows.append(row_of(water, FITTED, ours, water.kelvin, sigma, state, "as measured"))
    result.rows.append(row_of(water, FITTED, smoothed(water.um, ours), smoothed(water.um, water.kelvin), gases, state, "means over %d cm-1" % TABLE_CM))
    result.pictures["hytes_water"] = spectra("HyTES, water", "um", "K", [("HyTES", water.um, water.kelvin, instrument), ("ours", water.um, ours, gases)])
    quiet = within(1e3 * water.um, [(8600, 9000)])
    zigzag = water.kelvin[quiet][1:-1] - 0.5 * (water.kelvin[quiet][2:] + water.kelvin[quiet][:-2])
    far = within(1e3 * water.um, [(11800, 12000)])
    wide = 1e4 * water.width / water.um**2
    if zigzag.size > 5 and far.any():
        result.notes += ["The spectrum is an extract that its makers adjusted by an offset.",
                         "The column of water vapour and the water's temperature trade against each other; the column is kept below the table's %.1f g/cm2." % WATER[-1],
                         "Bands are %.0f to %.0f cm-1 wide and the builtin gases are smooth over 20 cm-1: lines of water from 8 to 9 um and of ozone are not resolved. "
                         "Bands differ from the mean of their neighbours by %.1f K rms from 8.6 to 9.0 um." % (wide.min(), wide.max(), np.sqrt((zigzag**2).mean())),
                         "From 11.3 um on the spectrum falls to %.0f K at 11.9 um. Ours (transmittance %.2f) stays at %.0f K, and no gas absorbs as much there: "
                         "those bands are left out of the fit." % (water.kelvin[far].mean(), up[far].mean(), ours[far].mean())]
        if not context.continuum:
            from . import hytes_tried  # it needs this module's classes
            result.notes += hytes_tried.notes(context, water)
    return result

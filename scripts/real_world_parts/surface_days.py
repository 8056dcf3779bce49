"""Days of surface radiation stations, as means of ten minutes (half hours of ARM): SURFRAD, BSRN's station-to-archive files, NREL's MIDC, ARM.

Irradiance in W/m2, NaN where it was not measured or is not clear. Clear minutes of the sun: after Long & Ackerman (J. Geophys. Res. 105, 2000),
diffuse light below 150 W/m2 mu^0.5, direct light above 120 W/m2; direct and diffuse light within 1.5 % and 5 % of their means over 21 minutes."""
import csv
import datetime
from dataclasses import dataclass, field

import numpy as np

from .sun import sun

MINUTES = 10     # of a mean
WINDOW = 21      # minutes over which clear light is steady
LOWEST = 8.0     # degrees of the sun's height
STEFAN_BOLTZMANN = 5.670374e-8
UAT = (32.22969, -110.95534, 786.0)  # MIDC's files have no place: the University of Arizona, by pressure and the time of noon
# Stated or typical standard deviations: relative and W/m2, whichever is more; of ARM's radiometer typical, of the others the networks' own.
BSRN = {"direct": (0.005, 1.5), "diffuse": (0.02, 3.0), "global": (0.02, 5.0), "longwave": (0.0, 3.0)}      # McArthur, BSRN operations manual, 2005
SURFRAD = {"direct": (0.02, 3.0), "diffuse": (0.02, 6.0), "global": (0.025, 5.0), "longwave": (0.0, 4.5)}   # Augustine et al., BAMS 81, 2000 (9 W/m2: two sigma)
MIDC = {"direct": (0.01, 2.0), "diffuse": (0.02, 3.0), "global": (0.025, 5.0)}
ARM = {"global": (0.05, 5.0), "longwave": (0.0, 7.0)}


@dataclass
class Day:
    """measured: quantity -> values over `hours` (h UTC of `date`); kelvin, vapour (Pa): of the screen; pressure: hPa; up: of the sun, or empty."""
    network: str
    place: str
    date: datetime.date
    site: tuple                # latitude, longitude (deg), height (m)
    sigma: dict
    hours: np.ndarray
    measured: dict
    kelvin: np.ndarray
    vapour: np.ndarray
    pressure: float
    albedo: float = float("nan")
    held_out: bool = False
    zenith: np.ndarray = field(default=None)
    distance: float = 1.0

    def __post_init__(self):
        start = datetime.datetime.combine(self.date, datetime.time())
        places = [sun(start + datetime.timedelta(hours=float(h)), *self.site[:2]) for h in self.hours]
        self.zenith, self.distance = np.array([p[0] for p in places]), float(np.mean([p[1] for p in places]))

    def error(self, quantity):
        """Standard deviation of the instrument, W/m2."""
        relative, least = self.sigma[quantity]
        return np.maximum(relative * abs(self.measured[quantity]), least)


def saturation(kelvin):
    """Pa over water; Bolton, Mon. Weather Rev. 108, 1980."""
    celsius = kelvin - 273.15
    return 611.2 * np.exp(17.67 * celsius / (celsius + 243.5))


def steady(values, share):
    """Where all values of the window are within a share of their mean."""
    half, good = WINDOW // 2, np.zeros(len(values), bool)
    for i in range(half, len(values) - half):
        part = values[i - half: i + half + 1]
        line = np.polyval(np.polyfit(np.arange(WINDOW), part, 2), np.arange(WINDOW)) if np.isfinite(part).all() else part
        good[i] = bool(np.isfinite(part).all() and (abs(part - line) <= share * line).all())
    return good


def in_means(hours, clear, values):
    """Means of MINUTES of which at least half are clear."""
    cell = np.floor(hours * 60 / MINUTES + 1e-6).astype(int)
    kept = [c for c in np.unique(cell) if clear[cell == c].sum() >= MINUTES // 2]
    pick = lambda v: np.array([v[(cell == c) & clear].mean() for c in kept])
    return (np.array([]), {k: np.array([]) for k in values}) if not kept else (pick(hours), {k: pick(v) for k, v in values.items()})


def day_of_minutes(network, place, date, site, sigma, hours, values, held_out=False):
    """values: the quantities of `sigma` that were measured, kelvin, vapour, pressure and perhaps up (reflected sunlight)."""
    start = datetime.datetime.combine(date, datetime.time())
    zenith = np.array([sun(start + datetime.timedelta(hours=float(h)), *site[:2])[0] for h in hours])
    clear = (zenith < 90 - LOWEST) & (values["diffuse"] < 150 * np.sqrt(np.maximum(np.cos(np.radians(zenith)), 0)))
    clear &= (values["direct"] > 120) & steady(values["direct"], 0.015) & steady(values["diffuse"], 0.05)
    for v in values.values():
        clear &= np.isfinite(v)
    middle, means = in_means(hours, clear, values)
    if len(middle) < 6:
        raise RuntimeError("%s %s: %d clear means of %d minutes, 6 are needed" % (network, place, len(middle), MINUTES))
    albedo = float(means["up"].sum() / means["global"].sum()) if "up" in means else float("nan")
    return Day(network, place, date, site, sigma, middle, {k: means[k] for k in sigma}, means["kelvin"], means["vapour"], float(means["pressure"].mean()),
               albedo, held_out)


def surfrad(path):
    lines = path.read_text().splitlines()
    latitude, west, height = (float(x) for x in lines[1].split()[:3])
    table = np.array([[float(x) for x in line.split()] for line in lines[2:] if line.strip()])
    table[table == -9999.9] = np.nan
    column = lambda k: np.where(table[:, 9 + 2 * k] == 1, np.nan, table[:, 8 + 2 * k])
    kelvin = column(15) + 273.15
    values = {"global": column(0), "up": column(1), "direct": column(2), "diffuse": column(3), "longwave": column(4), "kelvin": kelvin,
              "vapour": 0.01 * column(16) * saturation(kelvin), "pressure": column(19)}
    date = datetime.date(*(int(table[0, k]) for k in (0, 2, 3)))
    # Stamps end their minute; longitudes of SURFRAD are west.
    return day_of_minutes("SURFRAD", "%s, %s" % (lines[0].strip(), date), date, (latitude, -west, height), SURFRAD, table[:, 6] - 0.5 / 60, values)


def bsrn(path, days):
    """days: number -> held out. Of record 0100, two lines a minute; 0004 has the place."""
    lines = path.read_text().splitlines()
    at = {line[2:6]: i for i, line in enumerate(lines) if line.startswith("*")}
    _, month, year = (int(x) for x in lines[at["0001"] + 1].split()[:3])
    place = next(line for line in lines[at["0004"] + 1:] if len(line.split()) == 4 and line.split()[3].isdigit() and "." in line).split()
    site = (float(place[0]) - 90, float(place[1]) - 180, float(place[2]))
    body = [line.split() for line in lines[at["0100"] + 1:]]
    end = next((i for i, words in enumerate(body) if words and words[0].startswith("*")), len(body))
    table = np.array([[float(x) for x in a[:10] + b[:11]] for a, b in zip(body[0:end:2], body[1:end:2])])
    table[(table == -999) | (table == -99.9)] = np.nan
    found = []
    for number, held_out in days.items():
        day = table[table[:, 0] == number]
        kelvin = day[:, 18] + 273.15
        values = {"global": day[:, 2], "direct": day[:, 6], "diffuse": day[:, 10], "longwave": day[:, 14], "kelvin": kelvin,
                  "vapour": 0.01 * day[:, 19] * saturation(kelvin), "pressure": day[:, 20]}
        found.append(day_of_minutes("BSRN", "Payerne, %d-%02d-%02d" % (year, month, number), datetime.date(year, month, number), site, BSRN,
                                    (day[:, 1] + 0.5) / 60, values, held_out))
    return found


def midc(path):
    with open(path) as file:
        rows = list(csv.DictReader(file))
    column = lambda name: np.array([float(r[name]) for r in rows])
    date = datetime.date(int(rows[0]["Year"]), 1, 1) + datetime.timedelta(days=int(rows[0]["DOY"]) - 1)
    mst = column("MST")
    kelvin = column("Air Temperature [deg C]") + 273.15
    values = {"global": column("Global Horiz (platform) [W/m^2]"), "direct": column("Direct Normal [W/m^2]"), "diffuse": column("Diffuse Horiz [W/m^2]"),
              "kelvin": kelvin, "vapour": 0.01 * column("Rel Humidity [%]") * saturation(kelvin), "pressure": column("Station Pressure [mBar]")}
    order = np.argsort(mst, kind="stable")
    hours = (mst // 100 + mst % 100 / 60 + 7 - 0.5 / 60)[order]
    return day_of_minutes("MIDC", "Tucson, %s" % date, date, UAT, MIDC, hours, {k: v[order] for k, v in values.items()})


def arm_columns(path):
    with open(path) as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    return {name.split(" [")[0]: np.array([float(r[name]) for r in rows]) for name in rows[0]}


def screen_of(balance, eddies):
    """Kelvin and vapour pressure (Pa) beside the eddies: the sonic temperature is virtual and off by a constant, which is that of the night's mean
    difference from the gas analyser's. Rows of both begin or end together."""
    ratio = eddies["mr"] / (1 + eddies["mr"])
    true = eddies["mean_t"] / (1 + 0.51 * ratio)
    kelvin = true - np.mean((true - eddies["temp_irga"] - 273.15)[balance["down_short_hemisp"] < 0])
    return kelvin, eddies["mean_q"] * 1e-3 * 8.314 * kelvin


def arm(balance_path, eddies_path):
    """Half hours: the balance's end at their stamps, those of the eddies begin there (tests/physics/heat/pasture_test.cpp says how that is known).

    Clear: from 4 h until clouds came at 14.5 h UTC (the drop of sunlight at 15 h), as both curves show; no diffuse light was measured."""
    balance, eddies = arm_columns(balance_path), arm_columns(eddies_path)
    at = np.array([i for i, t in enumerate(balance["time"]) if 4 * 3600 < t <= 14.5 * 3600])
    light = np.where(balance["down_short_hemisp"] > 100, balance["down_short_hemisp"], np.nan)[at]
    kelvin, vapour = (v[at - 1] for v in screen_of({k: np.roll(v, -1) for k, v in balance.items()}, eddies))
    sunny = balance["down_short_hemisp"] > 100
    albedo = float(balance["up_short_hemisp"][sunny].sum() / balance["down_short_hemisp"][sunny].sum())
    return Day("ARM", "SGP E14, 2019-06-01", datetime.date(2019, 6, 1), (36.607, -97.488, 315.0), ARM, balance["time"][at] / 3600 - 0.25,
               {"global": light, "longwave": balance["down_long"][at]}, kelvin, vapour, float(10 * eddies["atm_pres"][at - 1].mean()), albedo)


def days(folder, held_out):
    """Every day whose files are there."""
    found = []
    for path in sorted(folder.glob("sgpsebs*.csv")):
        found.append(arm(path, folder / path.name.replace("sgpsebs", "sgp30ecor")))
    for path in sorted(folder.glob("bsrn-*pay0616.dat")):
        found += bsrn(path, {22: False, 23: True} if held_out else {22: False})
    found += [surfrad(path) for path in sorted(folder.glob("surfrad-*.dat"))]
    found += [midc(path) for path in sorted(folder.glob("midc_raw_20181018.txt"))]
    if not found:
        raise RuntimeError("%s: no file of SURFRAD, BSRN, MIDC or ARM (surfrad-*.dat, bsrn-*.dat, midc_raw_*.txt, sgpsebs*.csv)" % folder)
    return found

"""Irradiance at the ground on clear days: direct, diffuse, global and longwave of our air beside radiometers' (surface_days).

Given: the AFGL profile of the latitude and season, moved to the temperature of the screen at the ground, water vapour by the screen's humidity
(B. Leckner, Solar Energy 20, 1978), climatological ozone. Fitted: one aerosol depth a day, to the direct beam; without a direct beam it is given."""
import re
from pathlib import Path

import numpy as np

from . import ground_temperature
from .air import Table
from .pictures import spectra
from .results import Result, Row, judged
from .surface_days import STEFAN_BOLTZMANN, days

STANDARD = ["tropical", "midlatitude_summer", "midlatitude_winter", "subarctic_summer", "subarctic_winter", "us_standard"]
OZONE = {"SGP": 310, "Payerne": 335, "Alamosa": 285, "Tucson": 275}  # DU: zonal climatology of place and month, 10 % of it its standard deviation
GIVEN_DEPTH = (0.15, 0.08)  # at 550 nm, where no direct beam was measured: early summer over the Plains, and its spread
GUESSED_ALBEDO = 0.2        # of grass, where no reflected light was measured
DEPTHS = [0.01, 0.06, 0.15, 0.35]
WATER_SHARE, ALBEDO_SHARE, AEROSOL_SHARE = 0.2, 1 / 3, 0.08  # standard deviations: Leckner's column, albedo, diffuse light of aerosol (absorption)
FADING_KM = 1.5             # of the screen's difference from the profile, with 0.7 and 3 km as its uncertainty
EDGES_NM = np.concatenate([np.arange(280, 1000, 20), np.arange(1000, 2500, 50), np.arange(2500, 4001, 100)])
# Sunlight beyond 4 um, 0.8 % of it, is left out: the instruments' windows end there.
EDGES_CM = np.arange(100, 2501, 25.0)[::-1]


def standard(name):
    """km, hPa, K and ppmv of water of an AFGL atmosphere (libs/air/afgl_table.inc)."""
    text = (Path(__file__).resolve().parents[2] / "libs/air/afgl_table.inc").read_text()
    lists = {key: np.array([float(x) for x in body.replace("\n", " ").split(",") if x.strip()]) for key, body in re.findall(r"(\w+)\[\] = \{([^}]*)\}", text)}
    height = lists["kAfglHeightKm"]
    columns = lists["kAfglColumns"][: 6 * 9 * len(height)].reshape(6, 9, len(height))[STANDARD.index(name)]
    return height, columns[0], columns[1], columns[2]


def season(day):
    """The standard atmosphere of a day: by its own screen rather than by the calendar."""
    return "midlatitude_winter" if day.kelvin.mean() < 283 else "midlatitude_summer"


def moved(day, kelvin, fading_km, out):
    """Writes the standard profile with the screen's temperature and pressure at the ground; the difference fades upwards."""
    height, pressure, profile, water = standard(season(day))
    ground = day.site[2] / 1e3
    above = height > ground + 0.05
    at = lambda values: np.interp(ground, height, values)
    levels = np.concatenate([[ground], ground + np.array([0.1, 0.3, 0.6]), height[above]])
    levels = np.unique(levels)
    there = np.interp(levels, height, profile) + (kelvin - at(profile)) * np.exp(-(levels - ground) / fading_km)
    thick = np.exp(np.interp(levels, height, np.log(pressure))) * day.pressure / np.exp(at(np.log(pressure)))
    wet = np.exp(np.interp(levels, height, np.log(water)))
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_text("height_km,pressure_hpa,temperature_k,h2o_ppmv\n" + "".join("%.6g,%.6g,%.6g,%.6g\n" % row for row in zip(levels, thick, there, wet)))


def column_of(day):
    """Water vapour, g/cm2."""
    return 0.493 * day.vapour / day.kelvin


def rectangular(edges_um):
    low, high = np.minimum(edges_um[:-1], edges_um[1:]), np.maximum(edges_um[:-1], edges_um[1:])
    return ", ".join("{name: b%d, center_um: %.9g, fwhm_um: %.9g, shape: rectangular}" % (i, (a + b) / 2, b - a) for i, (a, b) in enumerate(zip(low, high)))


class Sunlight:
    """Broadband transmittances times irradiance, W/m2 at the day's distance, over [zenith, water, depth]."""

    def __init__(self, context, day, name):
        water = column_of(day)
        self.water = [round(float(w), 3) for w in (0.8 * water.min(), 1.25 * water.max())]
        self.zeniths = np.arange(np.floor(day.zenith.min()) - 2, day.zenith.max() + 6, 6).clip(0, 84)
        profile = context.work / name / "profile.csv"
        moved(day, float(day.kelvin.mean()), FADING_KM, profile)
        ozone = next(v for k, v in OZONE.items() if k in day.place)
        table = Table(context, name, "profile: '%s', ozone_du: %d, scene_height_m: %g, aerosol: {model: rural, optical_depth_550: 0.1}" % (profile, ozone, day.site[2]),
                      rectangular(EDGES_NM / 1e3), "H2OSTR: %s\nAOT550: %s\nsurface_elevation_km: %g\nsolar_zenith: %s\nwidest_bin_nm: 20\nstreams: 8\ncheck: false\n" % (
                          self.water, DEPTHS, day.site[2] / 1e3, [float(z) for z in np.unique(self.zeniths)]))
        self.zeniths = np.unique(self.zeniths)
        self.order = lambda key: np.moveaxis(np.broadcast_to(table[key], table["rhoatm"].shape), 2, 0)  # [zenith, water, depth, band]
        self.solar = 0.01 * self.order("solar_irr") * np.diff(EDGES_NM) / day.distance**2               # W/m2 of each band
        self.direct, self.diffuse, self.spherical = self.order("transm_down_dir"), self.order("transm_down_dif"), self.order("sphalb")
        self.band_um = (EDGES_NM[1:] + EDGES_NM[:-1]) / 2e3

    def reflectance(self, broadband):
        """Of vegetated ground in every band, scaled to a broadband albedo under this sun."""
        shape = np.where(self.band_um < 0.7, 0.08, np.where(self.band_um < 1.35, 0.32, 0.2))
        weight = (self.solar * (self.direct + self.diffuse))[0, 0, 1]
        return shape * broadband / ((shape * weight).sum() / weight.sum())

    def broadband(self, broadband_albedo, aerosol=1.0):
        """Direct normal and diffuse irradiance on [zenith, water, depth]; aerosol: factor of the diffuse light above that of the least depth."""
        cosine = np.cos(np.radians(self.zeniths))[:, None, None, None]
        ground = self.reflectance(broadband_albedo)
        sky = self.diffuse[:, :, :1] + aerosol * (self.diffuse - self.diffuse[:, :, :1])
        again = (self.direct + sky) * ground * self.spherical / (1 - ground * self.spherical)
        return (self.solar * self.direct).sum(-1), (self.solar * cosine * (sky + again)).sum(-1)

    def at(self, grid, day, water, depth):
        """Of every time: linear in water and depth, over the zenith angle linear in the cosine (logarithms would not gain anything at these steps)."""
        from_grid = []
        for zenith, column in zip(day.zenith, water):
            cosines = np.cos(np.radians(self.zeniths))[::-1]
            by_state = np.array([[np.interp(np.cos(np.radians(zenith)), cosines, grid[::-1, w, d]) for d in range(len(DEPTHS))] for w in range(len(self.water))])
            by_depth = [np.interp(column, self.water, by_state[:, d]) for d in range(len(DEPTHS))]
            from_grid.append(np.interp(depth, DEPTHS, by_depth))
        return np.array(from_grid)


def fitted_depth(sun, day, water):
    """Aerosol depth of the least squares of the direct beam's logarithm, and the standard deviation of single times."""
    direct = sun.broadband(GUESSED_ALBEDO)[0]
    trial = np.linspace(DEPTHS[0], DEPTHS[-1], 35)
    curves = np.array([sun.at(direct, day, water, d) for d in trial])
    single = np.array([np.interp(-m, -curves[:, i], trial) for i, m in enumerate(day.measured["direct"])])
    worst = ((np.log(curves) - np.log(day.measured["direct"])) ** 2).mean(1)
    return float(trial[worst.argmin()]), float(single.std())


def sunlight_of(sun, day):
    """Quantity -> (ours, our standard deviation), W/m2, and the depth with its spread."""
    water = column_of(day)
    albedo = day.albedo if np.isfinite(day.albedo) else GUESSED_ALBEDO
    depth, spread = fitted_depth(sun, day, water) if "direct" in day.measured else GIVEN_DEPTH
    cosine = np.cos(np.radians(day.zenith))

    def three(w, d, a, aerosol=1.0):
        direct, diffuse = (sun.at(grid, day, w, d) for grid in sun.broadband(a, aerosol))
        return {"direct": direct, "diffuse": diffuse, "global": direct * cosine + diffuse}

    base = three(water, depth, albedo)
    other = [three(water / (1 + WATER_SHARE), depth, albedo), three(water, depth + spread, albedo), three(water, depth, albedo * (1 + ALBEDO_SHARE)),
             three(water, depth, albedo, 1 + AEROSOL_SHARE)]
    return {k: (base[k], np.sqrt(sum((o[k] - base[k]) ** 2 for o in other))) for k in base}, depth, spread


class Longwave:
    """Downwelling longwave, W/m2, over [temperature of the screen, water]."""

    def __init__(self, context, day, name):
        low, high = day.kelvin.min(), day.kelvin.max()
        self.kelvin = np.linspace(low, max(high, low + 1), 2)  # between them the fourth root runs all but straight
        water = column_of(day)
        self.water = [round(float(w), 3) for w in (0.8 * water.min(), 1.25 * water.max())]
        self.sky = np.array([self._sky(context, day, name + "_%d" % i, k, FADING_KM, self.water) for i, k in enumerate(self.kelvin)])
        middle = float(day.kelvin.mean())
        here = [self._sky(context, day, name + "_fade%d" % i, middle, fading, [round(float(water.mean()), 3)])[0] for i, fading in enumerate((0.7, 3.0))]
        self.fading = 0.5 * abs(here[1] - here[0])

    def _sky(self, context, day, name, kelvin, fading, water):
        """Of each column of water."""
        profile = context.work / name / "profile.csv"
        moved(day, float(kelvin), fading, profile)
        table = Table(context, name, "profile: '%s', ozone_du: 300, ppm: {co2: 405}, scene_height_m: %g" % (profile, day.site[2]),
                      rectangular(1e4 / EDGES_CM), "H2OSTR: %s\nsurface_elevation_km: %g\nsolar_zenith: 30\nwidest_bin_nm: 1000\nstreams: 4\ncheck: false\n" % (
                          water, day.site[2] / 1e3), ())
        # Beyond 100 um the air is black at the screen's temperature; below 4 um it sends nothing that counts.
        um = 1e4 / EDGES_CM
        width = abs(np.diff(um))
        x = 1.438777 * EDGES_CM[-1] / kelvin
        far = 15 / np.pi**4 * (np.pi**4 / 15 - sum(np.exp(-n * x) * (x**3 / n + 3 * x**2 / n**2 + 6 * x / n**3 + 6 / n**4) for n in range(1, 60)))
        return np.pi * 10 * (np.atleast_2d(table["thermal_downwelling"]) * width).sum(-1) + far * STEFAN_BOLTZMANN * kelvin**4

    def of(self, day):
        """Ours and its standard deviation."""
        def at(water):
            by_kelvin = np.array([[np.interp(np.log(w), np.log(self.water), row) for row in self.sky] for w in water])
            return np.array([np.interp(k, self.kelvin, row**0.25) for k, row in zip(day.kelvin, by_kelvin)]) ** 4
        water = column_of(day)
        ours = at(water)
        return ours, np.hypot(at(water / (1 + WATER_SHARE)) - ours, self.fading)


def row_of(day, quantity, ours, sigma, fitted, rest, given):
    theirs = day.measured[quantity]
    fine = np.isfinite(theirs)
    both = np.hypot(sigma, day.error(quantity))[fine]
    off = (ours - theirs)[fine]
    found = judged(ours[fine], theirs[fine], both)
    mean = theirs[fine].mean()
    return Row(day.network, day.place, "%s, %d means" % (quantity, fine.sum()), given, fitted, "W/m2", held_out=day.held_out,
               details={"quantity": quantity, "percent": float(100 * off.mean() / mean), "least_depth": LEAST in fitted},
               rest="%+.1f, %.1f %% of %.0f W/m2; uncertainty: theirs %.1f, ours %.1f W/m2; %s" % (
                   100 * off.mean() / mean, 100 * found["rms"] / mean, mean, day.error(quantity)[fine].mean(), sigma[fine].mean(), rest), **found)


LEAST = ", the least of the table"  # of a fitted depth
RESTS = {"direct": "course of the aerosol within the day", "diffuse": "the aerosol's absorption and size, ground around",
         "global": "both, and the pyranometer's cosine response", "longwave": "temperature and water above the screen, which was not measured"}


def shown(day, quantity, ours, sigma):
    """Curves of a picture, where that was measured."""
    there = np.isfinite(day.measured[quantity])
    return [("%s, measured" % quantity, day.hours[there], day.measured[quantity][there], None), ("%s, ours" % quantity, day.hours[there], ours[there], sigma[there])]


def day_rows(context, day, result):
    name = "%s_%s_%d" % (day.network.lower(), day.place.split(",")[0].split()[-1].lower(), day.date.day)
    sun = Sunlight(context, day, name + "_sun")
    light, depth, spread = sunlight_of(sun, day)
    ozone = next(v for k, v in OZONE.items() if k in day.place)
    given = "%s, screen, ozone %d DU%s" % (season(day).replace("_", " "), ozone, "" if "direct" in day.measured else ", AOD %.2f" % depth)
    fitted = "aerosol depth %.3f (single times +- %.3f), by the direct beam%s" % (
        depth, spread, LEAST if depth <= DEPTHS[0] else "") if "direct" in day.measured else ""
    curves = []
    for quantity in ("direct", "diffuse", "global"):
        if quantity in day.measured:
            result.rows.append(row_of(day, quantity, *light[quantity], fitted, RESTS[quantity], given))
            curves += shown(day, quantity, *light[quantity])
    result.pictures[name] = spectra("%s, %s" % (day.network, day.place), "h UTC", "W/m2", curves[-4:], True)
    if "longwave" in day.measured:
        ours, sigma = Longwave(context, day, name + "_sky").of(day)
        water = column_of(day)
        result.rows.append(row_of(day, "longwave", ours, sigma, "", RESTS["longwave"], "%s, screen, water %.2f to %.2f g/cm2 by its humidity" % (
            season(day).replace("_", " "), water.min(), water.max())))
        result.pictures[name + "_longwave"] = spectra("%s, %s, longwave" % (day.network, day.place), "h UTC", "W/m2", [
            ("measured", day.hours, day.measured["longwave"], day.error("longwave")), ("ours", day.hours, ours, sigma)], True)


def least_note(rows):
    """What the days say whose aerosol depth came out as the least of the table; nothing where there is none."""
    least = [r for r in rows if r.details.get("least_depth")]
    if not least:
        return []
    cells = ["%s %s %%" % (q, ", ".join("%+.1f" % r.details["percent"] for r in least if r.details["quantity"] == q)) for q in ("direct", "diffuse")]
    places = [r.place for r in least if r.details["quantity"] == "direct"]
    wet = ["%s %+.1f %%" % (r.place, r.details["percent"]) for r in rows if r.details.get("quantity") == "longwave"]
    return ["Where the depth is the table's least (%s), ours is off by: %s. Too little of both asks for less water than the screen's humidity makes, and for some aerosol, which one number "
            "cannot separate. Longwave says the same of the water where it is too much: %s." % ("; ".join(places), "; ".join(cells), "; ".join(wet) or "not measured")]


def run(context):
    folder, result = context.data / "surface", Result()
    for day in days(folder, context.held_out):
        day_rows(context, day, result)
    ground_temperature.add(context, folder, result)
    result.notes += [
        "Clear: after Long & Ackerman (2000), by the measured light alone. ARM's day has neither direct nor diffuse light: its clear hours are those before clouds came.",
        "Profiles: AFGL's, whose difference from the screen's temperature fades with %.1f km; 0.7 and 3 km and %.0f %% of the water column make our longwave's uncertainty; the aerosol's own longwave "
        "(1 to 3 W/m2 of haze) is left out." % (FADING_KM, 100 * WATER_SHARE),
        "Sunlight's uncertainty of ours: the spread of the depth of single times, %.0f %% of water, a third of the albedo, %.0f %% of the aerosol's diffuse light." % (100 * WATER_SHARE, 100 * AEROSOL_SHARE),
        *least_note(result.rows),
        "Pyrheliometers see 2.5 degrees around the sun and are calibrated by cavities that see beyond 4 um, too; neither is in ours (together some 0.5 to 1 % of the direct beam, an estimate).",
        "The files name neither aerosol depth nor water vapour: depth is the one number fitted, to the direct beam; diffuse, global and longwave are not fitted."]
    return result

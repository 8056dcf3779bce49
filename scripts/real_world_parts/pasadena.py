"""AVIRIS-NG over Pasadena, 2017-11-08: radiance over targets whose reflectance was measured on the ground.

Only the water vapour column is fitted, to the depths of the bands at 0.94 and 1.13 um relative to their shoulders, which are in none of the
windows that judge but for their edges."""
import dataclasses
import datetime

import numpy as np

from .air import Table, along, gas_error, gaussian_bands, reflected
from .pictures import spectra
from .results import Result, Row, columns, judged
from .sun import sun

LATITUDE, LONGITUDE, GROUND_KM, SENSOR_KM = 34.139247, -118.127521, 0.35, 2.3
WINDOWS = [(400, 500), (500, 600), (600, 690), (740, 900), (1000, 1080), (1200, 1300), (1540, 1750), (2050, 2300)]
SHOULDERS = [(865, 885), (1000, 1080), (1235, 1255)]
DEPTHS = [(890, 995), (1090, 1190)]
WATER = [0.8, 1.4, 2.2, 3.2]  # g/cm2; where aerosol is varied the third
# Name, radiance, reflectance, UTC, kept apart while this was written.
TARGETS = [("horse arena", "ang20171108t184829_rdn_v2p11_horse.txt", "Horse_Trial2.txt", (18, 48, 29), 10, False),
           ("red field", "ang20171108t184227_rdn_v2p11_AstroRedBaseball.txt", "AstroRedBaseball.txt", (18, 42, 27), 10, False),
           ("lawn", "ang20171108t184227_rdn_v2p11_BeckmanLawn.txt", "BeckmanLawn.txt", (18, 42, 27), 294, True)]
MODTRAN = {"horse arena": 5.5, "red field": 5.8, "lawn": 9.2}  # MODTRAN 6, water vapour fitted, the same windows; percent
CALIBRATION = 0.01  # of the radiance, as the data set's configuration states it
POLARISATION = 0.05  # of path radiance below 600 nm: half of the bound of scalar scattering (formats/air_lut)


def aerosol_depths(folder):
    """At 550 nm, of each sun photometer: its aerosol's depths at 520 and 610 nm, a power law between them."""
    depths = []
    for path in sorted(folder.glob("aod*.txt")):
        rows = [line.split() for line in path.read_text().splitlines()]
        table = np.array([[float(x) for x in r[1:]] for r in rows if len(r) == 7 and r[0].isdigit()])
        if len(table) < 2:
            raise RuntimeError("%s: no rows 'channel, wavelength, ..., tau mie'" % path)
        depths.append(float(np.exp(np.interp(np.log(550), np.log(table[:, 0]), np.log(table[:, 5])))))
    if not depths:
        raise RuntimeError("%s: no sun photometer (aod*.txt)" % folder)
    return depths


def sun_at(time):
    return sun(datetime.datetime(2017, 11, 8, *time), LATITUDE, LONGITUDE)


def within(nm, windows):
    return np.any([(nm >= low) & (nm <= high) for low, high in windows], axis=0)


def in_bands(nm, value, centers, fwhm):
    weight = np.exp(-4 * np.log(2) * ((nm - centers[:, None]) / fwhm[:, None]) ** 2)
    return (weight * value).sum(1) / weight.sum(1)


def shoulder_scale(nm, ours, theirs):
    """Ours over theirs along the shoulders, a straight line of wavelength."""
    at = within(nm, SHOULDERS)
    return np.polyval(np.polyfit(nm[at], ours[at] / theirs[at], 1), nm)


def fitted_water(nm, states, water, measured):
    """The column (g/cm2) whose bands are as deep as measured, in the least squares of radiance."""
    at = within(nm, DEPTHS)

    def misfit(column):
        ours = along(states, water, column)
        return float((((ours / shoulder_scale(nm, ours, measured)) - measured)[at] ** 2).sum())

    columns_ = np.arange(water[0], water[-1] + 1e-9, 0.01)
    return float(columns_[np.argmin([misfit(c) for c in columns_])])


def window_means(nm, ours, theirs):
    """Percent by which ours exceeds theirs in the mean of every window that has bands."""
    chosen = [within(nm, [w]) for w in WINDOWS]
    return np.array([100 * (ours[w].mean() / theirs[w].mean() - 1) for w in chosen if w.any()])


class Air:
    """The tables that all targets share: states of water vapour under the mean of the photometers, and both photometers at one of them."""

    def __init__(self, context, nm, fwhm, depths, zeniths, gases=""):
        """gases: text of further keys of the atmosphere."""
        continuum = ", water_continuum: '%s'" % context.continuum if context.continuum else ""
        air = "profile: midlatitude_summer, ozone_du: 300, ppm: {co2: 405}, aerosol: {model: rural, optical_depth_550: 0.05}, scene_height_m: 350" + continuum + gases
        low, high = min(depths), max(max(depths), 1.01 * min(depths))
        grid = "H2OSTR: %s\nAOT550: %s\nsurface_elevation_km: %g\nobserver_altitude_km: %g\nsolar_zenith: %s\ncheck: false\n"
        make = lambda name, water, depth: Table(context, name, air, gaussian_bands(nm, fwhm), grid % (water, depth, GROUND_KM, SENSOR_KM, zeniths))
        self.wet = make("pasadena", WATER, "%.4g" % ((low + high) / 2))  # [water, zenith, band]
        self.hazy = make("pasadena_aerosol", WATER[2], "[%.4g, %.4g]" % (low, high))  # [aerosol, zenith, band]


class Closure:
    """One target through the tables of the air."""

    def __init__(self, context, nm, fwhm, target, air, which):
        """which: of the tables' angles of the sun."""
        self.name, radiance, ground, time, self.averaged, self.held_out = target
        folder = context.data / "pasadena"
        self.zenith, self.distance = sun_at(time)
        measured_nm, self.measured = columns(folder / radiance, 2)
        if len(measured_nm) != len(nm) or abs(measured_nm - nm).max() > 0.02:
            raise RuntimeError("%s: its wavelengths are not those of the wavelength file" % (folder / radiance))
        self.nm, self.noise = nm, noise_of(context.data, nm, self.measured, self.averaged)
        ground_nm, mean, spread = columns(folder / ground, 3)
        self.reflectance = in_bands(ground_nm, mean, nm, fwhm)
        self.spread = in_bands(ground_nm, spread, nm, fwhm)
        self.table = air.wet
        self.at = lambda values: along(values[:, which], air.wet.axes["H2OSTR"], self.water)
        states = self.seen(air.wet, self.reflectance)
        self.water = fitted_water(nm, states[:, which], air.wet.axes["H2OSTR"], self.measured)
        self.ours = self.at(states)
        hazy = self.seen(air.hazy, self.reflectance)[:, which]
        self.sigma_measured = np.hypot(np.hypot(CALIBRATION * self.measured, self.noise), self.ground_error())
        self.sigma_ours = self.model_error(0.5 * abs(hazy[1] - hazy[0]))

    def seen(self, table, reflectance):
        return reflected(table, reflectance, self.zenith, self.distance)

    def ground_error(self):
        """By the spread of the reflectance over the target."""
        return abs(self.at(self.seen(self.table, self.reflectance + self.spread)) - self.ours)

    def model_error(self, aerosol):
        """Half the span of the photometers, polarisation that is left out, gases."""
        sun_above = self.table["solar_irr"][0, 0] * np.cos(np.radians(self.zenith)) / np.pi / self.distance**2
        path = self.at(self.table["rhoatm"]) * sun_above
        blue = np.where(self.nm < 600, POLARISATION * path, 0)
        ground = (self.ours - path) * gas_error(self.nm) / np.maximum(self.at(self.table.two_way()), 0.05)
        return np.sqrt(aerosol**2 + blue**2 + ground**2)

    def row(self, depths):
        used = within(self.nm, WINDOWS)
        relative = window_means(self.nm, self.ours, self.measured)
        sigma = np.hypot(self.sigma_measured, self.sigma_ours)
        share = judged(self.ours[used], self.measured[used], sigma[used])["share"]
        worst = int(np.argmax(abs(relative)))
        windows = [w for w in WINDOWS if within(self.nm, [w]).any()]
        rest = "%+.1f %% from %d to %d nm; the other windows %.1f %% rms" % (
            relative[worst], *windows[worst], np.sqrt((np.delete(relative, worst) ** 2).mean()))
        return Row("AVIRIS-NG", "Pasadena, %s, sun at %.1f deg" % (self.name, self.zenith), "%d bands, 0.4-2.3 um, means of %d windows" % (used.sum(), len(relative)),
                   "reflectance, AOD %s, ozone 300 DU, geometry" % " and ".join("%.3f" % d for d in depths), "water vapour: %.2f g/cm2" % self.water, "%",
                   float(relative.mean()), float(np.sqrt((relative**2).mean())), share, rest, len(relative), self.held_out,
                   {"windows": [round(float(x), 2) for x in relative], "water_g_cm2": self.water, "modtran_rms": MODTRAN[self.name], "zenith": self.zenith})


def noise_of(data, nm, radiance, averaged):
    """Noise-equivalent radiance |a sqrt(b + L) + c| of one pixel by the published model, of the mean of `averaged`."""
    path = data / "noise/avirisng_noise.txt"
    if not path.exists():
        return np.zeros_like(nm)
    table = columns(path, 4)
    a, b, c = (np.interp(nm, table[0], x) for x in table[1:])
    return abs(a * np.sqrt(np.maximum(b + radiance, 0)) + c) / np.sqrt(averaged)


def calibration_note(one, other):
    """What two targets say about radiance without the path's: ratio of the measured to our difference of them."""
    ratio = (one.measured - other.measured) / (one.ours - other.ours)
    nm = one.nm
    cells = ", ".join("%.2f at %.0f nm" % (ratio[k], nm[k]) for k in (int(np.argmin(abs(nm - x))) for x in (417, 457, 497, 597, 858)))
    return ("Blue: the difference of %s and %s has no path radiance and hardly any light from around. Measured over ours: %s. The photometers' depths "
            "leave no room for that: it is the radiance's calibration, or the reflectance as measured in the blue." % (one.name, other.name, cells))


def lowtran_note(context, nm, fwhm, depths, zeniths, targets):
    """What the rows leave with LOWTRAN 7's gases."""
    air = Air(dataclasses.replace(context, work=context.work / "lowtran"), nm, fwhm, depths, zeniths, ", gases: lowtran")
    closures = [Closure(context, nm, fwhm, t, air, zeniths.index(zenith_of(t))) for t in targets]
    return "With LOWTRAN 7's own laws and continuum of 1988 (`gases: lowtran`, builtin before): %s." % ", ".join(
        "%s %.3g %% rms (water %.2f g/cm2)" % (c.name, c.row(depths).rms, c.water) for c in closures)


def zenith_of(target):
    return round(sun_at(target[3])[0], 4)


def run(context):
    result = Result()
    folder = context.data / "pasadena"
    _, center, width = columns(next(iter(sorted(folder.glob("*wavelength_fit.txt"))), folder / "wavelength_fit.txt"), 3)
    nm, fwhm = 1e3 * center, 1e3 * width
    depths = aerosol_depths(folder)
    targets = [t for t in TARGETS if (context.held_out or not t[5]) and (folder / t[1]).exists()]
    zeniths = sorted({zenith_of(t) for t in targets})
    air = Air(context, nm, fwhm, depths, zeniths)
    closures = [Closure(context, nm, fwhm, t, air, zeniths.index(zenith_of(t))) for t in targets]
    for closure in closures:
        result.rows.append(closure.row(depths))
        result.pictures["pasadena_" + closure.name.replace(" ", "_")] = spectra(
            "Pasadena, " + closure.name, "nm", "uW/(cm2 sr nm)", [("AVIRIS-NG", nm, closure.measured, closure.sigma_measured), ("ours", nm, closure.ours, closure.sigma_ours)])
        result.notes.append("%s: by window %s %%. MODTRAN 6 with fitted water vapour leaves %.1f %% rms (a figure given by others, which nothing here repeats)." % (
            closure.name.capitalize(), ", ".join("%+.1f" % x for x in result.rows[-1].details["windows"]), MODTRAN[closure.name]))
    if len(closures) > 1 and len(nm) > 100:
        result.notes.append(calibration_note(closures[0], closures[1]))
    result.notes.append("Surroundings: a dark target among brighter ground receives their light from the air (500 to 690 nm on the red field). No reflectance "
                        "of the surroundings was measured; the even ground of the table stands for them.")
    if len(nm) > 100 and not context.continuum:  # the whole spectrum, not the extract
        result.notes.append("2.05 to 2.3 um: one kilometre of midlatitude summer at 2.10 to 2.12 um stands beside MODTRAN's in the section on its paths.")
        result.notes.append(lowtran_note(context, nm, fwhm, depths, zeniths, targets))
    return result

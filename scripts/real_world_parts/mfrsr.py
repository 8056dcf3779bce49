"""A multifilter rotating shadowband radiometer of ARM (SGP E11, 2021-03-29), a clear day: direct and diffuse irradiance in six filters.

Fitted: the calibration of each filter, as the intercept of a Langley plot of the morning (the file's is nominal, by a lamp).
With it the direct beam gives an aerosol depth in every filter at every time; that depth gives the ratio of diffuse to direct, in which the
calibration cancels. The afternoon is kept apart."""
import csv
import datetime

import numpy as np

from .air import Table
from .pictures import spectra
from .results import Result, Row, judged
from .sun import sun

FILTERS = [1, 2, 3, 4, 5, 7]
NOMINAL_7 = (1624.0, 15.0)  # nm, centre and width: the file has no response of it
NOON_H = 18.6               # UTC: 98.3 degrees west, equation of time -5 min
# Of grass in spring, green and dry, with a third of itself as its uncertainty: nothing of it was measured there.
ALBEDO = {1: 0.05, 2: 0.07, 3: 0.10, 4: 0.10, 5: 0.28, 7: 0.25}
ZENITHS = [32, 36, 41, 46, 52, 58, 63, 68, 72, 76, 80]
DEPTHS = [0.01, 0.05, 0.12, 0.25]
JUDGED = (33, 80)   # heights of 10 to 57 degrees
READING = 0.02  # of a measured ratio, standard deviation
BAND_PERIOD_S = 1500  # the shadowband's steps come back to the same offset from the sun


class Day:
    """Times (h UTC), zenith angles (deg), and by filter direct normal and diffuse irradiance (W/(m2 nm)), NaN where flagged; responses (nm, 1)."""

    def __init__(self, folder):
        plain = folder / "extract.csv"
        if plain.exists():
            self._from_csv(plain, folder)
            return
        try:
            import netCDF4
        except ImportError:
            raise RuntimeError("%s: netCDF4 is needed to read the radiometer's file" % folder) from None
        path = next(iter(sorted(folder.glob("*.nc"))), None)
        if path is None:
            raise RuntimeError("%s: neither extract.csv nor a file of the radiometer (*.nc)" % folder)
        with netCDF4.Dataset(path) as file:
            read = lambda name: np.ma.filled(file[name][:].astype(float), np.nan)
            self.hours, self.zenith = read("time") / 3600, read("solar_zenith_angle")
            self.direct, self.diffuse, self.response = {}, {}, {}
            for k in FILTERS:
                self.direct[k], self.diffuse[k] = read("direct_normal_narrowband_filter%d" % k), read("diffuse_hemisp_narrowband_filter%d" % k)
                for values, name in ((self.direct[k], "direct_normal"), (self.diffuse[k], "diffuse_hemisp")):
                    values[(file["qc_%s_narrowband_filter%d" % (name, k)][:] != 0) | (values <= 0)] = np.nan
                nm, response = read("wavelength_filter%d" % k), read("normalized_transmittance_filter%d" % k)
                fine = (nm > 0) & (response > 1e-3 * np.max(response, initial=1e-9, where=np.isfinite(response)))
                self.response[k] = (nm[fine], response[fine])

    def _from_csv(self, path, folder):
        with open(path) as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        column = lambda name: np.array([float(r[name]) for r in rows])
        self.hours, self.zenith = column("hours_utc"), column("zenith_deg")
        self.direct = {k: column("direct_%d" % k) for k in FILTERS}
        self.diffuse = {k: column("diffuse_%d" % k) for k in FILTERS}
        with open(folder / "responses.csv") as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        self.response = {k: (np.array([float(r["nm"]) for r in rows if r["filter"] == str(k)]), np.array([float(r["response"]) for r in rows if r["filter"] == str(k)]))
                         for k in FILTERS}


def bands_of(day):
    texts = []
    for k in FILTERS:
        nm, response = day.response[k]
        if len(nm) == 0:
            texts.append("{name: f%d, center_um: %g, fwhm_um: %g}" % (k, NOMINAL_7[0] / 1e3, NOMINAL_7[1] / 1e3))
            continue
        lists = "wavelength_um: [%s], value: [%s], outside: zero" % (", ".join("%.6g" % x for x in nm / 1e3), ", ".join("%.5g" % x for x in response))
        texts.append("{name: f%d, response: {%s}}" % (k, lists))
    return ", ".join(texts)


class Sky:
    """Direct transmittance and diffuse over direct normal irradiance in the filters, over [zenith, aerosol depth at 550 nm]."""

    def __init__(self, context, day, name="mfrsr", model="rural", brighter=1.0):
        """model: of the aerosol; brighter: factor of the ground's albedo."""
        self.albedo = {k: brighter * a for k, a in ALBEDO.items()}
        table = Table(context, name, "profile: us_standard, ozone_du: 310, scene_height_m: 360, aerosol: {model: %s, optical_depth_550: 0.05}" % model, bands_of(day),
                      "H2OSTR: 1\nAOT550: %s\nsurface_elevation_km: 0.36\nsolar_zenith: %s\ncheck: false\n" % (DEPTHS, ZENITHS))
        self.direct = np.moveaxis(table["transm_down_dir"], 0, 1)  # [zenith, depth, filter]
        self.diffuse = np.moveaxis(table["transm_down_dif"], 0, 1)
        self.spherical = np.moveaxis(np.broadcast_to(table["sphalb"], table["rhoatm"].shape), 0, 1)
        _, distance = sun(datetime.datetime(2021, 3, 29, 18), 36.88, -98.29)
        self.irradiance = 0.01 / distance**2 * table["solar_irr"].reshape(-1, len(FILTERS))[0]  # W/(m2 nm)
        self.nm = table.nm

    def at(self, values, zenith, filter_index):
        """[time, depth]: linear in the cosine."""
        cosines = np.cos(np.radians(ZENITHS))[::-1]
        grid = values[::-1, :, filter_index]
        return np.stack([np.interp(np.cos(np.radians(zenith)), cosines, grid[:, d]) for d in range(len(DEPTHS))], 1)

    def direct_at(self, zenith, k):
        """Logarithms, linear over the air mass: [time, depth]."""
        masses = 1 / np.cos(np.radians(ZENITHS))
        logs = np.log(self.direct[:, :, k])
        return np.stack([np.interp(1 / np.cos(np.radians(zenith)), masses, logs[:, d]) for d in range(len(DEPTHS))], 1)

    def ratio(self, zenith, depth, k, albedo):
        """Of diffuse to direct normal irradiance over even ground of this albedo."""
        direct, diffuse, spherical = (self.at(v, zenith, k) for v in (self.direct, self.diffuse, self.spherical))
        again = albedo * spherical * (direct + diffuse) / (1 - albedo * spherical)
        every = (diffuse + again) / np.exp(self.direct_at(zenith, k)) * np.cos(np.radians(zenith))[:, None]
        return np.array([np.interp(d, DEPTHS, row) for d, row in zip(depth, every)])


def shaded(day):
    """Times at which the band hides the sun best: where diffuse light at 1624 nm is least beside the direct beam in a period of its steps."""
    ratio = day.diffuse[7] / day.direct[7]
    good = np.zeros(len(ratio), bool)
    half = BAND_PERIOD_S / 7200
    for i in np.flatnonzero(np.isfinite(ratio) & (ratio > 0) & (day.zenith < 82)):
        near = abs(day.hours - day.hours[i]) <= half
        good[i] = ratio[i] <= np.nanpercentile(np.where(ratio[near] > 0, ratio[near], np.nan), 25)
    return good


def langley(day, sky, good, index, filter_number):
    """Calibration (measured over ours at air mass 0), its relative uncertainty, and the scale below.

    The aerosol grew through the morning, which a plain Langley plot takes for calibration. Here its course is that of the diffuse light: the
    depth that ours needs for the measured ratio, times a free scale. So only the course of the ratio enters, not its level. Uncertainty: half the
    difference from the plain plot."""
    use = np.flatnonzero(good & (day.hours < NOON_H) & (day.zenith > JUDGED[0]) & (day.zenith < JUDGED[1]) & np.isfinite(day.diffuse[filter_number] / day.direct[filter_number]))
    if len(use) < 6:
        raise RuntimeError("filter %d: %d times for a Langley plot, 6 are needed" % (filter_number, len(use)))
    zenith = day.zenith[use]
    measured = day.diffuse[filter_number][use] / day.direct[filter_number][use]
    grid = np.stack([sky.ratio(zenith, np.full(len(use), d), index, sky.albedo[filter_number]) for d in DEPTHS], 1)
    course = np.array([np.interp(m, row, DEPTHS) for m, row in zip(measured, grid)])
    clear = sky.direct_at(zenith, index)
    dimmed = (clear[:, 0] - clear[:, -1]) / (DEPTHS[-1] - DEPTHS[0])  # of the logarithm a unit of depth
    logs = np.log(day.direct[filter_number][use] / sky.irradiance[index]) - clear[:, 0] - dimmed * DEPTHS[0]
    design = np.stack([np.ones(len(use)), -dimmed * course], 1)
    found, *_ = np.linalg.lstsq(design, logs, rcond=None)
    steady, *_ = np.linalg.lstsq(np.stack([np.ones(len(use)), -dimmed], 1), logs, rcond=None)
    return float(np.exp(found[0])), float(0.5 * abs(found[0] - steady[0])), float(found[1])


def depths_of(day, sky, times, index, filter_number, calibration):
    """Aerosol depth at 550 nm whose direct beam is the measured one, of every time."""
    logs = sky.direct_at(day.zenith[times], index)
    wanted = np.log(day.direct[filter_number][times] / calibration / sky.irradiance[index])
    slope = (logs[:, -1] - logs[:, 0]) / (DEPTHS[-1] - DEPTHS[0])
    return np.array([np.interp(-w, -row, DEPTHS, DEPTHS[0] + (w - row[0]) / s, DEPTHS[-1]) for w, row, s in zip(wanted, logs, slope)])


def compared(day, sky, times, index, filter_number, calibration):
    """Ours, measured, our relative uncertainty, and the aerosol depth."""
    value, error, _ = calibration
    measured = day.diffuse[filter_number][times] / day.direct[filter_number][times]
    depth = depths_of(day, sky, times, index, filter_number, value)
    deeper = depths_of(day, sky, times, index, filter_number, value * (1 + error))
    ratio = lambda d, albedo: sky.ratio(day.zenith[times], np.clip(d, 0, DEPTHS[-1]), index, albedo)
    albedo = sky.albedo[filter_number]
    ours = ratio(depth, albedo)
    return ours, measured, np.hypot(ratio(depth, 4 / 3 * albedo) - ours, ratio(deeper, albedo) - ours) / ours, depth


def half_day(day, sky, good, calibrations, afternoon):
    """The rows of a half day, and curves for pictures."""
    part = (day.hours >= NOON_H) == afternoon
    inside = part & (day.zenith >= JUDGED[0]) & (day.zenith <= JUDGED[1])
    rows, curves = [], {}
    for what, chosen in (("as measured", inside), ("band on the sun", inside & good)):
        found, cells = [], []
        for index, k in enumerate(FILTERS):
            times = np.flatnonzero(chosen & np.isfinite(day.diffuse[k] / day.direct[k]) & (day.direct[k] > 0.05 * sky.irradiance[index]))
            if len(times) == 0:
                continue
            ours, measured, sigma, depth = compared(day, sky, times, index, k, calibrations[k])
            relative = 100 * (ours / measured - 1)
            found.append((relative, 100 * np.hypot(sigma, READING), depth))
            cells.append("%.0f nm %.1f, %.1f" % (sky.nm[index], np.median(abs(relative)), np.percentile(abs(relative), 90)))
            if what == "as measured":
                curves[k] = (day.hours[times], measured, ours, ours * sigma)
        if found:
            rows.append(row_of(sky, found, cells, what, afternoon))
    return rows, curves


def row_of(sky, found, cells, what, afternoon):
    relative, sigma = (np.concatenate([f[i] for f in found]) for i in (0, 1))
    stats = judged(relative, 0 * relative, sigma)
    return Row("MFRSR", "SGP E11, %s, sun 10-57 deg high, %s" % ("afternoon" if afternoon else "morning", what),
               "%d filters, %.0f-%.0f nm, diffuse over direct" % (len(found), sky.nm[0], sky.nm[len(found) - 1]), "ozone 310 DU, ground of grass, direct beam",
               "calibration of each filter and scale of its aerosol's course (morning), aerosol depth of each time and filter", "%",
               rest="median %.1f %%, 90th percentile %.1f %%" % (np.median(abs(relative)), np.percentile(abs(relative), 90)), held_out=afternoon,
               details={"by_filter": cells, "depth_550": [round(float(np.median(f[2])), 4) for f in found]}, **stats)


def drift(day, sky, good, calibrations):
    """The direct beam with the aerosol of one time, of the morning: ours over measured, percent, at the lowest and the highest sun."""
    cells = []
    for index, k in enumerate(FILTERS):
        times = np.flatnonzero(good & (day.hours < NOON_H) & (day.zenith < JUDGED[1]) & (day.direct[k] > 0))
        middle = times[int(np.argmin(abs(day.zenith[times] - 60)))]
        depth = depths_of(day, sky, np.array([middle]), index, k, calibrations[k][0])[0]
        logs = sky.direct_at(day.zenith[times], index)
        ours = np.exp([np.interp(depth, DEPTHS, row) for row in logs]) * sky.irradiance[index] * calibrations[k][0]
        relative = 100 * (ours / day.direct[k][times] - 1)
        cells.append("%.0f nm %+.1f to %+.1f" % (sky.nm[index], np.percentile(relative, 5), np.percentile(relative, 95)))
    return cells


def medians(context, day, good, name, **changed):
    """Median of ours over measured less 1, percent, of each filter of the morning, the band on the sun, in another sky."""
    sky = Sky(context, day, "mfrsr_" + name, **changed)
    cells = []
    for index, k in enumerate(FILTERS):
        inside = (day.hours < NOON_H) & (day.zenith >= JUDGED[0]) & (day.zenith <= JUDGED[1]) & good
        times = np.flatnonzero(inside & np.isfinite(day.diffuse[k] / day.direct[k]) & (day.direct[k] > 0.05 * sky.irradiance[index]))
        ours, measured, *_ = compared(day, sky, times, index, k, langley(day, sky, good, index, k))
        cells.append("%.0f nm %+.1f" % (sky.nm[index], np.median(100 * (ours / measured - 1))))
    return ", ".join(cells)


def tried(context, day, good):
    """A line for each thing that may stand between ours and the measured ratio, put in by itself with all calibrations made again."""
    rows = [("as it is", "again", {}), ("half the albedo", "dark", {"brighter": 0.5}), ("twice the albedo", "bright", {"brighter": 2.0})]
    rows += [("aerosol `%s`" % m, m, {"model": m}) for m in ("maritime", "free_troposphere", "urban", "desert")]
    return ["Tried, %s: %s %%." % (what, medians(context, day, good, name, **changed)) for what, name, changed in rows]


def run(context):
    day, result = Day(context.data / "mfrsr"), Result()
    sky, good = Sky(context, day), shaded(day)
    calibrations = {k: langley(day, sky, good, index, k) for index, k in enumerate(FILTERS)}
    for afternoon in ([False, True] if context.held_out else [False]):
        rows, curves = half_day(day, sky, good, calibrations, afternoon)
        result.rows += rows
        for k in (1, 5):
            if len(curves.get(k, [[]])[0]) > 2:
                hours, measured, ours, sigma = curves[k]
                result.pictures["mfrsr_filter%d_%s" % (k, "afternoon" if afternoon else "morning")] = spectra(
                    "MFRSR, %.0f nm" % sky.nm[FILTERS.index(k)], "h UTC", "diffuse over direct normal",
                    [("measured", hours, measured, READING * measured), ("ours", hours, ours, sigma)], True)
        for row in rows:
            result.notes.append("%s: median, 90th percentile of the difference in percent: %s." % (row.place, "; ".join(row.details["by_filter"])))
    result.notes.append("Calibration by the Langley plot over the lamp's, and depth by the direct beam over that by the diffuse light: %s. 1624 nm is not calibrated in the file. "
                        "The aerosol is so thin (0.05) that 1 %% of calibration is a sixth of it; calibrations by the plain plot are %s %% lower." %
                        (", ".join("%.0f nm %.3f, %.2f" % (sky.nm[i], calibrations[k][0], calibrations[k][2]) for i, k in enumerate(FILTERS)),
                         ", ".join("%.1f" % (200 * calibrations[k][1]) for k in FILTERS)))
    result.notes.append("Direct beam with the aerosol of one time (sun 30 deg high), 5th to 95th percentile of the morning in percent: %s. The aerosol grew." % "; ".join(drift(day, sky, good, calibrations)))
    result.notes.append("The shadowband moves in steps: every 20 minutes its shade drifts off the sun, direct light falls by 2 %% and that light is counted as diffuse "
                        "(40 %% more at 869 nm). `band on the sun`: the quarter of the times in each %d minutes in which it hides the sun best." % (BAND_PERIOD_S // 60))
    result.notes.append("From 17.4 to 18.4 h the band fails at times: diffuse light holds the sun. The data set's quality file names those times for one filter "
                        "(672 nm); they stand in all figures here.")
    if len(day.hours) > 1000:  # the whole day, not the extract
        result.notes += tried(context, day, good)
    return result

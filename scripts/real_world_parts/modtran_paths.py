"""Transmittance and radiance along the MODTRAN 5.2.1 paths of pybsm, drawn by a seed: what tests/bench/air_paths does for its limits, here by
window with medians, rms and 95th percentile, the worst ten, and sunlight for every path drawn. A second seed is kept apart."""
import sys
from pathlib import Path

import numpy as np

from .air import Table
from .results import Result, Row, judged

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests/bench/air_paths"))

SEED, SECOND_SEED = 55, 56
SUNLIT = [(0.42, 0.5), (0.5, 0.6), (0.6, 0.68)]
# What limits the builtin gases (libs/air/lowtran_limits.cpp).
CAUSES = [(1.1, 1.35, "water, oxygen"), (2.0, 2.4, "methane, water"), (2.9, 3.4, "water"),
          (3.4, 4.15, "weak lines of water"), (4.15, 4.6, "carbon dioxide"), (4.6, 5.3, "water, ozone"), (5.3, 7.2, "water"), (7.2, 8.2, "water, methane"),
          (8.2, 9.3, "water"), (9.3, 10.15, "ozone"), (10.15, 12.4, "water's continuum, aerosol"), (12.4, 14.0, "carbon dioxide")]


def cause(um):
    return next((name for low, high, name in CAUSES if low <= um <= high), "band model of 20 cm-1")


def spread(errors):
    """Median, rms and 95th percentile of the absolute errors."""
    size = abs(np.asarray(errors)).ravel()
    return float(np.median(size)), float(np.sqrt((size**2).mean())), float(np.percentile(size, 95))


def windows_of(tools, ours, theirs):
    """Of every window: edges, errors of transmittance [path, piece], and of brightness (K) beyond 2.5 um."""
    um = ours[0, :, 0]
    t, s = tools.smooth(ours[:, :, 1]), tools.smooth(ours[:, :, 2])
    found = []
    for low, high in tools.WINDOWS:
        means = tools.Window(um, low, high)
        transmittance = means(t) - means(theirs[:, :, 0])
        kelvin = None
        if low > 2.5:
            middle = means(np.tile(um, (len(ours), 1)))
            seen = lambda radiance, through: tools.brightness(middle, means(radiance + through * tools.planck(um, 299)))
            kelvin = seen(s, t) - seen(1e4 * theirs[:, :, 1], theirs[:, :, 0])
        found.append((low, high, transmittance, kelvin))
    return found


def thermal_rows(tools, chosen, windows, limits, second):
    down = np.array([r[2] == 0 for r in chosen])
    lines, exceeded, everything = [], [], {"transmittance": [], "K": []}
    for low, high, transmittance, kelvin in windows:
        limit = tools.limit_of(limits, low, high)
        text = "| %.2f-%.2f | %.3f, %.3f, %.3f | %s |" % (low, high, *spread(transmittance), "%.2g" % limit[1] if limit[0] else "")
        everything["transmittance"].append(transmittance.ravel())
        if limit[0] and abs(transmittance).max() > 1.06 * limit[1]:
            exceeded.append("transmittance %.2f-%.2f um" % (low, high))
        if kelvin is not None:
            everything["K"].append(kelvin.ravel())
            for which, k, name in ((down, 2, "down"), (~down, 4, "slanted")):
                if which.any() and limit[k + 1] and abs(kelvin[which]).max() > 1.06 * limit[k + 1]:
                    exceeded.append("brightness %.2f-%.2f um, %s" % (low, high, name))
            text += " %.2f, %.2f, %.2f | %s |" % (*spread(kelvin), "%.2g" % max(limit[3], limit[5]) if limit[2] else "")
        else:
            text += " | |"
        lines.append(text)
    rows = []
    for quantity, errors in everything.items():
        errors = np.concatenate(errors)
        rows.append(Row("MODTRAN 5.2.1 (no instrument)", "%d paths of pybsm, seed %d" % (len(chosen), SECOND_SEED if second else SEED),
                        "0.4-14 um" if quantity == "transmittance" else "2.9-14 um, over a target of 299 K", "midlatitude summer, rural 23 and 5 km, geometry", "",
                        "" if quantity == "transmittance" else "K", rest="median %.3g, 95th percentile %.3g; beyond what runs report: %s" % (
                            spread(errors)[0], spread(errors)[2], ", ".join(x for x in exceeded if x.startswith("transm" if quantity == "transmittance" else "bright")) or "none"),
                        held_out=second, details={"exceeded": exceeded}, **judged(errors, 0 * errors)))
    return rows, lines


def worst_ten(chosen, windows):
    """The largest error of transmittance of each path, the ten worst."""
    best = []
    for low, high, transmittance, _ in windows:
        for path, row in enumerate(transmittance):
            best.append((float(abs(row).max()), float(row[np.argmax(abs(row))]), low, high, path))
    seen, lines = set(), []
    for _, error, low, high, path in sorted(best, reverse=True):
        if path in seen or len(lines) == 10:
            continue
        seen.add(path)
        r = chosen[path]
        lines.append("| %g km, %g km along the ground, %d km | %.2f-%.2f | %+.3f | %s |" % (r[1], r[2], {1: 23, 2: 5}[r[3]], low, high, error, cause(0.5 * (low + high))))
    return lines


def sunlit(tools, paths, chosen, second):
    ours, theirs = paths.ours(chosen, ["--sun"]), paths.theirs(chosen)
    um, fine = ours[0, :, 0], np.linspace(0.3, 14, theirs.shape[1])
    lines, plain, averaged = [], [], []
    for low, high in SUNLIT:
        a, b = (um > low) & (um < high), (fine > low) & (fine < high)
        of = 1e4 * theirs[:, b, 3].mean(1)
        ratios = [ours[:, a, k].mean(1) / of - 1 for k in (1, 2)]
        plain.append(ratios[0])
        averaged.append(ratios[1])
        lines.append("| %.2f-%.2f | %s | %s |" % (low, high, *("%+.1f; %.1f, %.1f, %.1f" % (100 * np.median(x), *(100 * y for y in spread(x))) for x in ratios)))
    plain, averaged = 100 * np.concatenate(plain), 100 * np.concatenate(averaged)
    row = Row("MODTRAN 5.2.1 (no instrument)", "%d paths of pybsm, seed %d" % (len(chosen), SECOND_SEED if second else SEED), "0.42-0.68 um, sunlight scattered into the path",
              "the same, sun 50 deg from the zenith", "", "%", rest="median %.1f %%, 95th percentile %.1f %%; with ours averaged over azimuths as its runs are: median %.1f %%, 95th %.1f %%" % (
                  spread(plain)[0], spread(plain)[2], spread(averaged)[0], spread(averaged)[2]), held_out=second, **judged(plain, 0 * plain))
    return row, lines


def kilometre(context, tools, paths):
    """Transmittance straight down one kilometre at 2.10 to 2.12 um, ours, LOWTRAN 7's and MODTRAN's; nothing where the package has no such path."""
    rows = [r for r in paths.rows if (r[1], r[2], r[3]) == (1, 0, 1)][:1]
    if not rows:
        return []
    ours, theirs = paths.ours(rows)[0], paths.theirs(rows)[0]
    mean = lambda um, values: float(values[(um > 2.099) & (um < 2.121)].mean())
    lowtran = Table(context, "modtran_kilometre", "profile: midlatitude_summer, aerosol: {model: rural, visibility_km: 23}, gases: lowtran",
                    "{name: b0, center_um: 2.11, fwhm_um: 0.03, shape: rectangular}",
                    "surface_elevation_km: 0\nobserver_altitude_km: 1\nsolar_zenith: 50\ncheck: false\n", ())["transm_up_dir"]
    return ["Straight down 1 km, visibility 23 km, 2.10 to 2.12 um: transmittance of ours %.3f, of LOWTRAN 7 (`gases: lowtran`) %.3f, of MODTRAN 5.2.1 %.3f." % (
        mean(ours[:, 0], tools.smooth(ours[None, :, 1])[0]), float(np.ravel(lowtran)[0]), mean(np.linspace(0.3, 14, len(theirs)), theirs[:, 0]))]


def run(context):
    import paths as tools  # of tests/bench/air_paths
    result = Result()
    paths = tools.Paths(context.build, None)
    limits = paths.reported()
    for second in ([False, True] if context.held_out else [False]):
        chosen, _ = tools.drawn(paths, context.paths, SECOND_SEED if second else SEED)
        windows = windows_of(tools, paths.ours(chosen), paths.theirs(chosen))
        rows, lines = thermal_rows(tools, chosen, windows, limits, second)
        row, sun_lines = sunlit(tools, paths, chosen, second)
        result.rows += rows + [row]
        if second:
            continue
        result.notes.append("Each cell: median, rms, 95th percentile of the absolute differences from MODTRAN 5.2.1; beside it the largest that a run reports.\n\n"
                            "| um | transmittance | reported | K | reported |\n|---|---|---|---|---|\n" + "\n".join(lines) + "\n")
        result.notes.append("Sunlight, ours less MODTRAN's in percent: median; median, rms, 95th percentile of its size; as it is, and with ours averaged over azimuths, as "
                            "its runs have it (DISAZM is not set in card 1A).\n\n| um | as it is | averaged |\n|---|---|---|\n" + "\n".join(sun_lines) + "\n")
        result.notes.append("The ten paths with the largest error of transmittance.\n\n| from, along the ground, visibility | um | ours less MODTRAN's | cause |\n|---|---|---|---|\n"
                            + "\n".join(worst_ten(chosen, windows)) + "\n")
    result.notes += kilometre(context, tools, paths)
    result.notes.append("Light that the ground reflects is not compared: the package's runs stand over a ground of its own.")
    return result

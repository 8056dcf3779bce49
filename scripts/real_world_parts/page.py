"""The page docs/validation/real_world.md, and rows.json beside its pictures, from the results of every data set."""
import dataclasses
import json
import math

HEAD = """# Real instruments

Ours beside what instruments measured, in one command; `--help` says what FOLDER holds. It took %(seconds)s beside other work.

    scripts/real_world                                                       # the extract that ships
    scripts/real_world --data FOLDER --continuum FILE --held-out --page      # this page

- Bias and rms: ours less the instrument's. Share: values within two standard deviations, of the stated uncertainty and ours in quadrature.
- Fitted: every number that was adjusted to the data. Nothing else was.
- Chosen after looking at residuals: the way of calibrating the MFRSR (on the morning) and the window of HyTES's fit. The MFRSR's calibration takes the
  course of its aerosol from the diffuse light, so its two lights are not independent: only the level of their ratio is tested.
- *Held out*: not looked at while the code was written, but run more than once: with the gases of LOWTRAN 7 before, and two or three times with those of now.
- Ours: spread of the given aerosol, the gas model's error ([ACCURACY.md](../../libs/air/ACCURACY.md)), scalar scattering in the blue ([air_lut](../../formats/air_lut/FORMAT.md)).
- The laws of the builtin gases are fitted to RRTMGP (scripts/bake_bands) and to nothing here; which bands take them was chosen by lines and REPTRAN, with 60
  of MODTRAN's paths in view.
- Gases: builtin, but where a water continuum is named. What LOWTRAN 7's own laws and continuum of 1988 (`gases: lowtran`, builtin before) leave stands in the
  sections of Pasadena and HyTES. Along the paths of MODTRAN they left 0.0299 and 2.62 K rms, both seeds: an earlier run, which the command does not repeat.

| instrument | place | bands | given | fitted | bias | rms | share | what explains the rest |
|---|---|---|---|---|---|---|---|---|
"""


PROMISED = 95  # percent of values within two standard deviations
TITLES = {"pasadena": "AVIRIS-NG over Pasadena", "mfrsr": "Shadowband radiometer", "hytes": "HyTES over water", "surface": "Irradiance at the ground", "modtran_paths": "Paths of MODTRAN"}


def row_text(row):
    share = "" if math.isnan(row.share) else "%.0f %%" % (100 * row.share)
    place = row.place + (" (*held out*)" if row.held_out else "")
    return "| %s | %s | %s | %s | %s | %s | %s | %s | %s |\n" % (
        row.data, place, row.bands, row.given, row.fitted or "nothing", "%+.3g %s" % (row.bias, row.unit), "%.3g %s" % (row.rms, row.unit), share, row.rest)


def short_of_share(rows):
    """Instruments with rows whose share is below what two standard deviations promise; nothing where there are none."""
    cells = []
    for data in dict.fromkeys(r.data for r in rows):
        known = [100 * r.share for r in rows if r.data == data and not math.isnan(r.share)]
        short = [x for x in known if x < PROMISED]
        if short:
            cells.append("%s %s (%d of %d rows)" % (data, " to ".join(dict.fromkeys("%.0f %%" % x for x in (min(short), max(short)))), len(short), len(known)))
    return "\nShares short of the %d %% of two standard deviations, so that a stated uncertainty is too small or something is missing: %s.\n" % (PROMISED, "; ".join(cells)) if cells else ""


def markdown(results):
    seconds = ", ".join("%s %.0f s" % (name, r.seconds) for name, r in results.items())
    text = HEAD % {"seconds": seconds}
    text += "".join(row_text(row) for result in results.values() for row in result.rows)
    text += short_of_share([row for result in results.values() for row in result.rows])
    for name, result in results.items():
        text += "\n## %s\n\n" % TITLES[name]
        text += "".join("- %s\n" % note for note in result.notes)
        text += "".join("\n![%s](../pictures/real_world/%s.svg)\n" % (p.replace("_", " "), p) for p in result.pictures)
    return text


def as_json(results):
    rows = {name: [dataclasses.asdict(row) for row in result.rows] for name, result in results.items()}
    clean = lambda x: None if isinstance(x, float) and math.isnan(x) else x
    return json.dumps({n: [{k: clean(v) for k, v in row.items()} for row in many] for n, many in rows.items()}, indent=1) + "\n"


def write(results, out):
    out.mkdir(parents=True, exist_ok=True)
    (out / "real_world.md").write_text(markdown(results))
    (out / "rows.json").write_text(as_json(results))
    for result in results.values():
        for name, svg in result.pictures.items():
            (out / (name + ".svg")).write_text(svg)

"""The page of data that ship, from the sources and NOTICE: python3 scripts/docs_parts/shipped.py > docs/guide/shipped_data.md"""
import fnmatch
import os
import re
import sys

PAGE = "docs/guide/shipped_data.md"
HEAD = """# What ships with it

Which spectra, atmospheres, suns, skies and surface models come with the suite, what they are called, and whose they are.

Example: a profile, an aerosol and a lamp by their names.

```yaml
atmosphere: {profile: midlatitude_summer, aerosol: {model: rural, visibility_km: 23}}
lamps: [{kind: point, name: street, position_m: [0, 0, 6], intensity: {lamp: led_3000, scale: 30}}]
```

Names are read from the sources, origin and licence from `NOTICE` (`scripts/docs --check` compares).

## Tables inside the programs

| what | asked for by | names | origin | licence |
|---|---|---|---|---|
"""
MODELS = """
## Models

Surface models, phase functions, kinds of light and detectors are formulas with their papers. The programs list all of them:

| what | command | page |
|---|---|---|
| surface models | `scene-prep --list-models` | [materials and media](materials.md) |
| phase functions | `scene-prep --list-phases` | [materials and media](materials.md) |
| temperature models | `scene-prep --list-temperatures` | [temperatures](temperatures.md) |
| suns, skies, lamps | `dirsig-render --list-sources` | [sun, sky, lamps](sources.md) |
| detectors of images | `dirsig-render --list-image-detectors` | [low-light detectors](low_light_detectors.md) |
| laser radars by public numbers | `dirsig-render --lidar-presets` | [laser radar](laser_radar.md) |

## Spectra of materials

No library of measured reflectances ships. Curves of the samples (grass, soil, asphalt, rock) are invented, for pictures. What is read:

| library | key | grammar |
|---|---|---|
| ECOSTRESS `.spectrum.txt`, ENVI `.sli`, DIRSIG `.ems`, tables | `reflectance: FILE` | [curves](../../formats/curve/FORMAT.md) |
| measured BRDFs (MERL, RGL, Cornell) | `model: sqt` | [measured BRDFs](measured_brdfs.md) |
| gas tables (REPTRAN, HITRAN line lists) | `gases: FILE` | [atmosphere](atmosphere.md) |
| weather (EPW, CSV) | `weather: FILE` | [temperatures](temperatures.md) |

## Data of the sample scenes

| file | origin | licence |
|---|---|---|
"""
# What; key; where its names stand (a file and what encloses them), or the names; a table that NOTICE names, or the origin and the licence.
ROWS = (
    ("atmospheres (AFGL 1986)", "`atmosphere: {profile: NAME}`", ("libs/air/profile.cpp", r"kProfiles\[\] = \{(.*?)\};"), "libs/air/afgl_table.inc"),
    ("gas absorption, 20 1/cm", "`gases: builtin`, `gases: lowtran`", "band functions of LOWTRAN 7 (`builtin`: with laws of libs/air/bands_table.inc)", "libs/air/lowtran_table.inc"),
    ("aerosols", "`aerosol: {model: NAME}`", ("libs/air/particle_tables.cpp", r"kAerosolNames\[\] = \{(.*?)\};"), "libs/air/tables/aerosols.inc"),
    ("desert aerosol", "`aerosol: {model: desert}`", "desert", "libs/air/tables/desert.inc"),
    ("clouds of water", "`clouds: [{kind: water}]`", "radius 2 to 32 um", "libs/air/tables/water_bulk.inc"),
    ("clouds of ice", "`clouds: [{kind: ice}]`", "radius 5 to 60 um", "libs/air/tables/ice.inc"),
    ("sun above the air", "`sun`, without `irradiance`", "TSIS-1", "libs/light/kinds/solar_table.inc"),
    ("clear sky", "`sky: {kind: clear}`", "Bird & Riordan 1984, Perez 1993", ("tables of the two papers", "published values")),
    ("moon", "`moon`", "ROLO", ("coefficients of Kieffer & Stone 2005", "published values")),
    ("stars", "`night_sky: {catalogue: builtin}`", "9096 stars", "libs/light/night/stars.inc"),
    ("zodiacal light", "`night_sky`", "zodiacal", "libs/light/night/zodiacal.inc"),
    ("airglow of OH", "`night_sky`", "airglow", "libs/light/night/airglow_oh.inc"),
    ("pure water", "`water` of a medium", "index and absorption, 0.2 to 200 um", "libs/water/tables/segelstein.inc"),
    ("lamps", "`{lamp: NAME}` as a curve", ("libs/spectral/lamp_spectra.cpp", r"all\{(.*?)\};\n  return"),
     ("sums of Gaussian lines and bands made for the suite, with the colour of their kind", "as the sources")),
)
LICENCES = (("CC0", r"CC0"), ("Apache 2.0", r"Apache License"), ("MPL 2.0", r"Mozilla Public License"), ("BSD 3-Clause", r"BSD.3-Clause"), ("MIT", r"MIT License"),
            ("public data", r"[Pp]ublic domain|public data|Published values|tables of published models|distributed by the Astronomical Data Center"))


def notices(root):
    """The entries of NOTICE, each as one line."""
    with open(os.path.join(root, "NOTICE")) as f:
        text = f.read()
    return [" ".join(entry.split("\n\n")[0].split()) for entry in re.split(r"^- ", text, flags=re.M)[1:]]


def patterns(entry):
    """The files that an entry begins with: names without a folder lie in that of the one before."""
    found, folder = [], ""
    for name in re.findall(r"[\w*./-]*\w", re.split(r": | \(|;", entry)[0]):
        if "/" in name:
            folder = os.path.dirname(name)
            found.append(name)
        elif "." in name:
            found.append(f"{folder}/{name}")
    return found


def entry_of(root, path):
    """What NOTICE says of a file, by the first entry that names its licence; '' where it says nothing."""
    found = [e for e in notices(root) if any(fnmatch.fnmatch(path, p) for p in patterns(e)) or re.search(rf"\b{re.escape(os.path.basename(path))}", e)]
    return next((e for e in found if said(e)[1]), found[0] if found else "")


def said(entry):
    """Origin and licence out of an entry of NOTICE."""
    licence = next((name for name, words in LICENCES if re.search(words, entry)), "")
    origin = re.sub(r"^[^:(]*(?:: | \()", "", entry)
    origin = re.split(r"(?: MIT License, reproduced|\. Apache License|\. CC0|; public data|\.? BSD 3-Clause|, BSD-3-Clause|\. Published values|\. Public domain| The tables of published|\), tests/)", origin)[0]
    return origin.rstrip(".; ").replace("|", "\\|"), licence


def names(root, where):
    if isinstance(where, str):
        return where
    with open(os.path.join(root, where[0])) as f:
        found = re.search(where[1], f.read(), re.S)
    return ", ".join(f"`{name}`" for name in re.findall(r'"(\w+)"', found[1])) if found else ""


def page(root):
    out = [HEAD]
    for what, key, where, source in ROWS:
        origin, licence = said(entry_of(root, source)) if isinstance(source, str) else source
        out.append(f"| {what} | {key} | {names(root, where)} | {origin} | {licence} |\n")
    out.append(MODELS)
    for entry in notices(root):
        files = [name for name in patterns(entry) if name.startswith("sample_scenes/")]
        if files:
            origin, licence = said(entry)
            out.append(f"| {', '.join(f'`{name}`' for name in files)} | {origin} | {licence} |\n")
    return "".join(out)


def differs(root):
    """Faults: the stored page is another, a row lacks something, or NOTICE says nothing of a table."""
    text = page(root)
    faults = [f"{PAGE}: a cell of '{row.split('|')[1].strip()}' is empty; NOTICE or the sources lack it" for row in re.findall(r"^\|.*\|$", text, re.M)
              if any(not cell.strip() for cell in row.split("|")[1:-1])]
    for folder, _, files in os.walk(os.path.join(root, "libs")):
        for name in files:
            path = os.path.relpath(os.path.join(folder, name), root)
            if name.endswith(".inc") and not entry_of(root, path):
                faults.append(f"NOTICE: says nothing of {path}")
    with open(os.path.join(root, PAGE)) as f:
        if f.read() != text:
            faults.append(f"{PAGE}: is not what NOTICE and the sources say; rewrite it: {__doc__.split(': ', 1)[1]}")
    return faults


if __name__ == "__main__":
    sys.stdout.write(page("."))

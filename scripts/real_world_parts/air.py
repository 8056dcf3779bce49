"""Tables for atmospheric correction (`dirsig-render --air-lut`) as arrays, and what sensors see through them.

Radiance in uW/(cm2 sr nm), wavelengths in nm, as in the tables."""
import csv
import subprocess

import numpy as np

C1, C2 = 1.191042972e8, 14387.76877  # W um4/(m2 sr), um K
AXES = ["H2OSTR", "AOT550", "O3", "surface_elevation_km", "observer_altitude_km", "observer_zenith", "solar_zenith", "relative_azimuth"]
# Errors of the builtin gases: rms of transmittance (libs/air/ACCURACY.md).
GAS_ERRORS = [(0.4, 1.1, 0.012), (1.1, 1.35, 0.025), (1.35, 2.0, 0.013), (2.0, 2.4, 0.023), (2.4, 2.9, 0.012), (3.4, 4.15, 0.055), (4.6, 5.3, 0.015),
              (7.2, 8.2, 0.019), (8.2, 9.3, 0.017), (9.3, 10.15, 0.026), (10.15, 12.4, 0.011), (12.4, 14.0, 0.012)]


def gas_error(nm):
    """Standard deviation of transmittance by the gas model; 0 where ACCURACY.md has none."""
    um = np.asarray(nm) / 1e3
    return sum(np.where((um >= low) & (um < high), error, 0.0) for low, high, error in GAS_ERRORS)


def planck(um, kelvin):
    """W/(m2 sr um)."""
    return C1 / um**5 / np.expm1(C2 / (um * kelvin))


def brightness(um, radiance):
    """Kelvin of a radiance in W/(m2 sr um)."""
    return C2 / (um * np.log1p(C1 / (um**5 * radiance)))


def gaussian_bands(centers_nm, fwhm_nm):
    return ", ".join("{name: b%d, center_um: %.8g, fwhm_um: %.8g}" % (i, c / 1e3, w / 1e3) for i, (c, w) in enumerate(zip(centers_nm, fwhm_nm)))


class Table:
    """The quantities of a table by name, over its axes and the bands: [axis, ..., band]. Axes of one value are dropped, but for the sun's."""

    def __init__(self, context, name, atmosphere, bands, grid, whole=("solar_zenith",)):
        """atmosphere, bands: texts as in a simulation; grid: text of the grid without its first line. whole: axes that stay when they have one value."""
        folder = context.work / name
        folder.mkdir(parents=True, exist_ok=True)
        text = ("scene: none.h5\natmosphere: {%s}\nsun: {direction: {zenith_deg: 30, azimuth_deg: 0}}\nsensors:\n  - {name: eye, kind: frame_camera, "
                "columns: 1, rows: 1, pitch_um: 10, focal_length_mm: 100, position_m: [0, 0, 1000], look_at_m: [0, 0, 0], up: [0, 1, 0], bands: [%s]}\n"
                % (atmosphere, bands))
        (folder / "sim.yaml").write_text(text)
        (folder / "grid.yaml").write_text("air_lut: 1\n" + grid)
        done = subprocess.run([str(context.program), "sim.yaml", "--air-lut", "grid.yaml", "-o", ".", "-q"], cwd=folder, capture_output=True, text=True)
        if done.returncode:
            raise RuntimeError("the table %s was not made:\n%s" % (name, done.stdout + done.stderr))
        with open(folder / "air_lut.csv") as file:
            rows = list(csv.reader(file))
        head = [title.split(" (")[0] for title in rows[0]]
        values = np.array(rows[1:], dtype=float)
        column = dict(zip(head, values.T))
        self.axes = {axis: np.unique(column[axis]) for axis in AXES}
        self.nm = column["wl"][: self._bands(column)]
        kept = [len(v) for axis, v in self.axes.items() if len(v) > 1 or axis in whole]
        shape = kept + [len(self.nm)]
        self.values = {key: column[key].reshape(shape) for key in head if key not in AXES and key != "wl"}

    def _bands(self, column):
        states = np.prod([len(v) for v in self.axes.values()])
        return len(column["wl"]) // int(states)

    def __getitem__(self, key):
        return self.values[key]

    def up(self):
        return self["transm_up_dir"] + self["transm_up_dif"]

    def two_way(self):
        return self["dir-dir"] + self["dif-dir"] + self["dir-dif"] + self["dif-dif"]


def reflected(table, reflectance, zenith_deg, distance_au):
    """Radiance over an even Lambert ground, of every state; formats/air_lut."""
    sun = table["solar_irr"] * np.cos(np.radians(zenith_deg)) / np.pi / distance_au**2
    return sun * (table["rhoatm"] + table.two_way() * reflectance / (1 - table["sphalb"] * reflectance))


def along(values, axis, at):
    """Linear between the values of the first axis; at: one value, or one a band."""
    at = np.clip(np.broadcast_to(at, values.shape[1:]), axis[0], axis[-1])
    k = np.clip(np.searchsorted(axis, at, side="right") - 1, 0, len(axis) - 2)
    share = (at - axis[k]) / (axis[k + 1] - axis[k])
    pick = lambda i: np.take_along_axis(values, i[None], 0)[0]
    return pick(k) * (1 - share) + pick(k + 1) * share

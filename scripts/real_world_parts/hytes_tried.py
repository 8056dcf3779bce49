"""What may stand between HyTES's spectrum and ours: each hypothesis put in by itself, water column and temperature fitted again, and the rms that is left.

None of it enters the rows. Bands of CFC-11 and CFC-12 are Gaussians of rough strengths: an estimate of the size of what our gases lack."""
import copy

import numpy as np

from .air import brightness, planck
from .hytes import FITTED, Water
from .pasadena import within

# cm-1, cm-1 (standard deviation), cm/molecule, ppt: rough, of the strongest bands within 8 to 12 um.
HALOCARBONS = [(847, 9, 6e-17, 228), (1085, 9, 2.5e-17, 228), (922, 12, 8e-17, 505), (1101, 12, 4e-17, 505), (1161, 12, 2.5e-17, 505)]
MOLECULES_CM2 = 2.12e25 * 884 / 1013.25  # of air above the lake


def left(water, kelvin=None):
    """Fitted state and rms in K over the windows of the fit; kelvin: a spectrum in place of the measured one."""
    other = copy.copy(water)
    other.kelvin = water.kelvin if kelvin is None else kelvin
    state = other.fit(FITTED)
    at = within(1e3 * water.um, FITTED)
    off = (other.seen(*state)[0] - other.kelvin)[at]
    return state, float(np.sqrt((off**2).mean()))


def best(values, spectrum, water):
    """The value of the least rms, what it leaves and its state."""
    found = [(left(water, spectrum(v)), v) for v in values]
    (state, rms), value = min(found, key=lambda f: f[0][1])
    return value, rms, state


class WithHalocarbons(Water):
    """The same air dimmed by CFC-11 and CFC-12, which shine at 255 K, the mean over a well mixed column."""

    def seen(self, water, kelvin):
        bright, up = super().seen(water, kelvin)
        wave = 1e4 / self.um
        depth = sum(s * 1e-12 * ppt * MOLECULES_CM2 * np.exp(-0.5 * ((wave - c) / w) ** 2) / (w * np.sqrt(2 * np.pi)) for c, w, s, ppt in HALOCARBONS)
        clear = np.exp(-depth)
        return brightness(self.um, planck(self.um, bright) * clear + planck(self.um, 255.0) * (1 - clear)), up * clear


def notes(context, water):
    """A line for each hypothesis; water: that of the rows."""
    radiance = planck(water.um, water.kelvin)
    lines, rms_of = [], {}

    def said(what, found):
        rms_of[what.removeprefix("Tried, ")] = found[1]
        lines.append("%s: %.2f K rms (water %.2f g/cm2, %.2f K)." % (what, found[1], *found[0]))

    said("Tried, as it is", left(water))
    # Hardly anything scatters here: four streams do for what needs a table of its own, and the first row shows it.
    value, rms, state = best(np.arange(-0.6, 0.61, 0.05), lambda v: brightness(water.um, radiance + v), water)
    said("Tried, an offset of the extract of %+.2f W/(m2 sr um), fitted" % value, (state, rms))
    value, rms, state = best(np.arange(0.9, 1.101, 0.01), lambda v: brightness(water.um, radiance * v), water)
    said("Tried, a gain of %.2f, fitted" % value, (state, rms))
    rougher = copy.copy(water)
    rougher.emissivity = water.emissivity - 0.01
    said("Tried, emissivity lower by 0.01 (waves, foam or a film)", left(rougher))
    halocarbons = copy.copy(water)
    halocarbons.__class__ = WithHalocarbons
    said("Tried, CFC-11 and CFC-12 (rough bands)", left(halocarbons))
    for what, keys in (("four streams in place of 16", {}), ("LOWTRAN 7's gases", {"air": {"gases": "lowtran"}}), ("ozone 200 DU", {"air": {"ozone_du": "200"}}), ("carbon dioxide 450 ppm, as its MODTRAN input has it", {"air": {"ppm": "{co2: 450}"}}),
                       ("no aerosol", {"air": {"aerosol": None}}), ("bands half as wide again", {"wider": 1.5}), ("bands 10 nm further on", {"shift_nm": 10.0}),
                       ("air 3 K colder", {"warmer": -3.0}), ("air 3 K warmer", {"warmer": 3.0})):
        said("Tried, " + what, left(Water(context, "hytes_tried_" + "".join(c for c in what if c.isalnum()), streams=4, **keys)))
    best_what = min(rms_of, key=rms_of.get)
    lines.append("Bands as measured, 0.5 K wanted: none of these comes there by itself; the best is %s (%.2f K)." % (best_what, rms_of[best_what]))
    return lines

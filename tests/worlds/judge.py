"""Does sum of coefficient x picture = what is expected hold? Student's t from the errors that renders report, then from seeds alone.

Every world is screened with one run a term and the standard errors that it reports: the picture's mean and each pixel of
every sensor and band, Bonferroni over them, SCREEN. Terms have the same seed, so that paths which are the same in two of them
have the same noise: the picture's mean is also judged by the spread of the differences of its pixels. What is below that is run again with other seeds and more paths, and judged
by the spread between the seeds alone (a right mean with a wrong error bar is then no failure): RETEST, and at last FINAL,
which only counts. A failure needs all three. Since each world is judged in the end by a test of its own
at FINAL, N worlds give a false alarm with a chance of N x FINAL at most, if means of so many seeds are normal: 0.5 % for 5,000.
"""
import math
import os
import sys
from dataclasses import dataclass

sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), "../golden"))
from comparison import quantile, two_sided  # noqa: E402

SCREEN, RETEST, FINAL = 1e-2, 1e-3, 1e-6
RETEST_SEEDS, RETEST_PATHS = 8, 4     # so many seeds of so many times the paths
FINAL_SEEDS, FINAL_PATHS = 16, 16
MEANS = 0.5                           # share of a bound that goes to pictures' means; the rest to their pixels
LEAST_PIXELS = 9                      # of a picture whose mean is judged by the spread of its pixels as well
TOLERANCE = 1e-4                      # of the radiance: tables, float32 and bins of wavelength (spectral_error 1e-5)
QUANTILES = {}


def critical(p, degrees):
    key = (p, round(degrees, 1))
    if key not in QUANTILES:
        QUANTILES[key] = quantile(*key)
    return QUANTILES[key]


@dataclass
class Finding:
    """The least probable among the tests of a world; size is the relative difference there."""
    p: float = 1.0
    where: str = ""
    size: float = 0.0
    sign: int = 0
    seen: float = 0.0      # relative difference of a picture's mean that screening sees with a chance of 90 %; the quietest picture's
    score: float = 0.0     # z of the quietest picture's mean
    pictures: int = 1

    def consider(self, difference, variance, degrees, scale, where, share):
        """share: of the bound of its picture that this test has (Bonferroni)."""
        if not math.isfinite(difference):
            self.p, self.where, self.size, self.sign = 0.0, where + " not a number", math.inf, 1
            return
        sigma = math.sqrt(variance)
        if difference == 0:
            return
        p = two_sided(abs(difference) / sigma, degrees) / share if sigma > 0 else 0.0
        if p < self.p:
            self.p, self.where, self.sign = p, where, 1 if difference > 0 else -1
            self.size = difference / scale if scale > 0 else math.inf

    def closed(self):
        self.p = min(1.0, self.p * self.pictures)
        return self


def satterthwaite(parts):
    """parts: (variance, degrees). -> variance, degrees of the sum."""
    total = sum(v for v, _ in parts)
    below = sum(v * v / d for v, d in parts)
    return total, min(total * total / below, 1000.0) if below > 0 else 1000.0


def expected_of(case, name, band, pixel):
    return case.expected[name][band][pixel] if case.expected is not None else 0.0


def known_pixels(case, name, band, n):
    """Pixels of which it is known what is right: all but those that are to be 'not a number'."""
    return [i for i in range(n) if not math.isnan(expected_of(case, name, band, i))]


def mean_tests(found, label, differences, parts, floor, size, quietest):
    """Of a picture's mean: by the reported errors, and by the spread of its pixels, which is less where terms share their noise."""
    n, total = len(differences), sum(differences)
    variance, degrees = satterthwaite(parts)
    ways = [(variance, degrees, "mean")]
    if n >= LEAST_PIXELS:
        ways.append((sum((d - total / n) ** 2 for d in differences) * n / (n - 1), n - 1, "mean by its pixels"))
    for variance, degrees, how in ways:
        sigma2 = variance + floor ** 2
        found.consider(total, sigma2, degrees, size, f"{label} {how}", MEANS / len(ways))
        if size > 0:
            seen = (critical(SCREEN * MEANS / len(ways) / found.pictures, max(degrees, 2)) + 1.3) * math.sqrt(sigma2) / size
            if seen < quietest:
                quietest, found.seen, found.score = seen, seen, total / math.sqrt(sigma2) if sigma2 > 0 else 0.0
    return quietest


def screen(case, pictures):
    """pictures: one {sensor: Picture} a term, in the terms' order, under the names of the first."""
    found, quietest = Finding(), math.inf
    found.pictures = sum(len(p.values) for p in pictures[0].values())
    for name, first in pictures[0].items():
        for band in range(len(first.values)):
            kept = known_pixels(case, name, band, len(first.values[band]))
            differences, parts, size = [], [], 0.0
            for i in kept:
                difference, scale, pixel = -expected_of(case, name, band, i), max(abs(expected_of(case, name, band, i)), case.floor), []
                for (coefficient, *_), seen in zip(case.terms, pictures):
                    p = seen[name]
                    difference += coefficient * p.values[band][i]
                    scale = max(scale, abs(p.values[band][i]))
                    pixel.append(((coefficient * p.errors[band][i]) ** 2, p.degrees))
                parts += pixel
                variance, degrees = satterthwaite(pixel)
                differences.append(difference)
                size += scale
                found.consider(difference, variance + (case.tolerance * scale) ** 2, degrees, scale, f"{name} band {band} pixel {i}", (1 - MEANS) / len(kept))
            quietest = mean_tests(found, f"{name} band {band}", differences, parts, case.tolerance * size, size, quietest)
    return found.closed()


def by_seeds(case, runs):
    """runs: one list a seed of what screen() is given. Student's t of the seeds' differences."""
    found = Finding()
    found.pictures = sum(len(p.values) for p in runs[0][0].values())
    for name, first in runs[0][0].items():
        for band in range(len(first.values)):
            kept = known_pixels(case, name, band, len(first.values[band]))
            n, differences, sizes = len(kept), [], []
            for pictures in runs:
                row = [sum(c * seen[name].values[band][i] for (c, *_), seen in zip(case.terms, pictures)) - expected_of(case, name, band, i) for i in kept]
                differences.append(row)
                sizes.append([max(case.floor, abs(expected_of(case, name, band, i)), *(abs(seen[name].values[band][i]) for seen in pictures)) for i in kept])
            for i in list(range(n)) + [None]:
                values = [sum(r) if i is None else r[i] for r in differences]
                scale = sum(sum(s) if i is None else s[i] for s in sizes) / len(runs)
                mean = sum(values) / len(values)
                spread = sum((v - mean) ** 2 for v in values) / (len(values) - 1) / len(values)
                where = f"{name} band {band} " + ("mean" if i is None else f"pixel {kept[i]}")
                found.consider(mean, spread + (case.tolerance * scale) ** 2, len(values) - 1, scale, where, MEANS if i is None else (1 - MEANS) / n)
    return found.closed()

"""How a render is held against what is stored: sums over blocks, their errors, Student's probabilities. README.md says why."""
import math

ROUNDING = 3e-6  # of the radiance: float32 files, and sums that are made in another order


def beta_fraction(a, b, x):
    """Continued fraction of the incomplete beta function (Abramowitz & Stegun 26.5.8), by Lentz' method."""
    tiny, c, d = 1e-300, 1.0, 1 - (a + b) * x / (a + 1)
    d = 1 / (d or tiny)
    value = d
    for m in range(1, 500):
        for term in (m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m)),
                     -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1))):
            d = 1 / ((1 + term * d) or tiny)
            c = (1 + term / c) or tiny
            value *= c * d
        if abs(c * d - 1) < 1e-14:
            break
    return value


def beta(a, b, x):
    """Regularized incomplete beta function I_x(a, b), 0 <= x <= 1."""
    if x <= 0 or x >= 1:
        return min(max(x, 0.0), 1.0)
    front = math.exp(math.lgamma(a + b) - math.lgamma(a) - math.lgamma(b) + a * math.log(x) + b * math.log1p(-x))
    if x < (a + 1) / (a + b + 2):
        return front * beta_fraction(a, b, x) / a
    return 1 - front * beta_fraction(b, a, 1 - x) / b


def two_sided(t, degrees):
    """Probability that Student's t is at least so far from zero."""
    return beta(degrees / 2, 0.5, degrees / (degrees + t * t))


def quantile(p, degrees):
    """t that two_sided() gives p for."""
    low, high = 0.0, 1.0
    while two_sided(high, degrees) > p:
        high *= 2
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if two_sided(middle, degrees) > p else (low, middle)
    return high


class Sum:
    """Difference of the sums over a set of independent pixels, its variance and the degrees of freedom of that."""

    def __init__(self):
        self.difference = self.radiance = self.stored = 0.0
        self.stated, self.stated2 = 0.0, 0.0    # variance that the render states, and the sum of its squares
        self.known, self.known2 = 0.0, 0.0  # variance that the spread of the stored runs lets expect

    def add(self, value, error, mean, stored_error, ratio):
        """ratio: variance of one tested render over that of the stored mean, when nothing changed but the paths."""
        self.difference += value - mean
        self.radiance += abs(mean)
        stated, stored = error * error, stored_error * stored_error
        known = ratio * stored
        self.stated, self.stated2 = self.stated + stated, self.stated2 + stated * stated
        self.known, self.known2 = self.known + known, self.known2 + known * known
        self.stored += stored

    def sigma(self):
        return math.sqrt(max(self.stated, self.known) + self.stored + (ROUNDING * self.radiance) ** 2)

    def degrees(self, stated, known):
        """F. Satterthwaite (1946), of each of the two variances; the fewer."""
        mine = stated * self.stated ** 2 / self.stated2 if self.stated2 else math.inf
        theirs = known * self.known ** 2 / self.known2 if self.known2 else math.inf
        return min(mine, theirs, 1000.0)  # beyond that Student is normal to a few per cent of p = 1e-8


def block_sums(value, error, mean, stored_error, edge, ratio):
    """-> {(block row, block column, band): Sum}; pictures of envi.py. edge 0: the whole picture."""
    sums = {}
    columns, rows, bands = mean.shape
    for b in range(bands):
        v, e, m, s = value.values[b], error.values[b], mean.values[b], stored_error.values[b]
        for r in range(rows):
            for c in range(columns):
                key = (r // edge, c // edge, b) if edge else (0, 0, b)
                i = r * columns + c
                sums.setdefault(key, Sum()).add(v[i], e[i], m[i], s[i], ratio)
    return sums


class Verdict:
    """Smallest probability among sums, where it is, and how many there were."""

    def __init__(self, sums, stated, known):
        self.sums, self.count = sums, len(sums)
        self.p, self.where = 1.0, None
        for key, s in sums.items():
            sigma = s.sigma()
            p = two_sided(s.difference / sigma, s.degrees(stated, known)) if sigma > 0 else float(s.difference == 0)
            if not p >= self.p:  # of numbers that are not finite too
                self.p, self.where = (p if p == p else 0.0), (key, s)

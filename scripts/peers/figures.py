"""From runs to figures: one reference a scene, each program's bias against it, errors, and the time to an error of 1 %."""
import math
from statistics import NormalDist


def image_of(run, scene):
    """Ours holds the scene's bands, Mitsuba's colours all three."""
    import numpy as np
    image = np.load(run["image"])
    return image if image.shape[2] == max(1, len(scene.channels)) else image[..., ["rgb".index(c) for c in scene.channels]]


def load(runs, kind, scene):
    import numpy as np
    return np.array([image_of(r, scene) for r in runs if r["kind"] == kind])


def cost_of(runs):
    """Of short runs of one kind: the variance of a pixel between seeds times the CPU seconds, at the largest number of paths."""
    import numpy as np
    rows = [r for r in runs if r["paths"] == max(r["paths"] for r in runs)]
    images = np.array([np.load(r["image"]) for r in rows])
    return float(images.var(axis=0, ddof=1).mean()) * sum(r["cpu_s"] for r in rows) / len(rows)


class LongRuns:
    """Independent long runs of one program: their mean, and the variance of the mean of every pixel (mean over pixels)."""

    def __init__(self, images):
        self.images, self.count = images, len(images)
        self.mean = images.mean(axis=0)
        self.noise = float(images.var(axis=0, ddof=1).mean()) / self.count

    def image_mean(self):
        """-> mean of the image and its standard error."""
        means = self.images.mean(axis=(1, 2, 3))
        return float(means.mean()), float(means.std(ddof=1)) / math.sqrt(self.count)


class Reference:
    """The closed form where there is one, else the mean of the long runs of both programs, each weighted by the inverse of its
    variance (one weight a program: weights of single pixels would follow their noise)."""

    def __init__(self, scene, ours, peer):
        import numpy as np
        self.exact = scene.exact
        self.image, self.noise, self.share = np.full(ours.mean.shape, scene.exact), 0.0, 0.0
        if not scene.exact:
            self.share = peer.noise / (ours.noise + peer.noise) if peer else 1.0  # of ours
            self.image = self.share * ours.mean + ((1 - self.share) * peer.mean if peer else 0)
            self.noise = 1 / (1 / ours.noise + 1 / peer.noise) if peer else ours.noise
        self.mean = float(self.image.mean())

    def bias(self, ours, peer, mine):
        """-> (mean of the program - reference) and its standard error, both relative to the reference. Against the shared one a
        program's bias is its part of the difference between the two."""
        program = ours if mine else peer
        mean, error = program.image_mean()
        if not self.exact:
            other, other_error = (peer if mine else ours).image_mean()
            part = 1 - self.share if mine else self.share
            return part * (mean - other) / self.mean, part * math.hypot(error, other_error) / self.mean
        return (mean - self.exact) / self.mean, error / self.mean


def compare_blocks(ours, peer, across=8):
    """Do the two pictures differ anywhere? Means of across x across blocks, each tested by Student's t over the runs. -> root mean
    square of the relative differences, the same as noise alone would give it, and the probability that noise alone makes the sum of
    the t^2 this large (their mean and variance are those of F(1, n); the sum of that many is taken as normal)."""
    import numpy as np

    def blocks(images):
        n, rows, columns, channels = images.shape
        cut = images[:, :rows // across * across, :columns // across * across]
        return cut.reshape(n, across, rows // across, across, columns // across, channels).mean(axis=(2, 4, 5)).reshape(n, -1)
    a, b = blocks(ours.images), blocks(peer.images)
    differences = a.mean(axis=0) - b.mean(axis=0)
    scale = float(ours.mean.mean())
    # Images are of single precision: what shows no noise may differ by its rounding.
    variances = a.var(axis=0, ddof=1) / len(a) + b.var(axis=0, ddof=1) / len(b) + (1e-6 * scale) ** 2
    t2, n = differences ** 2 / variances, 2 * (min(len(a), len(b)) - 1)
    mean, variance = n / (n - 2), 2 * n * n * (n - 1) / ((n - 2) ** 2 * (n - 4))
    z = float((t2.mean() - mean) / math.sqrt(variance / len(t2)))
    return float(np.sqrt(np.mean(differences ** 2))) / scale, float(np.sqrt(np.mean(variances))) / scale, 1 - NormalDist().cdf(z)


def to_one_percent(points):
    """Paths, error and CPU seconds of growing runs -> CPU seconds at 1 %: the error falls on as between the last two (as the square
    root at least, as the number of paths at most) for as far again, then as the square root; each further path takes what it took
    between them."""
    (n0, e0, t0), (n1, e1, t1) = points[-2:]
    if e1 <= 1e-6:
        return None
    slope = min(1.0, max(0.5, math.log(max(e0, e1) / e1) / math.log(n1 / n0)))
    again = (n1 / n0) ** slope  # what the error falls by
    paths = n1 * (e1 / 0.01) ** (1 / slope) if e1 / again < 0.01 else n1 * n1 / n0 * (e1 / again / 0.01) ** 2
    each = (t1 - t0) / (n1 - n0) if t1 > t0 else t1 / n1
    return t1 + each * (paths - n1) if paths > n1 else t1 * paths / n1


def row_of(runs, scene, reference, edge):
    """Runs of one program on one scene at growing numbers of paths -> a row of the table. The reference's own noise is taken off."""
    import numpy as np
    points, spread = [], 0.0
    budgets = sorted({r["paths"] for r in runs})
    for paths in budgets:
        rows = [r for r in runs if r["paths"] == paths]
        squares = [max(0.0, float(np.mean((image_of(r, scene) - reference.image) ** 2)) - reference.noise) for r in rows]
        errors = [math.sqrt(s) / reference.mean for s in squares]
        spread = (max(errors) - min(errors)) / 2
        points.append((paths, math.sqrt(sum(e * e for e in errors) / len(errors)), sum(r["cpu_s"] for r in rows) / len(rows)))
    _, error, cpu_s = points[-1]
    return {"scene": runs[0]["scene"], "program": runs[0]["program"], "paths": budgets[-1], "cpu_s": cpu_s,
            "mpaths_per_cpu_s": edge * edge * budgets[-1] / cpu_s / 1e6, "error": error, "error_spread": spread, "cpu_s_to_1_percent": to_one_percent(points)}


def quartiles(values):
    ordered = sorted(values)
    at = [(len(ordered) - 1) * q for q in (0, 0.25, 0.5, 0.75, 1)]
    return [ordered[int(x)] + (x - int(x)) * (ordered[min(int(x) + 1, len(ordered) - 1)] - ordered[int(x)]) for x in at]


def pairs_of(runs, scene, reference):
    """Runs of kind "pair" of one scene -> quartiles of ours : Mitsuba over the pairs: CPU seconds to 1 %, and paths per CPU second. None
    when some run has no noise."""
    import numpy as np
    first = [r["program"] for r in runs][0]
    ratios, speeds = [], []
    for seed in sorted({r["seed"] for r in runs}):
        to_one, speed = {}, {}
        for r in sorted((r for r in runs if r["seed"] == seed), key=lambda r: r["paths"]):
            square = max(0.0, float(np.mean((image_of(r, scene) - reference.image) ** 2)) - reference.noise)
            ours = r["program"].startswith("ours")
            to_one.setdefault(ours, []).append((r["paths"], math.sqrt(square) / reference.mean, r["cpu_s"]))
            speed[ours] = r["paths"] / r["cpu_s"]
        seconds = {ours: to_one_percent(points) for ours, points in to_one.items()}
        if not all(seconds.values()):
            return None
        ratios.append(seconds[True] / seconds[False])
        speeds.append(speed[True] / speed[False])
    return {"pairs": len(ratios), "to_1_percent": quartiles(ratios), "paths_per_cpu_s": quartiles(speeds), "paths": max(r["paths"] for r in runs),
            "with": next(r["program"] for r in runs if not r["program"].startswith("ours")) if first else None}

"""What users make of counts behind analysers: Stokes vectors by least squares, from a micro-grid, frames, lenses or arms, and from a
channelled spectrum.

Angles are degrees from up in the picture, counter-clockwise as the receiver sees it, like those of `analyser`. Counts are to be without
bias and dark current; a factor that is common to all is kept in I, Q and U.
"""
import numpy as np


def rows(angles_deg, extinction=np.inf):
    """The rows (I, Q, U) of polarizers at angles: an array of one more axis of 3."""
    a = np.radians(np.asarray(angles_deg, float))
    leak = 1 / extinction
    return np.stack([np.full_like(a, 0.5 * (1 + leak)), 0.5 * (1 - leak) * np.cos(2 * a), 0.5 * (1 - leak) * np.sin(2 * a)], -1)


def stokes(frames, analysers, variances=None):
    """I, Q, U (or as many as `analysers` has columns) from frames [analyser, ...], weighted by 1 / variances where those are given.

    Returns values [component, ...] and covariances [component, component, ...]; covariances are those of variances, or of variances
    of 1. ValueError: fewer analysers than components, or analysers that do not determine them."""
    y, A = np.asarray(frames, float), np.asarray(analysers, float)
    n = A.shape[1]
    if y.shape[0] != A.shape[0]:
        raise ValueError(f"{y.shape[0]} frames of {A.shape[0]} analysers")
    if np.linalg.matrix_rank(A, tol=1e-9) < n:
        raise ValueError(f"these analysers do not determine {n} components")
    w = np.ones_like(y) if variances is None else 1 / np.asarray(variances, float)
    normal = np.einsum("ki,kj,k...->...ij", A, A, w)
    covariance = np.linalg.inv(normal)
    right = np.einsum("ki,k...->...i", A, w * y)
    value = np.einsum("...ij,...j->...i", covariance, right)
    return np.moveaxis(value, -1, 0), np.moveaxis(covariance, (-2, -1), (0, 1))


def demosaic(counts, grid_deg, extinction=np.inf):
    """I, Q, U [3, row, column] of a micro-grid's counts [row, column], by bilinear interpolation of each orientation. grid_deg: angles
    [row, column] of the grid that repeats from the first detector on; several cells of one angle are taken together."""
    counts, grid = np.asarray(counts, float), np.asarray(grid_deg, float)
    height, width = counts.shape
    angle = np.tile(grid, (-(-height // grid.shape[0]), -(-width // grid.shape[1])))[:height, :width]
    reach_y, reach_x = (2 * np.minimum(n, 2) - 1 for n in grid.shape)
    kernel = np.outer(_hat(reach_y), _hat(reach_x))
    planes = []
    for one in np.unique(grid):
        there = (angle == one).astype(float)
        share = _blur(there, kernel)
        if not share.all():
            raise ValueError("grids of more than two different angles along a row or column are not interpolated: take their cells apart")
        planes.append(_blur(counts * there, kernel) / share)
    return stokes(np.array(planes), rows(np.unique(grid), extinction))[0]


def channelled(wavelength_um, spectrum, retarder_um, window_um):
    """I, Q / I and U / I from I/2 [1 + Q/I cos(d) + U/I sin(d)], d = 2 pi retarder_um / wavelength, by least squares within a window about
    each wavelength, in which all three are even. Returns an array [3, wavelength]."""
    x, y = np.asarray(wavelength_um, float), np.asarray(spectrum, float)
    d = 2 * np.pi * retarder_um / x
    A = 0.5 * np.stack([np.ones_like(x), np.cos(d), np.sin(d)], -1)
    out = np.empty((3, x.size))
    for i, centre in enumerate(x):
        near = np.abs(x - centre) <= 0.5 * window_um
        value = np.linalg.lstsq(A[near], y[near], rcond=None)[0]
        out[:, i] = value[0], value[1] / value[0], value[2] / value[0]
    return out


def _hat(reach):
    half = np.arange(1, reach // 2 + 2, dtype=float)
    return np.concatenate([half, half[-2::-1]]) if reach > 1 else np.ones(1)


def _blur(picture, kernel):
    ry, rx = kernel.shape[0] // 2, kernel.shape[1] // 2
    padded = np.pad(picture, ((ry, ry), (rx, rx)))
    out = np.zeros_like(picture)
    for j in range(kernel.shape[0]):
        for i in range(kernel.shape[1]):
            out += kernel[j, i] * padded[j:j + picture.shape[0], i:i + picture.shape[1]]
    return out

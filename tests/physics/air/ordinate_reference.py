#!/usr/bin/env python3
"""Prints the reference numbers of ordinate_reference_test.cpp: without arguments by PythonicDISORT, with the cosine of
the sun as an argument those of the views, by sasktran2 (pip install sasktran2==2026.10.1; about a minute each).
pip install PythonicDISORT==1.8 (numpy 2.4.6, scipy 1.17.1 were used); python3 ordinate_reference.py
PythonicDISORT's BDRF is pi times the usual one; it multiplies s_poly_coeffs by 1 - albedo."""
import sys

import numpy as np
from PythonicDISORT.pydisort import pydisort


def show(name, u, Fp, Fm, mu, depths):
    for t in depths:
        down, direct = Fm(t)
        print("%s flux %.17g %.12g %.12g %.12g" % (name, t, direct, down, Fp(t)))
    order = np.argsort(mu)
    for t in depths:
        radiance = u(t, np.array([0, 1.0, 3.0]))
        for i in order[[0, 3, 7, 8, 12, 15]]:
            print("%s view %.17g %.17g" % (name, t, mu[i]), " ".join("%.12g" % x for x in radiance[i]))


def mixed():
    albedo, bottom, top = np.array([0.9, 0.99, 0.999]), np.array([0.3, 1.3, 1.8]), [0, 0.3, 1.3]
    chi = np.zeros((3, 17))
    chi[0, :3] = chi[2, :3] = [1, 0, 0.1]
    chi[1] = 0.75 ** np.arange(17)
    upper, lower, source = [0.1, 0.2, 0.5], [0.2, 0.5, 0.6], []
    for a, b, t0, t1 in zip(upper, lower, top, bottom):
        slope = (b - a) / (t1 - t0)
        source.append([a - slope * t0, slope])
    mu, Fp, Fm, _, u = pydisort(bottom, albedo, 16, chi, 0.6, np.pi, 0, NLeg=16, NFourier=16, f_arr=chi[:, 16],
                                b_pos=0.2, b_neg=0.05, BDRF_Fourier_modes=[0.3], s_poly_coeffs=np.array(source))
    show("mixed", u, Fp, Fm, mu, [0, 0.67, 1.8])


def column():
    """Twenty layers of molecules, haze and gas under a low sun."""
    z = np.linspace(40, 0, 21)
    part = lambda h: np.exp(-z[1:] / h) - np.exp(-z[:-1] / h)
    rayleigh, haze, gas = 0.36 * part(8.0), 0.3 * part(1.5), 0.1 * part(4.0)
    depth, scattered = rayleigh + haze + gas, rayleigh + 0.92 * haze
    molecules = np.zeros(17)
    molecules[[0, 2]] = 1, 0.1
    chi = (rayleigh[:, None] * molecules + 0.92 * haze[:, None] * 0.7 ** np.arange(17)) / scattered[:, None]
    bottom = np.cumsum(depth)
    mu, Fp, Fm, _, u = pydisort(bottom, scattered / depth, 16, chi, 0.25, 1.0, 0, NLeg=16, NFourier=16,
                                f_arr=chi[:, 16], BDRF_Fourier_modes=[0.4])
    show("column", u, Fp, Fm, mu, [0, bottom[9], bottom[19]])


def views(sun):
    """The column under another sun over a ground of 0.3, seen from above; layers of 2 km, plane-parallel, 16 streams."""
    import sasktran2 as sk

    z, count = np.linspace(0, 40000, 21), 64
    part = lambda h: np.exp(-z[:-1] / h) - np.exp(-z[1:] / h)
    rayleigh, haze, gas = 0.36 * part(8000), 0.3 * part(1500), 0.1 * part(4000)
    depth, scattered = rayleigh + haze + gas, rayleigh + 0.92 * haze
    molecules = np.zeros(count)
    molecules[[0, 2]] = 1, 0.1
    chi = (rayleigh[:, None] * molecules + 0.92 * haze[:, None] * 0.7 ** np.arange(count)) / scattered[:, None]
    config = sk.Config()
    config.num_threads, config.num_streams, config.num_singlescatter_moments = 1, 16, count
    config.multiple_scatter_source = sk.MultipleScatterSource.DiscreteOrdinates
    config.single_scatter_source = sk.SingleScatterSource.Exact
    config.delta_m_scaling = True
    geometry = sk.Geometry1D(sun, 0, 6371000, z, sk.InterpolationMethod.LowerInterpolation,
                             sk.GeometryType.PlaneParallel)
    rays = sk.ViewingGeometry()
    for mu in (0.15, 0.3, 0.5, 0.75, 1.0):
        for phi in (0, 60, 120, 180):
            rays.add_ray(sk.GroundViewingSolar(sun, np.deg2rad(phi), mu, 200000))
    air = sk.Atmosphere(geometry, config, numwavel=1)
    air.storage.total_extinction[:, 0] = np.append(depth / np.diff(z), 0)
    air.storage.ssa[:, 0] = np.append(scattered / depth, 0)
    for l in range(count):
        air.leg_coeff.a1[l, :, 0] = (2 * l + 1) * np.append(chi[:, l], chi[-1, l])
    air.surface.albedo[:] = 0.3
    for x in sk.Engine(config, geometry, rays).calculate_radiance(air)["radiance"].values.reshape(5, 4):
        print(" ".join("%.6g" % v for v in x))


if len(sys.argv) > 1:
    views(float(sys.argv[1]))
else:
    mixed()
    column()

#!/usr/bin/env python3
"""tests/unit/motion/planets_reference.py DE421
Prints the rows of planets_rows.inc from astropy's AltAz without air with JPL's ephemeris DE421 (1900 to 2050), which has nothing in common
with the theory of the library. Centres of mass of planets and their moons stand for the outer planets, as DE421 has them. The file comes with
skyfield-data. Made with astropy 8.0.2, jplephem 2.24 and skyfield-data 7.0.0:
python3 -m venv V; V/bin/pip install astropy jplephem skyfield-data
V/bin/python tests/unit/motion/planets_reference.py V/lib/python3*/site-packages/skyfield_data/data/de421.bsp > tests/unit/motion/planets_rows.inc
"""
import sys
import warnings

import astropy.units as u
import numpy as np
from astropy.coordinates import AltAz, EarthLocation, get_body, get_body_barycentric, solar_system_ephemeris
from astropy.time import Time
from astropy.utils import iers

iers.conf.auto_download = False
iers.conf.iers_degraded_accuracy = "ignore"
iers.conf.auto_max_age = None
warnings.simplefilter("ignore")
SITES = [(49.4, 8.7, 120.0), (-24.6, -70.4, 2635.0)]
DATES = ["1950-03-03T01:30:00", "1976-07-20T12:00:00", "2000-01-01T22:00:00", "2026-11-29T03:15:00", "2049-12-01T00:00:00"]
PLANETS = ["mercury", "venus", "mars", "jupiter", "saturn", "uranus", "neptune"]
solar_system_ephemeris.set(sys.argv[1])
print("// Planet; latitude and longitude (degrees), height (m); terrestrial time and UT1, as day and fractions; azimuth and zenith distance")
print("// (degrees); distances to the Sun and the Earth (au), phase angle (degrees).")
for lat, lon, h in SITES:
    for date in DATES:
        t = Time(date, scale="utc")
        where = EarthLocation.from_geodetic(lon, lat, h)
        d1 = np.floor(t.jd1 + t.jd2 - 0.5) + 0.5
        tt, ut1 = (t.tt.jd1 - d1) + t.tt.jd2, (t.ut1.jd1 - d1) + t.ut1.jd2
        for i, name in enumerate(PLANETS):
            body = get_body(name, t, where)
            seen = body.transform_to(AltAz(obstime=t, location=where, pressure=0 * u.Pa))
            earth = (get_body_barycentric("earth", t).xyz.to_value(u.au), get_body_barycentric("sun", t).xyz.to_value(u.au))
            emitted = t - np.linalg.norm(get_body_barycentric(name, t).xyz.to_value(u.au) - earth[0]) * 499.004784 * u.s
            at = get_body_barycentric(name, emitted).xyz.to_value(u.au)
            r, delta = at - earth[1], at - earth[0]
            phase = np.degrees(np.arccos(r @ delta / np.linalg.norm(r) / np.linalg.norm(delta)))
            print(f"{{{i}, {lat}, {lon}, {h}, {d1}, {tt:.12f}, {ut1:.12f}, {seen.az.deg:.6f}, {90 - seen.alt.deg:.6f}, "
                  f"{np.linalg.norm(r):.6f}, {np.linalg.norm(delta):.6f}, {phase:.4f}}},")

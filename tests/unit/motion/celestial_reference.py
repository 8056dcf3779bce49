#!/usr/bin/env python3
"""tests/unit/motion/celestial_reference.py
Prints the rows of celestial_rows.inc. Without air: astropy's AltAz (which has polar motion, up to 0.5 arc seconds). With air: the
refraction of pyerfa's refco added to pyerfa's own chain. Made with astropy 8.0.2 and pyerfa 2.0.1.5:
python3 -m venv V; V/bin/pip install pyerfa astropy; V/bin/python tests/unit/motion/celestial_reference.py > tests/unit/motion/celestial_rows.inc
"""
import warnings

import astropy.units as u
import erfa
import numpy as np
from astropy.coordinates import AltAz, EarthLocation, SkyCoord
from astropy.time import Time
from astropy.utils import iers

iers.conf.auto_download = False
iers.conf.iers_degraded_accuracy = "ignore"
iers.conf.auto_max_age = None


def row(air, az, zd):
    print(f"{{{lat}, {lon}, {h}, {d1}, {tt2:.12f}, {ut12:.12f}, {air}, {ra}, {dec}, {pmr}, {pmd}, {az:.7f}, {zd:.7f}}},")


STARS = [("Sirius", 101.28708, -16.71611, -0.553, -1.205), ("Barnard", 269.45208, 4.69339, -0.798, 10.337), ("Polaris", 37.95292, 89.26417, 0.038, -0.015),
         ("Arcturus", 213.91542, 19.18250, -1.098, -1.999), ("Achernar", 24.42875, -57.23667, 0.088, -0.040)]
SITES = [(49.4, 8.7, 120.0), (-24.6, -70.4, 2635.0), (78.2, 15.6, 0.0)]
DATES = [(1950, 3, 3, 1.5), (2000, 1, 1, 22.0), (2026, 11, 29, 3.25), (2100, 8, 8, 0.0)]
AS = np.radians(1 / 3600)
warnings.simplefilter("ignore")
print("// Latitude and longitude (degrees), height (m); terrestrial time and UT1, as day and fractions; air; right ascension and declination (degrees),")
print("// their motions (arc seconds a year, the first times the cosine of the declination); azimuth and zenith distance (degrees).")
for lat, lon, h in SITES:
    for y, m, d, hour in DATES:
        d1, d2 = erfa.cal2jd(y, m, d)
        t = Time(d1, d2 + hour / 24, format="jd", scale="utc")
        tt2, ut12 = (t.tt.jd1 - d1) + t.tt.jd2, (t.ut1.jd1 - d1) + t.ut1.jd2
        for name, ra, dec, pmr, pmd in STARS:
            star = SkyCoord(ra * u.deg, dec * u.deg, pm_ra_cosdec=pmr * u.arcsec / u.yr, pm_dec=pmd * u.arcsec / u.yr, distance=1e6 * u.kpc, obstime=Time("J2000"))
            place = star.apply_space_motion(new_obstime=t).transform_to(AltAz(obstime=t, location=EarthLocation.from_geodetic(lon, lat, h), pressure=0 * u.Pa))
            row(0, place.az.deg, 90 - place.alt.deg)
            x, yy, s = erfa.xys06a(d1, tt2)
            epv = erfa.epv00(d1, tt2)
            a = erfa.apco(d1, tt2, epv[1], epv[0]["p"], x, yy, s, erfa.era00(d1, ut12), np.radians(lon), np.radians(lat), h, 0, 0, erfa.sp00(d1, tt2), *erfa.refco(1013.25, 9.85, 0.0, 0.55))
            az, zd, *_ = erfa.atioq(*erfa.atciq(np.radians(ra), np.radians(dec), pmr * AS / np.cos(np.radians(dec)), pmd * AS, 0, 0, a), a)
            if zd < np.radians(70):
                row(1, np.degrees(az), np.degrees(zd))

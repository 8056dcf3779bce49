"""Where the sun stands and how far it is: the low-precision formulas of the Astronomical Almanac after J. Michalsky, "The Astronomical
Almanac's algorithm for approximate solar position (1950-2050)", Solar Energy 40, 1988. Within 0.01 degrees and 0.0002 AU."""
import datetime
import math


def sun(time, latitude, longitude):
    """Zenith angle (deg, without refraction) and distance (AU). time: UTC, naive datetime; latitude, longitude: deg, north and east."""
    n = (time - datetime.datetime(2000, 1, 1, 12)).total_seconds() / 86400
    anomaly = math.radians(357.528 + 0.9856003 * n)
    ecliptic = math.radians(280.460 + 0.9856474 * n + 1.915 * math.sin(anomaly) + 0.020 * math.sin(2 * anomaly))
    obliquity = math.radians(23.439 - 4e-7 * n)
    ascension = math.atan2(math.cos(obliquity) * math.sin(ecliptic), math.cos(ecliptic))
    declination = math.asin(math.sin(obliquity) * math.sin(ecliptic))
    hours = time.hour + time.minute / 60 + (time.second + 1e-6 * time.microsecond) / 3600
    sidereal = 6.697375 + 0.0657098242 * n + hours
    hour_angle = math.radians(15 * sidereal + longitude) - ascension
    place = math.radians(latitude)
    height = math.asin(math.sin(declination) * math.sin(place) + math.cos(declination) * math.cos(place) * math.cos(hour_angle))
    distance = 1.00014 - 0.01671 * math.cos(anomaly) - 0.00014 * math.cos(2 * anomaly)
    return 90 - math.degrees(height), distance

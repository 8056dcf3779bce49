"""Rows of air and lights: what stands in the simulation."""
import datetime
import math


def air_none(d):
    pass


def layered(d):
    spec = {"heights_m": [0, 1000, 5000], "temperature_k": [d.kelvin, d.kelvin] if d.furnace else [290, 270], "rayleigh": not d.furnace and d.chance(0.5)}
    if not d.furnace and d.chance(0.6):  # quick layers scatter the sun alone: what else they scatter is lost (SIM's FORMAT.md)
        spec["aerosol"] = {"optical_depth_550": d.u(0.05, 0.8), "scale_height_m": d.one(500, 2000), "albedo": d.u(0.8, 1)}
    if d.chance(0.5):
        spec["gases"] = [{"name": "gas", "column_optical_depth": d.u(0.05, 1), "scale_height_m": 1500}]
    d.world.sim["atmosphere"] = spec


def profile(**keys):
    def make(d):
        spec = {"profile": d.one("us_standard", "midlatitude_summer", "subarctic_winter"), "gases": "none", "streams": 4, "ground_albedo": d.u(0, 0.4), **keys}
        if d.chance(0.6):
            spec["aerosol"] = {"model": d.one("rural", "maritime", "urban"), "visibility_km": d.one(10, 23, 50)}
        d.world.sim["atmosphere"] = spec
    return make


def with_gases(d):
    profile(gases="builtin")(d)
    d.world.facts["spectral_error"] = 1e-3  # lines take very many bins for less


def direction(d):
    return {"zenith_deg": d.u(5, 70), "azimuth_deg": d.u(0, 360)}


def sun(d):
    d.world.sim["sun"] = {"direction": direction(d), "irradiance": round(d.level * d.u(2, 6), 3), "half_angle_deg": d.one(0.26655, 2, 5)}


def collimated(d):
    d.world.sim["sun"] = {"direction": direction(d), "irradiance": round(d.level * d.u(2, 6), 3), "collimated": True}


def moon(d):
    d.world.sim["moon"] = {"direction": direction(d), "irradiance": round(d.level * d.u(0.5, 2), 3), "half_angle_deg": d.one(0.26, 3)}


def sky(d):
    d.world.sim["sky"] = {"radiance": round(d.level * d.u(0.3, 2), 3)}


def sky_full(d):
    d.world.sim["sky"] = {"radiance": round(d.level * d.u(0.3, 2), 3), "full_sphere": True}


def sky_table(d):
    d.world.sim["sky"] = {"radiance": round(d.level * d.u(0.3, 2), 3), "table": [[d.u(0.3, 1) for _ in range(4)] for _ in range(3)], "full_sphere": d.chance(0.5)}


def sky_thermal(d):
    d.world.sim["sky"] = {"kind": "thermal", "layers": [{"temperature_k": d.kelvin, "optical_depth": d.u(0.1, 2)}, {"temperature_k": round(d.kelvin * 0.95, 1), "optical_depth": 0.3}]}


def clear_sky(d):
    if "sun" not in d.world.sim:
        sun(d)
    d.world.sim["sky"] = {"kind": "clear"}


PARTS = ("zodiacal", "airglow", "starlight", "galactic", "stars", "planets")


def night_sky(d):
    """As bright as lamps. Its stars are spread, for sensors differ in which of them see stars as points, but where a relation bears that ('stars')."""
    scale = d.u(1e5, 4e5)
    parts = [part for part in PARTS if d.chance(0.75)] or ["airglow"]
    spec = {"time_utc": d.one("2026-03-20T23:00:00Z", "1973-07-02T01:00:00Z", "2099-12-05T12:00:00Z"),
            "place": {"latitude_deg": d.u(-70, 70), "longitude_deg": d.u(-170, 170)}, "parts": parts, "solar_flux_sfu": d.u(60, 300),
            "resolve_stars": "in_view" if "stars" in d.traits and d.chance(0.5) else "none"}
    if d.maybe("city_glow", 0.4):
        spec["city_glow"] = [{"azimuth_deg": d.u(0, 360), "spectrum": {"lamp": d.one("sodium", "led_3000", "mercury")}, "width_deg": d.u(5, 40), "height_deg": d.u(5, 30),
                              **d.one({"horizon_cd_m2": 1e-3}, {"population": 50000, "distance_km": d.u(6, 80)})} for _ in range(d.one(1, 2))]
        parts.append("city_glow")
    if d.maybe("star_catalogue", 0.3):
        spec["catalogue"] = catalogue(d)
    spec["scale"] = {part: round(scale * d.u(0.2, 1)) for part in parts}
    if spec["resolve_stars"] == "in_view":
        if d.maybe("scintillation", 0.5):
            spec["scintillation"] = {"seed": d.one(1, 2, 3)}
        if d.maybe("satellites", 0.5):
            spec["satellites"] = [satellite(d, spec["time_utc"], spec["place"]) for _ in range(d.one(1, 3))]
    d.world.sim["night_sky"] = spec


def satellite(d, utc, place):
    """One that passes within some 4 degrees of a place at a date, as wide as a town: as bright as the stars here. A circle; sidereal time to 0.1 degrees."""
    t = datetime.datetime.fromisoformat(utc.replace("Z", ""))
    day = (t - datetime.datetime(2000, 1, 1, 12)).total_seconds() / 86400
    latitude = math.radians(place["latitude_deg"] + d.u(-3, 3))
    ascension = math.radians(280.4606 + 360.9856474 * day + place["longitude_deg"] + d.u(-3, 3))
    tilt = math.radians(d.u(75, 105))
    along = math.asin(math.sin(latitude) / math.sin(tilt))
    node = math.degrees(ascension - math.atan2(math.cos(tilt) * math.sin(along), math.cos(along))) % 360
    revolutions = 86400 / (2 * math.pi) * math.sqrt(3.986004e14 / (6.378e6 + 1e3 * d.u(500, 900)) ** 3)
    first = f"1 00001U 00001A   {t.year % 100:02}{t.timetuple().tm_yday + (t.hour + t.minute / 60) / 24:012.8f}  .00000000  00000-0  00000-0 0    1"
    second = f"2 00001 {math.degrees(tilt):8.4f} {node:8.4f} 0001000   0.0000 {math.degrees(along) % 360:8.4f} {revolutions:11.8f}    1"
    return {"tle_lines": [line + str(sum(int(c) if c.isdigit() else c == "-" for c in line) % 10) for line in (first, second)],
            "area_m2": round(d.u(1e5, 4e5)), "albedo": d.u(0.2, 1), "name": d.one("a", "b")}


def catalogue(d):
    """Stores a table of stars of V -1 to 5, of any colour, and answers its name."""
    rows = [f"{d.u(0, 360)},{d.u(-89, 89)},{d.u(-1, 5)},{d.one(3000, 6000, 12000)}" for _ in range(200)]
    d.world.files["stars.csv"] = "\n".join(["ra_deg,dec_deg,v_mag,temperature_k", *rows, ""]).encode()
    return "stars.csv"


def sky_furnace(d):
    d.world.sim["sky"] = {"radiance": d.blackbody_curve(), "full_sphere": True}
    if d.chance(0.5):  # an even table is asked for on purpose, at every place; without one the sky is met by chance alone
        d.world.sim["sky"]["table"] = [[1, 1], [1, 1]]


def lamp(kind):
    def make(d):
        spec = {"kind": kind, "position_m": [d.u(-3.4, 3.4), d.one(-1.6, 1.6) * d.u(0.95, 1.05) - 1.6, d.u(2.9, 3.3)], "intensity": round(d.level * d.u(2, 20), 3)}
        if kind == "spot":
            spec.update(axis=[d.u(-1, 1), d.u(-1, 1), -1], outer_deg=d.u(30, 80))
        d.world.sim["lamps"].append(spec)
    return make


def lamp_distribution(d):
    lamp("point")(d)
    d.world.sim["lamps"][-1].update(axis=[d.u(-0.3, 0.3), d.u(-0.3, 0.3), -1], distribution={"table": [[1], [d.u(0.2, 1)], [d.u(0, 0.5)]]})


def lamp_scheduled(d):
    lamp("point")(d)
    d.world.sim["lamps"][-1]["schedule"] = [{"time_s": -50, "on": True, "scale": d.u(0.5, 2)}, {"time_s": 0.5, "scale": d.u(0.5, 2)}]
    d.moving = True


NOT_FURNACE = {"without": ("furnace",)}  # shines more or less than the one temperature
FAR = ("furnace", "room_sphere", "room_box", "ambient")  # is not seen from a room, or through air without end


def far(weight=1, without=()):
    return {"weight": weight, "without": FAR + tuple(without)}


ONE_SKY = ("sky", "sky_full", "sky_table", "sky_thermal", "clear_sky", "profile_air", "profile_no_adjacency", "traced_air", "gases_air")
PROFILE = {"without": ("furnace", "room_sphere", "room_box", "no_profile", "periodic"), "weight": 1}
ROWS = [
    ("air_none", "air", air_none, {"weight": 6}), ("layered_air", "air", layered, {"without": ("room_sphere", "room_box", "no_air"), "weight": 1.2}),
    ("profile_air", "air", profile(), PROFILE), ("profile_no_adjacency", "air", profile(adjacency=False), {**PROFILE, "weight": 1.2}),
    ("traced_air", "air", profile(scattering="traced"), {**PROFILE, "weight": 1.3}), ("gases_air", "air", with_gases, {**PROFILE, "weight": 1.2}),
    ("sun", "light", sun, far(without=("sun_collimated", "reciprocal"))), ("sun_collimated", "light", collimated, far(without=("reciprocal",))),
    ("moon", "light", moon, far(without=("reciprocal",))),
    ("sky", "sky", sky, far(1, ONE_SKY[1:] + ("reciprocal",))), ("sky_full", "sky", sky_full, far(1.2, ONE_SKY[2:] + ("reciprocal",))),
    ("sky_table", "sky", sky_table, far(1, ONE_SKY[3:] + ("reciprocal",))),
    ("sky_thermal", "sky", sky_thermal, far(1.1, ONE_SKY[4:] + ("reciprocal",))),
    ("clear_sky", "sky", clear_sky, far(3.5, ONE_SKY[5:] + ("reciprocal", "layered_air", "thermal", "moved"))),
    ("sky_furnace", "light_furnace", sky_furnace, {"without": ("sun", "sun_collimated", "moon", "sky", "sky_full", "sky_table", "sky_thermal", "clear_sky", "night_sky", "lamp_point",
                                                              "lamp_spot", "lamp_distribution", "lamp_scheduled", "room_sphere", "room_box", "room_glows",
                                                              "profile_air", "profile_no_adjacency", "traced_air", "gases_air")}),
    ("night_sky", "light", night_sky, far(1.3, ("reciprocal", "moved", "later"))),  # stands by date: is not turned, and moves as time goes on
    ("city_glow", "detail", None, {"without": tuple(air for air in ONE_SKY if air.endswith("air") or air == "profile_no_adjacency") + ("layered_air",)}),
    ("star_catalogue", "detail", None), ("scintillation", "detail", None), ("satellites", "detail", None),
    ("lamp_point", "light", lamp("point"), NOT_FURNACE), ("lamp_spot", "light", lamp("spot"), NOT_FURNACE),
    ("lamp_distribution", "light", lamp_distribution, NOT_FURNACE), ("lamp_scheduled", "light", lamp_scheduled, {"without": ("furnace", "still_world")}),
]

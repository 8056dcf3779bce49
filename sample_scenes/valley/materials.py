"""The valley's materials: optics by the curves of head.yaml, and what their temperatures need."""
import json


def layers(*rows):
    """rows: thickness (m), density (kg/m3), specific heat (J/(kg K)), conductivity (W/(m K))"""
    keys = ("thickness_m", "density_kg_m3", "specific_heat_j_kg_k", "conductivity_w_m_k")
    return {"layers": [dict(zip(keys, row)) for row in rows]}


def matte(curve, thermal, transmittance=None, **temperature):
    out = {"model": "lambert", "reflectance": curve}
    if transmittance:
        out["transmittance"] = transmittance
    return {**out, **warm(thermal, **temperature)}


def glossy(diffuse, specular, width, thermal, **temperature):
    return {"model": "ward", "diffuse": diffuse, "specular": specular, "roughness": width, **warm(thermal, **temperature)}


def warm(thermal, **temperature):
    return {**({"thermal": thermal} if thermal else {}), "temperature": {"model": "heat", **temperature}}


GRASSY = layers((0.02, 300, 2500, 0.15), (0.8, 1700, 1200, 1.1))
EARTH = layers((0.8, 1500, 1100, 0.8))
ROAD = layers((0.12, 2240, 920, 1.2), (0.7, 1800, 900, 1.0))
WALL = layers((0.02, 1600, 850, 0.8), (0.2, 1200, 880, 0.45))
TILE = layers((0.015, 1900, 850, 0.9))
GLASS = layers((0.006, 2500, 840, 1.0))
STEEL = layers((0.01, 7800, 460, 50))
BODY = layers((0.0008, 7800, 460, 50), (0.01, 50, 1400, 0.04))
OPEN = {"convection": "mcadams", "roughness": "rough"}
ROOM = {"convection": "tarp", "roughness": "rough", "back": "air", "back_k": 294, "back_film_w_m2_k": 8}
LOFT = {"convection": "tarp", "roughness": "rough", "back": "air", "back_k": 302, "back_film_w_m2_k": 3}


def points(*pairs):
    return {"points": [list(p) for p in pairs]}


PAINTS = {"red": points((0.3, 0.03), (0.58, 0.04), (0.63, 0.35), (2.5, 0.4), (8, 0.05), (14, 0.05), (100, 0.05)),
          "blue": points((0.3, 0.12), (0.46, 0.25), (0.53, 0.06), (0.7, 0.04), (2.5, 0.3), (8, 0.05), (14, 0.05), (100, 0.05)),
          "white": points((0.3, 0.5), (0.45, 0.75), (2.5, 0.6), (8, 0.05), (14, 0.05), (100, 0.05)),
          "grey": points((0.3, 0.2), (2.5, 0.25), (8, 0.05), (14, 0.05), (100, 0.05)),
          "black": points((0.3, 0.03), (2.5, 0.04), (8, 0.05), (14, 0.05), (100, 0.05))}

MATERIALS = {
    "covered": {"map": "cover", "temperature_k": 293},
    "water": {"model": "sea", "wind_m_s": 2.5, "index": "water_index", "k": "water_k", "below": "river_below", "temperature_k": 292},
    "bed": {"model": "lambert", "reflectance": "loam", "temperature_k": 292},
    "meadow": matte("grass", GRASSY, wetness=0.4, **OPEN),
    "pasture": {**matte("grass", GRASSY, wetness=0.4, **OPEN), "maps": ["tufts"]},
    "maize": {**matte("maize_green", GRASSY, wetness=0.4, **OPEN), "maps": ["rows"]},
    "maize_leaf": matte("maize_green", GRASSY, wetness=0.4, **OPEN),
    "wheat": matte("straw", GRASSY, wetness=0.1, **OPEN),
    "soil": matte("loam", EARTH, wetness=0.1, **OPEN),
    "forest_floor": matte("undergrowth", EARTH, wetness=0.3, **OPEN),
    "rock": matte("concrete_r", EARTH, **OPEN),
    "asphalt": matte("asphalt_r", ROAD, **OPEN),
    "paving": matte("concrete_r", ROAD, **OPEN),
    "plaster_white": matte("white_r", WALL, **ROOM),
    "plaster_yellow": matte("yellow_r", WALL, **ROOM),
    "plaster_grey": matte("concrete_r", WALL, **ROOM),
    "brick": matte("brick_r", WALL, **ROOM),
    "gravel": matte("slate_r", WALL, **ROOM),
    "tile": matte("tile_r", TILE, **LOFT),
    "pane": glossy(0.03, points((0.3, 0.06), (2.5, 0.06), (8, 0.08), (9.2, 0.2), (10, 0.12), (14, 0.06), (100, 0.06)), 0.03, GLASS,
                   absorptance=0.25, **{**ROOM, "back_film_w_m2_k": 2.5}),
    "solar": {"model": "sqt", "file": "satin.sqt", "outside": "hold", **warm(GLASS, convection="tarp", back="open")},
    "steel": matte(points((0.3, 0.35), (2.5, 0.5), (8, 0.3), (14, 0.3), (100, 0.3)), STEEL, convection="mcadams"),
    "dark": matte(0.04, BODY, convection="mcadams"),
    **{"paint_" + name: glossy(curve, 0.04, 0.1, BODY, convection="mcadams") for name, curve in PAINTS.items()},
    "bark": matte("bark_r", layers((0.1, 700, 1900, 0.2)), convection="mcadams"),
    # Without heat capacity: both faces, and water that evaporates.
    "leaf": matte("leaf_r", None, "leaf_t", back="open", wetness=0.15),
    "needle": matte("needle_r", None, "needle_t", back="open", wetness=0.12)}


def text():
    return "materials:\n" + "".join("  %s: %s\n" % (name, json.dumps(keys)) for name, keys in MATERIALS.items())

"""Rows of how a thing is placed: make(draw, name, place) -> placement of object or group `name`, whose middle comes to `place`."""
import math


def turn(d):
    return d.one({"euler_deg": [d.u(-180, 180), d.u(-180, 180), d.u(-180, 180)], "order": d.one("xyz", "zyx", "yxz")},
                 {"axis": [d.u(-1, 1), d.u(-1, 1), 1], "angle_deg": d.u(-180, 180)}, {"heading_deg": d.u(0, 360)},
                 [{"heading_deg": d.u(0, 360)}, {"axis": [1, 0, 0], "angle_deg": d.u(0, 180)}])


def still(d, name, place):
    return {"place": name, "translate": place}


def rotated(d, name, place):
    return {"place": name, "rotate": turn(d), "translate": place}


def scaled(d, name, place):
    return {"place": name, "scale": d.u(0.3, 1.3), "rotate": turn(d), "translate": place}


def stretched(d, name, place):
    return {"place": name, "scale": [d.u(0.5, 1.2), d.u(0.5, 1.2), d.u(0.5, 1.2)], "rotate": turn(d), "translate": place}


def mirrored(d, name, place):
    return {"place": name, "scale": d.one([-1, 1, 1], [1, 1, -0.8], [-0.7, -1.1, -1]), "rotate": turn(d), "translate": place}


def grouped(d, name, place):
    for _ in range(d.one(1, 2, 3)):
        shift = [d.u(-5, 5), d.u(-5, 5), d.u(-5, 5)]
        name = d.world.add("groups", "deep", [{"place": name, "translate": shift}])
        place = [round(p - s, 4) for p, s in zip(place, shift)]
    return {"place": name, "translate": place}


def far_scales(d, name, place):
    """The thing as it is, by a large scale of a small one."""
    factor = d.one(1e-5, 1e-3, 1e3, 1e5)
    inner = d.world.add("groups", "deep", [{"place": name, "scale": factor}])
    return {"place": inner, "scale": 1 / factor, "translate": place}


def matrix(d, name, place):
    a, s = math.radians(d.u(0, 360)), d.u(0.5, 1.1)
    c, n = s * math.cos(a), s * math.sin(a)
    return {"place": name, "matrix": [c, -n, 0, place[0], n, c, 0, place[1], 0, 0, s, place[2]]}


def table(d, name, place):
    file = f"table{len(d.world.files)}.csv"
    away = [place[0], place[1], place[2] + 3.2]
    rows = "".join(f"{x},{y},{z},{d.u(0, 360)},{d.u(0.5, 1.1)}\n" for x, y, z in [place, away][:d.one(1, 2)])
    d.world.files[file] = ("x,y,z,heading_deg,scale\n" + rows).encode()
    return {"place": name, "table": file}


def spin(d, name, place):
    d.moving = True
    return {"place": name, "rotate": turn(d), "motion": {"kind": "spin", "position_m": place, "axis": [d.u(-1, 1), d.u(-1, 1), 1], "rate_deg_s": d.u(-200, 200)}}


def straight(d, name, place):
    d.moving = True
    return {"place": name, "scale": 0.7, "motion": {"kind": "straight", "position_m": place, "heading_deg": d.u(0, 360), "speed_m_s": d.u(0, 0.3), "t0_s": 0}}


def keyframes(d, name, place):
    d.moving = True
    keys = [{"time_s": t, "position_m": [place[0] + dx, place[1], place[2]], "heading_deg": h} for t, dx, h in ((-1000, 0, 0), (0, 0.1, 20), (2, -0.2, 80), (1000, 0, 90))]
    return {"place": name, "scale": 0.8, "motion": {"kind": "keyframes", "keys": keys}}


def appears(d, name, place):
    begin, end = d.one((-5, 5), (-5, 0.2), (0.3, 5), (50, 60))  # seconds; captures lie in 0 to 1
    d.moving = True
    return {"place": name, "rotate": turn(d), "translate": place, "appears": begin, "disappears": end}


def scheduled(d, name, place):
    d.moving = True
    other = d.material({**d.pick("model").make(d), **d.emission()})
    rows = [{"time_s": -10, "there": True}, {"time_s": 0.4, "there": True, **({"material": other} if "holds_media" not in d.__dict__ else {})}]
    return {"place": name, "rotate": turn(d), "translate": place, "schedule": {"rows": rows}}


MIDDLE = {"what": ("about_middle",)}  # what is at the thing's origin is at `place`, always
MOVES = {"without": ("still_world",)}
ROWS = [
    ("still", "placing", still, {"weight": 2, **MIDDLE}), ("rotated", "placing", rotated, {"weight": 1.5, **MIDDLE}), ("scaled", "placing", scaled, MIDDLE),
    ("stretched", "placing", stretched, MIDDLE), ("mirrored", "placing", mirrored, MIDDLE), ("grouped", "placing", grouped, MIDDLE), ("far_scales", "placing", far_scales, MIDDLE),
    ("matrix", "placing", matrix, MIDDLE), ("table", "placing", table), ("spin", "placing", spin, {**MOVES, **MIDDLE}), ("straight", "placing", straight, MOVES),
    ("keyframes", "placing", keyframes, MOVES), ("appears", "placing", appears, MOVES), ("scheduled", "placing", scheduled, MOVES),
]

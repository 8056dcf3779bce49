"""Relations of sensors and of runs: other sensors in the same place, lamp and receiver swapped, the same run in other ways."""
import filecmp
import glob
import math
import os
import shutil


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(v):
    length = math.sqrt(sum(c * c for c in v))
    return [c / length for c in v]


def quaternion(x, y, z):
    """Of the rotation whose columns are x, y, z."""
    m = [[x[i], y[i], z[i]] for i in range(3)]
    best = max(range(4), key=lambda k: [m[0][0] + m[1][1] + m[2][2], m[0][0], m[1][1], m[2][2]][k])
    if best == 0:
        w = math.sqrt(1 + m[0][0] + m[1][1] + m[2][2]) / 2
        return [w, (m[2][1] - m[1][2]) / (4 * w), (m[0][2] - m[2][0]) / (4 * w), (m[1][0] - m[0][1]) / (4 * w)]
    i = best - 1
    j, k = (i + 1) % 3, (i + 2) % 3
    s = 2 * math.sqrt(1 + m[i][i] - m[j][j] - m[k][k])
    q = [(m[k][j] - m[j][k]) / s, 0, 0, 0]
    q[1 + i], q[1 + j], q[1 + k] = s / 4, (m[i][j] + m[j][i]) / s, (m[i][k] + m[k][i]) / s
    return q


def platform_of(camera):
    """A platform at rest with the framing camera's view."""
    view = unit([b - a for a, b in zip(camera["position_m"], camera["look_at_m"])])
    right = unit(cross(view, [0, 0, 1]))
    motion = {"kind": "static", "position_m": camera["position_m"], "quaternion": quaternion(right, cross(right, view), [-c for c in view])}
    array = {k: camera[k] for k in ("columns", "rows", "pitch_um", "bands", "paths", "spectral_error")}
    array["integration_time_s"] = camera.get("integration_time_s", 0)
    return {"kind": "platform", "name": camera["name"], "truth": [], "motion": motion, "tasks": [{"start": camera.get("time_s", 0)}],
            "instruments": [{"focal_length_mm": camera["focal_length_mm"], "arrays": [array]}]}


def other_sensor(world, rng):
    """-> world, partner, note, names; or None."""
    partner = world.copy()
    cameras = [s for s in world.sim["sensors"] if s["kind"] in ("frame_camera", "orthographic")]
    if not cameras:
        return None
    camera = cameras[0]
    if camera["kind"] == "frame_camera" and rng.random() < 0.5:
        partner.sim["sensors"] = [platform_of(camera)]
        world.sim["sensors"] = [camera]
        return world, partner, "framing camera and platform", {}
    keys = {k: camera[k] for k in ("name", "bands", "spectral_error", "truth", "time_s", "integration_time_s") if k in camera}
    paths = camera["paths"] * 32
    aside = [0.0123, 0.0171, 0]  # a camera that looks at a round number sees both sides of a map's step in one pixel, the point one
    if camera["kind"] == "frame_camera":
        target = [c + a for c, a in zip(camera["look_at_m"], aside)]
        place, look = camera["position_m"], unit([b - a for a, b in zip(camera["position_m"], target)])
        one = {**camera, "look_at_m": target, "columns": 1, "rows": 1, "pitch_um": 0.1, "focal_length_mm": min(max(1000, 100 * math.dist(place, target)), 1e6), "paths": paths}
    else:
        place, look = [*camera["center_m"], camera["height_m"]], [0, 0, -1]
        one = {**camera, "columns": 1, "rows": 1, "gsd_m": 1e-5, "paths": paths}
    world.sim["sensors"] = [one]
    partner.sim["sensors"] = [{**keys, "kind": "point", "paths": paths, "collectors": [{"name": "p", "quantity": "radiance", "position_m": place, "look": look}]}]
    return world, partner, f"a pixel of {camera['kind']} and a point", {}


FREE = ([0.0, 0.0, 3.3], [0.05, 3.4, 1.2], [-3.35, -0.05, 0.4], [3.4, -3.4, 2.5], [0.1, 0.0, 5.5])


def swapped(world, rng):
    """Lamp and receiver, and the other way round, without any other light."""
    a, b = rng.sample(FREE, 2)
    made = []
    for lamp, receiver in ((a, b), (b, a)):
        w = world.copy()
        for piece in [*w.scene["materials"].values(), *w.scene["media"].values()]:  # what is warm shines as well; water always, so the lamp is bright
            for key in ("temperature_k", "temperature", "thermal"):
                piece.pop(key, None)
            piece["maps"] = [m for m in piece.get("maps", []) if w.scene["maps"][m]["type"] != "temperature"]
            if not piece["maps"]:
                del piece["maps"]
        for key in ("sun", "moon", "sky", "night_sky"):
            w.sim.pop(key, None)
        keys = {k: w.sim["sensors"][0][k] for k in ("bands", "spectral_error", "truth") if k in w.sim["sensors"][0]}
        if not keys.get("bands"):
            keys = {**{k: w.sim["sensors"][0]["instruments"][0]["arrays"][0][k] for k in ("bands", "spectral_error")}, "truth": []}
        w.sim["lamps"] = [{"kind": "point", "position_m": lamp, "intensity": 1e6}]
        w.sim["sensors"] = [{"kind": "point", "name": "flux", "paths": 128 * world.facts["paths"], **keys,
                             "collectors": [{"name": "e", "quantity": "actinic_flux", "position_m": receiver}]}]
        made.append(w)
    return made


def differs(a, b):
    """Names of images that are not the same bytes in two folders."""
    names = [os.path.basename(p) for p in sorted(glob.glob(a + "/*.img"))]
    return [n for n in names if not os.path.exists(os.path.join(b, n)) or not filecmp.cmp(os.path.join(a, n), os.path.join(b, n), False)]


def bytes_differ(programs, world, folder, seed, what):
    """Runs the world in two ways. -> what differs, or ''."""
    programs.prepare(world, folder)
    render, run = [programs.tool("dirsig-render"), "sim.yaml", "-q", "--seed", str(seed)], programs.run
    run(render + ["-o", "a", "-j", "1"], folder)
    if what == "threads":
        run(render + ["-o", "b", "-j", "3"], folder)
    elif what == "memory":
        run(render + ["-o", "b", "-j", "1", "--memory", "1MiB", "--cache-memory", "1MiB"], folder)
    elif what == "parts":
        for k in (1, 2):
            run(render + ["-o", f"p{k}", "-j", "1", "--part", f"{k}/2", "--state"], folder)
        run(render + ["-o", "b", "-j", "1", "--merge", "p1", "p2"], folder)
    elif what == "more":
        run(render + ["-o", "a", "-j", "1", "--paths", "64"], folder)
        run(render + ["-o", "b", "-j", "1", "--paths", "32", "--state"], folder)
        run(render + ["-o", "b", "-j", "1", "--state", "--more", "32"], folder)
    elif what == "ranks" and shutil.which("mpirun"):
        mpi = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", "2"]
        run(mpi + render + ["-o", "b", "-j", "1"], folder)
    else:
        return ""
    wrong = differs(os.path.join(folder, "a"), os.path.join(folder, "b"))
    return f"{what}: {', '.join(wrong)}" if wrong else ""

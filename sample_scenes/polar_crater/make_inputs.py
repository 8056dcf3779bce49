#!/usr/bin/env python3
"""Makes crater.obj, a bowl (a cap of a sphere of 100 m) in level ground, and space.csv, weather without any air."""
import math

RADIUS, RIM = 100.0, 2 * math.atan(0.4)  # m; rad from the axis: a depth of a fifth of the diameter
RINGS, TURNS, OUTER = 24, 72, 250.0

corners, faces = [], []
for i in range(RINGS + 1):
    a = RIM * i / RINGS
    for j in range(TURNS):
        t = 2 * math.pi * j / TURNS
        corners.append((RADIUS * math.sin(a) * math.cos(t), RADIUS * math.sin(a) * math.sin(t),
                        RADIUS * (math.cos(RIM) - math.cos(a))))
for j in range(TURNS):
    t = 2 * math.pi * j / TURNS
    corners.append((OUTER * math.cos(t), OUTER * math.sin(t), 0.0))
for i in range(RINGS + 1):
    for j in range(TURNS):
        p, q = i * TURNS + j + 1, i * TURNS + (j + 1) % TURNS + 1
        faces.append((p + TURNS, q + TURNS, q))
        if i > 0:
            faces.append((p + TURNS, q, p))
with open("crater.obj", "w") as out:
    out.write("o crater\nusemtl regolith\n")
    out.writelines("v %.4f %.4f %.4f\n" % c for c in corners)
    out.writelines("f %d %d %d\n" % f for f in faces)

# The sun as it shines above the air; nothing else, and nothing to breathe.
with open("space.csv", "w") as out:
    out.write("site: 88 0 0\ntime_utc, air_temperature [K], pressure [Pa], wind_speed [m/s], direct_normal instant [W/m2], "
              "diffuse instant [W/m2], longwave_down [W/m2]\n")
    for day in range(26, 31):
        out.write("2020-03-%02dT00:00Z, 200, 0, 0, 1361, 0, 0\n" % day)

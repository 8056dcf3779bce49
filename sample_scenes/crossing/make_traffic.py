#!/usr/bin/env python3
"""Writes traffic.xml, a minute of traffic at a crossing with lights, as SUMO's floating car data: make_traffic.py [FOLDER]

Cars follow the one before them (the "intelligent driver" of Treiber, Hennecke & Helbing 2000) and stop at red; some turn right.
People walk over the zebra crossings while the cars that could meet them wait. A minute runs before the first record, so that
the streets are not empty. The network's (0, 0) lies 110 m west and south of the crossing. Python 3, standard library only.
"""
import math
import os
import random
import sys

folder = sys.argv[1] if len(sys.argv) > 1 else "."
random.seed(5)

HALF, STOP, TURN = 110.0, 100.5, 4.0  # m: half the network, way to the stop line, radius of a right turn
STEP, RECORD = 0.1, 5                 # s, and steps a record
LENGTH = {"red_car": 4.5, "white_car": 4.5, "blue_car": 4.5, "van": 6.0, "bus": 11.0}
NAMES = ["northbound", "eastbound", "southbound", "westbound"]


def open_to(way, t):
    """The lights: north and south from 0 to 26 s of every minute, east and west from 30 to 56 s."""
    return (t - 30 * (way % 2)) % 60 < 26


class Vehicle:
    def __init__(self, name, kind, way):
        self.name, self.kind, self.way = name, kind, way
        self.s, self.v, self.turns = 0.0, 11.0, kind != "bus" and random.random() < 0.3

    def end(self):
        return 2 * HALF if not self.turns else 2 * (HALF - 2 - TURN) + math.pi / 2 * TURN

    def place(self):
        """-> x, y, compass heading of the front bumper."""
        before = HALF - 2 - TURN
        if not self.turns or self.s < before:
            x, y, turned = 2.0, self.s - HALF, 0.0
        elif self.s < before + math.pi / 2 * TURN:
            a = (self.s - before) / TURN
            x, y, turned = 2 + TURN - TURN * math.cos(a), before - HALF + TURN * math.sin(a), math.degrees(a)
        else:
            x, y, turned = 2 + TURN + self.s - before - math.pi / 2 * TURN, -2.0, 90.0
        for _ in range(self.way):
            x, y = y, -x
        return x, y, (turned + 90 * self.way) % 360

    def drive(self, gap, closing):
        wanted = 5.0 if self.turns and HALF - 25 < self.s < HALF + 5 else 12.0
        room = 2 + max(0, self.v * 1.2 + self.v * closing / (2 * math.sqrt(1.5 * 2.5)))
        a = 1.5 * (1 - (self.v / wanted) ** 4 - (room / max(gap, 0.3)) ** 2)
        self.v = max(0.0, self.v + STEP * max(a, -6.0))
        self.s += STEP * self.v


lanes, due, made = [[] for _ in NAMES], [random.uniform(0, 4) for _ in NAMES], 0
people = [(f"walker_{k}", k % 2, 30 * (k % 2) + random.uniform(1, 4), random.choice((-1, 1)), random.uniform(1.2, 1.6),
           random.uniform(-0.8, 0.8)) for k in range(8)]
with open(os.path.join(folder, "traffic.xml"), "w") as out:
    out.write('<?xml version="1.0" encoding="UTF-8"?>\n<!-- Written by make_traffic.py. -->\n<fcd-export>\n')
    for step in range(-600, 626):
        t = step * STEP
        for way, lane in enumerate(lanes):
            if t + 60 > due[way] and (not lane or lane[-1].s > 25):
                made += 1
                kind = random.choices(list(LENGTH), (3, 4, 3, 2, 1))[0]
                lane.append(Vehicle(f"{NAMES[way]}_{made}", kind, way))
                due[way] = t + 60 + random.expovariate(1 / 5.5)
            for k, car in enumerate(lane):
                gap, closing = 1e3, 0.0
                if k:
                    gap, closing = lane[k - 1].s - LENGTH[lane[k - 1].kind] - car.s, car.v - lane[k - 1].v
                ahead = STOP - car.s
                if not open_to(way, t) and ahead > car.v ** 2 / 8 and ahead + 2 < gap:
                    gap, closing = ahead + 1.5, car.v
                car.drive(gap, closing)
            lanes[way] = [car for car in lane if car.s < car.end()]
        if step < 0 or step % RECORD:
            continue
        out.write(f'    <timestep time="{t:.2f}">\n')
        for car in (car for lane in lanes for car in lane):
            x, y, angle = car.place()
            out.write(f'        <vehicle id="{car.name}" x="{x + HALF:.3f}" y="{y + HALF:.3f}" angle="{angle:.3f}" type="{car.kind}" '
                      f'speed="{car.v:.2f}"/>\n')
        for name, leg, begin, side, speed, off in people:
            along = -10 + speed * (t - begin)
            if -10 <= along <= 10:
                # Over the western and the eastern leg while north and south drive, over the others while east and west do.
                x, y, angle = (side * 6.5 + off, along, 0) if leg == 0 else (along, side * 6.5 + off, 90)
                out.write(f'        <person id="{name}" x="{x + HALF:.3f}" y="{y + HALF:.3f}" angle="{angle:.3f}" speed="{speed:.2f}"/>\n')
        out.write("    </timestep>\n")
    out.write("</fcd-export>\n")

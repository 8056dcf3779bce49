#!/usr/bin/env python3
"""Does judge.py flag an error of the size that it states, and nothing else? Pictures are drawn here, no program runs."""
import math
import os
import random
import sys
import tempfile
import unittest
from unittest import mock

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))
import judge  # noqa: E402
import programs  # noqa: E402
from programs import Picture  # noqa: E402
from relations import Case  # noqa: E402

PIXELS, SCRAMBLES = 24, 13


def picture(rng, mean, spread, told=1.0, tail=False):
    """Pixels of a mean, each with 13 normal samples (or rare events) and the standard error that follows from them, times told."""
    values, errors = [], []
    for _ in range(PIXELS):
        samples = [mean * (rng.expovariate(0.05) if rng.random() < 0.05 else 0) if tail else rng.gauss(mean, spread * math.sqrt(SCRAMBLES)) for _ in range(SCRAMBLES)]
        m = sum(samples) / SCRAMBLES
        values.append(m)
        errors.append(told * math.sqrt(sum((s - m) ** 2 for s in samples) / (SCRAMBLES - 1) / SCRAMBLES))
    return {"frame": Picture([values], [errors], SCRAMBLES - 1.0)}


CASE = Case([(1, None), (-1, None)])


def pair(rng, error=0.0, pixel=None, **keys):
    a, b = picture(rng, 1.0, 0.02, **keys), picture(rng, 1.0, 0.02, **keys)
    v = a["frame"].values[0]
    for i in range(PIXELS) if pixel is None else [pixel]:
        v[i] += error
    return [a, b]


def shares(trials, error=0.0, bound=judge.SCREEN, **keys):
    """Share of trials that screening takes for suspicious, and mean of what it says that it sees."""
    flagged, seen = 0, 0.0
    for seed in range(trials):
        found = judge.screen(CASE, pair(random.Random(seed), error, **keys))
        flagged += found.p <= bound
        seen += found.seen / trials
    return flagged / trials, seen


class Judging(unittest.TestCase):
    def test_screening_flags_as_often_as_it_says_without_error(self):
        share, _ = shares(1500)
        self.assertLess(abs(share - judge.SCREEN), 3.3 * math.sqrt(judge.SCREEN / 1500))

    def test_screening_sees_the_error_that_it_states_nine_times_in_ten(self):
        _, seen = shares(20)
        share, _ = shares(400, error=seen)
        self.assertGreater(share, 0.86)
        self.assertLess(share, 0.97)
        share, _ = shares(200, error=seen / 4)
        self.assertLess(share, 0.2)

    def test_an_error_in_one_pixel_is_seen(self):
        share, _ = shares(100, error=0.2, pixel=7)
        self.assertGreater(share, 0.95)

    def test_seeds_alone_give_no_alarm_where_reported_errors_are_too_small(self):
        for seed in range(40):
            rng = random.Random(seed)
            found = judge.by_seeds(CASE, [pair(rng, told=0.2) for _ in range(judge.RETEST_SEEDS)])
            self.assertGreater(found.p, judge.FINAL)

    def test_seeds_alone_give_no_alarm_for_rare_events(self):
        for seed in range(40):
            rng = random.Random(seed)
            found = judge.by_seeds(CASE, [pair(rng, tail=True) for _ in range(judge.FINAL_SEEDS)])
            self.assertGreater(found.p, judge.FINAL)

    def test_seeds_alone_see_an_error(self):
        rng = random.Random(1)
        found = judge.by_seeds(CASE, [pair(rng, error=0.02) for _ in range(judge.FINAL_SEEDS)])
        self.assertLess(found.p, judge.FINAL)
        self.assertIn("mean", found.where)
        self.assertAlmostEqual(found.size, 0.02, delta=0.004)

    def test_no_noise_is_judged_by_the_tolerance(self):
        same = {"frame": Picture([[1.0] * PIXELS], [[0.0] * PIXELS], 12.0)}
        near = {"frame": Picture([[1 + judge.TOLERANCE / 2] * PIXELS], [[0.0] * PIXELS], 12.0)}
        far = {"frame": Picture([[1 + 20 * judge.TOLERANCE] * PIXELS], [[0.0] * PIXELS], 12.0)}
        self.assertEqual(judge.screen(CASE, [same, same]).p, 1.0)
        self.assertGreater(judge.screen(CASE, [same, near]).p, judge.SCREEN)
        self.assertLess(judge.screen(CASE, [same, far]).p, 1e-9)

    def test_what_is_not_a_number_fails(self):
        a, b = pair(random.Random(1))
        a["frame"].values[0][3] = math.nan
        self.assertEqual(judge.screen(CASE, [a, b]).p, 0.0)


class TimeLimit(unittest.TestCase):
    """Of programs: their own CPU time counts, not what the clock runs while others have the processor."""

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = scratch.name
        self.programs = programs.Programs(scratch.name, scratch.name)
        limit = mock.patch.object(programs, "TIMEOUT_S", 1)
        limit.start()
        self.addCleanup(limit.stop)

    def python(self, text):
        return self.programs.run([sys.executable, "-c", text], self.folder)

    def test_who_waits_longer_than_that_ends(self):
        self.assertEqual(self.python("import time; time.sleep(1.5); print('done')"), "done\n")

    def test_who_computes_longer_than_that_does_not(self):
        with self.assertRaisesRegex(programs.Refused, "no end after 1 s of CPU"):
            self.python("while True: pass")


if __name__ == "__main__":
    unittest.main()

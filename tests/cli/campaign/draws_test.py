"""Draws: distributions by chi-square over 10,000 draws each (significance 1e-5, fixed seeds) with a negative control; what they may depend on."""
import itertools
import math
import unittest
from collections import Counter
from statistics import NormalDist

import numpy as np
from kit import Case, chi_square, chi_square_bound
from remote_scenes.campaign import draws
from remote_scenes.campaign.regions import Polygons, Roads, Slots
from remote_scenes.campaign.distributions import read_rule
from remote_scenes.campaign.objects import Group, Item
from remote_scenes.campaign.pairs import Pair, place_later
from remote_scenes.campaign.placement import place_all
from remote_scenes.campaign.text import CampaignError, Node, read_text
from remote_scenes.campaign.things import placed_scene
from remote_scenes.campaign.variables import Draw, Variables, read_variables

N = 10_000
CELLS = 25


def uneven(count, cells):
    """What a control expects: the first cell of even ones 30 % more often."""
    return [count * (1.3 if i == 0 else 1) / (cells + 0.3) for i in range(cells)]


class Distributions(Case):
    def drawn(self, text, name="x", count=N, seed=5):
        (self.folder / "v.yaml").write_text(text)
        variables = read_variables(read_text(self.folder / "v.yaml"))
        return [variables.values(seed, i, count)[name] for i in range(count)]

    def held(self, values, cumulative):
        """chi-square of values against a cumulative distribution, in cells of even probability."""
        counts = Counter(min(CELLS - 1, int(CELLS * cumulative(v))) for v in values)
        return chi_square([counts[i] for i in range(CELLS)], [len(values) / CELLS] * CELLS)

    def test_continuous_kinds(self):
        cut = NormalDist(3, 2)
        low, high = cut.cdf(1), cut.cdf(4)
        kinds = {"uniform: [-2, 6]": lambda v: (v + 2) / 8, "normal: [3, 2]": cut.cdf,
                 "normal: [3, 2], within: [1, 4]": lambda v: (cut.cdf(v) - low) / (high - low),
                 "log_uniform: [0.01, 10]": lambda v: math.log(v / 0.01) / math.log(1000)}
        for kind, cumulative in kinds.items():
            values = self.drawn(f"x: {{{kind}}}")
            self.assertLess(self.held(values, cumulative), chi_square_bound(CELLS), kind)
            # The negative control: draws that lie 3 % of the range too high.
            self.assertGreater(self.held(values, lambda v: min(1, cumulative(v) ** 1.1)), chi_square_bound(CELLS), kind)

    def test_points_that_fill_the_range_evenly(self):
        for how in ("latin", "sobol"):
            values = self.drawn(f"x: {{uniform: [0, 1], draw: {how}}}")
            counts = Counter(int(CELLS * v) for v in values)
            self.assertLess(chi_square([counts[i] for i in range(CELLS)], [N / CELLS] * CELLS), 1, how)
            random = Counter(int(CELLS * v) for v in self.drawn("x: {uniform: [0, 1]}"))
            self.assertGreater(chi_square([random[i] for i in range(CELLS)], [N / CELLS] * CELLS), 1)
        self.assertEqual(sorted(int(500 * v) for v in self.drawn("x: {uniform: [0, 1], draw: latin}", count=500)), list(range(500)))
        for dimension in range(draws.SOBOL_DIMENSIONS):
            self.assertEqual(sorted(int(256 * draws.sobol(i, dimension, "s")) for i in range(256)), list(range(256)))
        # The first four dimensions in pairs: as many points in every cell of 8 x 8.
        for a, b in itertools.combinations(range(4), 2):
            cells = Counter((int(8 * draws.sobol(i, a, 1)), int(8 * draws.sobol(i, b, 1))) for i in range(256))
            self.assertEqual(set(cells.values()), {4}, (a, b))

    def test_two_variables_are_independent(self):
        for how in ("random", "latin", "sobol"):
            text = f"x: {{uniform: [0, 5], draw: {how}}}\ny: {{uniform: [0, 5], draw: {how}}}\nboth: [$x, $y]"
            cells = Counter((int(x), int(y)) for x, y in self.drawn(text, "both"))
            counts = [cells[i, j] for i in range(5) for j in range(5)]
            self.assertLess(chi_square(counts, [N / 25] * 25), chi_square_bound(25), how)
        same = Counter((int(x), int(y)) for x, y in self.drawn("x: {uniform: [0, 5]}\nboth: [$x, $x]", "both"))
        self.assertGreater(chi_square([same[i, j] for i in range(5) for j in range(5)], [N / 25] * 25), chi_square_bound(25))

    def test_counted_kinds(self):
        weights = [3, 1, 0, 2]
        values = Counter(self.drawn("x: {choice: [a, b, c, d], weights: [3, 1, 0, 2]}"))
        self.assertEqual(values["c"], 0)
        counts = [values[k] for k in "abd"]
        self.assertLess(chi_square(counts, [N * w / 6 for w in weights if w]), chi_square_bound(3))
        self.assertGreater(chi_square(counts, [N / 3] * 3), chi_square_bound(3))
        whole = Counter(self.drawn("x: {integers: [-2, 4]}"))
        self.assertEqual(sorted(whole), list(range(-2, 5)))
        self.assertLess(chi_square(whole.values(), [N / 7] * 7), chi_square_bound(7))
        self.assertGreater(chi_square(whole.values(), uneven(N, 7)), chi_square_bound(7))
        dates = self.drawn("x: {uniform: [2026-06-21T06:00:00Z, 2026-06-21T11:59:59Z]}")
        hours = Counter(d[11:13] for d in dates)
        self.assertEqual(sorted(hours), ["06", "07", "08", "09", "10", "11"])
        self.assertLess(chi_square(hours.values(), [N / 6] * 6), chi_square_bound(6))
        self.assertGreater(chi_square(hours.values(), uneven(N, 6)), chi_square_bound(6))

    def test_grid_and_zip(self):
        text = "a: {grid: [1, 2, 3]}\nb: {zip: [u, v]}\nc: {zip: [U, V]}\nall: [$a, $b, $c]"
        values = self.drawn(text, "all", count=12)
        self.assertEqual(values[:4], [[1, "u", "U"], [2, "u", "U"], [3, "u", "U"], [1, "v", "V"]])
        self.assertEqual(set(Counter(map(tuple, values)).values()), {2})
        self.assertEqual(len(set(map(tuple, values))), 6)
        # Of 10,000 samples as many in each cell of the factorial as can be, which random draws (the control) do not give.
        for drawn, is_even in ((text, True), ("a: {choice: [1, 2, 3]}\nb: {choice: [u, v]}\nall: [$a, $b]", False)):
            cells = Counter(map(tuple, self.drawn(drawn, "all")))
            self.assertEqual((len(cells), chi_square(cells.values(), [N / 6] * 6) < 0.01), (6, is_even))

    def test_conditional(self):
        text = "k: {choice: [low, high], weights: [1, 3]}\nx: {by: k, cases: {low: {uniform: [0, 1]}, high: {uniform: [$edge, 3]}}}\nedge: 2\nboth: [$k, $x]"
        values = self.drawn(text, "both")
        for case, low, share in (("low", 0, 0.25), ("high", 2, 0.75)):
            mine = [x - low for k, x in values if k == case]
            self.assertLess(chi_square([len(mine), N - len(mine)], [N * share, N * (1 - share)]), chi_square_bound(2))
            self.assertLess(self.held(mine, lambda v: v), chi_square_bound(CELLS))
            # The control: as if both cases came as often, and large values more often.
            self.assertGreater(chi_square([len(mine), N - len(mine)], [N / 2] * 2), chi_square_bound(2))
            self.assertGreater(self.held(mine, lambda v: v ** 1.3), chi_square_bound(CELLS))

    def test_mixtures_of_spectra(self):
        """Shares of a Dirichlet distribution: each has a beta distribution, of which these have closed forms."""
        kinds = {"mixture: [0, 1]": lambda v: v,  # beta(1, 1)
                 "mixture: [0, 1], shares: [3, 1], concentration: 4": lambda v: 1 - (1 - v) ** 3,  # beta(1, 3)
                 "mixture: [0, 1], concentration: 1": lambda v: 2 / math.pi * math.asin(v ** 0.5),  # beta(1/2, 1/2)
                 "mixture: [0, 0, 1]": lambda v: 1 - (1 - v) ** 2}  # beta(1, 2)
        for kind, cumulative in kinds.items():
            values = self.drawn(f"x: {{{kind}}}")
            self.assertLess(self.held(values, cumulative), chi_square_bound(CELLS), kind)
            self.assertGreater(self.held(values, lambda v: cumulative(v) ** 1.1), chi_square_bound(CELLS), kind)
        # Of curves: all have the same share everywhere, at all wavelengths that any has within those that all have.
        (self.folder / "wet.csv").write_text("wavelength nm, wet, dry\n400, 0.1, 0.2\n600, 0.3, 0.6\n")
        curves = "[{wavelength_um: [0.45, 0.5, 0.7], value: [0.9, 0.8, 0.4]}, {file: wet.csv, column: 2}, 0.5]"
        for drawn in self.drawn(f"x: {{mixture: {curves}, shares: [1, 2, 1], outside: hold}}", count=50):
            self.assertEqual((drawn["wavelength_um"], drawn["outside"]), ([0.45, 0.5, 0.6], "hold"))
            ends = [[0.9, 0.3, 0.5], [0.8, 0.4, 0.5], [0.6, 0.6, 0.5]]
            shares = np.linalg.solve(np.array([*ends[:2], [1, 1, 1]]), [*drawn["value"][:2], 1])
            self.assertTrue((shares > -1e-5).all())
            self.assertAlmostEqual(drawn["value"][2], shares @ ends[2], places=5)

    def test_variability_within_a_class(self):
        """Each wavelength is normal with the mean and the variance of the spectra, and so is a difference of two."""
        spectra = [[0.31, 0.52, 0.40], [0.35, 0.58, 0.47], [0.28, 0.47, 0.39], [0.33, 0.56, 0.41]]
        (self.folder / "grass.csv").write_text("um a b c d\n" + "".join(
            f"{w} " + " ".join(str(s[i]) for s in spectra) + "\n" for i, w in enumerate((0.5, 0.8, 1.6))))
        values = np.array([v["value"] for v in self.drawn("x: {variability: grass.csv}")])
        for weights in ([1, 0, 0], [0, 1, 0], [0, -1, 1], [1, 1, 1]):
            truth = np.array(spectra) @ weights
            law = NormalDist(truth.mean(), truth.std(ddof=1))
            self.assertLess(self.held(values @ weights, law.cdf), chi_square_bound(CELLS), weights)
            wide = NormalDist(truth.mean(), 1.1 * truth.std(ddof=1))
            self.assertGreater(self.held(values @ weights, wide.cdf), chi_square_bound(CELLS), weights)
        # The control: as if the wavelengths were independent.
        apart = NormalDist((np.array(spectra) @ [0, -1, 1]).mean(), np.hypot(*np.array(spectra)[:, 1:].std(axis=0, ddof=1)))
        self.assertGreater(self.held(values @ [0, -1, 1], apart.cdf), chi_square_bound(CELLS))
        cut = [v["value"] for v in self.drawn("x: {variability: grass.csv, deviation: 9, within: [0.2, 0.5]}", count=200)]
        self.assertEqual((np.min(cut), np.max(cut)), (0.2, 0.5))

    def test_a_new_variable_changes_no_other(self):
        before = self.drawn("x: {uniform: [0, 1]}\ny: {normal: [0, 1], draw: latin}\nb: [$x, $y]", "b", 50)
        after = self.drawn("new: {uniform: [0, 1]}\ny: {normal: [0, 1], draw: latin}\nx: {uniform: [0, 1]}\nb: [$x, $y]", "b", 50)
        self.assertEqual(before, after)
        self.assertNotEqual(before, self.drawn("x: {uniform: [0, 1]}\ny: {normal: [0, 1], draw: latin}\nb: [$x, $y]", "b", 50, seed=6))

    def test_permutations(self):
        for count in (1, 2, 3, 17, 1000):
            self.assertEqual(sorted(draws.shuffled(i, count, "p") for i in range(count)), list(range(count)))
        large = (1 << 16) + 1  # by another way than small ones
        self.assertEqual(len({draws.shuffled(i, large, "p") for i in range(large - 500, large)} & set(range(large))), 500)
        moved = Counter(8 * draws.shuffled(i, large, "q") // large for i in range(2000))
        self.assertLess(chi_square(moved.values(), [250] * 8), chi_square_bound(8))
        firsts = Counter(draws.shuffled(0, 8, seed) for seed in range(N))
        self.assertLess(chi_square(firsts.values(), [N / 8] * 8), chi_square_bound(8))


class Places(unittest.TestCase):
    def test_polygons_are_filled_evenly(self):
        """An L of three squares, with a hole in none: as many places in each."""
        shape = Polygons((((0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)),))
        found = [shape.place(0, lambda name, i=i: draws.unit(i, name)) for i in range(N)]
        cells = Counter((int(x), int(y)) for x, y, _ in filter(None, found))
        self.assertEqual(sorted(cells), [(0, 0), (0, 1), (1, 0)])
        there = sum(cells.values())
        self.assertLess(chi_square(cells.values(), [there / 3] * 3), chi_square_bound(3))
        self.assertGreater(chi_square(cells.values(), uneven(there, 3)), chi_square_bound(3))
        self.assertTrue(shape.holds_all([(0.1, 0.1), (0.9, 0.1), (0.9, 0.9), (0.1, 0.9)]))
        # All corners are inside, the notch is not.
        self.assertFalse(shape.holds_all([(1.9, 0.9), (0.9, 1.9), (0.1, 1.1), (1.1, 0.1)]))

    def test_roads_are_filled_by_length_and_headings_follow(self):
        roads = Roads((((0, 0), (0, 30)), ((0, 50), (10, 50))), 6, 1.5)
        found = [roads.place(0, lambda name, i=i: draws.unit(i, name)) for i in range(N)]
        cells = Counter(round(h) for _, _, h in found)
        # North and south three times as often as east and west.
        self.assertLess(chi_square([cells[k] for k in (0, 180, 90, 270)], [N * s / 8 for s in (3, 3, 1, 1)]), chi_square_bound(4))
        self.assertGreater(chi_square([cells[k] for k in (0, 180, 90, 270)], [N / 4] * 4), chi_square_bound(4))
        for x, y, heading in found[:200]:
            side = {0: x, 180: -x, 90: 50 - y, 270: y - 50}[round(heading)]
            self.assertAlmostEqual(side, 1.5)  # on the right of the way that is headed

    def test_slots_are_taken_once(self):
        slots = Slots(tuple((float(i), 0.0, 0.0) for i in range(12)))
        self.assertEqual(sorted(slots.place(i, lambda name: 0.3)[0] for i in range(12)), list(range(12)))
        self.assertIsNone(slots.place(12, lambda name: 0.3))

    def test_every_object_draws_a_material_of_its_own(self):
        rule = read_rule(Node({"material": Node({"model": Node("lambert", "c", 1, 1), "reflectance": Node({"uniform": Node(
            [Node(0.2, "c", 1, 1), Node(0.4, "c", 1, 1)], "c", 1, 1)}, "c", 1, 1)}, "c", 1, 1)}, "c", 1, 1), "materials.paint")
        self.assertEqual(rule.ends, ({"model": "lambert", "reflectance": 0.2}, {"model": "lambert", "reflectance": 0.2}, {"model": "lambert", "reflectance": 0.4}))
        placed = self.placed(4, tuple((9.0 * i, 0.0, 0.0) for i in range(9)), materials={"paint": rule})
        drawn = [p.materials["paint"]["reflectance"] for p in placed]
        self.assertEqual(len(set(drawn)), 4)
        self.assertTrue(all(0.2 < v < 0.4 for v in drawn))
        scene = {"scene": 1, "materials": {"paint": {"model": "lambert", "reflectance": 0.5}}, "objects": {"car": {"box": {}, "material": "paint"}}, "world": []}
        whole = placed_scene(scene, placed)
        self.assertEqual(sorted(m["reflectance"] for m in whole["materials"].values()), sorted(drawn))
        self.assertEqual([whole["materials"][whole["objects"][w["place"]]["material"]]["reflectance"] for w in whole["world"]], drawn)

    def test_pairs_leave_and_arrive_as_often_as_is_said(self):
        slots = tuple((9.0 * i, 0.0, 0.0) for i in range(40))
        group = self.group(20, slots)
        left = came = 0
        for sample in range(100):
            draw = Draw(Variables({}, (), {}, {}), 1, sample, 100)
            bounds, ground = (lambda place: ((-1, -2, 0), (1, 2, 1))), (lambda on, x, y: 0.0)
            first = place_all([group], draw, bounds, ground)
            later = place_later([group], draw, bounds, ground, first, Pair(frozenset(), 0.3, 0.15))
            stay = {p.tag for p in first} & {p.tag for p in later}
            left, came = left + 20 - len(stay), came + len(later) - len(stay)
            self.assertEqual(len({p.position_m for p in later}), len(later))
        for count, share in ((left, 0.3), (came, 0.15)):
            self.assertLess(chi_square([count, 2000 - count], [2000 * share, 2000 * (1 - share)]), chi_square_bound(2))
            self.assertGreater(chi_square([count, 2000 - count], [2000 * share * 1.4, 2000 * (1 - share * 1.4)]), chi_square_bound(2))

    def group(self, count, places, spacing=0.0, materials={}):
        number = lambda value: read_rule(Node(value, "c.yaml", 3, 1), "n")
        item = Item("car", "car", "car", 1, materials, None, Node({}, "c.yaml", 4, 1))
        return Group("g", (item,), number(count), Slots(places), None, spacing, True, number(0), None, 9, Node({}, "c.yaml", 5, 1))

    def placed(self, count, places, spacing=0.0, materials={}):
        group = self.group(count, places, spacing, materials)
        draw = Draw(Variables({}, (), {}, {}), 1, 0, 1)
        return place_all([group], draw, lambda place: ((-1, -2, 0), (1, 2, 1)), lambda on, x, y: 0.0)

    def test_slots_without_room_are_left_out(self):
        """Eight slots a metre apart hold things that are 2 m wide with 1 m between them: two for certain, four never."""
        places = tuple((float(i), 0.0, 0.0) for i in range(8))
        wide = tuple((3.0 * i, 0.0, 0.0) for i in range(8))
        self.assertEqual(sorted(p.position_m[0] for p in self.placed(8, wide, 1.0)), [3.0 * i for i in range(8)])
        xs = sorted(p.position_m[0] for p in self.placed(2, places, 1.0))
        self.assertGreaterEqual(xs[1] - xs[0], 3)
        for count, said in ((4, "c.yaml:5:1: error: sample 0: object \\d of 'g': no place has room in 8 attempts"), (9, "c.yaml:3:1: error: sample 0: 9 objects for 8 places")):
            with self.assertRaisesRegex(CampaignError, said):
                self.placed(count, places, 1.0)


if __name__ == "__main__":
    unittest.main()

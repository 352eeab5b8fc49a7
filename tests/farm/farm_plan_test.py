"""How pictures are cut into parts: every sample of every pixel once, and no worker idle for long by the time model."""
import os
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "python"))
import package  # noqa: E402,F401  (finds the package)
from whit._farm_plan import (BYTES_PER_PIXEL, MOST_BYTES, Part, ShareCost, TimeModel, bands, count_of_shares, cut,  # noqa: E402
                             schedule, simulate)


class Plan(unittest.TestCase):
    def test_every_sample_of_every_pixel_is_in_one_part(self):
        for width, height, samples, workers in ((40, 30, 1, 4), (640, 480, 100, 2), (4000, 3000, 37, 64), (7, 9000, 512, 1000)):
            for model in (TimeModel(0.2, 1.5), TimeModel(5, 0.01), TimeModel(0, 1), TimeModel(0.2, 0)):
                parts = cut(width, height, samples, workers, model)
                self.assertEqual(sum(p.work() for p in parts), width * height * samples)
                seen = set()
                for p in parts:
                    self.assertTrue(0 == p.x0 < p.x1 == width and 0 <= p.y0 < p.y1 <= height and 0 <= p.first < p.last <= samples)
                    new = {(p.y0, p.y1, s) for s in range(p.first, p.last)}
                    self.assertFalse(seen & new)
                    seen |= new
                rows = {(p.y0, p.y1) for p in parts}
                self.assertEqual(sum(y1 - y0 for y0, y1 in rows), height)

    def test_parts_are_worth_their_start(self):
        # A start of 1 s, and 0.5 s for a sample: 40 samples are the least of which the start is a twentieth.
        parts = cut(100, 100, 1000, 4, TimeModel(1, 0.5))
        self.assertGreaterEqual(min(p.last - p.first for p in parts), 40)
        # Where all samples are fewer, one part has them.
        self.assertEqual(len(cut(100, 100, 30, 4, TimeModel(1, 0.5))), 1)

    def test_sums_of_a_part_stay_small(self):
        for p in cut(8192, 8192, 4, 8, TimeModel(0.1, 10)):
            self.assertLessEqual((p.x1 - p.x0) * (p.y1 - p.y0) * BYTES_PER_PIXEL, MOST_BYTES)
            self.assertEqual(p.y0 % 16, 0)  # tiles are not cut
        self.assertEqual(bands(100, 100), [(0, 100)])

    def test_a_schedule(self):
        # Jobs of 4, 3, 2, 2, 1 for two workers, in turn to whoever is free: 4 + 2 (from 4 to 6), 3 + 2 + 1 (to 3, 5, 6).
        self.assertEqual(schedule([4, 3, 2, 2, 1], 2), 6)
        self.assertEqual(schedule([1.5], 7), 1.5)

    def test_the_last_part_ends_with_the_others(self):
        # The least time is (work + starts) / workers; what the last parts leave idle is less than one smallest part.
        model = TimeModel(0.05, 2)
        for workers in (1, 2, 4, 64):
            parts = cut(640, 480, 4096, workers, model)
            seconds = simulate(parts, workers, model, 640 * 480)
            least = (4096 * 2 + 0.05 * len(parts)) / workers
            self.assertGreaterEqual(seconds, least * (1 - 1e-9))
            self.assertLess(seconds, least * 1.05)

    def test_flags(self):
        self.assertEqual(Part(0, 8, 16, 32, 5, 7).flags(), ["--crop-pixels", "0", "8", "16", "32", "--sample-range", "5:7"])

    def test_shares_are_worth_their_start(self):
        # A start of 0.1 s and 1e-6 s for a sample: 1e5 samples take as long as a start.
        cost = ShareCost()
        self.assertEqual(count_of_shares(4e5, 100, 8, cost), 8)  # of which nothing is known
        cost.note(8e6, 4, 8.4, 8)
        self.assertAlmostEqual(cost.fixed, 0.1)
        self.assertAlmostEqual(cost.per_sample, 1e-6)
        for samples, expected in ((1e3, 1), (1.5e5, 1), (3.5e5, 3), (8.5e5, 8), (1.5e7, 8), (2.41e7, 12), (1e9, 32)):
            self.assertEqual(count_of_shares(samples, 10000, 8, cost), expected, samples)
        self.assertEqual(count_of_shares(1e9, 5, 8, cost), 5)  # no more than there are tiles
        self.assertEqual(count_of_shares(1, 1, 8, ShareCost(0, 1e-6)), 1)


if __name__ == "__main__":
    unittest.main()

"""What the studies of figure 5, GOODSAC and run times make of their rows. Needs no plots and no build."""
import pathlib
import sys
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / 'experiments'))
from studies import figure5, goodsac, run_times  # noqa: E402


class Recorder:
    """A context that keeps what a study reports."""

    def __init__(self):
        self.figures, self.tables = [], {}

    def figure(self, name, caption, draw, size=None):
        self.figures.append(name)

    def table(self, name, caption, columns, rows):
        self.tables[name] = [dict(zip(columns, row)) for row in rows]


def setting(descriptor, resolution, support, d_max, tp, fp, fn, ms):
    return {'descriptor': descriptor, 'resolution': float(resolution), 'support': support, 'd_max': d_max, 'tp': tp, 'fp': fp, 'fn': fn,
            **{stage: ms / len(figure5.STAGES) for stage in figure5.STAGES}}


class Figure5Test(unittest.TestCase):
    ROWS = [setting('range_patch', 8, 0.35, 0.02, 10, 10, 0, 100.0),      # zeta 10, 100 a second
            setting('range_patch', 8, 0.35, 0.04, 20, 10, 0, 1000.0),     # zeta 40, 40 a second
            setting('range_patch', 5, 0.6, 0.02, 10, 1, 3, 20.0),         # zeta 10, 500 a second
            setting('spherical_spin', 5, 0.6, 0.02, 10, 4, 4, 1000.0)]    # zeta 5, 5 a second

    def test_a_cell_is_the_best_d_max(self):
        cell = figure5.report_cells(self.ROWS)['range_patch', 8, 0.35]
        self.assertEqual((cell['zeta']['zeta'], cell['zeta']['d_max']), (40, 0.04))
        self.assertAlmostEqual(cell['zeta_a_second']['zeta_a_second'], 100)

    def test_names_the_best_settings_of_each_descriptor(self):
        cells = figure5.report_cells(self.ROWS)
        self.assertEqual(figure5.report_best(cells, 'range_patch', 'zeta')[:2], (8, 0.35))
        self.assertEqual(figure5.report_best(cells, 'range_patch', 'zeta_a_second')[:2], (5, 0.6))

    def test_says_how_the_papers_settings_do(self):
        context = Recorder()
        text = figure5.report(context, self.ROWS)
        self.assertIn('8 x 8 cells over 0.35 m', text)
        self.assertIn('is 12 % of that of range patches', text)
        self.assertEqual(len(context.tables['best']), 4)

    def test_the_grid_has_the_papers_settings_first_and_each_once(self):
        class Context:
            quick = False
        keys = [unit.key for unit in figure5.units(Context)]
        self.assertEqual(keys[:2], ['range_patch_8x8_35cm_30_scans', 'spherical_spin_8x8_35cm_30_scans'])
        self.assertEqual(len(set(keys)), 2 * len(figure5.RESOLUTIONS) * len(figure5.SUPPORTS))


class GoodsacTest(unittest.TestCase):
    ROWS = [{'rejections': 'all', 'order': order, 'first': first, 'tried': 100.0} for order, firsts in
            {'goodsac': (1, 2, 3, 0), 'goodsac_limited': (1, 1, 1, 1), 'ransac': (50, 0, 0, 0)}.items() for first in firsts]

    def test_shares_count_those_found_within_so_many(self):
        self.assertEqual([goodsac.report_share(self.ROWS, 'goodsac', n) for n in (0, 1, 2, 100)], [0, 0.25, 0.5, 0.75])

    def test_no_median_where_half_are_never_found(self):
        self.assertEqual(goodsac.report_median(self.ROWS, 'goodsac'), 3)
        self.assertIsNone(goodsac.report_median(self.ROWS, 'ransac'))
        self.assertIn('with RANSAC never (25 % within the budget)', goodsac.report(Recorder(), self.ROWS))


class RunTimesTest(unittest.TestCase):
    def test_percentiles_are_linear_between_values(self):
        self.assertEqual([run_times.report_percentile([4, 1, 3, 2], share) for share in (0, 0.5, 1)], [1, 2.5, 4])
        self.assertEqual(run_times.report_percentile([7], 0.95), 7)

    def test_our_stages_add_up_to_the_papers(self):
        rows = [{'method': 'paper', 'pruning': 1.0, 'collisions': 2.0, 'total': 9.0}, {'method': 'default', 'collisions': 4.0, 'total': 8.0}]
        context = Recorder()
        run_times.report(context, rows)
        collisions = next(line for line in context.tables['stages'] if line['stage'] == 'collisions')
        self.assertEqual((collisions['ours, paper method: median'], collisions['ours, default method: median']), (3, 4))


if __name__ == '__main__':
    unittest.main()

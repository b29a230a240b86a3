"""The studies: their reports draw and write from rows, their scenes are what they say. No program runs."""
import json
import math
import pathlib
import random
import tempfile
import unittest

import support  # noqa: F401
from harness import context as contexts
from harness import curves, driver, page, scenes, scoring, style
from studies import table1, tilt
from studies.paper_figures import CLASSES, TABLE1

LEVELS = {'figure7': ('step', (2, 4, 8, 12)), 'tilt': ('angle', (0, 10, 20)), 'noise': ('sigma_cm', (0.0, 1.5, 3.0)),
          'resolution': ('degrees', (0.2, 0.6, 1.0)), 'occlusion': ('cover', (0.0, 0.5)), 'table1': ('number', (0, 1))}


def sample_rows(name):
    """Rows as the study's units give them, drawn by chance."""
    rng, (key, values), rows = random.Random(name), LEVELS[name], []
    for number, value in enumerate(values):
        for method in ('default', 'paper'):
            for kind_of, axis in (('scanner', 'roll'), ('image', 'pitch')):
                common = {'method': method, key: value, 'kind_of': kind_of, 'axis': axis, 'scan': f'{number}'}
                for c in CLASSES:
                    found = rng.random() < 0.6
                    rows.append({**common, 'kind': 'object', 'class': c, 'points': rng.randrange(20, 2000), 'visible': rng.random(), 'distance': 3.0,
                                 'found': found, 'counts': True, 'translation_error': 0.02, 'rotation_error': 2.0})
                    if found:
                        rows.append({**common, 'kind': 'detection', 'class': c, 'on': c, 'score': 0.9, 'verdict': 'right'})
                rows.append({**common, 'kind': 'detection', 'class': 'fan', 'on': 'C', 'score': 0.6, 'verdict': 'wrong'})
    return rows


class Reports(unittest.TestCase):
    def test_every_report_writes_its_plots_tables_and_findings(self):
        known = driver.find_studies()
        for name in LEVELS:
            with self.subTest(name), tempfile.TemporaryDirectory() as folder:
                context = contexts.Context(folder, folder)
                context.study = name
                findings = known[name].report(context, sample_rows(name))
                self.assertRegex(findings, r'\d')
                self.assertTrue(context.tables and context.figures)
                json.dumps(context.tables)
                for table in context.tables:
                    self.assertTrue(all(len(row) == len(table['columns']) for row in table['rows']), table['name'])
                if style.available():
                    for figure in context.figures:
                        self.assertEqual([pathlib.Path(folder, f).stat().st_size > 1000 for f in figure['files']], [True, True])

    def test_plots_need_matplotlib(self):
        if not style.available():
            self.skipTest('no matplotlib: reports were tried without their plots')

    def test_every_study_says_what_it_is(self):
        for name, module in driver.find_studies().items():
            self.assertTrue(module.TITLE and module.ABOUT.endswith('.') and callable(module.units) and callable(module.report), name)


class Units(unittest.TestCase):
    def test_quick_has_fewer_units_with_the_same_keys(self):
        with tempfile.TemporaryDirectory() as folder:
            for name in LEVELS:
                module = driver.find_studies()[name]
                all_units, quick = ([u.key for u in module.units(contexts.Context(folder, folder, quick=q))] for q in (False, True))
                driver.check_keys(module.units(contexts.Context(folder, folder)))
                self.assertLess(len(quick), len(all_units), name)
                self.assertLessEqual(set(quick), set(all_units), name)

    def test_twenty_scans_have_every_class_ten_times_where_they_can(self):
        rng = random.Random(1)
        scans = []
        for pair in range(20):
            classes = rng.sample(CLASSES, 7)
            extra = [rng.choice(CLASSES)] if pair < 6 else []
            scans += [scenes.Scan(f'{len(scans) + i}', None, [{'class': c} for c in part]) for i, part in enumerate((classes[:4] + extra, classes[4:]))]
        chosen = table1.balanced(scans, 20)
        self.assertEqual({c: sum(o['class'] == c for s in chosen for o in s.objects) for c in CLASSES}, {c: 10 for c in CLASSES})
        self.assertEqual(len({s.name for s in chosen}), 20)

    def test_leaning_is_the_angle_from_the_vertical_whatever_the_heading(self):
        half = math.radians(20) / 2
        lean = (math.cos(half), math.sin(half), 0, 0)
        turned = (0.6 * lean[0], 0.6 * lean[1], 0.8 * lean[1], 0.8 * lean[0])  # first leant, then turned about z
        for q in (lean, turned, [2 * v for v in lean]):
            self.assertAlmostEqual(tilt.leaning([0, 0, 0, *q]), 20)

    def test_the_papers_table_has_the_sums_of_its_text(self):
        right = sum(TABLE1[c][i] for i, c in enumerate(CLASSES))
        self.assertEqual((right, sum(map(sum, TABLE1.values())) - right), (59, 29))


class FakeItem:
    def __init__(self, name):
        self.name, self.symmetry, self.reflectivity = name, 'none', 0.6
        self.shape = scenes.make_scenes.carton(0.5, 0.5, 0.6)


class Scenes(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.started = []
        self.made = scenes.SimulatedScenes(folder.name, self.simulate, 'simulator 1')
        self.made.loaded = None, [FakeItem(c) for c in CLASSES]
        for part in ('scenes', 'logs'):
            pathlib.Path(folder.name, part).mkdir()

    def simulate(self, program, arguments):
        self.started.append((program, json.loads(arguments[0].read_text())))
        arguments[2].write_text('log')
        arguments[4].write_text('{"scans": [{"objects": []}]}')

    def test_ring_has_every_class_once_at_the_distance(self):
        for view in range(5):
            self.made.ring(f'r{view}', view, distance=4)
        for _, scene in self.started:
            self.assertEqual(sorted(o['class'] for o in scene['objects']), sorted(CLASSES))
            for entry in scene['objects']:
                self.assertAlmostEqual(math.hypot(*entry['position'][:2]), 4, places=3)
                self.assertLessEqual(abs(entry['yaw_deg']), 180)
        self.assertEqual(len({json.dumps(s['objects']) for _, s in self.started}), 5)

    def test_scene_is_scanned_once_and_again_when_it_changes(self):
        for distance in (4, 4, 5):
            self.made.ring('r', 0, distance=distance)
        self.assertEqual(len(self.started), 2)
        self.made.simulator_digest = 'simulator 2'
        self.made.ring('r', 0, distance=5)
        self.assertEqual(len(self.started), 3)

    def test_sensor_noise_and_tilt_reach_the_scene(self):
        self.made.ring('r', 0, tilt=(10.0, 0.0), sensor={'num_beams': 91}, noise={'range_sigma': 0.03})
        scene = self.started[0][1]
        self.assertEqual((scene['sensor']['num_beams'], scene['noise']['range_sigma']), (91, 0.03))
        self.assertTrue(all(o['pitch_deg'] == 10 for o in scene['objects']))

    def test_screen_hides_its_share_of_the_width_from_either_side(self):
        item = FakeItem('box')
        for left in (False, True):
            for angle in (0.0, 0.7, -1.2):
                placed = scenes.make_scenes.Placed(item.shape, 3 * math.cos(angle), 3 * math.sin(angle), 0, angle, item=item)
                panel = scenes.screen_before(placed, 0.4, left)
                x, y = panel['position'][:2]
                ahead, middle = math.cos(angle) * x + math.sin(angle) * y, math.cos(angle) * y - math.sin(angle) * x
                half = panel['box']['size'][1] / 2
                scale = 3 / ahead  # the panel's edges as they fall on the object's plane
                hidden = min(0.25, scale * (middle + half)) - max(-0.25, scale * (middle - half))
                self.assertAlmostEqual(hidden, 0.4 * 0.5, places=2)
                self.assertLess(ahead, 3 - 0.35)


class Curves(unittest.TestCase):
    def test_rates_count_objects_alone(self):
        rows = [{'kind': 'object', 'x': 1, 'found': True}, {'kind': 'object', 'x': 1, 'found': False}, {'kind': 'object', 'x': 0, 'found': True},
                {'kind': 'detection', 'x': 1}]
        self.assertEqual(curves.rates(rows, 'x'), [(0, 1, 1), (1, 1, 2)])

    def test_cells_are_readable(self):
        self.assertEqual([page.cell(v) for v in (None, math.inf, 0.456, 3, 'a')], ['-', '∞', '0.46', '3', 'a'])
        self.assertEqual(page.markdown_row(['a|b']), '| a\\|b |')


if __name__ == '__main__':
    unittest.main()

"""The rules of scoring on cases made by hand."""
import math
import unittest

import support  # noqa: F401
from harness import scoring

CUBE = scoring.ObjectBox({'box': {'min': [-0.2, -0.2, 0], 'max': [0.2, 0.2, 0.4]}, 'symmetry': 'none'})    # on it: within 0.173 m
POST = scoring.ObjectBox({'box': {'min': [-0.1, -0.1, 0], 'max': [0.1, 0.1, 0.2]}, 'symmetry': 'yaw4'})    # on it: within 0.15 m
TABLE = scoring.ObjectBox({'box': {'min': [-0.8, -0.8, 0], 'max': [0.8, 0.8, 0.8]}, 'symmetry': 'yaw2'})   # on it: within 0.6 m
BOXES = {'cube': CUBE, 'post': POST, 'table': TABLE}


def thing(name, x, y=0.0, yaw=0.0, **more):
    half = math.radians(yaw) / 2
    return {'class': name, 'pose': [x, y, 0, math.cos(half), 0, 0, math.sin(half)], **more}


def verdicts(objects, detections, **limits):
    return [(r['class'], r['on'], r['verdict']) for r in scoring.score_scan(objects, detections, BOXES, **limits) if r['kind'] == 'detection']


class Verdicts(unittest.TestCase):
    def test_detection_lies_on_an_object_within_a_quarter_of_its_diameter(self):
        self.assertEqual(verdicts([thing('cube', 2)], [thing('cube', 2.17)]), [('cube', 'cube', 'right')])
        self.assertEqual(verdicts([thing('cube', 2)], [thing('cube', 2.18)]), [('cube', 'C', 'wrong')])

    def test_small_objects_have_fifteen_centimetres(self):
        self.assertEqual(verdicts([thing('post', 2)], [thing('post', 2.149)]), [('post', 'post', 'right')])
        self.assertEqual(verdicts([thing('post', 2)], [thing('post', 2.151)]), [('post', 'C', 'wrong')])

    def test_centres_of_boxes_count_not_origins(self):
        # the table's centre is 0.4 m up, the post's 0.1 m
        self.assertEqual(verdicts([thing('table', 2)], [thing('post', 2.51)]), [('post', 'table', 'wrong')])
        self.assertEqual(verdicts([thing('table', 2)], [thing('post', 2.53)]), [('post', 'C', 'wrong')])

    def test_other_class_is_a_confusion_and_the_object_stays_missed(self):
        rows = scoring.score_scan([thing('cube', 2)], [thing('post', 2)], BOXES)
        self.assertEqual(scoring.confusion(rows, BOXES)['post'], {'cube': 1, 'post': 0, 'table': 0, 'C': 0})
        sums = scoring.totals(rows)
        self.assertEqual((sums['tp'], sums['fp'], sums['fn']), (0, 1, 1))

    def test_object_of_the_own_class_is_preferred_to_a_nearer_one(self):
        self.assertEqual(verdicts([thing('cube', 2.05), thing('table', 2)], [thing('table', 2.04)]), [('table', 'table', 'right')])

    def test_free_object_is_preferred_to_a_nearer_one_that_is_taken(self):
        detections = [thing('table', 2.0, score=0.9), thing('table', 2.1, score=0.8)]
        self.assertEqual([v for *_, v in verdicts([thing('table', 2.0), thing('table', 2.5)], detections)], ['right', 'right'])

    def test_second_of_a_class_on_an_object_is_a_duplicate(self):
        detections = [thing('cube', 2, score=0.5), thing('cube', 2.1, score=0.9)]
        rows = scoring.score_scan([thing('cube', 2)], detections, BOXES)
        self.assertEqual([(r['score'], r['verdict']) for r in rows[1:]], [(0.9, 'right'), (0.5, 'duplicate')])
        self.assertAlmostEqual(rows[0]['translation_error'], 0.1)
        self.assertEqual(scoring.totals(rows)['fp'], 1)
        self.assertEqual(scoring.confusion(rows, BOXES)['cube']['cube'], 1)

    def test_two_classes_on_one_object_are_a_hit_and_a_confusion(self):
        detections = [thing('post', 2, score=0.9), thing('cube', 2, score=0.8)]
        self.assertEqual([v for *_, v in verdicts([thing('cube', 2)], detections)], ['wrong', 'right'])

    def test_hardly_visible_objects_do_not_count(self):
        for hidden in (thing('cube', 2, visible=0.19), thing('cube', 2, points=149)):
            self.assertEqual(scoring.totals(scoring.score_scan([hidden], [], BOXES))['fn'], 0)
            self.assertEqual(verdicts([hidden], [thing('cube', 2), thing('cube', 2)]), [('cube', 'cube', 'ignored')] * 2)
            self.assertEqual(verdicts([hidden], [thing('post', 2)]), [('post', 'cube', 'wrong')])
            self.assertEqual(verdicts([hidden], [thing('cube', 2)], min_visible=0, min_points=0), [('cube', 'cube', 'right')])

    def test_limits_themselves_count(self):
        rows = scoring.score_scan([thing('cube', 2, visible=0.2, points=150)], [], BOXES)
        self.assertEqual(scoring.totals(rows)['fn'], 1)


class Poses(unittest.TestCase):
    def errors(self, name, yaw):
        row = scoring.score_scan([thing(name, 2)], [thing(name, 2, yaw=yaw)], BOXES)[0]
        return row['rotation_error']

    def test_rotation_counts_modulo_symmetry(self):
        self.assertAlmostEqual(self.errors('cube', 90), 90)
        self.assertAlmostEqual(self.errors('cube', -170), 170)
        self.assertAlmostEqual(self.errors('post', 93), 3)
        self.assertAlmostEqual(self.errors('table', 93), 87)
        self.assertAlmostEqual(self.errors('table', 183), 3)

    def test_continuous_symmetry_counts_the_axis_alone(self):
        upright, lying = scoring.rotation_matrix([1, 0, 0, 0]), scoring.rotation_matrix([1, 1, 0, 0])
        turned = scoring.rotation_matrix([0.3, 0, 0, 0.8])
        self.assertAlmostEqual(scoring.rotation_error(upright, turned, 'yaw_continuous'), 0)
        self.assertAlmostEqual(scoring.rotation_error(upright, lying, 'yaw_continuous'), 90)

    def test_pose_recall_is_ten_centimetres_and_fifteen_degrees(self):
        for found, share in ((thing('cube', 2.09, yaw=14), 1), (thing('cube', 2.11), 0), (thing('cube', 2, yaw=16), 0)):
            self.assertEqual(scoring.totals(scoring.score_scan([thing('cube', 2)], [found], BOXES))['pose_recall'], share)

    def test_quaternions_need_not_have_length_one_but_a_direction(self):
        self.assertEqual(scoring.rotation_matrix([2, 0, 0, 0]), [[1, 0, 0], [0, 1, 0], [0, 0, 1]])
        for bad in ([0, 0, 0, 0], [math.nan, 0, 0, 1]):
            with self.assertRaises(ValueError):
                scoring.rotation_matrix(bad)


class Sums(unittest.TestCase):
    def test_the_papers_table_gives_its_rates(self):
        self.assertAlmostEqual(scoring.zeta(59, 29, 11), 23.2, places=1)

    def test_perfect_run_has_infinite_zeta_and_no_run_zero(self):
        self.assertEqual(scoring.zeta(3, 0, 0), math.inf)
        self.assertEqual(scoring.zeta(0, 0, 0), 0)

    def test_rates_without_denominator_are_none(self):
        self.assertEqual([scoring.totals([])[k] for k in ('recall', 'precision', 'f1')], [None] * 3)

    def test_detections_of_unknown_scans_and_classes_are_errors(self):
        with self.assertRaisesRegex(ValueError, "'b'"):
            scoring.score({'b': []}, {'a': []}, BOXES)
        with self.assertRaisesRegex(ValueError, 'lamp'):
            scoring.score_scan([], [thing('lamp', 1)], BOXES)

    def test_confidence_limits_enclose_the_share(self):
        for hits, count in ((0, 5), (5, 5), (3, 7), (99, 100)):
            low, high = scoring.wilson(hits, count)
            self.assertTrue(0 <= low <= hits / count <= high <= 1)
        self.assertEqual(scoring.wilson(0, 0), (0.0, 1.0))
        self.assertAlmostEqual(scoring.wilson(50, 100)[0], 0.404, places=3)


if __name__ == '__main__':
    unittest.main()

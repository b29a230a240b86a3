"""Which detections are right: the rules of the benchmark's scorer.

A detection lies on an object when the centres of their boxes are within max(0.15 m, a quarter of the object's diameter);
an object of its own class is preferred, a free one before one that is taken, then the nearest. Detections are taken by
falling score. The first of a class on an object counts: right if the class is the object's, else a confusion. Further ones
of the class there are duplicates: false, listed apart. Objects of which less than `min_visible` or fewer than
`min_points` points can be seen do not count, neither when missed nor when their own class is found there.
"""
import json
import math
import pathlib

SYMMETRIES = {'none': 1, 'yaw2': 2, 'yaw4': 4, 'yaw_continuous': 0}
CLUTTER = 'C'


class ObjectBox:
    """Box and symmetry of a class, from the model.json of its recording."""

    def __init__(self, description):
        low, high = description['box']['min'], description['box']['max']
        self.center = [(a + b) / 2 for a, b in zip(low, high)]
        self.diameter = math.dist(low, high)
        self.symmetry = description.get('symmetry', 'none')
        if self.symmetry not in SYMMETRIES:
            raise ValueError(f'unknown symmetry {self.symmetry}')


def load_boxes(recordings):
    """{class: ObjectBox} of a folder of recordings."""
    files = sorted(pathlib.Path(recordings).glob('*/model.json'))
    return {f.parent.name: ObjectBox(json.loads(f.read_text())) for f in files}


def rotation_matrix(quaternion):
    """Of (w, x, y, z), not necessarily of length 1."""
    length = math.sqrt(sum(v * v for v in quaternion))
    if not math.isfinite(length) or length < 1e-9:
        raise ValueError(f'bad quaternion {quaternion}')
    w, x, y, z = (v / length for v in quaternion)
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]


def rotation_error(a, b, symmetry):
    """Degrees between two attitudes of an object, the nearest of those that look the same."""
    if SYMMETRIES[symmetry] == 0:
        cosine = sum(a[i][2] * b[i][2] for i in range(3))
        return math.degrees(math.acos(max(-1.0, min(1.0, cosine))))
    difference = [[sum(a[k][i] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]
    return min(angle_of(turned_about_z(difference, 2 * math.pi * k / SYMMETRIES[symmetry]))
               for k in range(SYMMETRIES[symmetry]))


def turned_about_z(m, angle):
    c, s = math.cos(angle), math.sin(angle)
    return [[row[0] * c + row[1] * s, row[1] * c - row[0] * s, row[2]] for row in m]


def angle_of(m):
    sine = math.hypot(m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1])
    return math.degrees(math.atan2(sine, m[0][0] + m[1][1] + m[2][2] - 1))


class Placed:
    """Where a box is, of a label or a detection."""

    def __init__(self, entry, boxes):
        if entry['class'] not in boxes:
            raise ValueError(f'unknown class {entry["class"]!r}')
        self.name, self.box, pose = entry['class'], boxes[entry['class']], entry['pose']
        self.rotation = rotation_matrix(pose[3:])
        self.center = [sum(r * c for r, c in zip(row, self.box.center)) + t for row, t in zip(self.rotation, pose)]


def score_scan(objects, detections, boxes, min_visible=0.2, min_points=150):
    """Rows of a scan's objects (kind 'object') and detections (kind 'detection').

    object: class, points, visible, distance, counts (else "don't care"), found, translation_error (m) and
    rotation_error (degrees) where found. detection: class, on (class of the object there or CLUTTER), score, verdict
    'right', 'wrong', 'duplicate' or 'ignored'; a right one and one that is ignored are no false positives.
    """
    places = [Placed(o, boxes) for o in objects]
    rows = [{'kind': 'object', 'class': o['class'], 'points': o.get('points', 10 ** 9), 'visible': float(o.get('visible', 1)),
             'distance': float(o.get('distance', math.hypot(*o['pose'][:2]))), 'found': False} for o in objects]
    for row in rows:
        row['counts'] = row['visible'] >= min_visible and row['points'] >= min_points
    taken, judged = set(), []
    for detection in sorted(detections, key=lambda d: -float(d.get('score', 1.0))):
        judged.append(judge(detection, Placed(detection, boxes), places, rows, taken))
    return rows + judged


def judge(detection, place, places, objects, taken):
    row = {'kind': 'detection', 'class': place.name, 'on': CLUTTER, 'score': float(detection.get('score', 1.0)), 'verdict': 'wrong'}
    near = []
    for index, other in enumerate(places):
        distance = math.dist(place.center, other.center)
        if distance <= max(0.15, 0.25 * other.box.diameter):
            other_class = other.name != place.name
            near.append((other_class, not other_class and (place.name, index) in taken, distance, index))
    if not near:
        return row
    wrong, _, distance, index = min(near)
    row['on'] = places[index].name
    if not wrong and not objects[index]['counts']:
        row['verdict'] = 'ignored'
    elif (place.name, index) in taken:
        row['verdict'] = 'duplicate'
    else:
        taken.add((place.name, index))
        if not wrong:
            row['verdict'] = 'right'
            objects[index].update(found=True, translation_error=distance,
                                  rotation_error=rotation_error(place.rotation, places[index].rotation, place.box.symmetry))
    return row


def totals(rows):
    """Counts and rates of score_scan's rows of any number of scans. Rates without a denominator are None."""
    objects = [r for r in rows if r['kind'] == 'object' and r['counts']]
    verdicts = [r['verdict'] for r in rows if r['kind'] == 'detection']
    tp, fp = verdicts.count('right'), verdicts.count('wrong') + verdicts.count('duplicate')
    fn = sum(not r['found'] for r in objects)
    posed = sum(r['found'] and r['translation_error'] <= 0.10 and r['rotation_error'] <= 15 for r in objects)
    return {'objects': len(objects), 'tp': tp, 'fp': fp, 'fn': fn, 'recall': ratio(tp, tp + fn), 'precision': ratio(tp, tp + fp),
            'f1': ratio(2 * tp, 2 * tp + fp + fn), 'zeta': zeta(tp, fp, fn), 'pose_recall': ratio(posed, len(objects))}


def zeta(tp, fp, fn):
    """The paper's score TP^2 / (FN^2 + FP); infinite when everything was found and nothing else."""
    if fn * fn + fp == 0:
        return math.inf if tp else 0.0
    return tp * tp / (fn * fn + fp)


def ratio(a, b):
    return a / b if b else None


def confusion(rows, classes):
    """{detected class: {true class or CLUTTER: count}}; duplicates and ignored detections are left out."""
    table = {c: {t: 0 for t in [*classes, CLUTTER]} for c in classes}
    for row in rows:
        if row['kind'] == 'detection' and row['verdict'] in ('right', 'wrong'):
            table[row['class']][row['on']] += 1
    return table


def score(detections, labels, boxes, **limits):
    """Rows of many scans, each with its 'scan'. labels: {scan: [objects]}, detections: {scan: [detections]}."""
    unknown = sorted(set(detections) - set(labels))
    if unknown:
        raise ValueError(f'detections in unknown scan {unknown[0]!r}')
    return [{'scan': scan, **row} for scan, objects in labels.items()
            for row in score_scan(objects, detections.get(scan, []), boxes, **limits)]


def wilson(hits, count, z=1.96):
    """Limits of a share that lie around the true one in 95 of 100 cases."""
    if not count:
        return 0.0, 1.0
    p, n = hits / count, count
    middle, half = p + z * z / (2 * n), z * math.sqrt(p * (1 - p) / n + z * z / (4 * n * n))
    return max(0.0, (middle - half) / (1 + z * z / n)), min(1.0, (middle + half) / (1 + z * z / n))

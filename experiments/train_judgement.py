#!/usr/bin/env python3
"""Learn the default method's weights from figures of labelled scans.

usage: train_judgement.py --models MODELS_DIR --data LABELS.json=FIGURES.csv[@WEIGHT] [--data ..] [--judgement-only] [--out FILE.cpp]
                          [--held-out FOLDER]
       train_judgement.py --models MODELS_DIR --data .. --folds 5

MODELS_DIR has <class>/model.json with box and symmetry, LABELS.json and model.json are in the format of
the benchmark sets, FIGURES.csv comes from rimod-dump-figures. Writes rimod/judgement_weights.cpp: a
logistic regression for hypotheses as they are proposed (lines P) and another for the refined ones (lines R), in
which each object counts the same, and boosted trees for judging candidates (lines J; they need scikit-learn,
Debian's python3-sklearn). A candidate
is right within 10 cm and 15 degrees of an object of its class (modulo its symmetry), a proposal within 20 cm and
25 degrees; it is wrong when its centre is farther than max(0.15 m, 0.25 diameters) from all of them; those in
between are left out. With --judgement-only the two regressions stay as OUT has them. The trees' probability is calibrated on what held-out scans of the sets without @WEIGHT would
have as detections. With
--folds the scans are split and the log loss and the average precision over the held-out candidates are printed,
nothing is written. With --held-out the detections that trees learnt from the other four fifths of the scans would make, from 2 %
on, are written as rimod-detect writes its own: FOLDER/SET.jsonl for each set without @WEIGHT, SET the folder of its labels.
"""
import argparse
import json
import math
import pathlib
import sys

import numpy as np

SYMMETRY = {'none': 1, 'yaw2': 2, 'yaw4': 4, 'yaw_continuous': 0}

# What candidates are judged by, in the order of JudgementFigures (rimod/judgement.cpp), and which way each may only move the
# probability when all others stay as they are: +1 up, -1 down, 0 either. Unbound trees learn accidents of the scans.
JUDGEMENT_FIGURES = {
    'matched': 1, 'nearly_matched': 0, 'seen_through': -1, 'occluded': 0, 'no_return': 0, 'matched_of_known': 1, 'residual': -1,
    'normal_agreement': 1, 'silhouette_jump': 0, 'silhouette_continues': -1, 'silhouette_occluded': 0, 'silhouette_known': 1,
    'unexplained': -1, 'supported': 1, 'log_matched_pixels': 0, 'log_rendered_pixels': 0, 'distance': 0, 'tilt': 0,
    'second_normal': 0, 'third_normal': 0, 'relief': 0, 'strictly_matched': 1, 'bias': 0, 'slightly_in_front': -1,
    'slightly_behind': -1, 'worst_side': 1, 'known_sides': 0, 'closely': 1, 'spread': 0, 'turned_normals': -1, 'rim_worst': -1,
    'rim_second_worst': -1, 'rim_mean': -1, 'through_region': -1,
    # times log_matched_pixels
    'matched_size': 0, 'seen_through_size': 0, 'matched_of_known_size': 0, 'silhouette_continues_size': 0,
    'silhouette_known_size': 0, 'unexplained_size': 0, 'normal_agreement_size': 0, 'residual_size': 0,
    # of the ranking, and the features that the pose explains
    'at_place': 1, 'looked_through': -1, 'agreeing': 1, 'goes_on': -1, 'log_votes': 1,
    'log_features': 0, 'log_matching_features': 1, 'matching_share': 1}

OBJECT_WEIGHT = 6.0  # of an object's right candidates together, against 1 of a wrong one
RIGHT = {'P': (0.20, math.radians(25)), 'R': (0.10, math.radians(15)), 'J': (0.10, math.radians(15))}


def rotations(q):
    w, x, y, z = (q / np.linalg.norm(q, axis=-1, keepdims=True)).T
    return np.moveaxis(np.array([[1-2*(y*y+z*z), 2*(x*y-z*w), 2*(x*z+y*w)],
                                 [2*(x*y+z*w), 1-2*(x*x+z*z), 2*(y*z-x*w)],
                                 [2*(x*z-y*w), 2*(y*z+x*w), 1-2*(x*x+y*y)]]), -1, 0)


def angle_errors(R, target, symmetry):
    """Angles (rad) between attitudes R (N x 3 x 3) and one, modulo symmetry about z."""
    if symmetry == 0:
        return np.arccos(np.clip(R[:, :, 2] @ target[:, 2], -1, 1))
    best = np.full(len(R), np.pi)
    for k in range(symmetry):
        a = 2 * math.pi * k / symmetry
        turn = np.array([[math.cos(a), -math.sin(a), 0], [math.sin(a), math.cos(a), 0], [0, 0, 1]])
        trace = np.einsum('nij,ij->n', R, target @ turn)
        best = np.minimum(best, np.arccos(np.clip((trace - 1) / 2, -1, 1)))
    return best


class Model:
    def __init__(self, path):
        m = json.load(open(path))
        low, high = np.array(m['box']['min']), np.array(m['box']['max'])
        self.centre, self.diameter = (low + high) / 2, float(np.linalg.norm(high - low))
        self.symmetry = SYMMETRY[m.get('symmetry', 'none')]


def read_figures(path, kinds=tuple(RIGHT)):
    """{kind: (scans, classes, poses N x 7, figures N x F)}"""
    rows = {}
    for line in open(path):
        if line[0] not in kinds:
            continue
        kind, scan, name, *numbers = line.rstrip('\n').split(',')
        rows.setdefault(kind, []).append((scan, name, [float(x) for x in numbers]))
    result = {}
    for kind, r in rows.items():
        numbers = np.array([x[2] for x in r])
        result[kind] = ([x[0] for x in r], [x[1] for x in r], numbers[:, :7], numbers[:, 7:])
    return result


def label(labels, scans, names, poses, models, kind='J'):
    """1 right, 0 wrong, -1 in between, for each candidate; and a weight: all right ones of an object weigh the same."""
    objects = {s['scan']: s['objects'] for s in labels['scans']}
    R = rotations(poses[:, 3:])
    y, weight = np.zeros(len(scans), int), np.ones(len(scans))
    groups = {}
    for i, key in enumerate(zip(scans, names)):
        groups.setdefault(key, []).append(i)
    for (scan, name), index in groups.items():
        m = models[name]
        centres = poses[index, :3] + R[index] @ m.centre
        for o in objects.get(scan, []):
            if o['class'] != name:
                continue
            target = rotations(np.array([o['pose'][3:]], float))[0]
            distance = np.linalg.norm(centres - (target @ m.centre + o['pose'][:3]), axis=1)
            angle = angle_errors(R[index], target, m.symmetry)
            good = (distance < RIGHT[kind][0]) & (angle < RIGHT[kind][1])
            near = distance < max(0.15, RIGHT[kind][0], 0.25 * m.diameter)
            weight[np.array(index)[good]] = OBJECT_WEIGHT / max(good.sum(), 1)
            for k, i in enumerate(index):
                y[i] = 1 if good[k] else (-1 if near[k] and y[i] == 0 else y[i])
    return y, weight


def fit(X, y, weight, ridge=1.0):
    """Logistic regression: means, scales, weights, bias."""
    mean, scale = X.mean(0), X.std(0) + 1e-6
    Z = np.hstack([(X - mean) / scale, np.ones((len(X), 1))])
    penalty = ridge * np.r_[np.ones(X.shape[1]), 0]
    b = np.zeros(Z.shape[1])
    for _ in range(40):
        p = 1 / (1 + np.exp(-np.clip(Z @ b, -40, 40)))
        w = np.maximum(weight * p * (1 - p), 1e-9)
        step = np.linalg.solve((Z * w[:, None]).T @ Z + np.diag(penalty + 1e-9), Z.T @ (weight * (p - y)) + penalty * b)
        b -= step
        if np.abs(step).max() < 1e-8:
            break
    return mean, scale, b[:-1], b[-1]


class Logistic:
    def __init__(self, X, y, weight, ridge=1.0):
        self.mean, self.scale, self.weights, self.bias = fit(X, y, weight, ridge)

    def predict(self, X):
        return 1 / (1 + np.exp(-np.clip(((X - self.mean) / self.scale) @ self.weights + self.bias, -40, 40)))


def logits(p):
    p = np.clip(p, 1e-6, 1 - 1e-6)
    return np.log(p / (1 - p))


class Trees:
    """Gradient boosting for the judgement; the settings keep the leaves well filled, JUDGEMENT_FIGURES their order."""

    def __init__(self, X, y, weight):
        from sklearn.ensemble import HistGradientBoostingClassifier
        self.fitted = HistGradientBoostingClassifier(
            max_iter=400, learning_rate=0.04, max_leaf_nodes=16, l2_regularization=5.0,
            min_samples_leaf=60, early_stopping=False, random_state=0,
            monotonic_cst=list(JUDGEMENT_FIGURES.values())).fit(X, y, sample_weight=weight)
        self.slope, self.shift = 1.0, 0.0  # of the logit, after calibration

    def predict(self, X):
        return 1 / (1 + np.exp(-(self.slope * self.fitted.decision_function(X) + self.shift)))

    def calibrate(self, p, right):
        """Platt's scaling: makes probabilities p held out mean what they say."""
        mean, scale, w, bias = fit(logits(p)[:, None], right.astype(float), np.ones(len(p)), 0.01)
        self.slope, self.shift = float(w[0] / scale[0]), float(bias - w[0] * mean[0] / scale[0])

    def calibrated(self, p):
        return 1 / (1 + np.exp(-(self.slope * logits(p) + self.shift)))

    def nodes(self):
        """bias, roots, nodes (feature, threshold, left, right, value)"""
        roots, nodes = [], []
        for predictors in self.fitted._predictors:
            first = len(nodes)
            roots.append(first)
            for n in predictors[0].nodes:
                if n['is_leaf']:
                    nodes.append((-1, 0.0, 0, 0, self.slope * float(n['value'])))
                else:
                    nodes.append((int(n['feature_idx']), float(n['num_threshold']),
                                  first + int(n['left']), first + int(n['right']), 0.0))
        return self.slope * float(np.ravel(self.fitted._baseline_prediction)[0]) + self.shift, roots, nodes


def average_precision(y, p):
    y = y[np.argsort(-p, kind='stable')]
    precision = np.cumsum(y) / np.arange(1, len(y) + 1)
    return float((precision * y).sum() / max(y.sum(), 1))


def regression_of(path, name):
    """The lines of a regression that a file of weights has."""
    text = open(path).read()
    start = text.index(f'const LogisticWeights {name}')
    return text[start:text.index('};', start) + 2].split('\n') + ['']


def write(path, learnt):
    def array(v):
        return '{' + ', '.join(f'{x:.9g}' for x in v) + '}'

    def trees(name, fitted):
        bias, roots, nodes = fitted.nodes()
        lines = [f'const BoostedTrees {name} = {{', f'    {bias:.9g},', f'    {array(roots)},', '    {']
        for k in range(0, len(nodes), 4):
            lines.append('     ' + ' '.join('{%d, %.9g, %d, %d, %.9g},' % n for n in nodes[k:k + 4]))
        return lines + ['    }};', '']
    def logistic(name, fitted):
        return [f'const LogisticWeights {name} = {{', f'    {array(fitted.mean)},', f'    {array(fitted.scale)},',
                f'    {array(fitted.weights)},', f'    {fitted.bias:.9g}}};', '']
    lines = ['#include "rimod/judgement.h"', '',
             '// Written by experiments/train_judgement.py; docs/accuracy.md tells on what.', '',
             '// clang-format off', 'namespace rimod {', '']
    for name, kind in (('kProposalWeights', 'P'), ('kRankWeights', 'R')):
        lines += logistic(name, learnt[kind]) if kind in learnt else regression_of(path, name)
    lines += trees('kJudgementTrees', learnt['J'])
    open(path, 'w').write('\n'.join(lines + ['}  // namespace rimod', '']))


def held_out(learn, X, y, weight, groups, folds):
    """Each candidate's probability after learning from the other folds."""
    ids = {g: i % folds for i, g in enumerate(sorted(set(groups)))}
    fold = np.array([ids[g] for g in groups])
    p = np.zeros(len(y))
    for k in range(folds):
        train = (y >= 0) & (fold != k)
        p[fold == k] = learn(X[train], y[train], weight[train]).predict(X[fold == k])
    return p


def chosen(p, groups, names, centres, models, least=0.02):
    """The candidates that become detections: best first, none too near to a better one of its scan."""
    result, kept = [], {}
    for i in np.argsort(-p, kind='stable'):
        if p[i] < least:
            break
        diameter = models[names[i]].diameter
        near = any(np.linalg.norm(centres[i] - centres[k]) <
                   (0.4 if names[i] == names[k] else 0.2) * min(diameter, models[names[k]].diameter)
                   for k in kept.get(groups[i], []))
        if not near:
            kept.setdefault(groups[i], []).append(i)
            result.append(i)
    return np.array(result)


def write_detections(folder, sets, p, detections, groups, names, poses):
    """One JSON line a detection, a file for each {number: name} of sets."""
    folder.mkdir(parents=True, exist_ok=True)
    lines = {number: [] for number in sets}
    for i in detections:
        number, scan = groups[i].split('/', 1)
        if int(number) in lines:
            lines[int(number)].append(json.dumps({'scan': scan, 'class': str(names[i]), 'pose': [float(x) for x in poses[i]],
                                                  'score': float(p[i])}))
    for number, name in sets.items():
        (folder / f'{name}.jsonl').write_text(''.join(line + '\n' for line in lines[number]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--models', required=True, action='append')
    parser.add_argument('--data', required=True, action='append')
    parser.add_argument('--out')
    parser.add_argument('--folds', type=int)
    parser.add_argument('--judgement-only', action='store_true')
    parser.add_argument('--held-out', type=pathlib.Path)
    parser.add_argument('--ridge', type=float, default=1.0)
    a = parser.parse_args()
    models = {p.parent.name: Model(p) for folder in a.models for p in pathlib.Path(folder).glob('*/model.json')}
    kinds = ('J',) if a.judgement_only else tuple(RIGHT)
    data = {kind: [] for kind in kinds}
    sets = {}  # those without a weight: {number: folder}
    for n, pair in enumerate(a.data):
        labels_path, csv_path = pair.split('=')
        csv_path, _, set_weight = csv_path.partition('@')
        labels = json.load(open(labels_path))
        if not set_weight:
            sets[n] = pathlib.Path(labels_path).resolve().parent.name
        for kind, (scans, names, poses, figures) in read_figures(csv_path, kinds).items():
            y, weight = label(labels, scans, names, poses, models, kind)
            centres = poses[:, :3] + np.einsum('nij,nj->ni', rotations(poses[:, 3:]), np.array([models[n].centre for n in names]))
            groups = np.array([f'{n}/{s}' for s in scans])
            data[kind].append((figures, y, weight * float(set_weight or 1), groups, np.array(names), centres,
                               np.full(len(y), not set_weight), poses))
    learnt = {}
    for kind, parts in data.items():
        X, y, weight, groups, names, centres, own, poses = (np.concatenate([part[i] for part in parts]) for i in range(8))
        print(f'{kind}: {len(y)} candidates, {(y == 1).sum()} right, {(y == 0).sum()} wrong', file=sys.stderr)
        known = y >= 0
        learn = Trees if kind == 'J' else lambda X, y, w: Logistic(X, y, w, a.ridge)
        if a.folds:
            q = np.clip(held_out(learn, X, y, weight, groups, a.folds)[known], 1e-6, 1 - 1e-6)
            loss = -np.mean(y[known] * np.log(q) + (1 - y[known]) * np.log(1 - q))
            print(f'{kind}: held out: log loss {loss:.5f}, average precision {average_precision(y[known], q):.4f}')
            continue
        learnt[kind] = learn(X[known], y[known], weight[known])
        if kind == 'J':
            p = held_out(learn, X, y, weight, groups, 5)
            detections = chosen(np.where(own, p, 0.0), groups, names, centres, models)
            learnt[kind].calibrate(p[detections], y[detections] != 0)
            if a.held_out:
                write_detections(a.held_out, sets, learnt[kind].calibrated(p), detections, groups, names, poses)
    if not a.folds:
        write(a.out, learnt)


if __name__ == '__main__':
    main()

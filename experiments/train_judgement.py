#!/usr/bin/env python3
"""Learn the default method's weights from figures of labelled scans.

usage: train_judgement.py --models MODELS_DIR --data LABELS.json=FIGURES.csv [--data ..] [--out FILE.cpp]
       train_judgement.py --models MODELS_DIR --data .. --folds 5

MODELS_DIR has <class>/model.json with box and symmetry, LABELS.json and model.json are in the format of
the benchmark sets, FIGURES.csv comes from rimod-dump-figures. Writes rimod/judgement_weights.cpp: a
logistic regression for ranking candidates (lines R) and boosted trees for judging them (lines J; needs
scikit-learn, Debian's python3-sklearn). A candidate
is right within 10 cm and 15 degrees of an object of its class (modulo its symmetry) and wrong when its
centre is farther than max(0.15 m, 0.25 diameters) from all of them; those in between are left out. With
--folds the scans are split and the log loss and the average precision over the held-out candidates are printed,
nothing is written.
"""
import argparse
import json
import math
import sys

import numpy as np

SYMMETRY = {'none': 1, 'yaw2': 2, 'yaw4': 4, 'yaw_continuous': 0}
POSITION_ERROR, ANGLE_ERROR = 0.10, math.radians(15)


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


def read_figures(path):
    """{kind: (scans, classes, poses N x 7, figures N x F)}"""
    rows = {}
    for line in open(path):
        kind, scan, name, *numbers = line.rstrip('\n').split(',')
        rows.setdefault(kind, []).append((scan, name, [float(x) for x in numbers]))
    result = {}
    for kind, r in rows.items():
        numbers = np.array([x[2] for x in r])
        result[kind] = ([x[0] for x in r], [x[1] for x in r], numbers[:, :7], numbers[:, 7:])
    return result


def label(labels, scans, names, poses, models):
    """1 right, 0 wrong, -1 in between, for each candidate."""
    objects = {s['scan']: s['objects'] for s in labels['scans']}
    R = rotations(poses[:, 3:])
    y = np.zeros(len(scans), int)
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
            good = (distance < POSITION_ERROR) & (angle < ANGLE_ERROR)
            near = distance < max(0.15, 0.25 * m.diameter)
            for k, i in enumerate(index):
                y[i] = 1 if good[k] else (-1 if near[k] and y[i] == 0 else y[i])
    return y


def fit(X, y, ridge=1.0):
    mean, scale = X.mean(0), X.std(0) + 1e-6
    Z = np.hstack([(X - mean) / scale, np.ones((len(X), 1))])
    penalty = ridge * np.r_[np.ones(X.shape[1]), 0]
    b = np.zeros(Z.shape[1])
    for _ in range(40):
        p = 1 / (1 + np.exp(-np.clip(Z @ b, -40, 40)))
        w = np.maximum(p * (1 - p), 1e-9)
        step = np.linalg.solve((Z * w[:, None]).T @ Z + np.diag(penalty + 1e-9), Z.T @ (p - y) + penalty * b)
        b -= step
        if np.abs(step).max() < 1e-8:
            break
    return mean, scale, b[:-1], b[-1]


def predict(model, X):
    mean, scale, w, bias = model
    return 1 / (1 + np.exp(-np.clip(((X - mean) / scale) @ w + bias, -40, 40)))


class Trees:
    """Gradient boosting for the judgement; the settings keep the leaves well filled."""

    def __init__(self, X, y):
        from sklearn.ensemble import HistGradientBoostingClassifier
        self.fitted = HistGradientBoostingClassifier(
            max_iter=200, learning_rate=0.05, max_leaf_nodes=10, l2_regularization=3.0,
            min_samples_leaf=20, early_stopping=False, random_state=0).fit(X, y)

    def predict(self, X):
        return self.fitted.predict_proba(X)[:, 1]

    def nodes(self):
        """bias, roots, nodes (feature, threshold, left, right, value)"""
        roots, nodes = [], []
        for predictors in self.fitted._predictors:
            first = len(nodes)
            roots.append(first)
            for n in predictors[0].nodes:
                if n['is_leaf']:
                    nodes.append((-1, 0.0, 0, 0, float(n['value'])))
                else:
                    nodes.append((int(n['feature_idx']), float(n['num_threshold']),
                                  first + int(n['left']), first + int(n['right']), 0.0))
        return float(np.ravel(self.fitted._baseline_prediction)[0]), roots, nodes


def average_precision(y, p):
    y = y[np.argsort(-p, kind='stable')]
    precision = np.cumsum(y) / np.arange(1, len(y) + 1)
    return float((precision * y).sum() / max(y.sum(), 1))


def write(path, rank, trees):
    def array(v):
        return '{' + ', '.join(f'{x:.9g}' for x in v) + '}'
    mean, scale, w, rank_bias = rank
    bias, roots, nodes = trees.nodes()
    lines = ['#include "rimod/judgement.h"', '',
             '// Written by experiments/train_judgement.py; docs/accuracy.md tells on what.', '',
             '// clang-format off', 'namespace rimod {', '',
             'const LogisticWeights kRankWeights = {', f'    {array(mean)},', f'    {array(scale)},',
             f'    {array(w)},', f'    {rank_bias:.9g}}};', '',
             'const BoostedTrees kJudgementTrees = {', f'    {bias:.9g},', f'    {array(roots)},', '    {']
    for k in range(0, len(nodes), 4):
        lines.append('     ' + ' '.join('{%d, %.9g, %d, %d, %.9g},' % n for n in nodes[k:k + 4]))
    lines += ['    }};', '', '}  // namespace rimod', '']
    open(path, 'w').write('\n'.join(lines))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--models', required=True, action='append')
    parser.add_argument('--data', required=True, action='append')
    parser.add_argument('--out')
    parser.add_argument('--folds', type=int)
    parser.add_argument('--ridge', type=float, default=1.0)
    a = parser.parse_args()
    import pathlib
    models = {p.parent.name: Model(p) for folder in a.models for p in pathlib.Path(folder).glob('*/model.json')}
    data = {'R': [], 'J': []}
    for n, pair in enumerate(a.data):
        labels_path, csv_path = pair.split('=')
        labels = json.load(open(labels_path))
        for kind, (scans, names, poses, figures) in read_figures(csv_path).items():
            y = label(labels, scans, names, poses, models)
            data[kind].append((figures, y, np.array([f'{n}/{s}' for s in scans])))
    learnt = {}
    for kind, parts in data.items():
        X = np.vstack([p[0] for p in parts])
        y = np.concatenate([p[1] for p in parts])
        scans = np.concatenate([p[2] for p in parts])
        known = y >= 0
        print(f'{kind}: {len(y)} candidates, {(y == 1).sum()} right, {(y == 0).sum()} wrong', file=sys.stderr)
        if a.folds:
            ids = {s: i % a.folds for i, s in enumerate(sorted(set(scans)))}
            fold = np.array([ids[s] for s in scans])
            p = np.zeros(len(y))
            for k in range(a.folds):
                X_train, y_train = X[known & (fold != k)], y[known & (fold != k)]
                p[fold == k] = (predict(fit(X_train, y_train, a.ridge), X[fold == k]) if kind == 'R'
                                else Trees(X_train, y_train).predict(X[fold == k]))
            q = np.clip(p[known], 1e-6, 1 - 1e-6)
            loss = -np.mean(y[known] * np.log(q) + (1 - y[known]) * np.log(1 - q))
            print(f'{kind}: held out: log loss {loss:.5f}, average precision {average_precision(y[known], p[known]):.4f}')
        else:
            learnt[kind] = fit(X[known], y[known], a.ridge) if kind == 'R' else Trees(X[known], y[known])
    if not a.folds:
        write(a.out, learnt['R'], learnt['J'])


if __name__ == '__main__':
    main()

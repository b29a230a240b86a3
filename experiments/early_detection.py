#!/usr/bin/env python3
"""What detections before the end of the sweep gain, and how many of them are wrong.

usage: early_detection.py LABELS.json EARLY.jsonl MODELS_DIR [--curve]

EARLY.jsonl is written by rimod-early-detection (experiments/README.md has the commands), LABELS.json and MODELS_DIR are
those of a labelled set: objects with class and pose a scan, a model.json with the box a class.

An early detection is right when, at the moment when it is first told, it lies on a labelled object of its class: centres
of the boxes within max(0.15 m, 0.25 * diameter). Seconds gained: from the last beam that was known when the object was
first rightly told to the last beam of the sweep. --curve tries other thresholds on the same looks.
"""
import argparse
import json
import math
import pathlib
import statistics


def rotate(q, v):
    w, x, y, z = q
    n = math.sqrt(w * w + x * x + y * y + z * z)
    w, x, y, z = w / n, x / n, y / n, z / n
    t = [2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])]
    return [v[0] + w * t[0] + y * t[2] - z * t[1], v[1] + w * t[1] + z * t[0] - x * t[2],
            v[2] + w * t[2] + x * t[1] - y * t[0]]


class Labels:
    def __init__(self, labels, models):
        self.boxes = {}
        folder = models / 'models' if (models / 'models').is_dir() else models
        for path in sorted(folder.glob('*/model.json')):
            self.boxes[path.parent.name] = json.loads(path.read_text())['box']
        self.scans = {s['scan']: s['objects'] for s in json.loads(labels.read_text())['scans']}

    def centre(self, name, pose):
        box = self.boxes[name]
        middle = [(a + b) / 2 for a, b in zip(box['min'], box['max'])]
        return [a + b for a, b in zip(rotate(pose[3:], middle), pose[:3])]

    def on_object(self, scan, detection):
        """index of the labelled object of its class that a detection lies on, or None, and the distance, m"""
        box = self.boxes[detection['class']]
        reach = max(.15, .25 * math.dist(box['min'], box['max']))
        near = [(math.dist(self.centre(o['class'], o['pose']), self.centre(detection['class'], detection['pose'])), i)
                for i, o in enumerate(self.scans[scan]) if o['class'] == detection['class']]
        near = [n for n in near if n[0] <= reach]
        return (min(near)[1], min(near)[0]) if near else (None, None)

    def same_object(self, a, b, share=.4):
        box = self.boxes[a['class']]
        return a['class'] == b['class'] and math.dist(self.centre(a['class'], a['pose']), self.centre(
            b['class'], b['pose'])) <= share * math.dist(box['min'], box['max'])


def told_by(labels, scan, max_unseen, min_score, min_sightings):
    """[(look, detection, withdrawn)] of first tellings, with other thresholds than the run had; nobody is withdrawn for
    misses, only in the end"""
    tracks = []
    for k, look in enumerate(scan['looks']):
        seen = []
        for s in look['sightings']:
            track = next((t for t in tracks if t not in seen and labels.same_object(t['last'], s)), None)
            if track is None:
                track = {'row': 0, 'told': None}
                tracks.append(track)
            seen.append(track)
            track['last'] = s
            track['row'] = track['row'] + 1 if s['unseen'] <= max_unseen and s['score'] >= min_score else 0
            if track['told'] is None and track['row'] >= min_sightings:
                track['told'] = (k, s)
        for track in tracks:
            if track not in seen:
                track['row'] = 0
    final = [d for d in scan['final'] if d['status'] != 'withdrawn']
    return [(*t['told'], not any(labels.same_object(t['last'], f) for f in final)) for t in tracks if t['told']]


def told_in(scan):
    """the same as the run itself told it"""
    first, withdrawn = {}, {d['id'] for d in scan['final'] if d['status'] == 'withdrawn'}
    for k, look in enumerate(scan['looks']):
        for d in look['told']:
            first.setdefault(d['id'], (k, d))
    return [(k, d, i in withdrawn) for i, (k, d) in sorted(first.items())]


def judge(labels, scans, tell):
    r = {'gain': {}, 'found': [], 'right': 0, 'wrong_kept': 0, 'wrong_withdrawn': 0, 'right_withdrawn': 0, 'errors': [], 'flickers': 0}
    for scan in scans:
        name = scan['scan']
        for d in scan['final']:
            index, _ = labels.on_object(name, d)
            if d['status'] != 'withdrawn' and index is not None:
                r['found'].append((name, index))
        for k, d, withdrawn in tell(scan):
            index, distance = labels.on_object(name, d)
            if index is None:
                r['wrong_withdrawn' if withdrawn else 'wrong_kept'] += 1
                continue
            r['right'] += 1
            r['errors'].append(distance)
            r['right_withdrawn'] += withdrawn
            gain = (scan['end'] - scan['looks'][k]['known_until']) * 1e-6
            key = (name, index)
            r['gain'][key] = max(gain, r['gain'].get(key, 0.))
    return r


def median(values):
    return statistics.median(values) if values else float('nan')


def row(r, objects):
    gains = [r['gain'].get(o, 0.) for o in objects]
    early = sorted(g for g in gains if g > 0)
    n = len(objects)
    return (f"{n} | {len(early)} ({100 * len(early) / n if n else 0:.0f} %) | {median(gains):.1f} | {median(early):.1f} | "
            f"{early[0] if early else 0:.1f} .. {early[-1] if early else 0:.1f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('labels', type=pathlib.Path)
    parser.add_argument('early', type=pathlib.Path)
    parser.add_argument('models', type=pathlib.Path)
    parser.add_argument('--curve', action='store_true')
    a = parser.parse_args()
    labels = Labels(a.labels, a.models)
    scans = [json.loads(line) for line in a.early.read_text().splitlines()]
    if a.curve:
        print('| unseen at most | score at least | looks | found in the end | of these told early | median gain of all, s | wrong early | .. and in the end |')
        print('| --- | --- | --- | --- | --- | --- | --- | --- |')
        for sightings in (1, 2):
            for score in (.5, .7, .9):
                for unseen in (0., .02, .05, .1, .2, .3, .5, 1.):
                    r = judge(labels, scans, lambda s: told_by(labels, s, unseen, score, sightings))
                    found = sorted(set(r['found']))
                    gains = [r['gain'].get(o, 0.) for o in found]
                    print(f"| {unseen} | {score} | {sightings} | {len(found)} | {sum(g > 0 for g in gains)} | {median(gains):.1f} | "
                          f"{r['wrong_withdrawn']} | {r['wrong_kept']} |")
        return
    r = judge(labels, scans, told_in)
    found = sorted(set(r['found']))
    print('| class | found in the end | of these told early | gain of all, s, median | gain of those told early | least .. most |')
    print('| --- | --- | --- | --- | --- | --- |')
    for name in sorted(labels.boxes):
        objects = [o for o in found if labels.scans[o[0]][o[1]]['class'] == name]
        print(f'| {name} | {row(r, objects)} |')
    print(f'| **all** | {row(r, found)} |')
    sweep = median([(s['end'] - s['begin']) * 1e-6 for s in scans])
    looks = [look['ms'] for s in scans for look in s['looks']]
    print(f"""
{len(scans)} sweeps of {sweep:.1f} s. Told early: {r['right']} right, {r['wrong_kept'] + r['wrong_withdrawn']} wrong ({r['wrong_withdrawn']} withdrawn \
by the end, {r['wrong_kept']} are also in the final result); of the right ones {r['right_withdrawn']} are withdrawn.
Position error when first told: median {1e3 * median(r['errors']):.0f} mm. A look took {median(looks):.0f} ms in the median, {len(looks) / len(scans):.1f} looks a sweep; \
the last, at the whole scan, {median([s['ms'] for s in scans]):.0f} ms.""")


if __name__ == '__main__':
    main()

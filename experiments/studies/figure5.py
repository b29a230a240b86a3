"""The paper's figure 5 (section IV): which resolution and support the descriptors should have."""
import collections
import csv
import io

import studies

TITLE = 'Figure 5: resolution and support of the descriptors'
ABOUT = ('Score zeta of the paper\'s method, false positives not rejected, for descriptors of every resolution and support, '
         'the best over d_max; below it zeta by the seconds of a scan. Bright is good; the circle is our best setting, the square the paper\'s.')

DESCRIPTORS = {'range_patch': 'range patches', 'spherical_spin': 'spherical spin images'}
PAPER_BEST = {'range_patch': (8, 0.35), 'spherical_spin': (5, 0.60)}  # cells a side, m
D_MAX = (0.015, 0.03, 0.06, 0.1)  # m a cell, root mean square
# Three grids, each within the next; the first alone already makes whole heat maps.
COARSE = ((3, 5, 8, 12), (0.1, 0.2, 0.35, 0.6, 0.8))
FULL = (tuple(range(3, 13)), tuple(round(0.1 * i, 2) for i in range(1, 9)) + (0.35,))
NUM_SCANS = 30
STAGES = ('range_image', 'interest_points', 'descriptors', 'matching', 'hypotheses', 'scoring', 'pruning')


def zeta(tp, fp, fn):
    """Equation (3) of the paper."""
    below = fn * fn + fp
    return tp * tp / below if below else float('inf')


def settings(context):
    """(descriptor, resolution, support) in the order in which they are measured."""
    resolutions, supports = COARSE
    listed = [(d, n, s) for n in resolutions for s in supports for d in DESCRIPTORS]
    if context.option('full'):
        listed += [(d, n, s) for n in FULL[0] for s in sorted(FULL[1]) for d in DESCRIPTORS if (d, n, s) not in set(listed)]
    return listed


def measure(context, descriptor, resolution, support):
    command = [context.program('rimod-descriptor-grid'), '--models', context.models('paper'), '--recordings', context.recordings,
               '--labels', context.labels, '--config', context.config('paper'), '--descriptor', descriptor,
               '--resolution', str(resolution), '--support', str(support), '--d-max', *map(str, D_MAX),
               '--scans', *context.scans(8 if context.quick else NUM_SCANS)]
    rows = list(csv.DictReader(io.StringIO(context.run(command))))
    return [{key: value if key == 'descriptor' else float(value) for key, value in row.items()} for row in rows]


def units(context):
    return [studies.Unit(f'{d}_{n}_{s}', lambda d=d, n=n, s=s: measure(context, d, n, s)) for d, n, s in settings(context)]


def best_rows(rows):
    """{(descriptor, resolution, support): the row of the d_max with the largest zeta and that of the largest zeta a second}."""
    groups = collections.defaultdict(list)
    for row in rows:
        row = dict(row, zeta=zeta(row['tp'], row['fp'], row['fn']), seconds=sum(row[stage] for stage in STAGES) / 1000)
        row['zeta_a_second'] = row['zeta'] / row['seconds']
        groups[row['descriptor'], int(row['resolution']), row['support']].append(row)
    return {key: {measure: max(group, key=lambda row: row[measure]) for measure in ('zeta', 'zeta_a_second')} for key, group in groups.items()}

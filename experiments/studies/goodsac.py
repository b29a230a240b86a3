import math

from harness import style
from studies import Unit, labelled_offices

TITLE = 'GOODSAC against RANSAC: hypotheses until the first correct one'
ABOUT = ('Share of labelled objects of which a correct pose (10 cm, 15 degrees) is among the first hypotheses, by how many were tried: triples of correspondences in '
         'GOODSAC\'s order (best descriptor distances first) and drawn at random, of the same correspondences, with the same early rejections and budget. '
         'On the left triples are rejected by the distances of their points alone, as in the paper, on the right also by heights, normals and tilt, as by default.')
DATA = (labelled_offices.SET,)
PROGRAMS = ('rimod-triple-orders',)
CONFIGS = {'distances': {'method': 'paper', 'goodsac': {'angle_tolerance_deg': 180, 'height_tolerance': 1000, 'min_normal_cosine': -1, 'max_tilt_deg': 180}},
           'all': 'paper'}
SEEDS = 3
NUM_SCANS, NUM_QUICK_SCANS = 30, 3


def units(context):
    scans = NUM_QUICK_SCANS if context.quick else NUM_SCANS
    return [Unit(f'{name}_{number:03d}', lambda number=number, name=name: measure(context, name, number)) for number in range(scans) for name in CONFIGS]


def measure(context, name, number):
    """A row for each object of a scan and order: the first correct one of the hypotheses tried, 0 if none is."""
    rows = labelled_offices.run(context, PROGRAMS[0], CONFIGS[name], [number], '--seeds', SEEDS)
    texts = ('scan', 'class', 'order')
    return [{'rejections': name, **{key: value if key in texts else float(value) for key, value in row.items()}} for row in rows]


REJECTIONS = {'distances': 'distances alone', 'all': 'distances, heights, normals, tilt'}
ORDERS = {'goodsac': 'GOODSAC', 'goodsac_limited': 'GOODSAC, 5 poses a worst member', 'ransac': 'RANSAC'}
LOOKS = {'goodsac': {'color': style.COLOURS['blue'], 'linestyle': '-'},
         'goodsac_limited': {'color': style.COLOURS['green'], 'linestyle': '-.'},
         'ransac': {'color': style.COLOURS['vermilion'], 'linestyle': '--'}}


def report_share(rows, order, tried):
    """Of the objects, those with a correct pose among the first so many."""
    of_order = [row for row in rows if row['order'] == order]
    return sum(0 < row['first'] <= tried for row in of_order) / len(of_order) if of_order else 0.0


def report_curves(figure, rows, highest):
    steps = [10 ** (i / 20) for i in range(int(20 * math.log10(highest)) + 2)]
    for axes, (rejections, title) in zip(figure.subplots(1, 2, sharey=True), REJECTIONS.items()):
        of_both = [row for row in rows if row['rejections'] == rejections]
        for order, name in ORDERS.items():
            axes.plot(steps, [100 * report_share(of_both, order, tried) for tried in steps], label=name, **LOOKS[order])
        axes.set(xscale='log', xlabel='hypotheses tried for an object', xlim=(1, highest), ylim=(0, 103), title=f'rejected by {title}')
    figure.axes[0].set(ylabel='objects with a correct one (%)')
    figure.axes[0].legend(loc='upper left')


def report_median(rows, order):
    """Hypotheses after which half of all objects have a correct one; None when half never do."""
    first = sorted(row['first'] or math.inf for row in rows if row['order'] == order)
    middle = first[len(first) // 2] if first else math.inf
    return None if math.isinf(middle) else middle


def report(context, rows):
    highest = max(row['tried'] for row in rows)
    context.figure('first', 'Objects with a correct hypothesis among the first, by how many were tried.',
                   lambda figure: report_curves(figure, rows, highest), (8.0, 3.6))
    tried = (1, 10, 100, 1000, 10000)
    lines, sentences = [], []
    for rejections, title in REJECTIONS.items():
        of_both = [row for row in rows if row['rejections'] == rejections]
        if not of_both:
            continue
        parts = []
        for order, name in ORDERS.items():
            median, budget = report_median(of_both, order), report_share(of_both, order, highest)
            lines.append([title, name, sum(r['order'] == order for r in of_both), *(f'{100 * report_share(of_both, order, t):.0f} %' for t in tried),
                          f'{100 * budget:.0f} %', median])
            parts.append(f'{name} ' + ('never' if median is None else f'after {median:.0f}') + f' ({100 * budget:.0f} % within the budget)')
        sentences.append(f'Rejected by {title}, half of the objects have a correct hypothesis with ' + ', with '.join(parts) + '.')
    context.table('first', 'Objects with a correct hypothesis', ('rejected by', 'order', 'runs', *(f'within {t}' for t in tried), 'at all', 'median'), lines)
    return ' '.join(sentences)

import math

from harness import style
from studies import Unit, labelled_offices

TITLE = 'GOODSAC against RANSAC: hypotheses until the first correct one'
ABOUT = ('Share of labelled objects of which a correct pose (10 cm, 15 degrees) is among the first hypotheses, by how many were tried: triples of correspondences in '
         'GOODSAC\'s order (best descriptor distances first) and drawn at random, of the same correspondences, with the same early rejections and budget.')
DATA = (labelled_offices.SET,)
PROGRAMS = ('rimod-triple-orders',)
CONFIG = 'paper'
SEEDS = 3
NUM_SCANS, NUM_QUICK_SCANS = 30, 3


def units(context):
    scans = NUM_QUICK_SCANS if context.quick else NUM_SCANS
    return [Unit(f'{number:03d}', lambda number=number: measure(context, number)) for number in range(scans)]


def measure(context, number):
    """A row for each object of a scan and order: the first correct one of the hypotheses tried, 0 if none is."""
    rows = labelled_offices.run(context, PROGRAMS[0], CONFIG, [number], '--seeds', SEEDS)
    texts = ('scan', 'class', 'order')
    return [{key: value if key in texts else float(value) for key, value in row.items()} for row in rows]


ORDERS = {'goodsac': 'GOODSAC', 'goodsac_limited': 'GOODSAC, 5 poses a worst member', 'ransac': 'RANSAC'}
LOOKS = {'goodsac': {'color': style.COLOURS['blue'], 'linestyle': '-'},
         'goodsac_limited': {'color': style.COLOURS['green'], 'linestyle': '-.'},
         'ransac': {'color': style.COLOURS['vermilion'], 'linestyle': '--'}}


def report_share(rows, order, tried):
    """Of the objects, those with a correct pose among the first so many."""
    of_order = [row for row in rows if row['order'] == order]
    return sum(0 < row['first'] <= tried for row in of_order) / len(of_order)


def report_curves(figure, rows, highest):
    axes = figure.subplots()
    steps = [10 ** (i / 20) for i in range(int(20 * math.log10(highest)) + 2)]
    for order, name in ORDERS.items():
        axes.plot(steps, [100 * report_share(rows, order, tried) for tried in steps], label=name, **LOOKS[order])
    axes.set(xscale='log', xlabel='hypotheses tried for an object', ylabel='objects with a correct one (%)', xlim=(1, highest), ylim=(0, 103))
    axes.legend(loc='upper left')


def report_median(rows, order):
    """Hypotheses after which half of all objects have a correct one; None when half never do."""
    first = sorted(row['first'] or math.inf for row in rows if row['order'] == order)
    middle = first[len(first) // 2]
    return None if math.isinf(middle) else middle


def report(context, rows):
    highest = max(row['tried'] for row in rows)
    context.figure('first', 'Objects with a correct hypothesis among the first, by how many were tried.', lambda figure: report_curves(figure, rows, highest))
    tried = (1, 10, 100, 1000, 10000)
    lines = [[name, len([r for r in rows if r['order'] == order]), *(f'{100 * report_share(rows, order, t):.0f} %' for t in tried),
              f'{100 * report_share(rows, order, highest):.0f} %', report_median(rows, order)] for order, name in ORDERS.items()]
    context.table('first', 'Objects with a correct hypothesis', ('order', 'runs', *(f'within {t}' for t in tried), 'at all', 'median'), lines)
    parts = []
    for order, name in ORDERS.items():
        median = report_median(rows, order)
        parts.append(f'{name} has a correct hypothesis for half of the objects ' + ('never' if median is None else f'after {median:.0f}') +
                     f', for {100 * report_share(rows, order, highest):.0f} % within the budget')
    return '. '.join(parts) + '.'

import math

from harness import curves, scoring, style
from studies import Unit
from studies.paper_figures import FIGURE7_LIMIT, FIGURE7_NEAR

TITLE = "Figure 7: recognition rate over distance"
ABOUT = ('Seven objects in an empty hall, from near to so far that none is found; the dashed line counts the readings on an object. The simulator shows '
         'all seven in one scan, five views a step as in the paper; recorded sets have one object a scan.')
DATA = ('distance',)
DISTANCES = (2, 3, 4, 5, 6, 8, 10, 12, 14, 17)  # m
VIEWS = 5
LIMITS = {'min_visible': 0, 'min_points': 0}


def units(context):
    if context.has_data('distance'):
        return [Unit(f'data_{scan.name}', lambda scan=scan: data_work(context, scan)) for scan in context.shuffled(context.data_scans('distance'))]
    distances, views = (DISTANCES[::3], 1) if context.quick else (DISTANCES, VIEWS)
    return [Unit(f'{d}m_{view}', lambda d=d, view=view: work(context, d, view)) for view in range(views) for d in distances]


def data_work(context, scan):
    step = round(math.hypot(*scan.objects[0]['pose'][:2]))
    return context.judged(scan, simulated=False, limits=LIMITS, step=step)


def work(context, distance, view):
    scan = context.simulated.ring(f'distance_{distance}m_{view}', view, distance=distance)
    return context.judged(scan, limits=LIMITS, step=distance, view=view)


def report(context, rows):
    context.figure('recall', 'Recognition rate over distance, mean of the seven classes, with what the paper says of its own; '
                   'readings on an object (median) on the right.',
                   lambda figure: report_mean(figure, rows))
    context.figure('classes', 'Recognition rate of each class over distance.', lambda figure: report_classes(figure, rows), (7.0, 4.4))
    curves.rate_table(context, 'recall', 'Found objects by distance', rows, 'step', 'distance (m)')
    methods = curves.methods_of(rows)
    classes = sorted({r['class'] for r in rows if r['kind'] == 'object'})
    context.table('classes', 'Farthest distance (m) with at least half and with any of a class found, and the fewest readings on one that was found',
                  ['class'] + [f'{m}: {w}' for m in methods for w in ('half', 'any', 'fewest readings')],
                  [report_class(rows, c, methods) for c in classes])
    return ' '.join(report_sentence(rows, m) for m in methods) + f' The paper: {100 * FIGURE7_NEAR[1]:.0f} % below {FIGURE7_NEAR[0]:g} m, nothing beyond {FIGURE7_LIMIT:g} m.'


def report_mean(figure, rows):
    axes = curves.draw_methods(figure, rows, 'step', 'distance (m)')
    near, share = FIGURE7_NEAR
    axes.plot([0, near], [100 * share] * 2, color=style.COLOURS['black'], linestyle=':', label='paper, below 5 m (89 %)')
    axes.axvline(FIGURE7_LIMIT, color=style.COLOURS['black'], linestyle='-.', linewidth=1, label='paper: none beyond')
    readings = axes.twinx()
    readings.grid(False)
    readings.spines['right'].set_visible(True)
    counts = {}
    for row in rows:
        if row['kind'] == 'object' and row['method'] == rows[0]['method']:
            counts.setdefault(row['step'], []).append(row['points'])
    steps = sorted(counts)
    readings.plot(steps, [max(sorted(counts[s])[len(counts[s]) // 2], 1) for s in steps], color=style.COLOURS['grey'], linestyle='--', marker='^',
                  label='readings on an object')
    readings.set(yscale='log', ylabel='readings on an object (median)', ylim=(1, 10000))
    readings.yaxis.set_major_formatter('{x:g}')
    lines, labels = axes.get_legend_handles_labels()
    more_lines, more_labels = readings.get_legend_handles_labels()
    curves.legend_above(axes, lines + more_lines, labels + more_labels, columns=3)
    axes.set_xlim(left=min(steps) - 1)


def report_classes(figure, rows):
    methods = curves.methods_of(rows)
    grid = figure.add_gridspec(2, len(methods), height_ratios=[8, 1])
    panels = [figure.add_subplot(grid[0, i]) for i in range(len(methods))]
    legend = figure.add_subplot(grid[1, :])
    legend.axis('off')
    classes = sorted({r['class'] for r in rows if r['kind'] == 'object'})
    for axes, method in zip(panels, methods):
        for number, name in enumerate(classes):
            points = curves.rates(rows, 'step', method=method, **{'class': name})
            shift = 1.2 * (number - (len(classes) - 1) / 2)  # percent: lines that coincide stay apart
            axes.plot([p[0] for p in points], [100 * p[1] / p[2] + shift for p in points], label=name.replace('_', ' '),
                      color=style.CLASS_COLOURS[number % 7], marker=style.CLASS_MARKERS[number % 7])
        axes.set(xlabel='distance (m)', title=f'{method} method', ylim=(-6, 106), xticks=sorted({r['step'] for r in rows if r['step'] % 2 == 0}))
    panels[0].set_ylabel('objects found (%; lines shifted a little)')
    legend.legend(*panels[0].get_legend_handles_labels(), loc='center', ncols=4)


def report_class(rows, name, methods):
    line = [name.replace('_', ' ')]
    for method in methods:
        points = curves.rates(rows, 'step', method=method, **{'class': name})
        found = [r['points'] for r in rows if r['kind'] == 'object' and r['class'] == name and r['method'] == method and r['found']]
        line += [max((p[0] for p in points if 2 * p[1] >= p[2]), default=None), max((p[0] for p in points if p[1]), default=None), min(found, default=None)]
    return line


def report_sentence(rows, method):
    points = curves.rates(rows, 'step', method=method)
    near = [p for p in points if p[0] <= FIGURE7_NEAR[0]]
    last = max((p[0] for p in points if p[1]), default=None)
    sums = scoring.totals([r for r in rows if r['method'] == method])
    rate = sum(p[1] for p in near) / max(sum(p[2] for p in near), 1)
    return (f'The {method} method finds {curves.percent(rate)} up to {FIGURE7_NEAR[0]:g} m and something up to {last} m, the farthest step being {points[-1][0]} m '
            f'({sums["fp"]} false positives in all).')

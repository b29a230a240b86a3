import math

from harness import curves, scoring, style
from studies import Unit
from studies.paper_figures import TILT_LIMIT

TITLE = 'Roll and pitch: how upright must objects stand?'
ABOUT = ('Seven objects, leaning by up to 30 degrees about one of two level axes (recorded sets go to 20). '
         'The paper turns its patches by the world\'s vertical and reports that 15 degrees are tolerated.')
DATA = ('tilt',)
ANGLES = (0, 5, 10, 15, 20, 25, 30)  # degrees
VIEWS = 3
LIMITS = {'min_visible': 0, 'min_points': 0}


def units(context):
    if context.has_data('tilt'):
        return [Unit(f'data_{scan.name}', lambda scan=scan: data_work(context, scan)) for scan in context.shuffled(context.data_scans('tilt'))]
    angles, views = (ANGLES[::3], 1) if context.quick else (ANGLES, VIEWS)
    cases = [(angle, axis, view) for view in range(views) for angle in angles for axis in ('roll', 'pitch') if angle or axis == 'roll']
    return [Unit(f'{axis}_{angle}_{view}', lambda c=(angle, axis, view): work(context, *c)) for angle, axis, view in cases]


def leaning(pose):
    """Degrees between an object's axis and the vertical."""
    w, x, y, z = pose[3:]
    return math.degrees(math.acos(max(-1.0, min(1.0, 1 - 2 * (x * x + y * y) / (w * w + x * x + y * y + z * z)))))


def data_work(context, scan):
    angle = 5 * round(leaning(scan.objects[0]['pose']) / 5)
    return context.judged(scan, simulated=False, limits=LIMITS, angle=angle, axis='any')


def work(context, angle, axis, view):
    signed = angle if view % 2 == 0 else -angle
    scan = context.simulated.ring(f'tilt_{axis}_{angle}_{view}', view, tilt=(signed, 0.0) if axis == 'pitch' else (0.0, signed))
    return context.judged(scan, limits=LIMITS, angle=angle, axis=axis, view=view)


def report(context, rows):
    context.figure('recall', 'Objects found over how far they lean.', lambda figure: report_plot(figure, rows))
    curves.rate_table(context, 'recall', 'Found objects by leaning angle', rows, 'angle', 'leaning (degrees)')
    if len({r['axis'] for r in rows}) > 1:
        leaning_rows = [r for r in rows if r['angle'] > 0]
        curves.rate_table(context, 'axes', 'Leaning objects by axis', leaning_rows, 'axis', 'axis')
    sentences = []
    for method in curves.methods_of(rows):
        points = curves.rates(rows, 'angle', method=method)
        parts = [[p for p in points if wanted(p[0])] for wanted in (lambda a: a <= TILT_LIMIT, lambda a: a > TILT_LIMIT)]
        shares = [scoring.ratio(sum(p[1] for p in part), sum(p[2] for p in part)) for part in parts]
        sentences.append(f'The {method} method finds {curves.percent(shares[0])} of those that lean by {TILT_LIMIT:g} degrees or less '
                         f'and {curves.percent(shares[1])} of those beyond, '
                         f'up to {points[-1][0]:g} degrees.')
    return ' '.join(sentences)


def report_plot(figure, rows):
    axes = curves.draw_methods(figure, rows, 'angle', 'leaning from the vertical (degrees)')
    axes.axvline(TILT_LIMIT, color=style.COLOURS['black'], linestyle='-.', linewidth=1)
    axes.annotate('paper: tolerated up to here', (TILT_LIMIT, 6), xytext=(4, 0), textcoords='offset points', fontsize=8)

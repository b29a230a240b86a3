from harness import curves
from studies import Unit

TITLE = 'Occlusion: how much of an object must be seen?'
ABOUT = ('Objects of which something in front hides a part, counted by the share of their readings that is left. The simulator puts a screen '
         'before each of seven objects 3 m away; recorded sets are the cluttered offices of Table I, where hardly any object is mostly hidden.')
DATA = ('train',)
COVERS = (0.0, 0.2, 0.35, 0.5, 0.6, 0.7, 0.8)  # of the object's width
VIEWS = 4
LIMITS = {'min_visible': 0, 'min_points': 0}
STEP = 10  # percent, of the bins
NUM_SCANS = 20


def units(context):
    if context.has_data('train'):
        return [Unit(f'data_{scan.name}', lambda scan=scan: context.judged(scan, simulated=False, limits=LIMITS))
                for scan in context.data_scans('train')[:NUM_SCANS]]
    covers, views = (COVERS[::3], 1) if context.quick else (COVERS, VIEWS)
    return [Unit(f'{100 * cover:g}_{view}', lambda cover=cover, view=view: work(context, cover, view)) for view in range(views) for cover in covers]


def work(context, cover, view):
    scan = context.simulated.ring(f'occlusion_{100 * cover:g}_{view}', view, cover=cover)
    return context.judged(scan, limits=LIMITS, cover=cover, view=view)


def report(context, rows):
    objects = [{**r, 'bin': report_bin(r['visible'])} for r in rows if r['kind'] == 'object']
    context.figure('recall', f'Objects found over the share of them that is in view, in steps of {STEP} %.',
                   lambda figure: curves.draw_methods(figure, objects, 'bin', 'visible share (%, middle of the step)'))
    lines = []
    for value in sorted({r['bin'] for r in objects}):
        points = {m: [p for p in curves.rates(objects, 'bin', method=m) if p[0] == value][0] for m in curves.methods_of(rows)}
        lines.append([f'{value - STEP / 2:g} .. {value + STEP / 2:g}'] 
                     + [c for _, hits, count in points.values() for c in (f'{hits} of {count}', hits / count)])
    context.table('recall', 'Found objects by visible share', ['visible (%)'] + [f'{m}: {w}' for m in curves.methods_of(rows) for w in ('found', 'recall')], lines)
    sentences = []
    for method in curves.methods_of(rows):
        points = curves.rates(objects, 'bin', method=method)
        parts = [[p for p in points if low < p[0] < high] for low, high in ((0, 30), (30, 60), (60, 100))]
        texts = [curves.percent(sum(p[1] for p in part) / sum(p[2] for p in part)) if part else 'none there' for part in parts]
        sentences.append(f'The {method} method finds {texts[2]} of the objects seen to more than 60 %, {texts[1]} of those seen to 30 to 60 % '
                         f'and {texts[0]} of those below.')
    return ' '.join(sentences)


def report_bin(share):
    """Middle of the step that a visible share lies in, percent."""
    return STEP * min(int(100 * share / STEP), 100 // STEP - 1) + STEP / 2

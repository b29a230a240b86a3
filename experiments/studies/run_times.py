from harness import style
from studies import Unit, labelled_offices, paper_figures

TITLE = 'Run times: the paper\'s stages beside ours'
ABOUT = ('Milliseconds a scan of an office with seven models looked for, by stage, both methods on one thread and the same scans; each scan is the fastest of three runs. '
         'Bars are medians, whiskers reach to the 95th percentile; the grey bars are the ranges that the paper gives for its computer of 2009.')
DATA = (labelled_offices.SET,)
METHODS = ('paper', 'default')
NUM_SCANS, NUM_QUICK_SCANS, BATCH = 30, 4, 5
REPEATS = 3


def units(context):
    number = NUM_QUICK_SCANS if context.quick else NUM_SCANS
    batches = [range(first, min(first + BATCH, number)) for first in range(0, number, BATCH)]
    return [Unit(f'{method}_{batch[0]:03d}', lambda method=method, batch=batch: measure(context, method, batch), {'scans': number})
            for batch in batches for method in METHODS]


def measure(context, method, batch):
    """A row for each scan: of every stage the milliseconds of the run with the smallest total."""
    scans, simulated = labelled_offices.scans_of(context, batch)
    fastest = {}
    for _ in range(REPEATS if scans else 0):
        for scan, times in context.detect(scans, method, simulated, threads=1).timing.items():
            if scan not in fastest or times['ms']['total'] < fastest[scan]['ms']['total']:
                fastest[scan] = times
    return [{'method': method, 'scan': scan, 'points': times['points'], **times['ms']} for scan, times in fastest.items()]


# The paper's stages, and ours that do that work.
STAGES = {'range image': ('range_image',), 'interest points': ('interest_points',), 'descriptors': ('descriptors',), 'matching': ('matching',),
          'candidate search': ('hypotheses',), 'scoring': ('scoring',), 'collisions': ('pruning', 'collisions'),
          'rejection of false positives': ('scene_normals', 'refinement', 'validation')}
LABELS = {'paper': 'ours, paper method', 'default': 'ours, default method'}


def report_percentile(values, share):
    """Linear between the values."""
    ordered = sorted(values)
    place = share * (len(ordered) - 1)
    low = int(place)
    return ordered[low] + (place - low) * (ordered[min(low + 1, len(ordered) - 1)] - ordered[low])


def report_times(rows, method, parts):
    """(median, 95th percentile) of the sum of these of our stages; None without scans."""
    sums = [sum(float(row.get(part) or 0) for part in parts) for row in rows if row['method'] == method]
    return (report_percentile(sums, 0.5), report_percentile(sums, 0.95)) if sums else None


def report_bars(figure, rows):
    axes = figure.subplots()
    lines = [*paper_figures.RUN_TIMES, ('whole scan', *paper_figures.RUN_TIME_WHOLE)]
    for place, (stage, least, most) in enumerate(lines):
        parts = STAGES.get(stage, ('total',))
        axes.barh(place - 0.27, most - least, 0.25, left=least, color=style.COLOURS['grey'], label='paper, range' if place == 0 else None)
        for offset, method in ((0.0, 'paper'), (0.27, 'default')):
            times = report_times(rows, method, parts)
            if times:
                axes.barh(place + offset, max(times[0], 0.01), 0.25, color=style.METHOD_LOOK[method]['color'], label=LABELS[method] if place == 0 else None)
                axes.plot([max(times[0], 0.01), max(times[1], 0.01)], [place + offset] * 2, color='black', linewidth=1)
    axes.set(xscale='log', xlim=(0.01, 5000), xlabel='milliseconds a scan (logarithmic)', yticks=range(len(lines)), yticklabels=[line[0] for line in lines])
    axes.invert_yaxis()
    axes.grid(axis='y', visible=False)
    axes.legend(loc='upper center', bbox_to_anchor=(0.4, 1.12), ncols=3)


def report(context, rows):
    context.figure('stages', 'Milliseconds by stage: the paper\'s ranges, and medians with 95th percentiles of ours.',
                   lambda figure: report_bars(figure, rows), (7.0, 4.6))
    lines = []
    for stage, least, most in [*paper_figures.RUN_TIMES, ('whole scan', *paper_figures.RUN_TIME_WHOLE)]:
        cells = [stage, f'{least} .. {most}']
        for method in METHODS:
            times = report_times(rows, method, STAGES.get(stage, ('total',)))
            cells += [round(times[0], 2), round(times[1], 2)] if times else [None, None]
        lines.append(cells)
    columns = ('stage', 'paper (ms)', *(f'{LABELS[m]}: {what}' for m in METHODS for what in ('median', '95 %')))
    context.table('stages', 'Milliseconds a scan', columns, lines)
    whole = {m: report_times(rows, m, ('total',)) for m in METHODS}
    parts = [f'the {m} method {whole[m][0]:.0f} ms (95 %: {whole[m][1]:.0f})' for m in METHODS if whole[m]]
    return 'A scan takes ' + ' and '.join(parts) + f' on one thread; the paper needed {paper_figures.RUN_TIME_WHOLE[0]} to {paper_figures.RUN_TIME_WHOLE[1]} ms.'

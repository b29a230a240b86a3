from harness import scoring, style
from studies import Unit, labelled_offices, paper_figures

TITLE = 'Figure 5: resolution and support of the descriptors'
ABOUT = ('Score zeta of the paper\'s method for descriptors of several resolutions and supports, false positives not rejected and gamma = 0.3, the best over '
         'd_max; below it zeta divided by the processor time of a scan. Bright is good; the circle is the best setting here, the square the paper\'s.')
DATA = (labelled_offices.SET,)
PROGRAMS = ('rimod-descriptor-grid',)
DESCRIPTORS = ('range_patch', 'spherical_spin')
RESOLUTIONS = (8, 5, 12, 3)             # cells a side; the paper's best first, as with all that may be stopped
SUPPORTS = (0.35, 0.6, 0.2, 0.8, 0.1)   # m
D_MAX = (0.03, 0.06, 0.12, 0.2)         # m a cell, root mean square
CONFIG = {'method': 'paper', 'scoring': {'gamma': 0.3}}
NUM_SCANS, NUM_QUICK_SCANS = 30, 6


def units(context):
    return grid(context, RESOLUTIONS, SUPPORTS)


def grid(context, resolutions, supports):
    """Units of a grid, each a setting of a descriptor; those that stand first in both lists come first."""
    settings = sorted((i + j, n, s) for i, n in enumerate(resolutions) for j, s in enumerate(supports))
    number = NUM_QUICK_SCANS if context.quick else NUM_SCANS
    return [Unit(f'{d}_{n}x{n}_{100 * s:g}cm_{number}_scans', lambda d=d, n=n, s=s: measure(context, number, d, n, s))
            for _, n, s in settings for d in DESCRIPTORS]


def measure(context, number, descriptor, resolution, support):
    """A row for each d_max: counts of all scans, mean processor milliseconds a scan on one thread."""
    rows = labelled_offices.run(context, PROGRAMS[0], CONFIG, range(number), '--descriptor', descriptor, '--resolution', resolution,
                                '--support', support, '--d-max', *D_MAX)
    return [{key: value if key == 'descriptor' else float(value) for key, value in row.items()} for row in rows]


STAGES = ('range_image', 'interest_points', 'descriptors', 'matching', 'hypotheses', 'scoring', 'pruning')
MEASURES = {'zeta': 'zeta', 'zeta_a_second': 'zeta / s'}
NAMES = {'range_patch': 'range patches', 'spherical_spin': 'spherical spin images'}


def report_cells(rows):
    """{(descriptor, resolution, support): {measure: the row of the d_max where it is largest}}."""
    cells = {}
    for row in rows:
        seconds = sum(row[stage] for stage in STAGES) / 1000
        zeta = scoring.zeta(row['tp'], row['fp'], row['fn'])
        row = dict(row, seconds=seconds, zeta=zeta, zeta_a_second=zeta / seconds)
        cell = cells.setdefault((row['descriptor'], int(row['resolution']), row['support']), {})
        for measure in MEASURES:
            if measure not in cell or row[measure] > cell[measure][measure]:
                cell[measure] = row
    return cells


def report_best(cells, descriptor, measure):
    """(resolution, support, row) where the measure is largest, the first of equals."""
    _, resolution, support = max((key for key in sorted(cells) if key[0] == descriptor), key=lambda key: cells[key][measure][measure])
    return resolution, support, cells[descriptor, resolution, support][measure]


def report_map(figure, axes, cells, descriptor, measure):
    """A heat map with the value in each cell."""
    resolutions = sorted({n for d, n, _ in cells if d == descriptor})
    supports = sorted({s for d, _, s in cells if d == descriptor})
    values = [[cells[descriptor, n, s][measure][measure] if (descriptor, n, s) in cells else float('nan') for s in supports] for n in resolutions]
    highest = max(v[measure][measure] for v in cells.values())  # one scale for both descriptors
    picture = axes.imshow(values, origin='lower', aspect='auto', cmap=style.COLOUR_MAP, vmin=0, vmax=highest)
    for row, line in enumerate(values):
        for column, value in enumerate(line):
            if value == value:
                axes.text(column, row - 0.28, f'{value:.1f}', ha='center', va='center', fontsize=6.5, color='black' if value > 0.6 * highest else 'white')
    best_resolution, best_support, _ = report_best(cells, descriptor, measure)
    marks = [(best_resolution, best_support, 'o', 9)]
    paper = paper_figures.FIGURE5_BEST[descriptor]
    if paper[0] in resolutions and paper[1] in supports:
        marks.append((*paper, 's', 13))
    for resolution, support, marker, size in marks:
        axes.plot(supports.index(support), resolutions.index(resolution), marker, markersize=size, markerfacecolor='none',
                  markeredgecolor=style.COLOURS['vermilion'], markeredgewidth=1.6)
    axes.set(xticks=range(len(supports)), xticklabels=[f'{100 * s:g}' for s in supports], yticks=range(len(resolutions)),
             yticklabels=[str(n) for n in resolutions], xlabel='support (cm)', ylabel='resolution (cells a side)',
             title=f'{NAMES[descriptor]}: {MEASURES[measure]}')
    axes.grid(False)
    figure.colorbar(picture, ax=axes, label=MEASURES[measure])


def report_maps(figure, cells):
    for row, axes in zip(MEASURES, figure.subplots(len(MEASURES), len(DESCRIPTORS))):
        for column, descriptor in enumerate(DESCRIPTORS):
            report_map(figure, axes[column], cells, descriptor, row)


def report(context, rows):
    cells = report_cells(rows)
    context.figure('maps', 'Score zeta (above) and zeta a second (below), each the best over d_max. Circle: best here; square: best in the paper.',
                   lambda figure: report_maps(figure, cells), (8.0, 6.4))
    columns = ('descriptor', 'best by', 'resolution', 'support (m)', 'd_max (m)', 'zeta', 'true', 'false', 'missed', 'ms a scan', 'paper')
    lines, sentences = [], []
    for descriptor in DESCRIPTORS:
        n, s = paper_figures.FIGURE5_BEST[descriptor]
        for measure in MEASURES:
            resolution, support, row = report_best(cells, descriptor, measure)
            lines.append((NAMES[descriptor], MEASURES[measure], f'{resolution} x {resolution}', support, row['d_max'], row['zeta'], row['tp'],
                          row['fp'], row['fn'], 1000 * row['seconds'], f'{n} x {n}, {s:g} m'))
        resolution, support, row = report_best(cells, descriptor, 'zeta')
        fast = report_best(cells, descriptor, 'zeta_a_second')
        sentence = (f'{NAMES[descriptor].capitalize()} do best with {resolution} x {resolution} cells over {support:g} m (zeta {row["zeta"]:.1f}), '
                    f'by time with {fast[0]} x {fast[0]} over {fast[1]:g} m')
        at_paper = cells.get((descriptor, n, s))
        if at_paper:
            value = at_paper['zeta']['zeta']
            sentence += f'; the paper\'s {n} x {n} over {s:g} m reach {100 * value / row["zeta"]:.0f} % of that best zeta ({value:.1f})'
        sentences.append(sentence + '.')
    context.table('best', 'Best settings', columns, lines)
    best = {d: report_best(cells, d, 'zeta')[2]['zeta'] for d in DESCRIPTORS}
    sentences.append(f'The best zeta of spin images is {100 * best["spherical_spin"] / best["range_patch"]:.0f} % of that of range patches '
                     '(the paper: significantly lower).')
    return ' '.join(sentences)

from harness import curves, scoring, style
from studies import Unit
from studies.paper_figures import CLASSES, TABLE1, TABLE1_PRECISION, TABLE1_RECALL, TABLE1_ZETA

TITLE = 'Table I: what is found in cluttered offices'
ABOUT = ('Twenty scans of cluttered offices with seven classes ten times each. Rows are what was reported, columns what stands there, C is clutter; '
         'the paper\'s own table (real scans, its own objects) is the third.')
DATA = ('train',)
NUM_SCANS, TIMES = 20, 10
SHORT = {'box': 'B', 'fan': 'F', 'monitor': 'M', 'office_chair': 'O', 'pioneer': 'P', 'table': 'T', 'wooden_chair': 'W'}


def units(context):
    if context.has_data('train'):
        scans = balanced(context.data_scans('train'), 4 if context.quick else NUM_SCANS)
        return [Unit(f'data_{scan.name}', lambda scan=scan: context.judged(scan, simulated=False)) for scan in scans]
    numbers = range(4 if context.quick else NUM_SCANS)
    return [Unit(f'office_{n:03d}', lambda n=n: context.judged(context.simulated.office(n))) for n in numbers]


def balanced(scans, count):
    """That many scans in which every class stands as nearly as possible equally often: exchanges, from the first ones on."""
    chosen, classes = list(range(min(count, len(scans)))), sorted({o['class'] for s in scans for o in s.objects})

    def excess(indices):
        sums = {c: 0 for c in classes}
        for i in indices:
            for o in scans[i].objects:
                sums[o['class']] += 1
        return sum((n - TIMES * count / NUM_SCANS) ** 2 for n in sums.values())

    improved = True
    while improved and excess(chosen) > 0:
        improved = False
        for place in range(len(chosen)):
            for other in range(len(scans)):
                changed = [*chosen[:place], other, *chosen[place + 1:]]
                if other not in chosen and excess(changed) < excess(chosen):
                    chosen, improved = changed, True
    return [scans[i] for i in sorted(chosen)]


def report(context, rows):
    methods = curves.methods_of(rows)
    classes = [c for c in CLASSES if any(r['class'] == c for r in rows)]
    tables = {f'{m} method': scoring.confusion([r for r in rows if r['method'] == m], classes) for m in methods}
    printed = {c: dict(zip([*CLASSES, scoring.CLUTTER], TABLE1[c])) for c in CLASSES}
    context.figure('confusion', 'Confusion tables: rows are what was reported, columns what stands there; C is clutter.',
                   lambda figure: report_plot(figure, {**tables, 'the paper': printed}, classes), (9.0, 2.9))
    for name, table in tables.items():
        heads = [SHORT.get(c, c) for c in classes]
        context.table(name.split()[0], f'Confusion table, {name}', ['reported'] + heads + ['C'], [[c.replace('_', ' '), *table[c].values()] for c in classes])
    sums = {m: scoring.totals([r for r in rows if r['method'] == m]) for m in methods}
    context.table('rates', 'Rates', ['', 'found', 'false', 'missed', 'recall', 'precision', 'zeta', 'pose recall (10 cm, 15°)'],
                  [[f'{m} method', s['tp'], s['fp'], s['fn'], s['recall'], s['precision'], s['zeta'], s['pose_recall']] for m, s in sums.items()]
                  + [['the paper', 59, 29, 11, TABLE1_RECALL, TABLE1_PRECISION, TABLE1_ZETA, None]])
    texts = [f'the {m} method finds {s["tp"]} of {s["objects"]} with {s["fp"]} false positives (precision {curves.percent(s["precision"])})' for m, s in sums.items()]
    text = '; '.join(texts) + f'; the paper reports 59 of 70 with 29 ({100 * TABLE1_PRECISION:.0f} %).'
    return text[0].upper() + text[1:] + ' Objects that show less than 20 % or 150 readings do not count.'


def report_plot(figure, tables, classes):
    panels = figure.subplots(1, len(tables), sharey=True)
    columns = [*classes, scoring.CLUTTER]
    for axes, (name, table) in zip(panels, tables.items()):
        values = [[table[row][column] for column in columns] for row in classes]
        axes.imshow(values, cmap=style.COLOUR_MAP, vmin=0, vmax=10, aspect='equal')
        axes.grid(False)
        for i, row in enumerate(values):
            for j, value in enumerate(row):
                if value:
                    axes.text(j, i, str(value), ha='center', va='center', color='black' if value >= 6 else 'white', fontsize=8)
        axes.set(title=name, xlabel='what stands there', xticks=range(len(columns)), xticklabels=[SHORT.get(c, c) for c in columns],
                 yticks=range(len(classes)), yticklabels=[f'{c.replace("_", " ")} ({SHORT.get(c, c)})' for c in classes])
    panels[0].set_ylabel('reported')

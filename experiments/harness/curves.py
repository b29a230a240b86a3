"""Recognition rates over something that changes: what several studies count and draw."""
from harness import scoring, style


def rates(rows, key, **where):
    """[(value of key, found, objects)] of the object rows that have the values of where, by rising value."""
    counts = {}
    for row in rows:
        if row['kind'] == 'object' and all(row[k] == v for k, v in where.items()):
            hits, count = counts.get(row[key], (0, 0))
            counts[row[key]] = (hits + bool(row['found']), count + 1)
    return [(value, *counts[value]) for value in sorted(counts)]


def draw_rates(axes, points, label, look, band=True):
    """A line of found / objects in percent with its 95 % confidence band."""
    x = [p[0] for p in points]
    axes.plot(x, [100 * hits / count for _, hits, count in points], label=label, **look)
    if band:
        limits = [scoring.wilson(hits, count) for _, hits, count in points]
        axes.fill_between(x, [100 * low for low, _ in limits], [100 * high for _, high in limits], color=look['color'], alpha=0.15, linewidth=0)


def legend_above(axes, *handles_and_labels, columns=2):
    axes.legend(*handles_and_labels, loc='lower center', bbox_to_anchor=(0.5, 1.01), ncols=columns)


def draw_methods(figure, rows, key, x_label):
    """One axes with the rates of every method over key."""
    axes = figure.subplots()
    for method in methods_of(rows):
        draw_rates(axes, rates(rows, key, method=method), f'{method} method', style.METHOD_LOOK[method])
    axes.set(xlabel=x_label, ylabel='objects found (%)', ylim=(-3, 103))
    legend_above(axes)
    return axes


def methods_of(rows):
    return [m for m in style.METHOD_LOOK if any(r['method'] == m for r in rows)]


def rate_table(context, name, caption, rows, key, head):
    """A table: for each value of key and method found of how many, recall, false positives, pose errors."""
    methods = methods_of(rows)
    columns = [head] + [f'{m}: {what}' for m in methods for what in ('found', 'recall', 'false')]
    lines = []
    for value in sorted({r[key] for r in rows}):
        line = [value if isinstance(value, str) else f'{value:g}']
        for method in methods:
            sums = scoring.totals([r for r in rows if r[key] == value and r['method'] == method])
            line += [f'{sums["tp"]} of {sums["objects"]}', sums['recall'], sums['fp']]
        lines.append(line)
    context.table(name, caption, columns, lines)


def crossing(points, share):
    """Where the rate first falls below the share for good (midway to the last value above it), or None."""
    last = None
    for value, hits, count in points:
        if hits >= share * count:
            last = value
    later = [p[0] for p in points if last is not None and p[0] > last]
    return (last + later[0]) / 2 if later else None


def percent(share):
    return '-' if share is None else f'{100 * share:.0f} %'

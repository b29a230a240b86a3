from harness import curves, style
from studies import Unit

TITLE = 'Resolution: how fine must the sensor look?'
ABOUT = ('Seven objects 3 m away in an empty hall, at 0.2 to 1.0 degrees. Solid lines: beams and lines of the scanner lie this far apart '
         'and the range image has pixels as large; dashed: only the range image does, the scanner keeps its 0.25 degrees. Models are built with the same pixels; '
         'the default method enlarges them by itself where readings are too sparse.')
RESOLUTIONS = (0.2, 0.3, 0.4, 0.6, 0.8, 1.0)  # degrees
VIEWS = 3
LIMITS = {'min_visible': 0, 'min_points': 0}
KINDS = {'scanner': 'scanner and image', 'image': 'image alone'}


def units(context):
    resolutions, views = (RESOLUTIONS[::2], 1) if context.quick else (RESOLUTIONS, VIEWS)
    return [Unit(f'{kind}_{degrees:g}_{view}', lambda c=(kind, degrees, view): work(context, *c))
            for view in range(views) for degrees in resolutions for kind in KINDS]


def work(context, kind, degrees, view):
    # A level line has beams every angle_step; twice as many lines would take a real unit twice the time.
    sensor = {'angle_step_deg': degrees, 'num_beams': int(180 / degrees) + 1, 'interlaced': False, 'tilt_step_deg': degrees} if kind == 'scanner' else None
    scan = context.simulated.ring(f'resolution_{kind}_{degrees:g}_{view}' if sensor else f'resolution_image_{view}', view, sensor=sensor)
    beams = {'sweep': {'beams_per_line': sensor['num_beams']}} if sensor else {}
    configs = {m: {'method': m, 'range_image': {'resolution_deg': degrees}, **beams} for m in ('default', 'paper')}
    return context.judged(scan, configs, limits=LIMITS, kind_of=kind, degrees=degrees, view=view)


def report(context, rows):
    context.figure('recall', 'Objects found over the angle between readings (solid) or over the size of the pixels alone (dashed).',
                   lambda figure: report_plot(figure, rows))
    for kind, title in KINDS.items():
        curves.rate_table(context, kind, f'Found objects, {title}', [r for r in rows if r['kind_of'] == kind], 'degrees', 'degrees a pixel')
    sentences = []
    for method in curves.methods_of(rows):
        for kind, title in KINDS.items():
            points = curves.rates(rows, 'degrees', method=method, kind_of=kind)
            ends = [curves.percent(p[1] / p[2]) for p in (points[0], points[-1])]
            best = max(points, key=lambda p: p[1] / p[2])
            sentences.append(f'{method.capitalize()} method, {title}: {ends[0]} at {points[0][0]:g} degrees, {ends[1]} at {points[-1][0]:g} (best at {best[0]:g}).')
    return ' '.join(sentences)


def report_plot(figure, rows):
    axes = figure.subplots()
    for method in curves.methods_of(rows):
        for kind, title in KINDS.items():
            look = {**style.METHOD_LOOK[method], 'linestyle': '-' if kind == 'scanner' else '--'}
            points = curves.rates(rows, 'degrees', method=method, kind_of=kind)
            curves.draw_rates(axes, points, f'{method} method, {title}', look, band=kind == 'scanner')
    axes.set(xlabel='angle between readings, or of a pixel (degrees)', ylabel='objects found (%)', ylim=(-3, 103))
    curves.legend_above(axes)

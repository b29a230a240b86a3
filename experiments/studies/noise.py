from harness import curves, scoring
from studies import Unit

TITLE = 'Range noise: how exact must the sensor be?'
ABOUT = ('Seven objects 3 m away in an empty hall, seen by a scanner whose ranges scatter by 0 to 3 cm (standard deviation, one reading from the next). '
         'The models are built from recordings with the usual 8 mm.')
SIGMAS = (0.0, 0.005, 0.01, 0.015, 0.02, 0.025, 0.03)  # m
VIEWS = 4
LIMITS = {'min_visible': 0, 'min_points': 0}


def units(context):
    sigmas, views = (SIGMAS[::3], 1) if context.quick else (SIGMAS, VIEWS)
    return [Unit(f'{1000 * sigma:g}mm_{view}', lambda sigma=sigma, view=view: work(context, sigma, view)) for view in range(views) for sigma in sigmas]


def work(context, sigma, view):
    scan = context.simulated.ring(f'noise_{1000 * sigma:g}mm_{view}', view, noise={'range_sigma': sigma})
    return context.judged(scan, limits=LIMITS, sigma_cm=100 * sigma, view=view)


def report(context, rows):
    context.figure('recall', 'Objects found over the range noise.',
                   lambda figure: curves.draw_methods(figure, rows, 'sigma_cm', 'standard deviation of a range (cm)'))
    curves.rate_table(context, 'recall', 'Found objects by noise', rows, 'sigma_cm', 'noise (cm)')
    sentences = []
    for method in curves.methods_of(rows):
        levels = curves.rates(rows, 'sigma_cm', method=method)
        (low, *first), (high, *last) = levels[0], levels[-1]
        sums = scoring.totals([r for r in rows if r['method'] == method])
        sentences.append(f'The {method} method finds {curves.percent(first[0] / first[1])} at {low:g} cm and {curves.percent(last[0] / last[1])} at {high:g} cm '
                         f'({sums["fp"]} false positives in all).')
    return ' '.join(sentences)

"""How all plots look: fonts, colours that the colour-blind can tell apart (Okabe and Ito), PNG and SVG."""
import importlib.util

COLOURS = {'black': '#000000', 'orange': '#E69F00', 'sky': '#56B4E9', 'green': '#009E73', 'yellow': '#F0E442', 'blue': '#0072B2',
           'vermilion': '#D55E00', 'purple': '#CC79A7', 'grey': '#7F7F7F'}
METHOD_LOOK = {'default': {'color': COLOURS['blue'], 'marker': 'o'}, 'paper': {'color': COLOURS['vermilion'], 'marker': 's'}}
CLASS_COLOURS = [COLOURS[c] for c in ('orange', 'sky', 'green', 'blue', 'vermilion', 'purple', 'black')]
CLASS_MARKERS = 'osD^vP*'
COLOUR_MAP = 'viridis'
SETTINGS = {'font.size': 9, 'font.family': 'DejaVu Sans', 'axes.grid': True, 'grid.color': '#DDDDDD', 'grid.linewidth': 0.6, 'axes.axisbelow': True,
            'axes.spines.top': False, 'axes.spines.right': False, 'lines.linewidth': 1.6, 'lines.markersize': 4.5, 'legend.frameon': False,
            'legend.fontsize': 8, 'figure.facecolor': 'white', 'svg.hashsalt': 'rimod', 'svg.fonttype': 'path'}
DOTS_PER_INCH = 130


def available():
    return importlib.util.find_spec('matplotlib') is not None


def draw(folder, name, fill, size):
    """Writes folder/name.png and .svg; their names, or none where matplotlib is not installed."""
    if not available():
        return []
    import matplotlib
    from matplotlib.figure import Figure
    folder.mkdir(parents=True, exist_ok=True)
    with matplotlib.rc_context(SETTINGS):
        figure = Figure(figsize=size, dpi=DOTS_PER_INCH, layout='constrained')
        fill(figure)
        files = [f'{name}.png', f'{name}.svg']
        figure.savefig(folder / files[0], metadata={'Software': None})
        figure.savefig(folder / files[1], metadata={'Date': None})
    return files

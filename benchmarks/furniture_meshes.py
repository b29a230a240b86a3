"""Meshes of many different pieces of furniture, as OBJ files in metres, z up: drawn from a seed, or cut out of the
catalogues of Debian's package sweethome3d-furniture. The same arguments give the same files."""
import math
import pathlib
import random
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / 'experiments'))
import make_scenes  # noqa: E402  (shapes of primitives, and the reader of the catalogues)

SMALLEST, LARGEST = 0.3, 1.5  # m, largest edge of a catalogue piece that is used
CORNERS = 24  # of the polygon that stands for a circle


def ring(radius, height):
    return [(radius * math.cos(2 * math.pi * i / CORNERS), radius * math.sin(2 * math.pi * i / CORNERS), height)
            for i in range(CORNERS)]


def part_mesh(part):
    """Vertices and faces (outward) of a primitive, in the shape's frame."""
    if 'box' in part:
        x, y, z = part['box']['size']
        vertices = [(i * x / 2, j * y / 2, k * z) for k in (0, 1) for i, j in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        faces = [(3, 2, 1, 0), (4, 5, 6, 7)] + [(i, (i + 1) % 4, 4 + (i + 1) % 4, 4 + i) for i in range(4)]
    else:
        c = part.get('cone') or {'bottom_radius': part['cylinder']['radius'], 'top_radius': part['cylinder']['radius'],
                                 'height': part['cylinder']['height']}
        n = CORNERS
        vertices = ring(c['bottom_radius'], 0) + ring(c['top_radius'], c['height'])
        faces = [tuple(reversed(range(n))), tuple(range(n, 2 * n))] + [(i, (i + 1) % n, n + (i + 1) % n, n + i) for i in range(n)]
    turn = make_scenes.rotation(part.get('yaw_deg', 0), part.get('pitch_deg', 0), part.get('roll_deg', 0))
    moved = [tuple(sum(turn[i][j] * v[j] for j in range(3)) + part['position'][i] for i in range(3)) for v in vertices]
    return moved, faces


def write_shape(shape, path):
    """Origin at the middle of the box's bottom, as object frames have it."""
    low, high = shape.low, shape.high
    origin = ((low[0] + high[0]) / 2, (low[1] + high[1]) / 2, low[2])
    with open(path, 'w') as out:
        first = 1
        for part in shape.spec['parts']:
            vertices, faces = part_mesh(part)
            for v in vertices:
                out.write('v ' + ' '.join(f'{v[i] - origin[i]:.5f}' for i in range(3)) + '\n')
            for face in faces:
                out.write('f ' + ' '.join(str(first + i) for i in face) + '\n')
            first += len(vertices)


def draw(rng):
    """A shape of a random kind and size."""
    u = rng.uniform
    kinds = [
        lambda: make_scenes.chair(u(0.38, 0.55), u(0.36, 0.55), u(0.75, 1.2), u(0.025, 0.05), u(0, 15)),
        lambda: make_scenes.table(u(0.4, 0.9), u(0.5, 1.6), u(0.35, 0.8), u(0.03, 0.08)),
        lambda: make_scenes.panel_desk(u(0.5, 0.8), u(0.8, 1.6), u(0.65, 0.8)),
        lambda: make_scenes.round_table(u(0.2, 0.6), u(0.4, 0.9)),
        lambda: make_scenes.bin_shape(u(0.08, 0.25), u(0.1, 0.3), u(0.3, 0.8)),
        lambda: make_scenes.screen(u(0.4, 0.9), u(0.3, 0.6), u(0.03, 0.08), u(0.08, 0.25)),
        lambda: make_scenes.robot(u(0.35, 0.7), u(0.3, 0.6), u(0.12, 0.4), u(0.1, 0.4)),
        lambda: make_scenes.corner_shelf(u(0.5, 0.9), u(0.5, 1.2)),
        lambda: make_scenes.filled_shelf(rng, u(0.25, 0.45), u(0.5, 1.2), u(0.7, 1.9), rng.randint(2, 5)),
        lambda: make_scenes.carton(u(0.25, 0.7), u(0.25, 0.7), u(0.2, 0.7)),
    ]
    return rng.choice(kinds)()


def generated(folder, count, seed=1):
    """count drawn pieces as (class name, path)."""
    folder.mkdir(parents=True, exist_ok=True)
    pieces = []
    for i in range(count):
        shape = draw(random.Random(f'{seed}-{i}'))
        name = f'{shape.name}_{i:03d}'
        path = folder / f'{name}.obj'
        write_shape(shape, path)
        pieces.append((name, path))
    return pieces


def from_catalogue(catalogues, folder, count):
    """The catalogues' first count pieces of a size that stands on floors and desks, spread over all of them."""
    furniture = make_scenes.Furniture(catalogues, folder)
    fitting = []
    for key, (_, piece) in sorted(furniture.models.items()):
        try:
            size = max(float(piece[edge]) / 100 for edge in ('depth', 'width', 'height'))
        except (KeyError, ValueError):
            continue
        if SMALLEST <= size <= LARGEST and piece['model'].lower().endswith('.obj'):
            fitting.append(key)
    if len(fitting) < count:
        raise SystemExit(f'{catalogues}: only {len(fitting)} usable pieces')
    pieces = []
    for i in range(count):
        collection, name = fitting[i * len(fitting) // count]
        shape = furniture.shape(collection, name)
        path = folder / pathlib.Path(shape.spec['mesh']['file']).name
        pieces.append((''.join(c if c.isalnum() else '_' for c in f'{collection}_{name}')[:60], path))
    return pieces

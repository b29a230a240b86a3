#!/usr/bin/env python3
"""Make labelled scans of random offices with rimod-simulator, as training data for the judgement.

usage: make_scenes.py --furniture FOLDER --simulator rimod-simulator --out OUT [--scenes 150] [--seed 1] [--jobs 2]
                      [--mean-visible 1.0] [--set offices|alone|tilted]
                      [--draw-objects N] [--own-lookalikes 0.5] [--coarse]

FOLDER holds the .sh3f files of Debian's package sweethome3d-furniture (/usr/share/sweethome3d/furniture); the
meshes used are cut out of them, scaled to their catalogue sizes and written to OUT/meshes. Writes

    OUT/models/<class>/{model.json,scan_*.pcd}    a recording of each object, for rimod-modeler --recording
    OUT/SET/logs/NNN.lcm, OUT/SET/labels.json     scans and what stands where, in the benchmark's format
    OUT/scenes/*.yaml                             the scene files of all of them

Scene NNN depends on the seed and its number only: more scenes leave the first ones as they are. A scene in which
one of the objects can hardly be seen, or of whose objects more is in view than --mean-visible, is thrown away and
drawn again, up to ATTEMPTS times. The set "alone" has one object a scan, 1.5 to 13 m away in a hall with other things
along its walls and far away; in the set "tilted" it hangs 2 to 4 m away, rolled and pitched by up to 25 degrees.

The objects are sixteen of ours, or with --draw-objects N others that the seed draws: primitives of all sizes and meshes.
Then a share of the look-alikes are the objects themselves in another size. With --coarse the scanner has a beam a degree and
more noise, its scans are clouds (OUT/SET/scans/NNN.pcd), and an object is recorded from one to four places around it only.
"""
import argparse
import concurrent.futures
import json
import math
import pathlib
import random
import re
import subprocess
import sys
import zipfile

ATTEMPTS = 8
LEAST_POINTS, LEAST_VISIBLE = 200, 0.3
GAP = 0.02  # m between things
HALL_MIN, HALL_MAX = [-4, -8, 0], [20, 8, 5]  # m


# ---------------------------------------------------------------- shapes
class Shape:
    """What the simulator shall draw, and the box around it in its own frame (front along +x, bottom at z = 0)."""

    def __init__(self, name, spec, low, high, top=None):
        self.name, self.spec, self.low, self.high = name, spec, low, high
        self.top = top  # (x, y) size of a flat top that things can stand on, or None

    @property
    def height(self):
        return self.high[2]

    @property
    def radius(self):
        return max(math.hypot(x, y) for x in (self.low[0], self.high[0]) for y in (self.low[1], self.high[1]))


def box(x, y, z, at=(0, 0, 0), **angles):
    return {'box': {'size': [x, y, z]}, 'position': list(at), **angles}


def cylinder(radius, height, at=(0, 0, 0), **angles):
    return {'cylinder': {'radius': radius, 'height': height}, 'position': list(at), **angles}


def cone(bottom, top, height, at=(0, 0, 0)):
    return {'cone': {'bottom_radius': bottom, 'top_radius': top, 'height': height}, 'position': list(at)}


def part_size(part):
    if 'box' in part:
        return part['box']['size']
    if 'cylinder' in part:
        return [2 * part['cylinder']['radius']] * 2 + [part['cylinder']['height']]
    c = part['cone']
    return [2 * max(c['bottom_radius'], c['top_radius'])] * 2 + [c['height']]


def of_parts(name, parts, top=None):
    """A shape of primitives; its box is measured at the corners of the parts' boxes."""
    corners = []
    for part in parts:
        size, turn = part_size(part), rotation(part.get('yaw_deg', 0), part.get('pitch_deg', 0), part.get('roll_deg', 0))
        for corner in box_corners([-size[0] / 2, -size[1] / 2, 0], [size[0] / 2, size[1] / 2, size[2]]):
            corners.append([sum(turn[i][j] * corner[j] for j in range(3)) + part['position'][i] for i in range(3)])
    low = [min(c[i] for c in corners) for i in range(3)]
    high = [max(c[i] for c in corners) for i in range(3)]
    return Shape(name, {'parts': parts}, low, high, top)


def rotation(yaw, pitch, roll):
    cy, sy, cp, sp, cr, sr = (f(math.radians(a)) for a in (yaw, pitch, roll) for f in (math.cos, math.sin))
    return [[cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr]]


def box_corners(low, high):
    return [[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]


class Furniture:
    """Meshes of Sweet Home 3D's catalogues, as shapes."""

    def __init__(self, folder, meshes):
        self.meshes, self.models = meshes, {}
        self.drawn, self.taken = [], set()  # objects that the seed drew, and their meshes
        self.own_lookalikes = 0.5  # share of the look-alikes that are drawn objects in other sizes
        meshes.mkdir(parents=True, exist_ok=True)
        for archive in sorted(pathlib.Path(folder).glob('*.sh3f')):
            pieces = {}
            text = zipfile.ZipFile(archive).read('PluginFurnitureCatalog.properties').decode('latin1')
            for key, number, value in re.findall(r'^(\w+)#(\d+)=(.*)$', text, re.M):
                pieces.setdefault(number, {})[key] = value.strip()
            for piece in pieces.values():
                if 'model' in piece:
                    self.models[(archive.stem, piece['model'].split('/')[2])] = (archive, piece)

    def shape(self, collection, name, scale=1.0):
        """Depth along x (the front at +x), width along y."""
        archive, piece = self.models[(collection, name)]
        size = [scale * float(piece[key]) / 100 for key in ('depth', 'width', 'height')]
        path = self.meshes / f'{collection}_{name}_{scale:g}.obj'
        if not path.exists():
            write_mesh(zipfile.ZipFile(archive).read(piece['model'].lstrip('/')).decode('latin1'), size, path)
        spec = {'mesh': {'file': f'../meshes/{path.name}'}}
        return Shape(name, spec, [-size[0] / 2, -size[1] / 2, 0], [size[0] / 2, size[1] / 2, size[2]])

    def any_of(self, rng, pieces):
        """The shape of one of these that is not an object."""
        return self.shape(*rng.choice([p for p in pieces if p not in self.taken]))

    def points(self, shape, rng, count=4000):
        """On the surface of a mesh's shape, evenly, in its own frame."""
        vertices, triangles = [], []
        for line in (self.meshes / pathlib.Path(shape.spec['mesh']['file']).name).read_text().splitlines():
            kind, *words = line.split()
            if kind == 'v':
                vertices.append([float(w) + low for w, low in zip(words, shape.low)])
            else:
                index = [int(w) - 1 for w in words]
                triangles += [(index[0], a, b) for a, b in zip(index[1:], index[2:])]
        areas = [area(*(vertices[i] for i in t)) for t in triangles]
        result = []
        for a, b, c in rng.choices(triangles, areas, k=count):
            u, v = sorted((rng.random(), rng.random()))
            result.append([u * p + (v - u) * q + (1 - v) * r for p, q, r in zip(vertices[a], vertices[b], vertices[c])])
        return result


def area(a, b, c):
    u, v = ([y - x for x, y in zip(a, p)] for p in (b, c))
    return 0.5 * math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])


def symmetry_of(points, cell=0.025):
    """About z: the turns after which 98 % of the points are within a cell or two of others."""
    def cell_of(p):
        return tuple(math.floor(x / cell) for x in p)

    near = {(i + a, j + b, k + c) for i, j, k in map(cell_of, points) for a in (-1, 0, 1) for b in (-1, 0, 1) for c in (-1, 0, 1)}

    def same(angle):
        c, s = math.cos(angle), math.sin(angle)
        return sum(cell_of((c * x - s * y, s * x + c * y, z)) in near for x, y, z in points) > 0.98 * len(points)

    if all(same(math.radians(a)) for a in range(30, 180, 30)):
        return 'yaw_continuous'
    return 'yaw4' if same(math.pi / 2) else 'yaw2' if same(math.pi) else 'none'


def write_mesh(obj, size, path):
    """Vertices and faces only, z up, scaled to the size."""
    vertices, faces = [], []
    for line in obj.splitlines():
        words = line.split()
        if words[:1] == ['v']:
            x, y, z = (float(w) for w in words[1:4])
            vertices.append((z, x, y))
        elif words[:1] == ['f']:
            index = [int(w.split('/')[0]) for w in words[1:]]
            faces.append([i - 1 if i > 0 else len(vertices) + i for i in index])
    used = sorted({i for face in faces for i in face})
    low = [min(vertices[i][k] for i in used) for k in range(3)]
    high = [max(vertices[i][k] for i in used) for k in range(3)]
    new = {old: i + 1 for i, old in enumerate(used)}
    scales = [size[k] / max(high[k] - low[k], 1e-9) for k in range(3)]
    with open(path, 'w') as out:
        for i in used:
            out.write('v ' + ' '.join(f'{(vertices[i][k] - low[k]) * scales[k]:.5f}' for k in range(3)) + '\n')
        for face in faces:
            out.write('f ' + ' '.join(str(new[i]) for i in face) + '\n')


def carton(x, y, z, name='carton'):
    return of_parts(name, [box(x, y, z)], top=(x, y))


def table(x, y, z, leg, name='desk'):
    legs = [box(leg, leg, z - 0.03, (i * (x - leg) / 2, j * (y - leg) / 2, 0)) for i in (-1, 1) for j in (-1, 1)]
    return of_parts(name, [box(x, y, 0.03, (0, 0, z - 0.03))] + legs, top=(x, y))


def panel_desk(x, y, z):
    sides = [box(x - 0.06, 0.03, z - 0.03, (0, j * (y / 2 - 0.04), 0)) for j in (-1, 1)]
    back = box(0.02, y - 0.12, 0.4, (-x / 2 + 0.1, 0, z - 0.45))
    return of_parts('desk', [box(x, y, 0.03, (0, 0, z - 0.03)), back] + sides, top=(x, y))


def round_table(radius, z):
    return of_parts('round_table', [cylinder(radius, 0.03, (0, 0, z - 0.03)), cylinder(0.04, z - 0.06, (0, 0, 0.03)),
                                    cylinder(0.55 * radius, 0.03)])


def stool(x, z, leg=0.04):
    return table(x, x, z, leg, 'stool')


def bin_shape(bottom, top, z):
    return of_parts('bin', [cone(bottom, top, z)])


def screen(width, height, thick, lift, foot=0.22):
    """A panel on a foot, looking along +x."""
    return of_parts('screen', [box(thick, width, height, (0.02, 0, lift)), box(0.03, 0.08, lift + 0.6 * height, (-0.02, 0, 0)),
                               box(foot, min(0.28, 0.6 * width), 0.02)])


def robot(x, y, z, turret):
    """A low box on wheels with a turret towards its front."""
    wheels = [cylinder(0.09, 0.05, (i * 0.3 * x, j * (y / 2 + 0.005) + 0.025, 0.09), roll_deg=90) for i in (-1, 1) for j in (-1, 1)]
    return of_parts('robot', [box(x, y, z, (0, 0, 0.06)), box(0.16, 0.15, turret, (0.25 * x, 0, 0.06 + z))] + wheels)


def corner_shelf(size, z):
    return of_parts('corner_shelf', [box(size, 0.28, z, (0, -size / 2 + 0.14, 0)),
                                     box(0.28, size - 0.28, 0.7 * z, (-size / 2 + 0.14, 0.14, 0))])


def shelf(depth, width, height, boards):
    parts = [box(depth, 0.02, height, (0, j * (width / 2 - 0.01), 0)) for j in (-1, 1)]
    parts += [box(0.02, width, height, (-depth / 2 + 0.01, 0, 0))]
    parts += [box(depth, width - 0.04, 0.02, (0, 0, i * (height - 0.02) / boards)) for i in range(boards + 1)]
    return of_parts('shelf', parts, top=(depth, width))


def filled_shelf(rng, depth, width, height, boards):
    """Books and boxes of various heights on every board."""
    shape = shelf(depth, width, height, boards)
    step = height / boards
    for i in range(boards):
        y = -width / 2 + 0.03
        while y < width / 2 - 0.12:
            w, full = rng.uniform(0.06, 0.25), rng.random() < 0.7
            w = min(w, width / 2 - 0.03 - y)
            if full:
                d = rng.uniform(0.5, 0.9) * depth
                shape.spec['parts'].append(box(d, w, rng.uniform(0.4, 0.85) * step, (d / 2 - depth / 2 + 0.02, y + w / 2, i * step + 0.02)))
            y += w
    return shape


def chair(seat, depth, back, legs=0.035, lean=8):
    """A plain chair of boxes, looking along +x."""
    shape = table(depth, depth, seat, legs, 'chair')
    shape.top = None
    parts = shape.spec['parts'] + [box(0.03, depth, back - seat, (-depth / 2 + 0.02, 0, seat - 0.02), pitch_deg=-lean)]
    return of_parts('chair', parts)


class ObjectClass:
    def __init__(self, name, shape, symmetry, small=False, may_tilt=False, reflectivity=0.6):
        self.name, self.shape, self.symmetry = name, shape, symmetry
        self.small = small        # also stands on desks and cabinets
        self.may_tilt = may_tilt  # leans a little now and then
        self.reflectivity = reflectivity


def object_classes(furniture):
    f = furniture.shape
    return [
        ObjectClass('swivel_chair', f('KatorLegaz', 'office-chair'), 'none', reflectivity=0.4),
        ObjectClass('kitchen_chair', f('Scopia', 'chair4'), 'none'),
        ObjectClass('rattan_armchair', f('Scopia', 'rattanArmchair'), 'none'),
        ObjectClass('cafe_table', round_table(0.35, 0.68), 'yaw_continuous'),
        ObjectClass('stool', stool(0.38, 0.47), 'yaw4'),
        ObjectClass('bin', bin_shape(0.14, 0.19, 0.52), 'yaw_continuous', may_tilt=True),
        ObjectClass('carton_long', carton(0.38, 0.60, 0.42), 'yaw2', may_tilt=True),
        ObjectClass('carton_cube', carton(0.33, 0.33, 0.36), 'yaw4', small=True, may_tilt=True),
        ObjectClass('robot', robot(0.50, 0.38, 0.20, 0.18), 'none', may_tilt=True, reflectivity=0.5),
        ObjectClass('screen', screen(0.54, 0.35, 0.05, 0.14), 'none', small=True, may_tilt=True, reflectivity=0.4),
        ObjectClass('round_fan', f('BlendSwap-CC-0', 'riggedFan', 1.5), 'none', small=True),
        ObjectClass('traffic_cone', of_parts('cone', [cylinder(0.19, 0.03), cone(0.14, 0.03, 0.6, (0, 0, 0.03))]), 'yaw_continuous',
                    small=True, may_tilt=True),
        ObjectClass('dog', f('Scopia', 'dog'), 'none'),
        ObjectClass('coffee_machine', f('Scopia', 'coffee_machine'), 'none', small=True),
        ObjectClass('corner_shelf', corner_shelf(0.7, 0.65), 'none'),
        ObjectClass('low_table', f('Scopia', 'children_table'), 'yaw2', small=False),
    ]


# ---------------------------------------------------------------- things that are not looked for
CHAIRS = [('Scopia', 'chair3'), ('KatorLegaz', 'cafe-chair'), ('BlendSwap-CC-BY', 'plaidChair'), ('BlendSwap-CC-BY', 'kitchenChair'),
          ('BlendSwap-CC-0', 'sillaBlanca'), ('BlendSwap-CC-0', 'oakChair'), ('Scopia', 'tubular_chair'), ('BlendSwap-CC-0', 'antiqueChair'),
          ('Scopia', 'white_kitchen_chair'), ('Scopia', 'office_chair'), ('BlendSwap-CC-BY', 'cafe_set_tonon_chair')]
SEATS = [('Scopia', 'armchair3'), ('BlendSwap-CC-BY', 'fotel'), ('BlendSwap-CC-BY', 'cafe_set_mota_chair'), ('Scopia', 'ryokanChair'),
         ('BlendSwap-CC-0', 'armchair'), ('KatorLegaz', 'mid-century-chair'), ('Scopia', 'puff'), ('BlendSwap-CC-BY', 'leaf_chair')]
FLOOR_THINGS = [('KatorLegaz', 'filing-cabinet'), ('Scopia', 'stroller'), ('Scopia', 'tricycle'), ('Scopia', 'shopping-basket'),
                ('Scopia', 'clothes-basket'), ('Scopia', 'bar_chair'), ('Scopia', 'water_cooler'), ('Scopia', 'step-ladder-wood'),
                ('BlendSwap-CC-BY', 'backpack'), ('BlendSwap-CC-BY', 'suitcase'), ('BlendSwap-CC-BY', 'bulldog'), ('Scopia', 'cat'),
                ('BlendSwap-CC-0', 'fireExtinguisher'), ('Scopia', 'maceta'), ('BlendSwap-CC-0', 'electricGuitar'), ('Scopia', 'vase5'),
                ('KatorLegaz', 'residential-trashcan'), ('KatorLegaz', 'bullet-trash-can'), ('BlendSwap-CC-BY', 'bedsideTable'),
                ('Scopia', 'children_chair'), ('BlendSwap-CC-0', 'silla2'), ('Scopia', 'scooter'), ('Scopia', 'doll-house'),
                ('KatorLegaz', 'male-01-suit'), ('KatorLegaz', 'female-01-casual-clothing'), ('Scopia', 'open-cardboard-box'),
                ('KatorLegaz', 'cafe-table'), ('Scopia', 'wood_logs'), ('BlendSwap-CC-BY', 'green_stool'), ('KatorLegaz', 'hose-reel')]
WALL_THINGS = [('BlendSwap-CC-0', 'bookcase'), ('BlendSwap-CC-0', 'cupboard'), ('KatorLegaz', 'fridge'), ('BlendSwap-CC-BY', 'washing_machine'),
               ('Scopia', 'dryer_machine'), ('KatorLegaz', 'utility-shelving'), ('Scopia', 'simple_sofa'), ('BlendSwap-CC-0', 'radiator'),
               ('BlendSwap-CC-0', 'whiteBoard'), ('BlendSwap-CC-BY', 'sofa2'), ('BlendSwap-CC-BY', 'dresserWithDrawers'),
               ('BlendSwap-CC-BY', 'piano'), ('Scopia', 'kids_shelves'), ('BlendSwap-CC-0', 'shelves'), ('Scopia', 'clothes-rack'),
               ('Scopia', 'dressing-table'), ('BlendSwap-CC-0', 'drawersCabinet'), ('Scopia', 'chest-freezer')]
TOP_THINGS = [('BlendSwap-CC-BY', 'laptop'), ('Scopia', 'inkjet_and_scanner_printer'), ('Scopia', 'tv'), ('BlendSwap-CC-0', 'led_tv'),
              ('BlendSwap-CC-BY', 'microwave'), ('BlendSwap-CC-0', 'tableFan'), ('BlendSwap-CC-BY', 'lamp'), ('Scopia', 'desk_lamp1'),
              ('BlendSwap-CC-0', 'speaker2'), ('Scopia', 'cooker'), ('Scopia', 'small-oven'), ('KatorLegaz', 'apple-imac-1998'),
              ('Scopia', 'bandeja'), ('Scopia', 'video-projector'), ('BlendSwap-CC-0', 'kitchenaid'), ('Scopia', 'bonsai-tree'),
              ('BlendSwap-CC-0', 'teddyBear'), ('Scopia', 'vase3'), ('Scopia', 'living_room_lamp1'), ('BlendSwap-CC-BY', 'kitchenScale')]


def other_size(rng, size):
    """Not the size itself: at least one edge differs by 18 % and more."""
    while True:
        factors = [rng.uniform(0.65, 1.4) for _ in size]
        if max(abs(math.log(f)) for f in factors) > 0.17:
            return [round(s * f, 3) for s, f in zip(size, factors)]


def lookalike(rng, furniture):
    """Something a little like one of the objects."""
    if furniture.drawn and rng.random() < furniture.own_lookalikes:
        return rng.choice(furniture.drawn).lookalike(rng)
    kind = rng.choice(['carton', 'carton', 'carton', 'chair', 'chair', 'chair', 'screen', 'panel', 'robot', 'bin', 'stool', 'round', 'shelf', 'stack', 'seat'])
    if kind == 'carton':
        return carton(*other_size(rng, rng.choice([(0.38, 0.60, 0.42), (0.33, 0.33, 0.36), (0.35, 0.55, 0.30)])))
    if kind == 'chair':
        return furniture.any_of(rng, CHAIRS) if rng.random() < 0.75 else \
            chair(rng.uniform(0.4, 0.5), rng.uniform(0.38, 0.5), rng.uniform(0.75, 1.05), lean=rng.uniform(0, 14))
    if kind == 'seat':
        return furniture.any_of(rng, SEATS)
    if kind == 'screen':
        return lookalike_screen(rng)
    if kind == 'panel':
        return of_parts('panel', [box(rng.uniform(0.03, 0.08), rng.uniform(0.5, 1.1), rng.uniform(0.5, 1.5))])
    if kind == 'robot':
        return robot(*other_size(rng, (0.50, 0.38, 0.20, 0.18)))
    if kind == 'bin':
        return bin_shape(*other_size(rng, (0.14, 0.19, 0.52)))
    if kind == 'stool':
        return stool(*other_size(rng, (0.38, 0.47)))
    if kind == 'round':
        return round_table(*other_size(rng, (0.35, 0.68)))
    if kind == 'shelf':
        return corner_shelf(*other_size(rng, (0.7, 0.65)))
    low = other_size(rng, (0.38, 0.60, 0.42))
    high = [0.7 * low[0], 0.6 * low[1], rng.uniform(0.1, 0.3)]
    return of_parts('stack', [box(*low), box(*high, (0, 0.1 * low[1], low[2]), yaw_deg=rng.uniform(-20, 20))])


PRIMITIVES = {  # what draws one: the shape, ranges of its sizes (m), symmetry, small
    'carton': (carton, [(0.25, 0.55), (0.25, 0.7), (0.2, 0.6)], 'yaw2', True),
    'cube': (lambda x, z: carton(x, x, z), [(0.25, 0.45), (0.2, 0.6)], 'yaw4', True),
    'screen': (lambda w, h, lift: screen(w, h, 0.05, lift), [(0.4, 0.8), (0.25, 0.5), (0.08, 0.2)], 'none', True),
    'robot': (robot, [(0.35, 0.7), (0.3, 0.5), (0.12, 0.35), (0.1, 0.3)], 'none', False),
    'bin': (bin_shape, [(0.1, 0.18), (0.19, 0.25), (0.35, 0.7)], 'yaw_continuous', False),
    'stool': (stool, [(0.3, 0.5), (0.35, 0.7)], 'yaw4', False),
    'table': (lambda x, y, z: table(x, y, z, 0.04, 'table'), [(0.4, 0.7), (0.75, 1.3), (0.4, 0.8)], 'yaw2', False),
    'round_table': (round_table, [(0.28, 0.5), (0.45, 0.8)], 'yaw_continuous', False),
    'corner_shelf': (corner_shelf, [(0.5, 0.9), (0.4, 0.9)], 'none', False),
    'chair': (lambda seat, depth, back: chair(seat, depth, seat + back), [(0.38, 0.5), (0.36, 0.5), (0.3, 0.6)], 'none', False),
    'shelf': (lambda d, w, h: shelf(d, w, h, 3), [(0.28, 0.42), (0.45, 0.8), (0.6, 1.1)], 'none', False),
    'drum': (lambda r, z: of_parts('drum', [cylinder(r, z)]), [(0.12, 0.25), (0.3, 0.8)], 'yaw_continuous', False),
    'post': (lambda r, z: of_parts('post', [cylinder(2.2 * r, 0.04), cone(r, 0.5 * r, z, (0, 0, 0.04))]), [(0.06, 0.12), (0.5, 1.0)],
             'yaw_continuous', False),
}


class DrawnPrimitive(ObjectClass):
    """An object whose look-alikes are the same primitive in other sizes."""

    def __init__(self, rng, kind):
        self.draw, ranges, symmetry, small = PRIMITIVES[kind]
        self.size = [round(rng.uniform(*r), 3) for r in ranges]
        super().__init__(kind, self.draw(*self.size), symmetry, small, rng.random() < 0.3, round(rng.uniform(0.3, 0.7), 2))

    def lookalike(self, rng):
        return self.draw(*other_size(rng, self.size))


class DrawnMesh(ObjectClass):
    """An object whose look-alikes are the same mesh, larger or smaller."""

    def __init__(self, rng, furniture, piece):
        self.furniture, self.piece, self.scale = furniture, piece, rng.choice([0.9, 1.0, 1.1])
        shape = furniture.shape(*piece, self.scale)
        super().__init__(piece[1], shape, symmetry_of(furniture.points(shape, rng)), shape.radius < 0.3, reflectivity=round(rng.uniform(0.3, 0.7), 2))

    def lookalike(self, rng):
        return self.furniture.shape(*self.piece, round(self.scale * rng.choice([0.75, 0.82, 1.2, 1.3]), 3))


def drawn_classes(seed, furniture, count):
    """Half primitives, half meshes, none twice."""
    rng = random.Random(f'{seed}/drawn')
    primitives = [DrawnPrimitive(rng, kind) for kind in rng.sample(sorted(PRIMITIVES), min(count // 2, len(PRIMITIVES)))]
    pieces, meshes = CHAIRS + SEATS + FLOOR_THINGS + TOP_THINGS, []
    rng.shuffle(pieces)
    for piece in pieces:
        low, high = furniture.shape(*piece).low, furniture.shape(*piece).high
        if len(meshes) < count - len(primitives) and 0.4 < math.dist(low, high) < 1.9:
            meshes.append(DrawnMesh(rng, furniture, piece))
            furniture.taken.add(piece)
    furniture.drawn = primitives + meshes
    for number, drawn in enumerate(furniture.drawn):
        drawn.name = f'{drawn.name}_{seed}_{number}'.replace('-', '_')
    return furniture.drawn


def lookalike_screen(rng):
    width, height, lift = other_size(rng, (0.54, 0.35, 0.14))
    return screen(width, height, rng.uniform(0.03, 0.08), lift)


def top_thing(rng, furniture):
    kind = rng.random()
    if kind < 0.2:
        return lookalike_screen(rng)
    if kind < 0.4:
        return carton(*other_size(rng, rng.choice([(0.33, 0.33, 0.36), (0.25, 0.33, 0.12), (0.2, 0.3, 0.2)])))
    if kind < 0.5:
        return of_parts('can', [cylinder(rng.uniform(0.04, 0.12), rng.uniform(0.1, 0.35))])
    return furniture.any_of(rng, TOP_THINGS)


def wall_thing(rng, furniture):
    kind = rng.random()
    if kind < 0.3:
        return filled_shelf(rng, rng.uniform(0.28, 0.45), rng.uniform(0.6, 1.2), rng.uniform(1.2, 2.1), rng.randint(3, 6))
    if kind < 0.5:
        size = rng.uniform(0.4, 0.6), rng.uniform(0.4, 1.2), rng.uniform(0.5, 0.9) if rng.random() < 0.6 else rng.uniform(1.2, 2.0)
        return of_parts('cabinet', [box(*size)], top=size[:2])
    return furniture.any_of(rng, WALL_THINGS)


def desk(rng):
    x, y, z = rng.uniform(0.6, 0.9), rng.uniform(1.0, 1.8), rng.uniform(0.68, 0.78)
    return table(x, y, z, rng.uniform(0.03, 0.07)) if rng.random() < 0.5 else panel_desk(x, y, z)


# ---------------------------------------------------------------- placing
class Placed:
    def __init__(self, shape, x, y, z, yaw, tilt=(0.0, 0.0), item=None, reflectivity=0.6):
        self.shape, self.x, self.y, self.z, self.yaw, self.tilt = shape, x, y, z, yaw, tilt
        self.item, self.reflectivity = item, reflectivity

    def corners(self, margin=0.0):
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        lean = self.shape.height * math.sin(math.radians(max(abs(t) for t in self.tilt))) + margin
        (x0, y0), (x1, y1) = self.shape.low[:2], self.shape.high[:2]
        return [(self.x + c * u - s * v, self.y + s * u + c * v)
                for u, v in ((x0 - lean, y0 - lean), (x1 + lean, y0 - lean), (x1 + lean, y1 + lean), (x0 - lean, y1 + lean))]

    def entry(self):
        """The simulator's object; a leaning one stands on its lowest corner."""
        pitch, roll = self.tilt
        turn = rotation(0, pitch, roll)
        lift = -min(sum(turn[2][j] * c[j] for j in range(3)) for c in box_corners(self.shape.low, self.shape.high))
        entry = {'name': self.shape.name, 'position': [round(self.x, 4), round(self.y, 4), round(self.z + max(lift, 0.0), 4)],
                 'yaw_deg': round(math.degrees(self.yaw), 3), 'reflectivity': round(self.reflectivity, 2), **self.shape.spec}
        if pitch or roll:
            entry.update(pitch_deg=round(pitch, 2), roll_deg=round(roll, 2))
        if self.item:
            entry.update({'class': self.item.name, 'symmetry': self.item.symmetry})
        return entry


def overlap(a, b):
    """Whether two convex polygons have common points (separating axes)."""
    for polygon in (a, b):
        for i, p in enumerate(polygon):
            q = polygon[(i + 1) % len(polygon)]
            n = (q[1] - p[1], p[0] - q[0])
            da, db = ([n[0] * x + n[1] * y for x, y in c] for c in (a, b))
            if max(da) <= min(db) or max(db) <= min(da):
                return False
    return True


class Office:
    def __init__(self, rng, furniture, items):
        self.rng, self.furniture, self.items = rng, furniture, items
        self.x0, self.x1 = -rng.uniform(0.4, 1.5), rng.uniform(3.6, 5.8)
        self.y0, self.y1 = -rng.uniform(2.0, 3.6), rng.uniform(2.0, 3.6)
        self.ceiling = rng.uniform(2.5, 3.2)
        self.sensor_height = rng.uniform(1.05, 1.3)
        self.floor, self.tops = [], []  # tops: (Placed, [Placed on it])

    def free(self, placed, others):
        corners = placed.corners(GAP)
        return not any(overlap(corners, other.corners()) for other in others)

    def try_floor(self, placed, keep_out=1.1):
        corners = placed.corners(0.01)
        inside = all(self.x0 < x < self.x1 and self.y0 < y < self.y1 for x, y in corners)
        nearest = math.hypot(placed.x, placed.y) - placed.shape.radius
        if not inside or nearest < (keep_out if placed.shape.height > 0.6 else 0.6) or not self.free(placed, self.floor):
            return False
        self.floor.append(placed)
        if placed.shape.top and placed.shape.height < 1.0 and min(placed.shape.top) > 0.38 and not placed.item:
            self.tops.append((placed, []))
        return True

    def try_top(self, shape, item=None, tilt=(0.0, 0.0), near=5.0):
        """On a random desk or cabinet, inside its top."""
        if not self.tops:
            return None
        base, others = self.rng.choice(self.tops)
        reach = [t / 2 - 0.1 for t in base.shape.top]
        u, v = self.rng.uniform(-reach[0], reach[0]), self.rng.uniform(-reach[1], reach[1])
        c, s = math.cos(base.yaw), math.sin(base.yaw)
        yaw = self.rng.uniform(-math.pi, math.pi) if item or self.rng.random() < 0.4 else base.yaw + self.rng.uniform(-0.3, 0.3)
        placed = Placed(shape, base.x + c * u - s * v, base.y + s * u + c * v, base.shape.height, yaw, tilt, item, self.reflectivity())
        limits = [t / 2 for t in base.shape.top]
        for x, y in placed.corners():
            a, b = c * (x - base.x) + s * (y - base.y), -s * (x - base.x) + c * (y - base.y)
            if abs(a) > limits[0] or abs(b) > limits[1]:
                return None
        if not self.free(placed, others) or math.hypot(placed.x, placed.y) > near:
            return None
        others.append(placed)
        return placed

    def reflectivity(self):
        return self.rng.uniform(0.25, 0.85)

    def against_wall(self, shape):
        wall, gap = self.rng.choice(['front', 'front', 'left', 'right']), self.rng.uniform(0.03, 0.12)
        depth = -shape.low[0] + gap
        if wall == 'front':
            x, y, yaw = self.x1 - depth, self.rng.uniform(self.y0, self.y1), math.pi
        elif wall == 'left':
            x, y, yaw = self.rng.uniform(self.x0, self.x1), self.y1 - depth, -math.pi / 2
        else:
            x, y, yaw = self.rng.uniform(self.x0, self.x1), self.y0 + depth, math.pi / 2
        return self.try_floor(Placed(shape, x, y, 0, yaw + math.radians(self.rng.uniform(-2, 2)), reflectivity=self.reflectivity()), 0.9)

    def somewhere(self, shape, item=None, tilt=(0.0, 0.0)):
        """In front of the sensor; in every third try close to something that stands there already."""
        heading = self.rng.uniform(-math.pi, math.pi)
        if self.floor and self.rng.random() < 0.33:
            base, angle = self.rng.choice(self.floor), self.rng.uniform(-math.pi, math.pi)
            away = self.rng.uniform(0.5, 1.0) * (base.shape.radius + shape.radius)
            x, y = base.x + away * math.cos(angle), base.y + away * math.sin(angle)
        else:
            distance, angle = math.sqrt(self.rng.uniform(1.3 ** 2, 4.9 ** 2)), math.radians(self.rng.uniform(-80, 80))
            x, y = distance * math.cos(angle), distance * math.sin(angle)
        if item and (math.hypot(x, y) > 4.8 or x < 0.1):
            return None
        placed = Placed(shape, x, y, 0, heading, tilt, item, item.reflectivity if item else self.reflectivity())
        return placed if self.try_floor(placed) else None

    def keep_trying(self, attempt, times=150):
        for _ in range(times):
            result = attempt()
            if result:
                return result
        return None

    def place_item(self, item):
        tilt = (0.0, 0.0)
        if item.may_tilt and self.rng.random() < 0.12:
            tilt = (self.rng.uniform(-10, 10), self.rng.uniform(-10, 10))
        if item.small and self.rng.random() < 0.65:
            placed = self.keep_trying(lambda: self.try_top(item.shape, item, tilt, 4.8))
            if placed:
                return placed
        return self.keep_trying(lambda: self.somewhere(item.shape, item, tilt))

    def hide_partly(self, target):
        """Something between the sensor and the object, a little aside."""
        shape = self.any_thing()
        distance, bearing = math.hypot(target.x, target.y), math.atan2(target.y, target.x)
        at = self.rng.uniform(0.4, 0.9) * distance
        aside = self.rng.uniform(-0.7, 0.7) * (shape.radius + target.shape.radius * at / distance)
        x, y = at * math.cos(bearing) - aside * math.sin(bearing), at * math.sin(bearing) + aside * math.cos(bearing)
        return self.try_floor(Placed(shape, x, y, 0, self.rng.uniform(-math.pi, math.pi), reflectivity=self.reflectivity()))

    def any_thing(self):
        return lookalike(self.rng, self.furniture) if self.rng.random() < 0.6 else self.furniture.any_of(self.rng, FLOOR_THINGS)

    def fill(self):
        rng = self.rng
        for _ in range(rng.randint(3, 7)):
            shape = wall_thing(rng, self.furniture)
            self.keep_trying(lambda: self.against_wall(shape), 15)
        for _ in range(rng.randint(1, 3)):
            shape = desk(rng)
            if rng.random() < 0.5:
                self.keep_trying(lambda: self.against_wall(shape), 20)
            else:
                self.keep_trying(lambda: self.somewhere(shape), 20)
        targets = [placed for placed in (self.place_item(item) for item in self.items) if placed]
        for target in targets:
            if rng.random() < 0.75:
                self.keep_trying(lambda: self.hide_partly(target), 12)
        for _ in range(rng.randint(1, 7)):
            shape = top_thing(rng, self.furniture)
            self.keep_trying(lambda: self.try_top(shape), 10)
        for _ in range(rng.randint(4, 9)):
            shape = self.any_thing()
            self.keep_trying(lambda: self.somewhere(shape), 15)

    def wall_details(self):
        """Pillars, door frames, pictures; windows give no return."""
        rng, details = self.rng, []
        for _ in range(rng.randint(1, 4)):
            wall = rng.choice(['front', 'left', 'right'])
            kind = rng.choice(['window', 'picture', 'frame'])
            thick = 0.02 if kind == 'window' else rng.uniform(0.02, 0.06)
            width, low = rng.uniform(0.4, 1.4), 0.9 if kind == 'window' else rng.uniform(1.1, 1.6)
            height = rng.uniform(0.4, 1.2)
            parts = [box(thick, width, min(height, self.ceiling - low - 0.05))]
            if kind == 'frame':
                low, parts = 0, [box(0.05, 0.1, 2.0, (0, -0.45, 0)), box(0.05, 0.1, 2.0, (0, 0.45, 0)), box(0.05, 1.0, 0.1, (0, 0, 2.0))]
            inset = thick / 2 + 0.005 if kind != 'frame' else 0.03
            if wall == 'front':
                at, yaw = [self.x1 - inset, rng.uniform(self.y0 + 0.8, self.y1 - 0.8), low], 0
            else:
                at, yaw = [rng.uniform(0.5, self.x1 - 0.8), self.y1 - inset if wall == 'left' else self.y0 + inset, low], 90
            details.append({'name': kind, 'parts': parts, 'position': [round(v, 4) for v in at], 'yaw_deg': yaw,
                            'reflectivity': 0 if kind == 'window' else 0.5})
        return details

    def scene(self, seed):
        everything = self.floor + [p for _, others in self.tops for p in others]
        return {**SCANNER, 'seed': seed, 'noise': noise(self.rng),
                'sensor': {**SCANNER['sensor'], 'position': [0, 0, round(self.sensor_height, 3)]},
                'room': {'min': [round(self.x0, 3), round(self.y0, 3), 0], 'max': [round(self.x1, 3), round(self.y1, 3), round(self.ceiling, 3)],
                         'reflectivity': round(self.rng.uniform(0.5, 0.8), 2)},
                'objects': [p.entry() for p in everything] + self.wall_details()}


SCANNER = {'sensor': {'tilt_start_deg': -30, 'tilt_end_deg': 60, 'tilt_step_deg': 0.25, 'line_period': 0.02667,
                      'first_angle_deg': -90, 'angle_step_deg': 0.5, 'num_beams': 361, 'interlaced': True,
                      'max_range': 80, 'no_return': 81.91}}


COARSE = {'tilt_step_deg': 1.0, 'angle_step_deg': 1.0, 'num_beams': 181, 'interlaced': False}


def noise(rng):
    sigma = (0.008, 0.02) if SCANNER['sensor']['num_beams'] == COARSE['num_beams'] else (0.007, 0.009)
    return {'range_sigma': round(rng.uniform(*sigma), 4), 'range_step': 0.01, 'angle_sigma_deg': 0.02,
            'beam_divergence_deg': 0.25, 'rays_per_beam': 7, 'mixing_distance': 0.4,
            'drop_out': round(rng.uniform(0.001, 0.004), 4), 'dark_signal': 0.01}


# ---------------------------------------------------------------- running the simulator
def simulate(simulator, arguments):
    run = subprocess.run([simulator, *map(str, arguments)], capture_output=True, text=True)
    if run.returncode:
        sys.exit(f'{simulator} {arguments[0]}: {run.stderr}')


def scan_folder():
    return 'scans' if SCANNER['sensor']['num_beams'] == COARSE['num_beams'] else 'logs'


def output_of(log):
    """The simulator's option for a scan that would be this log."""
    if log.parent.name == 'scans':
        return '--pcd', log.with_suffix('.pcd')
    return '--log', log


def record(item, out, simulator, seed):
    tall = item.shape.height > 0.7
    views = 8 if SCANNER['sensor'].get('num_beams') != COARSE['num_beams'] else random.Random(f'{seed}/views').randint(1, 4)
    scene = {**SCANNER, 'seed': seed, 'noise': noise(random.Random(seed)),
             'recording': {'views': views, 'distance': round(1.3 + 0.5 * item.shape.radius + 0.3 * item.shape.height, 2),
                           'heights': [1.1, 0.6] if tall else [1.1]},
             'room': {'min': [-6, -6, 0], 'max': [6, 6, 3]},
             'objects': [Placed(item.shape, 0, 0, 0, 0.4, item=item, reflectivity=item.reflectivity).entry()]}
    path = out / 'scenes' / f'record_{item.name}.yaml'
    path.write_text(json.dumps(scene, indent=1))
    (out / 'models').mkdir(exist_ok=True)
    simulate(simulator, [path, '--recording', out / 'models' / item.name])


def items_of(number, seed, classes):
    """The objects of a scan: every class once in a run of four scans (two, of few classes), some left out, some twice."""
    order, run = list(classes), 4 if len(classes) > 8 else 2
    random.Random(f'{seed}/classes/{number // run}').shuffle(order)
    items = order[number % run::run]
    rng = random.Random(f'{seed}/items/{number}')
    if rng.random() < 0.25:
        items.pop(rng.randrange(len(items)))
    if rng.random() < 0.2:
        items.append(rng.choice(items or order))
    return items


def hall_things(rng, furniture, target):
    """Entries of things that stand along the walls of a hall or behind the object, none before it."""
    hall = Office(rng, furniture, [])
    hall.x0, hall.x1, hall.y0, hall.y1 = HALL_MIN[0], HALL_MAX[0], HALL_MIN[1], HALL_MAX[1]
    bearing, distance = math.atan2(target.y, target.x), math.hypot(target.x, target.y)
    entries = []
    for _ in range(rng.randint(8, 25)):
        shape = wall_thing(rng, furniture) if rng.random() < 0.4 else hall.any_thing()
        if rng.random() < 0.6:
            x, y = rng.uniform(1, HALL_MAX[0] - 0.8), rng.choice((-1, 1)) * (HALL_MAX[1] - rng.uniform(0.5, 1.5))
        else:
            x, y = rng.uniform(6, HALL_MAX[0] - 0.8), rng.uniform(HALL_MIN[1] + 1, HALL_MAX[1] - 1)
        placed = Placed(shape, x, y, 0, rng.uniform(-math.pi, math.pi), reflectivity=hall.reflectivity())
        beside = abs(math.atan2(y, x) - bearing) * math.hypot(x, y) > shape.radius + target.shape.radius + 0.3
        behind = math.hypot(x, y) > distance + shape.radius + target.shape.radius + 0.3
        if (beside or behind) and hall.free(placed, hall.floor):
            hall.floor.append(placed)
            entries.append(placed.entry())
    return entries


def make_hall_scan(number, out, simulator, seed, furniture, classes, tilted):
    """One object alone in a hall; the scan's labels."""
    name, item = f'{number:03d}', classes[number % len(classes)]
    folder = out / ('tilted' if tilted else 'alone')
    truth, path, log = (out / 'scenes' / f'{folder.name}_{name}.truth.json', out / 'scenes' / f'{folder.name}_{name}.yaml',
                        folder / scan_folder() / f'{name}.lcm')
    rng = random.Random(f'{seed}/{folder.name}/{number}')
    distance = rng.uniform(2, 4) if tilted else rng.uniform(1.5, 13)
    bearing = rng.uniform(-0.5, 0.5)
    tilt, lift = (0.0, 0.0), 0.0
    if tilted:
        angle, axis = rng.uniform(0, 25), rng.uniform(-math.pi, math.pi)
        tilt, lift = (angle * math.cos(axis), angle * math.sin(axis)), 0.05
    placed = Placed(item.shape, distance * math.cos(bearing), distance * math.sin(bearing), lift, rng.uniform(-math.pi, math.pi),
                    tilt, item, item.reflectivity)
    scene = {**SCANNER, 'seed': rng.randrange(1, 2**31), 'noise': noise(rng),
             'sensor': {**SCANNER['sensor'], 'position': [0, 0, round(rng.uniform(1.05, 1.3), 3)]},
             'room': {'min': HALL_MIN, 'max': HALL_MAX}, 'objects': [placed.entry()] + hall_things(rng, furniture, placed)}
    path.write_text(json.dumps(scene, indent=1))
    simulate(simulator, [path, *output_of(log), '--truth', truth])
    objects = json.loads(truth.read_text())['scans'][0]['objects']
    truth.unlink()
    return {'scan': name, 'objects': objects}


def make_scan(number, out, simulator, seed, furniture, classes, mean_visible):
    """The scan's labels. Scenes are drawn until every object can be seen; the best of all attempts counts."""
    name, best, items = f'{number:03d}', None, items_of(number, seed, classes)
    truth, path, log = (out / 'scenes' / f'{name}.truth.json', out / 'scenes' / f'{name}.yaml', out / 'offices' / scan_folder() / f'{name}.lcm')
    for attempt in range(ATTEMPTS):
        rng = random.Random(f'{seed}/{number}/{attempt}')
        office = Office(rng, furniture, items)
        office.fill()
        text = json.dumps(office.scene(rng.randrange(1, 2**31)), indent=1)
        path.write_text(text)
        simulate(simulator, [path, *output_of(log), '--truth', truth])
        objects = json.loads(truth.read_text())['scans'][0]['objects']
        seen = sum(o['points'] >= LEAST_POINTS and o['visible'] >= LEAST_VISIBLE for o in objects)
        visible = sum(o['visible'] for o in objects) / max(len(objects), 1)
        quality = seen - 2 * (len(objects) - seen) - max(visible - mean_visible, 0)
        if best is None or quality > best[0]:
            best = (quality, text, objects)
        if seen == len(items) and visible <= mean_visible:
            break
    else:
        path.write_text(best[1])
        simulate(simulator, [path, *output_of(log), '--truth', truth])
    truth.unlink()
    return {'scan': name, 'objects': best[2]}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--furniture', required=True, type=pathlib.Path)
    parser.add_argument('--simulator', required=True)
    parser.add_argument('--out', required=True, type=pathlib.Path)
    parser.add_argument('--scenes', type=int, default=150)
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('--jobs', type=int, default=2)
    parser.add_argument('--mean-visible', type=float, default=1.0, help='smaller: more of the objects is hidden')
    parser.add_argument('--set', default='offices', choices=('offices', 'alone', 'tilted'))
    parser.add_argument('--draw-objects', type=int, metavar='N', help='N other objects, drawn by the seed')
    parser.add_argument('--own-lookalikes', type=float, default=0.5, help='share of the look-alikes that are drawn objects in other sizes')
    parser.add_argument('--coarse', action='store_true', help='a scanner with a beam a degree, objects recorded from few sides')
    parser.add_argument('--no-recordings', action='store_true', help='OUT has the models already')
    a = parser.parse_args()
    furniture = Furniture(a.furniture, a.out / 'meshes')
    furniture.own_lookalikes = a.own_lookalikes
    if not furniture.models:
        sys.exit(f'{a.furniture}: no .sh3f files')
    if a.coarse:
        SCANNER['sensor'].update(COARSE)
    for folder in ('scenes', f'{a.set}/{scan_folder()}'):
        (a.out / folder).mkdir(parents=True, exist_ok=True)
    classes = drawn_classes(a.seed, furniture, a.draw_objects) if a.draw_objects else object_classes(furniture)
    for piece in CHAIRS + SEATS + FLOOR_THINGS + WALL_THINGS + TOP_THINGS:
        furniture.shape(*piece)
    for drawn in furniture.drawn:  # written before the threads read them
        for scale in range(40):
            drawn.lookalike(random.Random(scale))
    with concurrent.futures.ThreadPoolExecutor(a.jobs) as pool:
        if not a.no_recordings:
            list(pool.map(lambda p: record(p[1], a.out, a.simulator, a.seed * 1000 + p[0]), enumerate(classes)))
        if a.set == 'offices':
            scans = list(pool.map(lambda n: make_scan(n, a.out, a.simulator, a.seed, furniture, classes, a.mean_visible), range(a.scenes)))
        else:
            scans = list(pool.map(lambda n: make_hall_scan(n, a.out, a.simulator, a.seed, furniture, classes, a.set == 'tilted'), range(a.scenes)))
    (a.out / a.set / 'labels.json').write_text(json.dumps({'scans': scans}, indent=0))
    count = {}
    for scan in scans:
        for o in scan['objects']:
            count[o['class']] = count.get(o['class'], 0) + 1
    print(f'{len(scans)} scans, {sum(count.values())} objects: ' + ', '.join(f'{n} {c}' for c, n in sorted(count.items())))


if __name__ == '__main__':
    main()

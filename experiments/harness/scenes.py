"""Scans with known contents: of a folder of sets, or made by rimod-simulator."""
import dataclasses
import hashlib
import json
import math
import pathlib
import random
import sys
import typing

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import make_scenes  # noqa: E402

FURNITURE = '/usr/share/sweethome3d/furniture'
RING_BEARINGS = [-75, -50, -25, 0, 25, 50, 75]  # degrees, of the seven objects of a ring
RING_DISTANCE = 3.0  # m, where a study does not say otherwise
ATTEMPTS = 8         # to draw an office in which every object can be seen


@dataclasses.dataclass
class Scan:
    """A recorded sweep and what stands in it."""
    name: str
    log: pathlib.Path
    objects: typing.List[dict]  # as in labels.json


class DataFolder:
    """A folder with models/<class>/ and sets of logs/NNN.lcm and labels.json."""
    name = 'data'

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.recordings = self.folder / 'models'
        if not any(self.recordings.glob('*/model.json')):
            raise FileNotFoundError(f'{self.recordings}: no recordings of objects (<class>/model.json)')

    def has(self, name):
        return (self.folder / name / 'labels.json').exists()

    def scans(self, name):
        labels = json.loads((self.folder / name / 'labels.json').read_text())
        return [Scan(s['scan'], self.folder / name / 'logs' / f'{s["scan"]}.lcm', s['objects']) for s in labels['scans']]

    def identity(self, name):
        return hashlib.sha256((self.folder / name / 'labels.json').read_bytes()).hexdigest()


class SimulatedScenes:
    """Seven objects like the paper's, in scenes that rimod-simulator scans when they are asked for."""
    name = 'simulator'

    def __init__(self, folder, run, simulator_digest, furniture=FURNITURE, seed=1):
        """run(program, arguments) starts a program of the build and raises when it fails."""
        self.folder, self.run, self.simulator_digest, self.seed = pathlib.Path(folder), run, simulator_digest, seed
        self.furniture_folder, self.loaded = furniture, None
        self.recordings = self.folder / 'models'

    def classes(self):
        """[ObjectClass] under the paper's names."""
        if self.loaded is None:
            for part in ('scenes', 'logs'):
                (self.folder / part).mkdir(parents=True, exist_ok=True)
            furniture = make_scenes.Furniture(self.furniture_folder, self.folder / 'meshes')
            if not furniture.models:
                raise FileNotFoundError(f'{self.furniture_folder}: no furniture; ./setup.sh --experiments installs sweethome3d-furniture')
            self.loaded = furniture, paper_classes(furniture)
        return self.loaded[1]

    def make_recordings(self):
        """A recording of every object for rimod-modeler; the folder."""
        for number, item in enumerate(self.classes()):
            rng = random.Random(f'{self.seed}/record/{number}')
            tall = item.shape.height > 0.7
            placed = make_scenes.Placed(item.shape, 0, 0, 0, 0.4, item=item, reflectivity=item.reflectivity)
            scene = {**make_scenes.SCANNER, 'seed': rng.randrange(1, 2 ** 31), 'noise': make_scenes.noise(rng),
                     'recording': {'views': 8, 'distance': round(1.3 + 0.5 * item.shape.radius + 0.3 * item.shape.height, 2),
                                   'heights': [1.1, 0.6] if tall else [1.1]},
                     'room': {'min': [-6, -6, 0], 'max': [6, 6, 3]}, 'objects': [placed.entry()]}
            self.simulate(f'record_{item.name}', scene, ['--recording', self.recordings / item.name], [self.recordings / item.name / 'model.json'])
        return self.recordings

    def simulate(self, key, scene, arguments, results):
        """Scans the scene unless the results of this very scene are there."""
        text = json.dumps(scene, indent=1)
        path, made_of = self.folder / 'scenes' / f'{key}.yaml', self.folder / 'scenes' / f'{key}.made_of'
        digest = hashlib.sha256((text + self.simulator_digest).encode()).hexdigest()
        if made_of.exists() and made_of.read_text() == digest and all(r.exists() for r in results):
            return
        made_of.unlink(missing_ok=True)
        path.write_text(text)
        for result in results:
            result.parent.mkdir(parents=True, exist_ok=True)
        self.run('rimod-simulator', [path, *arguments])
        made_of.write_text(digest)

    def scan(self, key, scene):
        log, truth = self.folder / 'logs' / f'{key}.lcm', self.folder / 'logs' / f'{key}.json'
        self.simulate(key, scene, ['--log', log, '--truth', truth], [log, truth])
        return Scan(key, log, json.loads(truth.read_text())['scans'][0]['objects'])

    def office(self, number):
        """A cluttered office; every class stands once in each two of them."""
        order = list(self.classes())
        random.Random(f'{self.seed}/classes/{number // 2}').shuffle(order)
        items = order[number % 2::2]
        for attempt in range(ATTEMPTS):
            rng = random.Random(f'{self.seed}/office/{number}/{attempt}')
            office = make_scenes.Office(rng, self.loaded[0], items)
            office.fill()
            scan = self.scan(f'office_{number:03d}_{attempt}', office.scene(rng.randrange(1, 2 ** 31)))
            if len(scan.objects) == len(items) and min(o['visible'] for o in scan.objects) >= 0.2:
                break
        return scan

    def ring(self, key, view, distance=RING_DISTANCE, tilt=(0.0, 0.0), cover=0.0, sensor=None, noise=None):
        """All seven objects in an empty hall, side by side at a distance from the sensor.

        view: turns the objects and changes their places. tilt: pitch and roll in degrees. cover: share of their
        width behind a screen that stands half a metre before them. sensor, noise: values other than the usual ones.
        """
        rng = random.Random(f'{self.seed}/ring/{view}')
        items = self.classes()
        entries, turn = [], rng.uniform(-math.pi, math.pi)
        for place, bearing in enumerate(RING_BEARINGS):
            item, angle = items[(place + 2 * view) % len(items)], math.radians(bearing)
            yaw = math.remainder(turn + 2 * math.pi * (view + 0.37 * place) / 5, 2 * math.pi)
            placed = make_scenes.Placed(item.shape, distance * math.cos(angle), distance * math.sin(angle), 0, yaw, tilt, item,
                                        item.reflectivity)
            entries.append(placed.entry())
            if cover > 0:
                entries.append(screen_before(placed, cover, left=(view + place) % 2 == 0))
        usual = make_scenes.noise(rng)
        usual['drop_out'] = 0.002
        scene = {'sensor': {**make_scenes.SCANNER['sensor'], 'position': [0, 0, 1.15], **(sensor or {})},
                 'noise': {**usual, **(noise or {})}, 'seed': rng.randrange(1, 2 ** 31),
                 'room': {'min': [-2, -distance - 3, 0], 'max': [distance + 6, distance + 3, 5]}, 'objects': entries}
        return self.scan(key, scene)


def paper_classes(furniture):
    """Our seven objects that resemble the paper's, under its names."""
    ours = {c.name: c for c in make_scenes.object_classes(furniture)}
    for pieces in (make_scenes.CHAIRS, make_scenes.SEATS, make_scenes.FLOOR_THINGS, make_scenes.WALL_THINGS, make_scenes.TOP_THINGS):
        for piece in pieces:
            furniture.shape(*piece)
    names = {'box': 'carton_long', 'fan': 'round_fan', 'monitor': 'screen', 'office_chair': 'swivel_chair', 'pioneer': 'robot',
             'table': 'cafe_table', 'wooden_chair': 'kitchen_chair'}
    return [renamed(ours[source], name) for name, source in names.items()]


def renamed(item, name):
    return make_scenes.ObjectClass(name, item.shape, item.symmetry, item.small, item.may_tilt, item.reflectivity)


def screen_before(placed, cover, left):
    """An upright panel that hides this share of the object's width, as seen from the sensor, from one side on."""
    distance, bearing = math.hypot(placed.x, placed.y), math.atan2(placed.y, placed.x)
    c, s = math.cos(bearing), math.sin(bearing)
    sides = [c * y - s * x for x, y in placed.corners()]
    near = (distance - placed.shape.radius - 0.15) / distance
    low, high = near * min(sides), near * max(sides)
    edge = low + cover * (high - low)
    first, last = (low - 0.1, edge) if left else (low + high - edge, high + 0.1)
    middle, ahead = (first + last) / 2, near * distance
    return {'name': 'screen', 'box': {'size': [0.03, round(last - first, 4), round(placed.shape.height + 0.4, 3)]},
            'position': [round(ahead * c - middle * s, 4), round(ahead * s + middle * c, 4), 0],
            'yaw_deg': round(math.degrees(bearing), 3), 'reflectivity': 0.6}

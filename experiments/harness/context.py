"""What a study can use: programs, scenes, models, detections, plots, tables."""
import ast
import hashlib
import json
import os
import pathlib
import subprocess
import tempfile
import typing

from harness import scenes, scoring

METHODS = ('default', 'paper')
MODEL_PROGRAM, DETECT_PROGRAM = 'rimod-modeler', 'rimod-detect'


class ProgramError(RuntimeError):
    """A program of the build failed; the text says which and why."""


class Detected(typing.NamedTuple):
    detections: dict  # {scan: [{'class', 'pose', 'score'}]}
    timing: dict      # {scan: {'points': n, 'ms': {stage: milliseconds}}}


class Context:
    """One for each study: what it asks for is made when it asks."""

    def __init__(self, out, build, data=None, threads=1, quick=False):
        self.out, self.build = pathlib.Path(out), pathlib.Path(build)
        self.threads, self.quick = threads, quick
        self.study, self.figures, self.tables = None, [], []
        self.folder = scenes.DataFolder(data) if data else None
        self.simulated = scenes.SimulatedScenes(self.out / 'scenes', self.run, self.program_digest('rimod-simulator'))
        self.made_models, self.made_boxes = {}, {}

    # ------------------------------------------------------------ programs
    def program(self, name):
        path = self.build / 'bin' / name
        if not path.exists():
            raise ProgramError(f'{path} is not there: build it, or say where with --build')
        return path

    def program_digest(self, name):
        path = self.build / 'bin' / name
        return hashlib.sha256(path.read_bytes()).hexdigest() if path.exists() else ''

    def run(self, name, arguments):
        """What the program writes to stdout. Raises ProgramError with the end of its stderr."""
        done = subprocess.run([str(self.program(name)), *map(str, arguments)], capture_output=True, text=True, stdin=subprocess.DEVNULL)
        if done.returncode:
            raise ProgramError(f'{name} ended with {done.returncode}: {done.stderr.strip()[-600:]}')
        return done.stdout

    # ------------------------------------------------------------ data
    def has_data(self, name):
        """Whether --data has this set."""
        return self.folder is not None and self.folder.has(name)

    def data_scans(self, name):
        """[Scan] of a set of --data, in the order of its labels; with --quick every fifth."""
        scans = self.folder.scans(name)
        return scans[::5] if self.quick else scans

    @staticmethod
    def shuffled(scans):
        """In an order that tells nothing: a part of a run has a bit of everything."""
        return sorted(scans, key=lambda scan: digest_of(scan.name))

    def recordings(self, simulated):
        """Folder with a recording of every object: of the simulated ones, or of --data."""
        return self.simulated.make_recordings() if simulated else self.folder.recordings

    def boxes(self, simulated):
        if simulated not in self.made_boxes:
            self.made_boxes[simulated] = scoring.load_boxes(self.recordings(simulated))
        return self.made_boxes[simulated]

    # ------------------------------------------------------------ configurations, models, detections
    def config(self, config):
        """File of a configuration: 'default', 'paper', or {'method': .., section: {key: value}} over one of them."""
        text = json.dumps({'method': config} if isinstance(config, str) else config, sort_keys=True)
        path = self.out / 'configs' / f'{digest_of(text)[:16]}.yaml'
        if not path.exists():
            write_atomically(path, text + '\n')  # JSON is YAML
        return path

    def models(self, config, simulated=True):
        """Folder with the models of all objects, built for this configuration."""
        path = self.config(config)
        if (path, simulated) in self.made_models:
            return self.made_models[(path, simulated)]
        recordings = self.recordings(simulated)
        state = digest_of(self.program_digest(MODEL_PROGRAM), *(f.read_bytes() for f in sorted(recordings.glob('*/model.json'))),
                          *(str(os.path.getsize(f)) for f in sorted(recordings.glob('*/*.pcd'))))
        folder = self.out / 'models' / f'{path.stem}_{"simulated" if simulated else "data"}_{state[:8]}'
        for recording in sorted(f.parent for f in recordings.glob('*/model.json')):
            model = folder / f'{recording.name}.rimod'
            if not model.exists():
                folder.mkdir(parents=True, exist_ok=True)
                self.run(MODEL_PROGRAM, ['--recording', recording, '--config', path, '--out', model, '--threads', self.threads])
        self.made_models[(path, simulated)] = folder
        return folder

    def detect(self, scans, config, simulated=True, threads=None):
        """Detected of [Scan], by rimod-detect with the models of the configuration."""
        with tempfile.TemporaryDirectory() as folder:
            timing = pathlib.Path(folder) / 'timing.json'
            text = self.run(DETECT_PROGRAM, ['--models', self.models(config, simulated), '--config', self.config(config), '--timing', timing,
                                             '--threads', self.threads if threads is None else threads, *(s.log for s in scans)])
            times = {t['scan']: t for t in json.loads(timing.read_text())}
        detections = {s.name: [] for s in scans}
        for line in text.splitlines():
            detection = json.loads(line)
            detections.setdefault(detection['scan'], []).append(detection)
        return Detected(detections, times)

    def score(self, detections, labels, simulated=True, **limits):
        """Rows as of scoring.score. labels: {scan: [objects]}."""
        return scoring.score(detections, labels, self.boxes(simulated), **limits)

    def judged(self, scan, configs=METHODS, simulated=True, limits=None, **columns):
        """Rows of one scan with each configuration ('method' is its name); columns are added to every row."""
        if not isinstance(configs, dict):
            configs = {name: name for name in configs}
        rows = []
        for name, config in configs.items():
            detections = {scan.name: self.kept_detections(scan, config, simulated)}
            rows += [{'method': name, **columns, **row}
                     for row in self.score(detections, {scan.name: scan.objects}, simulated, **(limits or {}))]
        return rows

    def kept_detections(self, scan, config, simulated):
        """Of one scan; several studies that look at the same scan run the detector once."""
        models = self.models(config, simulated)
        key = digest_of(scan.log.read_bytes(), models, self.config(config).read_text(), self.program_digest(DETECT_PROGRAM))
        path = self.out / 'detections' / f'{key[:32]}.json'
        if not path.exists():
            write_atomically(path, json.dumps(self.detect([scan], config, simulated).detections[scan.name]))
        return json.loads(path.read_text())

    # ------------------------------------------------------------ results
    def figure(self, name, caption, draw, size=(7.0, 3.8)):
        """A plot as <study>_<name>.png and .svg; draw(figure) fills a matplotlib Figure of this size in inches."""
        from harness import style
        files = style.draw(self.out, f'{self.study}_{name}', draw, size)
        self.figures.append({'name': name, 'caption': caption, 'files': files})

    def table(self, name, caption, columns, rows):
        """A table of the results page; cells are texts or numbers (None: nothing known)."""
        self.tables.append({'name': name, 'caption': caption, 'columns': list(columns), 'rows': [list(r) for r in rows]})


def digest_of(*parts):
    digest = hashlib.sha256()
    for part in parts:
        digest.update(part if isinstance(part, bytes) else str(part).encode())
        digest.update(b'\0')
    return digest.hexdigest()


def code_of(module):
    """What a study measures: its code but for texts, report() and functions named report_*."""
    tree = ast.parse(pathlib.Path(module.__file__).read_text())
    kept = [ast.dump(node) for node in tree.body if not is_presentation(node)]
    return '\n'.join(kept)


def is_presentation(node):
    if isinstance(node, ast.FunctionDef):
        return node.name == 'report' or node.name.startswith('report_')
    if isinstance(node, ast.Assign):
        return any(getattr(target, 'id', '') in ('TITLE', 'ABOUT') for target in node.targets)
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)


def write_atomically(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(path.name + '.part')
    part.write_text(text)
    part.replace(path)

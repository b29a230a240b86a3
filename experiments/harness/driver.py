"""The command experiments/run: runs the units of studies that have no result yet, then writes tables, plots and pages."""
import argparse
import csv
import importlib
import json
import pathlib
import pkgutil
import re
import subprocess
import sys
import time

from harness import context as contexts
from harness import page, style
from harness.progress import Progress

ROOT = pathlib.Path(__file__).resolve().parents[2]
USUAL_PROGRAMS = ('rimod-detect', 'rimod-modeler')


def find_studies():
    """{name: module} of experiments/studies."""
    import studies
    modules = {m.name: importlib.import_module(f'studies.{m.name}') for m in pkgutil.iter_modules(studies.__path__)}
    return {name: module for name, module in sorted(modules.items()) if hasattr(module, 'TITLE')}


def state_of(context, module):
    """Digest of everything but a unit's own settings that its result depends on."""
    programs = [context.program_digest(p) for p in getattr(module, 'PROGRAMS', USUAL_PROGRAMS)]
    sets = [context.folder.identity(s) for s in getattr(module, 'DATA', ()) if context.has_data(s)]
    return contexts.digest_of(*programs, *sets, contexts.code_of(module), context.simulated.simulator_digest if not sets else '')


class UnitStore:
    """Results of a study's units, as files. With anew it finds only what was saved by itself."""

    def __init__(self, folder, state, anew=False):
        self.folder, self.state, self.anew = folder, state, anew

    def digest(self, unit):
        return contexts.digest_of(self.state, unit.key, json.dumps(unit.settings, sort_keys=True, default=str))

    def load(self, unit):
        """The unit's rows, or None when it must run (again)."""
        if self.anew:
            return None
        try:
            held = json.loads((self.folder / f'{unit.key}.json').read_text())
            return held['rows'] if held['digest'] == self.digest(unit) else None
        except (OSError, ValueError, KeyError, TypeError):
            return None

    def save(self, unit, rows):
        text = json.dumps({'digest': self.digest(unit), 'rows': rows})
        contexts.write_atomically(self.folder / f'{unit.key}.json', text)


def check_keys(units):
    keys = [u.key for u in units]
    for key in keys:
        if not re.fullmatch(r'[\w.+-]+', key) or keys.count(key) > 1:
            raise ValueError(f'unit key {key!r} is used twice or is no file name')


def run_units(name, units, store, stream, only_report=False):
    """(rows of all units that worked, {key: error})"""
    results = {u.key: store.load(u) for u in units}
    waiting = [u for u in units if results[u.key] is None and not only_report]
    done = sum(rows is not None for rows in results.values())
    progress, errors = Progress(name, len(units), done, len(waiting), stream), {}
    for unit in waiting:
        try:
            results[unit.key] = list(unit.work())
            store.save(unit, results[unit.key])
        except Exception as error:  # whatever it is, the other units go on
            errors[unit.key] = f'{type(error).__name__}: {error}'
            progress.note(f'{name}: {unit.key} failed: {errors[unit.key]}')
        progress.step()
    progress.end()
    left_out = sum(results[u.key] is None and u.key not in errors for u in units)
    if left_out:
        errors['not run yet'] = f'{left_out} of {len(units)} units'
    return [row for u in units for row in results[u.key] or []], errors


def write_csv(path, rows):
    columns = list(dict.fromkeys(key for row in rows for key in row))
    with open(path, 'w', newline='') as out:
        writer = csv.DictWriter(out, columns)
        writer.writeheader()
        writer.writerows({k: format(v, '.6g') if isinstance(v, float) else v for k, v in row.items()} for row in rows)


def run_study(name, module, context, stream=sys.stderr, only_report=False, anew=False):
    """Whether every unit worked."""
    context.study, context.figures, context.tables = name, [], []
    units = module.units(context)
    check_keys(units)
    store = UnitStore(context.out / name / 'units', state_of(context, module), anew)
    rows, errors = run_units(name, units, store, stream, only_report)
    write_csv(context.out / f'{name}.csv', rows)
    findings = ''
    if rows:
        try:
            findings = module.report(context, rows)
        except Exception as error:
            errors['report'] = f'{type(error).__name__}: {error}'
            print(f'{name}: report failed: {errors["report"]}', file=stream)
    result = {'name': name, 'title': module.TITLE, 'about': module.ABOUT, 'findings': findings, 'figures': context.figures,
              'tables': context.tables, 'errors': errors, 'units': len(units), 'rows': len(rows), 'csv': f'{name}.csv', 'made': provenance(context, module)}
    contexts.write_atomically(context.out / name / 'result.json', json.dumps(result, indent=1))
    return not errors


def provenance(context, module):
    sets = [s for s in getattr(module, 'DATA', ()) if context.has_data(s)]
    return {'data': [f'{s}' for s in sets], 'simulated': not sets, 'quick': context.quick, 'commit': commit(), 'date': time.strftime('%Y-%m-%d')}


def commit():
    done = subprocess.run(['git', '-C', str(ROOT), 'describe', '--always', '--dirty'], capture_output=True, text=True)
    return done.stdout.strip() if done.returncode == 0 else 'unknown'


def parse(arguments):
    parser = argparse.ArgumentParser(prog='experiments/run', description='Runs studies: tables as CSV, plots as PNG and SVG, one page with all of them. '
                                     'What is done already is kept; a run that was stopped goes on.')
    parser.add_argument('names', nargs='*', metavar='NAME', help='studies; "all" for every one')
    parser.add_argument('--list', action='store_true', help='say which studies there are')
    parser.add_argument('--data', type=pathlib.Path, help='folder with sets of labelled scans (train, distance, tilt) and models; otherwise the simulator makes scenes')
    parser.add_argument('--out', type=pathlib.Path, default=ROOT / 'build' / 'experiments', help='results (build/experiments)')
    parser.add_argument('--build', type=pathlib.Path, default=ROOT / 'build' / 'release', help='folder of the build (build/release)')
    parser.add_argument('--threads', type=int, default=1, help='that a program may use (1)')
    parser.add_argument('--quick', action='store_true', help='a part of the units, to see that all works')
    parser.add_argument('--report', action='store_true', help='run nothing: tables and plots of what is there')
    parser.add_argument('--anew', action='store_true', help='run everything again, e.g. after a change of experiments/harness')
    parser.add_argument('--publish', type=pathlib.Path, metavar='DIR', help='write what OUT has as Markdown with plots and CSV there, after the studies named')
    return parser.parse_args(arguments)


def main(arguments):
    """Exit code: 0 all done, 1 a unit failed, 2 bad usage, 130 stopped."""
    options, known = parse(arguments), find_studies()
    if options.list:
        for name, module in known.items():
            print(f'{name:14} {module.TITLE}')
        return 0
    names = list(known) if options.names == ['all'] else options.names
    for name in names:
        if name not in known:
            print(f'experiments/run: no study {name!r}; there are: {", ".join(known)}', file=sys.stderr)
            return 2
    if not names and not options.publish:
        print('experiments/run: which study? --list names them', file=sys.stderr)
        return 2
    if names and not style.available():
        print('experiments/run: no matplotlib for this python3: tables without plots (./setup.sh --experiments installs it)', file=sys.stderr)
    try:
        return run_all(options, {name: known[name] for name in names})
    except KeyboardInterrupt:
        print('\nstopped; the same command goes on where it was', file=sys.stderr)
        return 130
    except (OSError, contexts.ProgramError, ValueError) as error:
        print(f'experiments/run: {error}', file=sys.stderr)
        return 2


def run_all(options, chosen):
    options.out.mkdir(parents=True, exist_ok=True)
    context = contexts.Context(options.out.resolve(), options.build.resolve(), options.data, options.threads, options.quick)
    failed = [name for name, module in chosen.items() if not run_study(name, module, context, only_report=options.report, anew=options.anew)]
    page.write_html(options.out)
    if options.publish:
        page.publish(options.out, options.publish)
    print(f'{options.out / "index.html"}' + (f'; failed in part: {", ".join(failed)}' if failed else ''), file=sys.stderr)
    return 1 if failed else 0

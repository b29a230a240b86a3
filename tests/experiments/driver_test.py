"""experiments/run: what it keeps, what it runs again, and what it says of units that fail."""
import csv
import importlib.util
import io
import json
import pathlib
import tempfile
import unittest

import support  # noqa: F401
from harness import context as contexts
from harness import driver, page

STUDY = '''
from studies import Unit
TITLE = 'Squares'
ABOUT = 'The squares of a few numbers.'
PROGRAMS = ('counter',)
RUN = []
NUMBERS = [1, 2, 3]
BROKEN = []
STOP_AT = []

def units(context):
    return [Unit(f'n{n}', lambda n=n: work(n), {'n': n}) for n in NUMBERS]

def work(n):
    if n in STOP_AT:
        raise KeyboardInterrupt
    RUN.append(n)
    if n in BROKEN:
        raise RuntimeError(f'cannot square {n}')
    return [{'n': n, 'square': n * n}] + ([{'n': n, 'note': 'odd'}] if n % 2 else [])

def report(context, rows):
    context.table('sums', 'Sums', ['of', 'sum'], [['squares', sum(r.get('square', 0) for r in rows)], ['nothing', None]])
    return 'A finding & more.'
'''


class DriverTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.out, self.bin = self.folder / 'out', self.folder / 'build' / 'bin'
        self.bin.mkdir(parents=True)
        (self.bin / 'counter').write_text('version 1')
        self.text = STUDY

    def run_study(self, broken=(), numbers=(1, 2, 3), stop_at=(), **options):
        """The study's units that ran; what was said is in self.said."""
        path = self.folder / 'squares.py'
        path.write_text(self.text)
        specification = importlib.util.spec_from_file_location('squares', path)
        module = importlib.util.module_from_spec(specification)
        specification.loader.exec_module(module)
        module.BROKEN, module.NUMBERS, module.STOP_AT = list(broken), list(numbers), list(stop_at)
        stream = io.StringIO()
        try:
            self.worked = driver.run_study('squares', module, contexts.Context(self.out, self.folder / 'build'), stream, **options)
        except KeyboardInterrupt:
            self.worked = None
        self.said = stream.getvalue()
        return module.RUN

    def result(self):
        return json.loads((self.out / 'squares' / 'result.json').read_text())

    def test_units_that_are_done_do_not_run_again(self):
        self.assertEqual(self.run_study(), [1, 2, 3])
        self.assertTrue(self.worked)
        self.assertEqual(self.run_study(), [])

    def test_stopped_run_goes_on_where_it_was(self):
        self.assertEqual(self.run_study(stop_at=[2]), [1])
        self.assertIsNone(self.worked)
        self.assertEqual(self.run_study(), [2, 3])

    def test_new_units_alone_run(self):
        self.run_study()
        self.assertEqual(self.run_study(numbers=[1, 2, 3, 4]), [4])

    def test_changed_program_makes_all_stale(self):
        self.run_study()
        (self.bin / 'counter').write_text('version 2')
        self.assertEqual(self.run_study(), [1, 2, 3])

    def test_changed_settings_make_a_unit_stale(self):
        store = driver.UnitStore(self.out / 'squares' / 'units', 'state')
        from studies import Unit
        store.save(Unit('u', list, {'n': 1}), [])
        self.assertEqual(store.load(Unit('u', list, {'n': 1})), [])
        self.assertIsNone(store.load(Unit('u', list, {'n': 2})))

    def test_changed_measurement_makes_all_stale_but_texts_and_report_do_not(self):
        self.run_study()
        self.text = STUDY.replace('of a few numbers', 'of numbers').replace('A finding', 'Another').replace('    RUN.append(n)', '    # a comment\n    RUN.append(n)')
        self.assertEqual(self.run_study(), [])
        self.assertIn('Another', self.result()['findings'])
        self.text = STUDY.replace('n * n', 'n * n * n')
        self.assertEqual(self.run_study(), [1, 2, 3])

    def test_damaged_result_of_a_unit_is_made_again(self):
        self.run_study()
        units = self.out / 'squares' / 'units'
        (units / 'n1.json').write_text((units / 'n1.json').read_text()[:-9])
        (units / 'n2.json').write_text('[]')
        self.assertEqual(self.run_study(), [1, 2])

    def test_anew_runs_everything_and_report_nothing(self):
        self.run_study(numbers=[1, 2])
        self.assertEqual(self.run_study(numbers=[1, 2], anew=True), [1, 2])
        self.assertEqual(self.run_study(only_report=True), [])
        self.assertEqual(self.result()['errors'], {'not run yet': '1 of 3 units'})
        self.assertIn('3 units, 2 of them done before', self.said)
        self.assertEqual(self.result()['tables'][0]['rows'][0], ['squares', 5])

    def test_broken_unit_is_named_and_the_others_run(self):
        self.assertEqual(self.run_study(broken=[2]), [1, 2, 3])
        self.assertFalse(self.worked)
        self.assertIn('n2 failed: RuntimeError: cannot square 2', self.said)
        self.assertEqual(self.result()['errors'], {'n2': 'RuntimeError: cannot square 2'})
        self.assertEqual(self.result()['tables'][0]['rows'][0], ['squares', 10])
        page.write_html(self.out)
        self.assertIn('n2: RuntimeError: cannot square 2', (self.out / 'index.html').read_text())
        self.assertEqual(self.run_study(), [2])
        self.assertTrue(self.worked)

    def test_broken_report_is_named(self):
        self.text = STUDY.replace("context.table('sums'", "missing('sums'")
        self.run_study()
        self.assertFalse(self.worked)
        self.assertIn('report', self.result()['errors'])

    def test_keys_that_cannot_name_files_or_occur_twice_are_refused(self):
        for before, after in (("f'n{n}'", "f'n/{n}'"), ("f'n{n}'", "'n'")):
            self.text = STUDY.replace(before, after)
            with self.assertRaisesRegex(ValueError, 'unit key'):
                self.run_study()

    def test_table_of_all_rows_has_every_column(self):
        self.run_study()
        with open(self.out / 'squares.csv', newline='') as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 5)
        self.assertEqual(rows[1], {'n': '1', 'square': '', 'note': 'odd'})

    def test_page_needs_no_other_file(self):
        self.run_study()
        page.write_html(self.out)
        text = (self.out / 'index.html').read_text()
        self.assertIn('A finding &amp; more.', text)
        for reference in text.split('src="')[1:]:
            self.assertTrue(reference.startswith('data:'))

    def test_published_page_has_table_findings_and_command(self):
        self.run_study()
        page.publish(self.out, self.folder / 'docs')
        text = (self.folder / 'docs' / 'README.md').read_text()
        for wanted in ('## Squares', 'The squares of a few numbers.', '**A finding & more.**', '| squares | 14 |', '| nothing | - |', 'experiments/run squares'):
            self.assertIn(wanted, text)
        self.assertIn('squares,14', (self.folder / 'docs' / 'squares_sums.csv').read_text())

    def test_pages_take_results_of_other_programs(self):
        contexts.write_atomically(self.out / 'tune' / 'result.json', json.dumps(
            {'name': 'tune', 'title': 'Tuned', 'about': 'About.', 'findings': 'Better.', 'figures': [], 'tables': [], 'command': 'rimod-tune --help'}))
        self.run_study()
        page.write_html(self.out)
        page.publish(self.out, self.folder / 'docs')
        self.assertIn('Tuned', (self.out / 'index.html').read_text())
        text = (self.folder / 'docs' / 'README.md').read_text()
        self.assertIn('    rimod-tune --help', text)
        self.assertLess(text.index('## Squares'), text.index('## Tuned'))

    def test_progress_counts_what_is_left(self):
        self.run_study(numbers=[1])
        self.run_study()
        self.assertIn('3 units, 1 of them done before', self.said)
        self.assertIn('2/2, 0:00:00 left', self.said)


class ContextTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / 'bin').mkdir()
        self.context = contexts.Context(self.folder / 'out', self.folder)

    def program(self, text):
        path = self.folder / 'bin' / 'tool'
        path.write_text('#!/bin/sh\n' + text)
        path.chmod(0o755)

    def test_failing_program_is_named_with_what_it_said(self):
        self.program('echo no such scan >&2; exit 3')
        with self.assertRaisesRegex(contexts.ProgramError, 'tool ended with 3: no such scan'):
            self.context.run('tool', [])

    def test_missing_program_is_named(self):
        with self.assertRaisesRegex(contexts.ProgramError, 'bin/tool is not there'):
            self.context.run('tool', [])

    def test_equal_configurations_share_a_file(self):
        files = {self.context.config(c) for c in ('paper', {'method': 'paper'}, {'method': 'paper', 'scoring': {'gamma': 0.4}})}
        self.assertEqual(len(files), 2)

    def test_folder_without_recordings_is_refused(self):
        with self.assertRaisesRegex(FileNotFoundError, 'no recordings'):
            contexts.Context(self.folder / 'out', self.folder, data=self.folder)


if __name__ == '__main__':
    unittest.main()

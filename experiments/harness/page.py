"""The results of all studies found in a folder, as one HTML page or as Markdown with plots and CSV files.

Every OUT/NAME/result.json is one, whoever wrote it: name, title, about, findings (texts); figures: [{name, caption, files in OUT}];
tables: [{name, caption, columns, rows}]; and, if known, errors {key: text}, units, csv, command, and made {data, simulated, quick, commit, date}.
"""
import base64
import html
import json
import math
import pathlib
import shutil

ORDER = ('table1', 'figure5', 'figure7', 'tilt', 'occlusion', 'resolution', 'noise', 'run_times', 'goodsac')


def results(out):
    """result.json of every study in the folder, the paper's first."""
    found = [json.loads(f.read_text()) for f in sorted(pathlib.Path(out).glob('*/result.json'))]
    return sorted(found, key=lambda r: (ORDER.index(r['name']) if r['name'] in ORDER else len(ORDER), r['name']))


def cell(value):
    if value is None:
        return '-'
    if isinstance(value, float):
        return '∞' if math.isinf(value) else f'{value:.2f}'
    return str(value)


def origin(result):
    """Where the numbers come from, as a sentence."""
    made = result.get('made', {})
    source = 'Scenes of rimod-simulator' if made.get('simulated', True) else 'Recorded sets: ' + ', '.join(made.get('data', []))
    quick = ', part of the units (--quick)' if made.get('quick') else ''
    left_out = ' (not run yet: ' + result['errors']['not run yet'] + ')' if 'not run yet' in result.get('errors', {}) else ''
    units = f'; {result["units"]} units{left_out}' if 'units' in result else ''
    return f'{source}{quick}{units}; programs of {made.get("commit", "unknown")}, {made.get("date", "")}.'


def failures(result):
    return [f'{key}: {text}' for key, text in result.get('errors', {}).items() if key != 'not run yet']


# ---------------------------------------------------------------- HTML
STYLE = ('body{font:16px/1.5 sans-serif;max-width:60em;margin:2em auto;padding:0 1em;color:#111}img{max-width:100%}'
         'table{border-collapse:collapse;margin:.5em 0 1.5em}td,th{border:1px solid #bbb;padding:.15em .6em;text-align:right}'
         'td:first-child,th:first-child{text-align:left}figure{margin:1em 0}figcaption,caption{text-align:left;color:#444;font-size:90%}'
         '.error{color:#a00}')


def write_html(out):
    """out/index.html, which needs no other file."""
    found = results(out)
    parts = ['<!doctype html><html lang="en"><meta charset="utf-8"><title>Experiments</title>', f'<style>{STYLE}</style><h1>Experiments</h1><ul>']
    parts += [f'<li><a href="#{r["name"]}">{html.escape(r["title"])}</a></li>' for r in found]
    parts.append('</ul>')
    for result in found:
        parts += html_of(result, pathlib.Path(out))
    (pathlib.Path(out) / 'index.html').write_text('\n'.join(parts) + '\n')


def html_of(result, out):
    parts = [f'<h2 id="{result["name"]}">{html.escape(result["title"])}</h2><p>{html.escape(result["about"])}</p>']
    parts.append(f'<p><b>{html.escape(result["findings"])}</b></p>')
    for figure in result['figures']:
        image = next((out / f for f in figure['files'] if f.endswith('.svg')), None)
        if image and image.exists():
            data = base64.b64encode(image.read_bytes()).decode()
            parts.append(f'<figure><img alt="{html.escape(figure["caption"])}" src="data:image/svg+xml;base64,{data}">'
                         f'<figcaption>{html.escape(figure["caption"])}</figcaption></figure>')
    for table in result['tables']:
        head = ''.join(f'<th>{html.escape(c)}</th>' for c in table['columns'])
        rows = ''.join('<tr>' + ''.join(f'<td>{html.escape(cell(v))}</td>' for v in row) + '</tr>' for row in table['rows'])
        parts.append(f'<table><caption>{html.escape(table["caption"])}</caption><tr>{head}</tr>{rows}</table>')
    parts.append(f'<p>{html.escape(origin(result))}' + (f' All rows: {html.escape(result["csv"])}.' if 'csv' in result else '') + '</p>')
    parts += [f'<p class="error">Failed: {html.escape(text)}</p>' for text in failures(result)]
    return parts


# ---------------------------------------------------------------- Markdown
def publish(out, folder):
    """folder/README.md with a PNG of every plot and the CSV files of the tables."""
    out, folder = pathlib.Path(out), pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    found = results(out)
    lines = ['# Experiments', '', 'Written by `experiments/run --publish FOLDER`; `experiments/README.md` says how to run them. Bands in plots are 95 % confidence intervals.', '']
    lines += [f'- [{r["title"]}](#{anchor(r["title"])})' for r in found]
    lines += [f'- Other scans: [{f.parent.name.replace("_", " ")}]({f.parent.name}/README.md)' for f in sorted(folder.glob('*/README.md'))]
    for result in found:
        lines += markdown_of(result)
        for figure in result['figures']:
            for name in (f for f in figure['files'] if f.endswith('.png') and (out / f).exists()):
                shutil.copyfile(out / name, folder / name)
        for table in result['tables']:
            write_table(folder / table_file(result, table), table)
    (folder / 'README.md').write_text('\n'.join(lines) + '\n')


def table_file(result, table):
    return f'{result["name"]}_{table["name"]}.csv'


def anchor(title):
    kept = ''.join(c for c in title.lower() if c.isalnum() or c in ' -_')
    return kept.replace(' ', '-')


def write_table(path, table):
    import csv
    with open(path, 'w', newline='') as out:
        csv.writer(out).writerows([table['columns'], *([format(v, '.4g') if isinstance(v, float) else v for v in row] for row in table['rows'])])


def markdown_of(result):
    lines = ['', f'## {result["title"]}', result['about'], '', f'**{result["findings"]}**']
    for figure in result['figures']:
        lines += ['', *(f'![{figure["caption"]}]({f})' for f in figure['files'] if f.endswith('.png')), '', figure['caption']]
    for table in result['tables']:
        lines += ['', f'{table["caption"]} ([CSV]({table_file(result, table)}))', '', markdown_row(table['columns']), markdown_row(['---'] * len(table['columns']))]
        lines += [markdown_row(map(cell, row)) for row in table['rows']]
    lines += ['', origin(result), '', f'    {command(result)}']
    return lines + [f'\nFailed: {text}' for text in failures(result)]


def markdown_row(cells):
    return '| ' + ' | '.join(str(c).replace('|', '\\|') for c in cells) + ' |'


def command(result):
    if 'command' in result:
        return result['command']
    return f'experiments/run {result["name"]}' + ('' if result.get('made', {}).get('simulated', True) else ' --data DIR')

"""Cluttered offices with labels, as the programs that count hits by themselves want them."""
import json
import pathlib
import tempfile

SET = 'train'  # of --data


def scans_of(context, numbers):
    """([Scan], whether they are simulated): those of --data, or the simulator's offices."""
    if context.has_data(SET):
        scans = context.folder.scans(SET)
        return [scans[i] for i in numbers if i < len(scans)], False
    return [context.simulated.office(i) for i in numbers], True


def run(context, program, config, numbers, *arguments):
    """The program's CSV rows as {column: text} of the offices of these numbers; none without such offices."""
    scans, simulated = scans_of(context, numbers)
    if not scans:
        return []
    with tempfile.TemporaryDirectory() as folder:
        labels = pathlib.Path(folder) / 'labels.json'
        labels.write_text(json.dumps({'scans': [{'scan': s.name, 'objects': s.objects} for s in scans]}))
        text = context.run(program, ['--models', context.models(config, simulated), '--recordings', context.recordings(simulated),
                                     '--labels', labels, '--config', context.config(config), *arguments, '--scans', *(s.log for s in scans)])
    head, *lines = text.splitlines()
    return [dict(zip(head.split(','), line.split(','))) for line in lines]


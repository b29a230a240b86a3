#!/usr/bin/env python3
"""Show the scenes of make_scenes.py to a spinning lidar or a depth camera: labelled point clouds of other sensors.

usage: make_clouds.py --scenes OUT/scenes --sensor lidar|camera --program rimod-sensor-clouds --out FOLDER

The sensor stands where the scenes' scanner does, at another height and pitch in every scene; a camera looks in two directions. Writes
FOLDER/NNN.lcm (channels CLOUD and CARRIER_TO_LOCAL), FOLDER/NNN.yaml (the configuration that tells rimod the sensor's mount) and
FOLDER/labels.json (in the benchmark's format; an object is listed when the sensor has a point of it; "visible" is always 1).
A scene's mount depends only on its number, the sensor and the name of the folder above --scenes.
"""
import argparse
import json
import pathlib
import random
import subprocess
import sys


def mount_of(sensor, rng):
    """Options of rimod-sensor-clouds: what a robot might carry."""
    if sensor == 'camera':
        left = rng.uniform(-50, -20)
        return ['--yaw', f'{left:.1f}', f'{left + 50:.1f}', '--pitch', f'{rng.uniform(5, 25):.1f}',
                '--height', f'{rng.uniform(0.7, 1.5):.2f}']
    return ['--pitch', f'{rng.uniform(-3, 8):.1f}', '--height', f'{rng.uniform(0.6, 1.5):.2f}']


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--scenes', required=True, type=pathlib.Path)
    parser.add_argument('--sensor', required=True, choices=('lidar', 'camera'))
    parser.add_argument('--program', required=True)
    parser.add_argument('--out', required=True, type=pathlib.Path)
    a = parser.parse_args()
    scenes = sorted(p for p in a.scenes.glob('*.yaml') if p.stem.isdigit())
    if not scenes:
        sys.exit(f'{a.scenes}: no scenes of offices')
    a.out.mkdir(parents=True, exist_ok=True)
    scans = []
    for scene in scenes:
        rng = random.Random(f'{a.scenes.resolve().parent.name}{scene.stem}{a.sensor}')
        log, truth = a.out / f'{scene.stem}.lcm', a.out / f'{scene.stem}.json'
        run = subprocess.run([a.program, str(scene), '--sensor', a.sensor, *mount_of(a.sensor, rng),
                              '--seed', str(rng.randrange(1 << 20)), '--log', str(log), '--truth', str(truth)],
                             capture_output=True, text=True)
        if run.returncode != 0:
            sys.exit(f'{scene}: {run.stderr.strip()}')
        log.with_suffix('.yaml').write_text(run.stdout[run.stdout.index('cloud:\n  '):])
        scans += json.loads(truth.read_text())['scans']
        truth.unlink()
    (a.out / 'labels.json').write_text(json.dumps({'scans': scans}, indent=0))
    print(f'{len(scans)} clouds, {sum(len(s["objects"]) for s in scans)} objects')


if __name__ == '__main__':
    main()

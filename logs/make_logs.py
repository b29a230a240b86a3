#!/usr/bin/env python3
"""Cuts this folder's recordings and office log out of the full benchmark data.

    make_logs.py BENCH OUT [--scan 032]

BENCH holds models/<class>/{model.json,scan_NNN.pcd} and train/{labels.json,logs/NNN.lcm};
OUT gets recordings/<class>/, office.lcm and expected/office.labels.json. Plain Python, no packages.

A model scan keeps the points inside the object's box grown by BOX_MARGIN (the object and the floor
round it), and the points whose beam passes through the box grown by BEAM_MARGIN (what was seen
through and beside the object: it tells that there is nothing in between). Order, values and
VIEWPOINT stay as they were recorded.
"""

import argparse
import json
import pathlib
import shutil
import struct

BOX_MARGIN = 0.12  # m
BEAM_MARGIN = 0.02  # m


def rotate(q, v):
    """v turned by the unit quaternion q = (w, x, y, z)."""
    w, x, y, z = q
    tx, ty, tz = 2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])
    return (v[0] + w * tx + y * tz - z * ty,
            v[1] + w * ty + z * tx - x * tz,
            v[2] + w * tz + x * ty - y * tx)


def to_object(pose, p_world):
    """A point of the world in the object's frame; pose = object -> world."""
    inverse = (pose[3], -pose[4], -pose[5], -pose[6])
    return rotate(inverse, [p_world[i] - pose[i] for i in range(3)])


def inside(p, low, high):
    return all(low[i] <= p[i] <= high[i] for i in range(3))


def beam_passes(origin, p, low, high):
    """Whether the ray from origin through p and on passes through the box (slab test)."""
    near, far = 0.0, float("inf")
    for i in range(3):
        step = p[i] - origin[i]
        if step == 0.0:
            if not low[i] <= origin[i] <= high[i]:
                return False
            continue
        a, b = (low[i] - origin[i]) / step, (high[i] - origin[i]) / step
        near, far = max(near, min(a, b)), min(far, max(a, b))
    return near <= far


def read_pcd(path):
    """Viewpoint line and points of a binary x y z float PCD."""
    content = path.read_bytes()
    marker = b"DATA binary\n"
    start = content.index(marker) + len(marker)
    header = dict(line.split(" ", 1) for line in content[:start].decode().splitlines()
                  if line[0] != "#")
    if (header["FIELDS"], header["TYPE"], header["SIZE"]) != ("x y z", "F F F", "4 4 4"):
        raise SystemExit(f"{path}: not a PCD of x y z floats")
    count = int(header["POINTS"])
    return header["VIEWPOINT"], list(struct.iter_unpack("<3f", content[start:start + 12 * count]))


def write_pcd(path, viewpoint, points):
    n = len(points)
    header = ("# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\n"
              f"TYPE F F F\nCOUNT 1 1 1\nWIDTH {n}\nHEIGHT 1\nVIEWPOINT {viewpoint}\nPOINTS {n}\n"
              "DATA binary\n")
    path.write_bytes(header.encode() + b"".join(struct.pack("<3f", *p) for p in points))


def cut(viewpoint, points, model):
    pose = model["object_pose"]
    low, high = model["box"]["min"], model["box"]["max"]

    def grown(margin):
        return [v - margin for v in low], [v + margin for v in high]

    box, beam_box = grown(BOX_MARGIN), grown(BEAM_MARGIN)
    origin = to_object(pose, [float(v) for v in viewpoint.split()[:3]])
    kept = []
    for point in points:
        p_object = to_object(pose, point)
        if inside(p_object, *box) or beam_passes(origin, p_object, *beam_box):
            kept.append(point)
    return kept


def cut_recording(source, target):
    target.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(source / "model.json", target / "model.json")
    model = json.loads((source / "model.json").read_text())
    before = after = 0
    for scan in sorted(source.glob("scan_*.pcd")):
        viewpoint, points = read_pcd(scan)
        kept = cut(viewpoint, points, model)
        write_pcd(target / scan.name, viewpoint, kept)
        before, after = before + len(points), after + len(kept)
    print(f"{target.name}: {after} of {before} points")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bench", type=pathlib.Path, help="folder with models/ and train/")
    parser.add_argument("out", type=pathlib.Path, help="folder to write to")
    parser.add_argument("--scan", default="032", help="the train log to take (default: %(default)s)")
    arguments = parser.parse_args()

    for source in sorted((arguments.bench / "models").iterdir()):
        cut_recording(source, arguments.out / "recordings" / source.name)
    train = arguments.bench / "train"
    shutil.copyfile(train / "logs" / f"{arguments.scan}.lcm", arguments.out / "office.lcm")
    scans = json.loads((train / "labels.json").read_text())["scans"]
    office = [dict(scan, scan="office") for scan in scans if scan["scan"] == arguments.scan]
    expected = arguments.out / "expected"
    expected.mkdir(exist_ok=True)
    (expected / "office.labels.json").write_text(json.dumps({"scans": office}, indent=1) + "\n")


if __name__ == "__main__":
    main()

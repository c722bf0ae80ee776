#!/usr/bin/python3
"""Makes recordings in which a camera is lost out of simulated ones.

    tests/calibration/break_recordings.py SACCADE OUT DATASET...

SACCADE is the command. Of the datasets, in turn: `jump` leaves 0.18 s out and joins what is before and after; `cover`
drops all events for 0.2 s; `noise` puts events of noise in their place; `other` takes frame and depth, and with them
the map, from the next dataset but one. Recordings of more than 1.5 M events are passed over. The result of DATASET is the folder OUT/NAME-KIND.
"""
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

GAP = 0.15, 0.35
JUMP = 0.2, 0.38
MOST_EVENTS = 1500000  # of a recording that is broken: text takes long
MAP_FILES = "images", "images.txt", "depth", "depth.txt"


def read_events(saccade, dataset):
    with tempfile.NamedTemporaryFile(suffix=".txt") as text:
        subprocess.run([saccade, "convert", str(dataset / "events.h5"), text.name, "-q"], check=True)
        return np.loadtxt(text.name, ndmin=2)


def closed(table, begin, end):
    """Without what lies between two times, what follows moved forward."""
    after = table[table[:, 0] >= end].copy()
    after[:, 0] -= end - begin
    return np.concatenate([table[table[:, 0] < begin], after])


def noise(begin, end, size, count=40000):
    random = np.random.default_rng(5)
    t = np.sort(random.uniform(begin, end, count))
    return np.column_stack([t, random.integers(0, size[0], count), random.integers(0, size[1], count),
                            random.integers(0, 2, count)])


def write(folder, dataset, map_of, events, truth):
    folder.mkdir(parents=True)
    replaced = ("events.h5", "events.txt", "groundtruth.txt") + MAP_FILES
    for file in dataset.iterdir():
        if file.name not in replaced:
            os.symlink(file.resolve(), folder / file.name)
    for name in MAP_FILES:
        os.symlink((map_of / name).resolve(), folder / name)
    np.savetxt(folder / "events.txt", events, fmt="%.9f %d %d %d")
    np.savetxt(folder / "groundtruth.txt", truth, fmt="%.12g")


def main(saccade, out, datasets):
    for i, dataset in enumerate(datasets):
        kind = ("jump", "cover", "noise", "other")[i % 4]
        folder = out / f"{dataset.name}-{kind}"
        if folder.exists():
            continue
        events, truth = read_events(saccade, dataset), np.loadtxt(dataset / "groundtruth.txt")
        if len(events) > MOST_EVENTS:
            continue
        size = events[:, 1].max() + 1, events[:, 2].max() + 1
        map_of = dataset
        if kind == "jump":
            events, truth = closed(events, *JUMP), closed(truth, *JUMP)
        elif kind in ("cover", "noise"):
            events = events[(events[:, 0] < GAP[0]) | (events[:, 0] >= GAP[1])]
            if kind == "noise":
                events = np.concatenate([events, noise(*GAP, size)])
                events = events[np.argsort(events[:, 0], kind="stable")]
        else:
            map_of = datasets[(i + 2) % len(datasets)]
        write(folder, dataset, map_of, events, truth)


if __name__ == "__main__":
    if len(sys.argv) < 4:
        raise SystemExit(__doc__)
    main(sys.argv[1], Path(sys.argv[2]), [Path(a) for a in sys.argv[3:]])

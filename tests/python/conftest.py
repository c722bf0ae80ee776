"""What the tests of the Python module share: a small recording, and the command beside the module."""
import os
import pathlib
import subprocess

import pytest

import saccade

ROOT = pathlib.Path(__file__).resolve().parents[2]
SMALL = {"width": 120, "height": 90, "fx": 100, "fy": 100, "cx": 59.5, "cy": 44.5}
DURATION_S = 0.3
WALLS = ROOT / "configs" / "simulation" / "walls.yaml"


@pytest.fixture(scope="session")
def walls(tmp_path_factory):
    """The begin of Walls on a small sensor."""
    return saccade.simulate(WALLS, tmp_path_factory.mktemp("data") / "walls", camera=SMALL, duration_s=DURATION_S)


@pytest.fixture(scope="session")
def command():
    """Runs the command; returns it with its output."""
    def call(*words, expected=0):
        done = subprocess.run([os.environ["SACCADE_COMMAND"], *map(os.fspath, words)], capture_output=True,
                              text=True, cwd=ROOT, check=False)
        assert done.returncode == expected, done.stderr
        return done
    return call

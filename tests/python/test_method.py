"""Estimators in Python: in this process, as an adapter's program, and in a sweep beside built-in ones."""
import csv
import os
import subprocess
import sys

import numpy as np
import pytest

import saccade
from conftest import ROOT, SMALL, WALLS

EXAMPLE = ROOT / "examples" / "python" / "constant_velocity"


@pytest.fixture(autouse=True)
def nothing_registered():
    saccade.method._registered.clear()
    yield
    saccade.method._registered.clear()


def test_a_class_is_run_timed_and_scored_in_this_process(walls, tmp_path):
    @saccade.estimator("truth of the start", inputs=["events", "start"], truth_s=0.05, dt_s=0.02)
    class Still:
        def __init__(self, setup):
            assert setup.camera.width == 120 and setup.start.shape[1] == 8
            self.pose, self.seed = setup.start[-1, 1:], setup.seed
            assert setup.start[-1, 0] <= 0.05 + walls.events.t_s[0] + 1e-9

        def feed(self, events):
            return [[events.t_s[-1], *self.pose]] if len(events) > 0 else []

    for stated in (Still, "truth of the start"):
        run = saccade.run(stated, walls, tmp_path / "run", seed=3)
        assert run.module == "external" and not run.problem
        assert len(run.trajectory) == pytest.approx(walls.events.duration_s / 0.02, abs=1)
        assert 0 < run.timing["wall_s"] < 5
        scores = saccade.evaluate(run)
        assert scores["trajectory.dt_rel_percent.mean"] > 0
    table = saccade.results(tmp_path)
    assert len(table) == 1


def test_a_function_is_a_batch_method(walls):
    @saccade.estimator("all at once", inputs=["events", "imu"])
    def found(setup, events):
        assert len(setup.imu) > 100
        return [[events.t_s[len(events) // 2], 0, 0, 0, 0, 0, 0, 1]]

    run = saccade.run(found, walls)
    assert run.trajectory.shape == (1, 8)
    text = open(run.path + "/run.yaml", encoding="utf-8").read()
    assert "batch" in text and "all at once" in text


def test_an_exception_of_a_method_is_seen_and_nothing_is_left(walls, tmp_path):
    @saccade.estimator("broken")
    def broken(setup, events):
        raise ZeroDivisionError("no map")

    with pytest.raises(ZeroDivisionError, match="no map"):
        saccade.run("broken", walls, tmp_path / "run")
    assert os.listdir(tmp_path) == []


def test_poses_that_are_none_are_bad_input(walls):
    @saccade.estimator("short rows")
    def short(setup, events):
        return [[0, 1, 2]]

    with pytest.raises(saccade.InputError, match="short rows: gave poses of shape"):
        saccade.run(short, walls)
    with pytest.raises(saccade.InputError, match="is a module of saccade"):
        saccade.estimator("track")
    with pytest.raises(saccade.InputError, match="neither a module nor registered"):
        saccade.run(lambda setup, events: [], walls)


def test_a_sweep_ranks_the_example_beside_built_in_ones(tmp_path):
    """By the command; the program of examples/external, which computes the same, has the same errors."""
    sweep = tmp_path / "sweep.yaml"
    camera = "{width: 120, height: 90, fx: 100, fy: 100, cx: 59.5, cy: 44.5}"
    sweep.write_text(f"""
title: Python beside ours
datasets:
  - {{simulate: {WALLS}, set: {{duration_s: 0.4, camera: {camera}}}}}
configurations:
  - {{file: {ROOT}/configs/tracking/fast.yaml}}
  - {{adapter: {EXAMPLE}.yaml, name: python}}
  - {{adapter: {ROOT}/examples/external/constant_velocity.yaml, name: program}}
seeds: [1]
""")
    environment = {**os.environ, "SACCADE_PYTHON": sys.executable, "SACCADE_CACHE": str(tmp_path / "cache")}
    done = subprocess.run([os.environ["SACCADE_COMMAND"], "sweep", sweep, "-o", tmp_path / "out"], env=environment,
                          capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr + done.stdout
    with open(tmp_path / "out" / "sweep.csv", encoding="utf-8") as file:
        rows = {row["configuration"]: row for row in csv.DictReader(file)}
    assert set(rows) == {"fast", "python", "program"}
    key = "trajectory.dt_rel_percent.mean"
    assert float(rows["python"][key]) == pytest.approx(float(rows["program"][key]), rel=1e-3)
    assert float(rows["fast"][key]) < float(rows["python"][key])
    # The interpreter's start, imports and files do not count.
    assert float(rows["python"]["speed.wall_s.median"]) < 1 > float(rows["fast"]["speed.wall_s.median"])
    table = (tmp_path / "out" / "sweep.md").read_text()
    assert "| python |" in table and "| fast |" in table


def test_the_example_in_this_process_is_the_one_of_the_adapter(walls, command, tmp_path):
    saccade.method._load(str(EXAMPLE) + ".py")
    mine = saccade.run("constant velocity in Python", walls)
    theirs = saccade.run("external", walls, tmp_path / "run", config=str(EXAMPLE) + ".yaml")
    assert np.array_equal(mine.trajectory, theirs.trajectory)
    assert saccade.evaluate(mine)["trajectory.coverage"] > 0.9


def test_a_file_without_an_estimator_is_bad_output_with_its_reason(walls, tmp_path):
    (tmp_path / "nothing.py").write_text("import saccade\n")
    (tmp_path / "nothing.yaml").write_text("name: nothing\npython: nothing.py\n")
    run = saccade.run("external", walls, config=tmp_path / "nothing.yaml")
    assert "registers 0 estimators" in run.problem

"""Scores, the gate and stored results: those of the command."""
import json

import numpy as np
import pytest

import saccade
from conftest import ROOT

FAST = ROOT / "configs" / "tracking" / "fast.yaml"


@pytest.fixture(scope="module")
def runs(walls, tmp_path_factory):
    folder = tmp_path_factory.mktemp("runs")
    found = [saccade.run("track", walls, folder / f"seed{seed}", config=FAST, seed=seed) for seed in (1, 2)]
    for run in found:
        saccade.evaluate(run)
    return found


def test_scores_are_those_of_the_command(runs, command):
    mine = saccade.evaluate(runs[0])
    done = command("eval", runs[0].path)
    theirs = json.loads(open(runs[0].path + "/metrics.json", encoding="utf-8").read())
    assert mine["trajectory.dt_rel_percent.mean"] == theirs["trajectory"]["dt_rel_percent"]["mean"]
    assert str(mine) == done.stdout
    assert runs[0].metrics["trajectory.dt_rel_percent.mean"] == mine["trajectory.dt_rel_percent.mean"]


def test_an_array_is_scored_like_a_file(walls, runs, command, tmp_path):
    rows = runs[0].trajectory
    np.savetxt(tmp_path / "mine.txt", rows, fmt="%.17g")
    command("eval", "--trajectory", tmp_path / "mine.txt", "--data", walls.path, "-o", tmp_path / "scores.json")
    theirs = json.loads((tmp_path / "scores.json").read_text())["trajectory"]
    mine = saccade.evaluate(rows, walls)
    assert mine["trajectory.dt_rel_percent.rmse"] == pytest.approx(theirs["dt_rel_percent"]["rmse"], rel=1e-9)
    assert mine["trajectory.se3.ate_rmse_m"] == pytest.approx(theirs["se3"]["ate_rmse_m"], rel=1e-9)
    with pytest.raises(saccade.InputError, match="dataset: state"):
        saccade.evaluate(rows)


def test_errors_of_a_known_shift_are_the_shift(walls):
    shifted = walls.poses.copy()
    shifted[:, 1] += 0.1
    assert saccade.ate(shifted, walls.poses)["ate_rmse_m"] == pytest.approx(0.1, rel=1e-6)
    assert saccade.ate(shifted, walls.poses, "se3")["ate_rmse_m"] < 1e-9
    scaled = walls.poses.copy()
    scaled[:, 1:4] *= 2
    assert saccade.ate(scaled, walls.poses, "sim3")["scale"] == pytest.approx(0.5, rel=1e-6)
    relative = saccade.rpe(scaled, walls.poses)
    assert relative["length_50_percent.trans_percent"] == pytest.approx(100, rel=0.05)
    series = saccade.errors(shifted, walls.poses, 2.0)
    assert series["dt_rel_percent"] == pytest.approx(np.full(len(series["t"]), 5.0))
    with pytest.raises(saccade.InputError, match=r"estimate\[1\]: times must increase"):
        saccade.ate(shifted[[1, 0]], walls.poses)
    with pytest.raises(saccade.InputError, match="alignment: 'sim'"):
        saccade.ate(shifted, walls.poses, "sim")


def test_the_gate_passes_what_is_equal_and_trips_on_what_is_worse(walls, runs, tmp_path):
    baseline = tmp_path / "baseline.yaml"
    with pytest.raises(saccade.InputError, match="does not exist"):
        saccade.gate(runs, baseline)
    assert saccade.gate(runs, baseline, update=True) is None
    assert saccade.gate(runs, baseline, speed=False)
    for run in runs:  # ten times the errors
        path = run.path + "/metrics.json"
        metrics = json.loads(open(path, encoding="utf-8").read())
        for statistic, value in metrics["trajectory"]["dt_rel_percent"].items():
            metrics["trajectory"]["dt_rel_percent"][statistic] = 10 * value
        open(path, "w", encoding="utf-8").write(json.dumps(metrics))
    worse = saccade.gate(runs, baseline, speed=False)
    assert worse.tripped and not worse
    assert any(row["verdict"] == "regressed" and "dt_rel" in row["metric"] for row in worse.rows)
    assert "regressed" in str(worse) and "<testsuite" in worse.junit
    with pytest.raises(saccade.InputError, match="toleranc: is no option of gate"):
        saccade.gate(runs, baseline, toleranc=0.1)
    for run in runs:
        saccade.evaluate(run)


def test_results_are_a_table_of_the_stored_runs(runs):
    import os
    folder = os.path.dirname(runs[0].path)
    table = saccade.results(folder)
    rows = table if isinstance(table, list) else table.to_dict("records")
    assert [row["run"] for row in rows] == ["seed1", "seed2"]
    assert rows[0]["module"] == "track" and rows[0]["config"].startswith("fast")
    assert rows[0]["trajectory.dt_rel_percent.mean"] == pytest.approx(
        runs[0].metrics["trajectory.dt_rel_percent.mean"])
    assert len(saccade.results(folder, where="seed = 2")) == 1
    with pytest.raises(saccade.InputError, match="--where"):
        saccade.results(folder, where="sed = 2")

"""Figures: each is drawn and shows what it is about."""
import matplotlib

matplotlib.use("Agg")

import numpy as np
import pytest

import saccade
from conftest import ROOT


@pytest.fixture(scope="module")
def run(walls):
    return saccade.run("track", walls, config=ROOT / "configs" / "tracking" / "fast.yaml")


def test_events_are_drawn_in_their_colours(walls, tmp_path):
    window = walls.events.between(0.1, 0.12)
    ax = saccade.plot.events(window)
    picture = ax.images[0].get_array()
    on, off = window.to_frame()
    assert np.allclose(picture[(on == 0) & (off == 0)], 1)
    assert np.allclose(picture[on > off], saccade.plot._rgb(saccade.plot._ON))
    assert np.allclose(picture[off > on], saccade.plot._rgb(saccade.plot._OFF))
    ax.figure.savefig(tmp_path / "events.pdf")
    assert (tmp_path / "events.pdf").stat().st_size > 1000
    assert saccade.plot.events(window, frame=walls.frames[2]).images


def test_a_trajectory_is_drawn_beside_the_truth(walls, run, tmp_path):
    ax = saccade.plot.trajectory({"fast": run}, truth=walls, axes="xz")
    assert [line.get_label() for line in ax.lines] == ["truth", "fast"]
    assert np.array_equal(ax.lines[1].get_ydata(), run.trajectory[:, 3])
    assert "z [m]" in ax.get_ylabel()
    ax.figure.savefig(tmp_path / "trajectory.png")


def test_errors_are_those_of_the_scores(walls, run):
    top, bottom = saccade.plot.errors({"fast": run}, walls)
    mean = saccade.evaluate(run.trajectory, walls)["trajectory.dt_rel_percent.mean"]
    assert np.mean(top.lines[0].get_ydata()) == pytest.approx(mean, rel=0.05)
    assert "deg" in bottom.get_ylabel() and "%" in top.get_ylabel()


def test_unknown_depth_stays_white(walls):
    image = walls.depth[0].copy()
    image[:10] = 0
    shown = saccade.plot.depth(image).images[0].get_array()
    assert np.ma.masked_invalid(shown).mask[:10].all() and not np.ma.masked_invalid(shown).mask[20:].all()

"""Runs and the fed tracker: the poses of the command."""
import numpy as np
import pytest

import saccade
from conftest import ROOT

FAST = ROOT / "configs" / "tracking" / "fast.yaml"
BEST = ROOT / "configs" / "tracking" / "best.yaml"
POLARITY = ROOT / "configs" / "tracking" / "polarity.yaml"


@pytest.fixture(scope="module")
def tracked(walls):
    return saccade.run("track", walls, config=FAST)


def test_a_run_has_the_poses_of_the_command(walls, tracked, command, tmp_path):
    command("run", "track", "--data", walls.path, "-c", FAST, "-o", tmp_path / "run")
    theirs = saccade.Run(tmp_path / "run")
    assert np.array_equal(theirs.trajectory, tracked.trajectory)
    assert theirs.status == tracked.status and np.array_equal(theirs.map, tracked.map)
    assert len(tracked.trajectory) > 50 and tracked.timing["events"] == len(walls.events)


@pytest.mark.parametrize("config", [FAST, BEST, POLARITY])
@pytest.mark.parametrize("slices", [{"dt": 0.01}, {"n": 137}, {"dt": 10.0}])
def test_a_fed_tracker_has_the_poses_of_a_run(walls, config, slices):
    expected = saccade.run("track", walls, config=config)
    tracker = saccade.Tracker(walls, config=config)
    found = [tracker.feed(part) for part in walls.events.slices(**slices)]
    found.append(tracker.finish())
    rows = np.concatenate([poses.trajectory for poses in found])
    # trajectory.txt holds times with nine decimals; its quaternions are normalised again when they are read.
    assert np.allclose(rows[:, 0], expected.trajectory[:, 0], atol=1e-9, rtol=0)
    assert np.array_equal(rows[:, 1:4], expected.trajectory[:, 1:4])
    assert np.allclose(rows[:, 4:], expected.trajectory[:, 4:], atol=4e-16, rtol=0)
    assert np.concatenate([poses.is_lost for poses in found]).tolist() == expected.is_lost.tolist()
    assert tracker.waiting < len(walls.events) // 10
    assert len(tracker.map) > 100


def test_poses_come_as_soon_as_their_events(walls):
    tracker = saccade.Tracker(walls, config=FAST)
    for part in walls.events.slices(dt=0.01):
        poses = tracker.feed(part)
        assert len(poses) == 0 or poses.trajectory[-1, 0] <= part.t_s[-1]
    assert tracker.waiting < 2000


def test_what_a_tracker_cannot_take_is_an_error(walls):
    tracker = saccade.Tracker(walls, config=FAST)
    tracker.feed(walls.events[1000:2000])
    with pytest.raises(saccade.InputError, match="events are fed in order of time"):
        tracker.feed(walls.events[:100])
    beside = saccade.Events.from_columns([2 * 10**9], [120], [0], [1], 200, 100)
    with pytest.raises(saccade.InputError, match="not on the sensor of 120 x 90 pixels"):
        tracker.feed(beside)
    with pytest.raises(saccade.InputError, match="state disjoint"):
        saccade.Tracker(walls, edges__event_window="sliding")
    with pytest.raises(saccade.InputError, match="takes no events"):
        saccade.Tracker(walls, method="frames")


@pytest.mark.parametrize("field, value", [("t", -1), ("x", 120), ("x", 65535), ("y", 90), ("y", 65535)])
def test_a_bad_event_is_found_wherever_it_stands(walls, field, value):
    tracker = saccade.Tracker(walls, config=FAST)
    start = np.zeros(2, saccade.EVENT_DTYPE)
    start["x"], start["y"] = 119, 89
    tracker.feed(start)
    for count in range(1, 7):
        for bad in range(count):
            part = np.repeat(start[:1], count)
            part[field][bad] = value
            with pytest.raises(saccade.InputError, match=rf"events\[{bad}\]: "):
                tracker.feed(part)


def test_polarities_are_those_of_the_array_whatever_its_stride(walls):
    rows = np.array(walls.events.data[:3001])
    twice = np.zeros((len(rows), 2), rows.dtype)
    twice[:, 0] = rows
    found = []
    for part in (rows, twice[:, 0]):
        tracker = saccade.Tracker(walls, config={"method": "polarity"})
        found.append(np.concatenate([tracker.feed(part).trajectory, tracker.finish().trajectory]))
    assert len(found[0]) > 0
    assert np.array_equal(found[0], found[1])


def test_overrides_and_windows_reach_the_module(walls):
    run = saccade.run("track", walls, config={"edges": {"samples": 20}}, edges__iterations=3, duration_s=0.1, seed=7)
    assert "samples: 20" in run._native.config_yaml and "iterations: 3" in run._native.config_yaml
    assert run.trajectory[-1, 0] < walls.events.t_s[0] + 0.1


def test_errors_are_those_of_the_command(walls, command, tmp_path):
    done = command("run", "trak", "--data", walls.path, "-o", tmp_path / "run", expected=2)
    with pytest.raises(saccade.InputError) as error:
        saccade.run("trak", walls)
    assert done.stderr == f"saccade: {error.value}\n"
    with pytest.raises(saccade.InputError, match="edges.sampels: unknown key.*samples"):
        saccade.run("track", walls, edges__sampels=3)


def test_depth_and_images_are_arrays(walls):
    depth = saccade.run("depth", walls, config=ROOT / "configs" / "depth" / "best.yaml")
    assert len(depth.views) > 0 and depth.depth[0].shape == (90, 120)
    view = depth.views[-1]
    assert view.depth_variance.shape == (90, 120) and (view.depth > 0).sum() > 100
    scores = saccade.evaluate(depth)
    assert scores["depth.rel_median"] < 0.1
    image = saccade.run("reconstruct", walls, depth_from=depth, config=ROOT / "configs/reconstruction/best.yaml")
    assert image.images[0].shape == (90, 120)


def test_a_run_has_covariances_where_its_method_states_them(walls, tracked):
    assert tracked.covariances[1].shape == (0, 6, 6)
    refined = saccade.run("refine", walls, refines=tracked)
    times, covariances = refined.covariances
    assert len(times) == len(covariances) > 0
    assert (np.linalg.eigvalsh(covariances[len(times) // 2]) > 0).all()

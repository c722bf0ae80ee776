"""Simulated datasets, streams and closed loops: the bytes of the command, however they are taken."""
import os
import pathlib
import signal
import threading

import numpy as np
import pytest

import saccade
from conftest import DURATION_S, SMALL, WALLS


def small_simulator(**more):
    return saccade.Simulator(WALLS, camera=SMALL, duration_s=DURATION_S, **more)


def test_the_dataset_has_the_bytes_of_the_command(walls, command, tmp_path):
    command("simulate", WALLS, "-o", tmp_path / "walls", "--set", f"duration_s={DURATION_S}", "--set",
            "camera={width: 120, height: 90, fx: 100, fy: 100, cx: 59.5, cy: 44.5}")
    theirs = saccade.Dataset(tmp_path / "walls")
    assert np.array_equal(theirs.events.data, walls.events.data)
    assert np.array_equal(theirs.poses, walls.poses)
    for name in ("events.h5", "groundtruth.txt", "imu.txt", "calib.txt"):
        assert (tmp_path / "walls" / name).read_bytes() == pathlib.Path(walls.path, name).read_bytes()


@pytest.mark.parametrize("dt", [0.01, 0.0333, 1.0])
def test_a_stream_is_the_recording_in_slices(walls, dt):
    parts = list(small_simulator().stream(dt))
    assert len(parts) == int(np.ceil(DURATION_S / dt))
    for k, part in enumerate(parts):
        assert len(part) == 0 or (part.t[0] >= round(k * dt * 1e9) and part.t[-1] < round((k + 1) * dt * 1e9))
    assert np.array_equal(np.concatenate([part.data for part in parts]), walls.events.data)


def test_a_stream_that_was_left_begins_anew(walls):
    simulator = small_simulator()
    first = next(iter(simulator.stream(0.02)))
    assert np.array_equal(next(iter(simulator.stream(0.02))).data, first.data)
    assert np.array_equal(simulator.events().data, walls.events.data)


def test_other_samplings_stream_too():
    for sampling in ("frames", "adaptive"):
        simulator = saccade.Simulator(WALLS, camera=SMALL, duration_s=0.1, events__sampling=sampling)
        streamed = np.concatenate([part.data for part in simulator.stream(0.02)])
        assert len(streamed) > 0 and np.array_equal(streamed, simulator.record().events.data)


def test_noise_streams_as_it_is_recorded():
    simulator = saccade.Simulator(WALLS, camera=SMALL, sensor="davis240c", duration_s=0.1)
    streamed = np.concatenate([part.data for part in simulator.stream(0.01)])
    assert np.array_equal(streamed, simulator.record().events.data)


def test_views_at_any_time_are_those_of_the_dataset(walls):
    simulator = small_simulator()
    k = len(walls.frames) // 2
    assert np.allclose(simulator.frame(walls.frames.t[k]), walls.frames[k], atol=1e-6)
    assert np.array_equal(simulator.depth(walls.depth.t[k]), walls.depth[k])
    assert simulator.flow(0.1).shape == (2, 90, 120)
    assert np.allclose(simulator.poses(walls.poses[:, 0])[:, 1:4], walls.poses[:, 1:4], atol=1e-9)
    with pytest.raises(saccade.InputError, match="t_s: 9 s is not within 0 and 0.3 s"):
        simulator.frame(9)


def test_a_trajectory_may_be_an_array_or_a_function(walls):
    start = walls.poses[0, 1:]

    def sideways(t):
        return [start[0] + 0.5 * t, *start[1:]]

    rows = np.array([[t, *sideways(t)] for t in np.linspace(0, 0.2, 41)])
    by_array = saccade.Simulator(WALLS, rows, SMALL)
    by_function = saccade.Simulator(WALLS, sideways, SMALL, duration_s=0.2)
    assert by_array.duration_s == pytest.approx(0.2)
    assert np.array_equal(by_array.events().data, by_function.events().data)
    assert by_array.pose(0.1)[:3] == pytest.approx(sideways(0.1)[:3], abs=1e-6)
    assert len(by_array.events()) > 100


def test_a_matrix_is_a_pose():
    turn = np.array([[0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]], float)  # 90 degrees about z
    simulator = saccade.Simulator(WALLS, lambda t: turn, SMALL, duration_s=0.1)
    assert simulator.pose(0.05) == pytest.approx([1, 2, 3, 0, 0, np.sqrt(0.5), np.sqrt(0.5)], abs=1e-6)


def test_a_configuration_may_be_a_dictionary():
    data = saccade.simulate({"include": str(WALLS), "camera": SMALL}, duration_s=0.05)
    assert data.camera.width == 120 and len(data.events) > 100
    path = data.path
    del data
    assert not os.path.exists(path)  # a temporary folder goes with its dataset


def test_errors_are_those_of_the_command(command, tmp_path):
    done = command("simulate", WALLS, "-o", tmp_path / "x", "--set", "events.contrast_onn=0.2", expected=2)
    with pytest.raises(saccade.InputError) as error:
        saccade.simulate(WALLS, tmp_path / "x", events__contrast_onn=0.2)
    assert done.stderr == f"saccade: {error.value}\n"
    assert isinstance(error.value, ValueError) and "contrast_on" in str(error.value)
    assert error.value.location and str(error.value).startswith(error.value.location)


def test_progress_is_told_and_an_exception_ends_the_work(tmp_path):
    seen = []

    def progress(label, done, total):
        seen.append((label, done, total))
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        saccade.simulate(WALLS, tmp_path / "walls", duration_s=1.0, progress=progress)
    assert len(seen) == 1 and seen[0][2] > 0
    assert not (tmp_path / "walls").exists()


def test_ctrl_c_is_a_keyboard_interrupt_and_the_next_call_goes_on(walls, tmp_path):
    def press():
        os.kill(os.getpid(), signal.SIGINT)

    pressed = threading.Timer(0.5, press)
    pressed.start()
    with pytest.raises(KeyboardInterrupt):
        for _ in range(1000):  # whatever the machine's speed
            saccade.simulate(WALLS, tmp_path / "walls", duration_s=1.5)
    assert len(saccade.simulate(WALLS, tmp_path / "walls", camera=SMALL, duration_s=DURATION_S).events) == len(
        walls.events)


def test_results_do_not_depend_on_threads(walls):
    saccade.set_threads(1)
    try:
        assert np.array_equal(small_simulator().events().data, walls.events.data)
    finally:
        saccade.set_threads(0)


def test_a_policy_moves_the_camera_by_what_it_sees(walls):
    """Sideways until something moves, then back: the events reach the policy, its commands the camera."""
    def policy(seen):
        assert seen.frame().shape == seen.depth().shape == (90, 120)
        return [0.5 if policy.events < 2000 else -0.5, 0, 0, 0, 0, 0]

    policy.events = 0

    def counting(seen):
        policy.events += len(seen.events)
        return policy(seen)

    loop = saccade.closed_loop(WALLS, SMALL, counting, 0.01, duration_s=0.4, start=walls.poses[0, 1:])
    turned = int(np.argmax(loop.commands[:, 0] < 0))
    assert 2 < turned < 38 and policy.events >= 2000
    assert len(loop.poses) == 41 and len(loop.commands) == 40
    travelled = np.linalg.norm(loop.poses[:, 1:4] - loop.poses[0, 1:4], axis=1)
    assert travelled.argmax() < 40 and travelled[-1] < travelled.max()
    assert (np.diff(loop.events.t) >= 0).all()


def test_a_steered_camera_sees_what_a_known_motion_shows(walls):
    """The path that a policy took, simulated again as a trajectory, gives the same events but for the last ticks,
    which a loop leaves to its next interval."""
    dt, commands = 0.02, np.random.default_rng(1).uniform(-0.4, 0.4, (10, 6))
    loop = saccade.closed_loop(WALLS, SMALL, lambda seen: commands[round(seen.t / dt)], dt, duration_s=0.2,
                               start=walls.poses[0, 1:])
    controls = [walls.poses[0, 1:]] * 3
    for command in commands:
        controls.append(moved(controls[-1], dt * command))
    known = saccade.Simulator(WALLS, {"source": "control_poses", "knot_spacing_s": dt, "control_poses": controls}, SMALL)
    expected = known.events()
    assert len(loop.events) > 1000
    assert len(expected) - len(loop.events) < 20
    # Slices that end elsewhere bracket crossings elsewhere: within the tolerance of a microsecond.
    assert len(set_of(loop.events) ^ set_of(expected)) < 0.02 * len(expected)


def set_of(events):
    return set(zip((events.t // 5000).tolist(), events.x.tolist(), events.y.tolist(), events.p.tolist()))


def moved(pose, twist):
    """pose exp(twist), by the series of the matrix exponential."""
    v, w = twist[:3], twist[3:]
    generator = np.zeros((4, 4))
    generator[:3, :3] = [[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]]
    generator[:3, 3] = v
    step, term = np.eye(4), np.eye(4)
    for k in range(1, 12):
        term = term @ generator / k
        step = step + term
    x, y, z, w = pose[3:]
    matrix = np.eye(4)
    matrix[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                      [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                      [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    matrix[:3, 3] = pose[:3]
    result = matrix @ step
    return np.concatenate([result[:3, 3], saccade.simulation.quaternion_of(result[:3, :3])])

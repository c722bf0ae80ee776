"""Datasets, and windows of them for training."""
import numpy as np
import pytest

import saccade
from conftest import DURATION_S


def test_a_dataset_holds_what_was_simulated(walls):
    assert repr(walls).startswith("Dataset(")
    assert walls.camera.matrix.tolist() == [[100, 0, 59.5], [0, 100, 44.5], [0, 0, 1]]
    assert walls.poses.shape[1] == 8 and walls.poses[-1, 0] == pytest.approx(DURATION_S, abs=2e-3)
    assert walls.frames[0].shape == walls.depth[-1].shape == (90, 120)
    assert walls.frames[0].dtype == np.float32 and (walls.depth[0] > 0).any()
    assert walls.imu.shape[1] == 7 and np.abs(walls.imu[:, 1:4]).max() > 5  # gravity
    assert walls.contrast_on > 0 and walls.mean_depth_m > 0 and "walls" in walls.config_yaml
    assert walls.labels() is None and walls.further_cameras == []


def test_images_are_read_by_index_time_and_slice(walls):
    assert len(walls.frames[1:3]) == 2
    assert walls.frames.nearest(walls.frames.t[2] + 1e-4) == 2
    assert np.array_equal(walls.frames[-1], walls.frames[len(walls.frames) - 1])
    with pytest.raises(IndexError):
        walls.frames[len(walls.frames)]
    assert sum(1 for _ in walls.frames) == len(walls.frames)


def test_a_plain_folder_of_the_event_camera_dataset_is_one(walls, tmp_path):
    with open(tmp_path / "events.txt", "w", encoding="utf-8") as file:
        for event in walls.events.data[:500]:
            file.write(f"{event['t'] * 1e-9:.9f} {event['x']} {event['y']} {int(event['p'])}\n")
    (tmp_path / "calib.txt").write_text("100 100 59.5 44.5 0 0 0 0 0\n")
    (tmp_path / "dataset.yaml").write_text("format_version: 1\nwidth: 120\nheight: 90\n")
    plain = saccade.Dataset(tmp_path)
    assert np.array_equal(plain.events.t, walls.events.t[:500])
    assert len(plain.poses) == 0 and len(plain.frames) == 0 and plain.imu is None


def test_a_folder_that_is_none_says_so(tmp_path):
    with pytest.raises(saccade.InputError, match=str(tmp_path)):
        saccade.Dataset(tmp_path / "nothing")


def test_a_path_that_the_system_refuses_is_an_input_error(tmp_path):
    with pytest.raises(saccade.InputError, match="File name too long"):
        saccade.Dataset(tmp_path / ("a" * 300))


def test_windows_are_samples_with_targets(walls):
    windows = saccade.EventWindows(walls, 0.05, stride_s=0.02, targets=["frame", "depth", "pose"])
    assert len(windows) == int((walls.events.duration_s - 0.05) / 0.02) + 1
    sample = windows[3]
    assert set(sample) == {"input", "t", "frame", "depth", "pose"}
    assert sample["input"].shape == (5, 90, 120) and sample["input"].dtype == np.float32
    start = walls.events.t[0] * 1e-9 + 0.06
    assert np.array_equal(sample["input"], walls.events.between(start, start + 0.05).to_voxel_grid())
    assert np.array_equal(sample["depth"], walls.depth[walls.depth.nearest(sample["t"])])
    assert sample["pose"] == pytest.approx(saccade.pose_at(walls.poses, sample["t"]))
    frames = saccade.EventWindows([walls, walls], 0.1, representation=saccade.Events.to_frame)
    assert frames[0]["input"].shape == (2, 90, 120) and len(frames) % 2 == 0
    with pytest.raises(IndexError):
        windows[len(windows)]


def test_a_pose_between_two_lies_on_the_straight_line_and_the_shortest_turn():
    half = np.sqrt(0.5)
    poses = np.array([[0, 0, 0, 0, 0, 0, 0, 1], [2, 4, 0, 0, 0, 0, -half, -half]])  # 90 degrees about z
    assert saccade.pose_at(poses, 1.0) == pytest.approx(
        [2, 0, 0, 0, 0, np.sin(np.pi / 8), np.cos(np.pi / 8)])
    assert saccade.pose_at(poses, 9.0)[:3] == pytest.approx([4, 0, 0])

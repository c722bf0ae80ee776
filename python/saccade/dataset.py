"""Datasets, simulated or recorded, and windows of them for training."""
from __future__ import annotations

import functools
import os
from typing import Any, Callable, Iterator, Optional, Sequence, Union

import numpy as np

from saccade import _native
from saccade.camera import Camera
from saccade.events import Events


class Images(Sequence):
    """Images of a dataset, each read when it is asked for.

    Attributes
    ----------
    t : numpy.ndarray
        Their times in seconds, increasing.
    """

    def __init__(self, times: Sequence[float], load: Callable[[int], np.ndarray]) -> None:
        self.t = np.asarray(times, float)
        self._load = load

    def __len__(self) -> int:
        return len(self.t)

    def __getitem__(self, index: Any) -> Any:
        """The image at an index, or a list of them."""
        if isinstance(index, slice):
            return [self[i] for i in range(*index.indices(len(self)))]
        if not -len(self) <= index < len(self):
            raise IndexError(f"there are {len(self)} images")
        return self._load(int(index) % len(self))

    def nearest(self, t_s: float) -> int:
        """Index of the image nearest in time."""
        if len(self) == 0:
            raise IndexError("there are no images")
        return int(np.argmin(np.abs(self.t - t_s)))


class Dataset:
    """A dataset folder: of ``saccade simulate``, or any layout that the command reads.

    Parameters
    ----------
    path : path
        The folder. Opening reads the small tables; events and images are read on request.

    Attributes
    ----------
    path : str
    name : str
    camera : Camera
    poses : numpy.ndarray
        True poses, rows ``t x y z qx qy qz qw`` (world from camera), (N, 8); N = 0 without.
    frames, depth, flow : Images
        Linear radiance and z depth [m] (0 = nothing hit), (height, width), and motion fields [px/s],
        (2, height, width), all float32.
    contrast_on, contrast_off, mean_depth_m : float or None
        Contrast thresholds [log units] and mean depth of the scene, where the dataset states them.

    Examples
    --------
    >>> data = saccade.Dataset("data/walls")            # doctest: +SKIP
    >>> data.events["t"], data.depth[0], data.poses[-1]  # doctest: +SKIP
    """

    def __init__(self, path: Union[str, os.PathLike], _keep: Any = None) -> None:
        self._keep = _keep  # a temporary folder lives as long as its dataset
        native = self._native = _native.Dataset(os.fspath(path))
        self.path: str = native.folder
        self.camera = Camera.of(native.camera)
        self.poses: np.ndarray = native.poses
        self.frames = Images(native.frame_times, native.load_frame)
        self.depth = Images(native.depth_times, native.load_depth)
        self.flow = Images(native.flow_times, native.load_flow)
        facts = native.facts
        self.name: str = facts["name"]
        self.contrast_on: Optional[float] = facts["contrast_on"]
        self.contrast_off: Optional[float] = facts["contrast_off"]
        self.mean_depth_m: Optional[float] = facts["mean_depth_m"]

    def __repr__(self) -> str:
        return f"Dataset({self.path!r}, {self.camera.width} x {self.camera.height})"

    def __fspath__(self) -> str:
        return self.path

    @functools.cached_property
    def events(self) -> Events:
        """All events; read once."""
        return self.load_events()

    def load_events(self, start_s: float = -np.inf, end_s: float = np.inf) -> Events:
        """The events with ``start_s <= t < end_s``; seconds count from the dataset's time zero."""
        return Events(self._native.load_events(start_s, end_s), self.camera.width, self.camera.height)

    @functools.cached_property
    def imu(self) -> Optional[np.ndarray]:
        """Rows ``t ax ay az gx gy gz`` [s, m/s^2, rad/s], (N, 7); None without."""
        return self._native.load_imu() if self._native.has_imu else None

    def labels(self, start_s: float = -np.inf, end_s: float = np.inf) -> Optional[dict[str, np.ndarray]]:
        """Labels of the events of a window by name (docs/labels.md); None without."""
        return self._native.load_labels(start_s, end_s) if self._native.has_labels else None

    @property
    def further_cameras(self) -> list["Dataset"]:
        """The datasets of a rig's further cameras."""
        return [Dataset(folder, self._keep) for folder in self._native.further_cameras]

    @property
    def config_yaml(self) -> str:
        """The resolved configuration of a simulation; empty for a recording."""
        return self._native.config_yaml


class EventWindows(Sequence):
    """Windows of datasets as samples for training, shaped as ``torch.utils.data.Dataset`` (and usable
    in its place: it needs no torch, and ``DataLoader`` turns its arrays into tensors).

    Parameters
    ----------
    datasets : path, Dataset, or several of them
    duration_s : float
        Length of a window; one begins every ``stride_s`` (default: ``duration_s``).
    representation : callable
        From the window's :class:`Events` to an array; default the voxel grid of five bins.
    targets : sequence of {"frame", "depth", "flow", "pose"}
        What a sample holds beside ``input``: the image nearest to the window's end, the true pose then.

    Examples
    --------
    >>> windows = saccade.EventWindows("data/walls", 0.05, targets=["depth"])  # doctest: +SKIP
    >>> windows[0]["input"].shape, windows[0]["depth"].shape                    # doctest: +SKIP
    ((5, 180, 240), (180, 240))
    """

    _IMAGES = {"frame": "frames", "depth": "depth", "flow": "flow"}

    def __init__(self, datasets: Any, duration_s: float, stride_s: Optional[float] = None,
                 representation: Optional[Callable[[Events], np.ndarray]] = None,
                 targets: Sequence[str] = ()) -> None:
        if not duration_s > 0 or not (stride_s is None or stride_s > 0):
            raise _native.InputError("EventWindows: duration_s and stride_s must be above 0")
        for target in targets:
            if target not in (*self._IMAGES, "pose"):
                raise _native.InputError(f"targets: {target!r} is none; there are frame, depth, flow, pose")
        if isinstance(datasets, (str, os.PathLike, Dataset)):
            datasets = [datasets]
        self.datasets = [d if isinstance(d, Dataset) else Dataset(d) for d in datasets]
        self.duration_s = duration_s
        self.representation = representation or Events.to_voxel_grid
        self.targets = tuple(targets)
        self._starts = [(i, start) for i, d in enumerate(self.datasets)
                        for start in self._starts_of(d, stride_s or duration_s)]

    def _starts_of(self, dataset: Dataset, stride_s: float) -> Iterator[float]:
        events = dataset.events
        if len(events) == 0:
            return
        first, last = events.t[0] * 1e-9, events.t[-1] * 1e-9
        # A window that just fits must not fall to rounding.
        count = int(np.floor((last - first - self.duration_s) / stride_s + 1e-6)) + 1
        yield from (first + k * stride_s for k in range(max(count, 0)))

    def __len__(self) -> int:
        return len(self._starts)

    def __getitem__(self, index: int) -> dict[str, Any]:
        """``input`` (float32), ``t`` [s] of the window's end, and the targets."""
        which, start = self._starts[index]
        dataset, end = self.datasets[which], start + self.duration_s
        sample: dict[str, Any] = {"input": self.representation(dataset.events.between(start, end)), "t": end}
        for target in self.targets:
            if target == "pose":
                sample[target] = pose_at(dataset.poses, end)
            else:
                images = getattr(dataset, self._IMAGES[target])
                sample[target] = images[images.nearest(end)]
        return sample


def pose_at(poses: np.ndarray, t_s: float) -> np.ndarray:
    """The pose ``x y z qx qy qz qw`` at a time, between two rows: straight line and slerp; held beyond the ends."""
    poses = np.asarray(poses, float)
    if len(poses) == 0:
        raise _native.InputError("poses: there are none")
    i = int(np.clip(np.searchsorted(poses[:, 0], t_s, side="right") - 1, 0, max(len(poses) - 2, 0)))
    a, b = poses[i], poses[min(i + 1, len(poses) - 1)]
    fraction = float(np.clip((t_s - a[0]) / (b[0] - a[0]), 0, 1)) if b[0] > a[0] else 0.0
    qa, qb = a[4:8], b[4:8] * (1 if a[4:8] @ b[4:8] >= 0 else -1)
    angle = np.arccos(np.clip(qa @ qb, -1, 1))
    weights = ((1 - fraction, fraction) if angle < 1e-6 else
               np.sin(np.array([1 - fraction, fraction]) * angle) / np.sin(angle))
    q = weights[0] * qa + weights[1] * qb
    return np.concatenate([a[1:4] + fraction * (b[1:4] - a[1:4]), q / np.linalg.norm(q)])

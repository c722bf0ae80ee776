"""Running estimators over datasets, and the tracker fed with events."""
from __future__ import annotations

import contextlib
import dataclasses
import functools
import os
import sys
import tempfile
from typing import Any, Iterator, Optional, Union

import numpy as np

from saccade import _native, method
from saccade.config import Config, command_line, document
from saccade.dataset import Dataset
from saccade.events import Events
from saccade.simulation import Progress, _show

PathLike = Union[str, os.PathLike]


@dataclasses.dataclass
class View:
    """A view that an estimator made a picture of."""

    t: float  #: [s]
    pose: np.ndarray  #: ``x y z qx qy qz qw``, world from camera
    depth: Optional[np.ndarray]  #: z [m], 0 = unknown, (height, width) float32
    depth_variance: Optional[np.ndarray]  #: [m^2]
    image: Optional[np.ndarray]  #: log intensity, (height, width) float32


class Run:
    """A run folder, by whatever estimator.

    Parameters
    ----------
    path : path

    Attributes
    ----------
    path, module : str
    dataset_path : str
        The folder that it ran over.
    trajectory : numpy.ndarray or None
        Rows ``t x y z qx qy qz qw`` (world from camera), (N, 8).
    poses : dict or None
        Per row of poses.csv, of modules that judge their poses: ``t``, ``status`` (ok, lost,
        relocalised), ``inlier_ratio``, ``residual``, ``probability``.
    timing : dict
        Of timing.json by dotted key; ``wall_s`` is ``wall_s.median``.
    problem : str
        What is to be said of a run that came to nothing; empty where all is well.
    """

    def __init__(self, path: PathLike, _keep: Any = None) -> None:
        self._keep = _keep
        native = self._native = _native.RunFolder(os.fspath(path))
        self.path: str = os.fspath(path)
        self.module: str = native.module
        self.dataset_path: str = native.dataset
        self.trajectory: Optional[np.ndarray] = native.trajectory
        self.poses: Optional[dict[str, Any]] = native.poses
        self.timing: dict[str, Optional[float]] = _with_medians(native.timing)
        self.problem: str = native.problem

    def __repr__(self) -> str:
        poses = "" if self.trajectory is None else f", {len(self.trajectory)} poses"
        return f"Run({self.path!r}, {self.module}{poses})"

    def __fspath__(self) -> str:
        return self.path

    @property
    def status(self) -> list[str]:
        """Of every pose: ok, lost or relocalised; empty where the module states none."""
        return [] if self.poses is None else list(self.poses["status"])

    @property
    def is_lost(self) -> np.ndarray:
        """Whether each row of ``poses`` is lost."""
        return np.array([status == "lost" for status in self.status])

    @property
    def metrics(self) -> dict[str, Optional[float]]:
        """Of metrics.json; empty before :func:`saccade.evaluate`."""
        return _native.RunFolder(self.path).metrics

    @functools.cached_property
    def covariances(self) -> tuple[np.ndarray, np.ndarray]:
        """Times (N,) and covariances (N, 6, 6) of the twist (v, w) [m, rad]; N = 0 without."""
        return self._native.covariances()

    @functools.cached_property
    def map(self) -> np.ndarray:
        """Points of the map in the world [m], (N, 3) float32; N = 0 without."""
        return self._native.map()

    @functools.cached_property
    def views(self) -> list[View]:
        """Depth maps and images that it made, in order of time."""
        file = os.path.join(self.path, "views.yaml")
        return [self._view(view) for view in _native.read_views(file)] if os.path.exists(file) else []

    @staticmethod
    def _view(view: dict[str, Any]) -> View:
        depth = _native.read_exr(view["depth"]) if view["depth"] else {}
        image = _native.read_exr(view["image"]) if view["image"] else {}
        variance = [channel for name, channel in depth.items() if name != "Z"]
        return View(view["t"], view["pose"][0, 1:], depth.get("Z"), variance[0] if variance else None,
                    next(iter(image.values()), None))

    @property
    def depth(self) -> list[np.ndarray]:
        """The depth maps of :attr:`views`."""
        return [view.depth for view in self.views if view.depth is not None]

    @property
    def images(self) -> list[np.ndarray]:
        """The images of :attr:`views`."""
        return [view.image for view in self.views if view.image is not None]

    def open_dataset(self) -> Dataset:
        """The dataset that it ran over."""
        return Dataset(self.dataset_path, self._keep)


def _with_medians(timing: dict[str, Optional[float]]) -> dict[str, Optional[float]]:
    medians = {key[:-len(".median")]: value for key, value in timing.items() if key.endswith(".median")}
    return {**medians, **timing}


@contextlib.contextmanager
def _python_programs() -> Iterator[None]:
    """Adapters of Python methods run by this interpreter, with this package."""
    package = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    old = {name: os.environ.get(name) for name in ("SACCADE_PYTHON", "PYTHONPATH")}
    os.environ["SACCADE_PYTHON"] = sys.executable
    os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, [package, old["PYTHONPATH"]]))
    try:
        yield
    finally:
        for name, value in old.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


def run(estimator: Any, dataset: Union[Dataset, PathLike], output: Optional[PathLike] = None, *,
        config: Config = None, start_s: Optional[float] = None, duration_s: Optional[float] = None,
        poses_from: Optional[PathLike] = None, smooth_poses_s: Optional[float] = None,
        depth_from: Optional[PathLike] = None, refines: Optional[PathLike] = None, seed: Optional[int] = None, repeat: int = 1,
        progress: Progress = None, **overrides: Any) -> Run:
    """Runs an estimator over a dataset, as ``saccade run`` does.

    Parameters
    ----------
    estimator : str, class or callable
        A module (``"track"``, ``"depth"``, ``"reconstruct"``, ``"odometry"``, ``"refine"``,
        ``"stabilize"``, ``"rotation"``, ``"mosaic"``, ``"external"``), or what
        :func:`saccade.estimator` registered, or its name.
    dataset : Dataset or path
    output : path, optional
        Run folder to write; default a temporary one, which is removed with the last reference to the run.
    config : path or dict, optional
        Configuration of the module; default all defaults.
    start_s, duration_s : float, optional
        Window of the dataset.
    poses_from, depth_from, refines : Run or path, optional
        As ``--poses-from``, ``--depth-from`` and ``--from``.
    smooth_poses_s : float, optional
        As ``--smooth-poses``, in seconds.
    seed, repeat : int
        As ``--seed`` and ``--repeat``.
    progress
        As of :func:`saccade.simulate`.
    **overrides
        Keys in place of the configuration's, ``__`` for each dot: ``edges__samples=200``.

    Returns
    -------
    Run
        Poses and maps are those of the command.
    """
    keep = None
    is_own = method.is_registered(estimator)
    name = method.find(estimator).name if is_own else estimator
    if not isinstance(name, str):
        raise _native.InputError("estimator: is neither a module nor registered by saccade.estimator")
    if output is None:
        keep = tempfile.TemporaryDirectory(prefix="saccade-")
        output = os.path.join(keep.name, name.replace(os.sep, "_").replace(" ", "_"))
    options = {"start_s": start_s, "duration_s": duration_s, "poses_from": _path(poses_from),
               "smooth_poses_s": smooth_poses_s, "depth_from": _path(depth_from), "from": _path(refines), "repeat": repeat}
    if seed is not None:
        overrides = {**overrides, "seed": seed}
    folder, data = os.fspath(output), os.fspath(dataset)
    show = _show(progress)
    if is_own:
        own = method.find(estimator)
        request = _native.RunRequest(document(own.adapter(), overrides), data, folder, options)
        _native.run_method(request, own.run)
    else:
        options["command"] = command_line(["saccade", "run", name, "--data", data, "-o", folder], config, overrides)
        request = _native.RunRequest(document(config, overrides), data, folder, options)
        with _python_programs() if name == "external" else contextlib.nullcontext():
            _native.run_module(name, request, show)
    keep_all = (keep, dataset._keep if isinstance(dataset, Dataset) else None)
    return Run(folder, keep_all)


def _path(stated: Optional[PathLike]) -> Optional[str]:
    return None if stated is None else os.fspath(stated)


@dataclasses.dataclass
class Poses:
    """Poses that a tracker found, with their evidence; one entry per pose in each array."""

    trajectory: np.ndarray  #: rows ``t x y z qx qy qz qw``, world from camera
    is_lost: np.ndarray
    probability: np.ndarray  #: that it is within 5 % of the depth and 5 degrees of the truth
    inlier_ratio: np.ndarray
    residual: np.ndarray
    position_sigma_m: np.ndarray
    rotation_sigma_rad: np.ndarray

    def __len__(self) -> int:
        return len(self.trajectory)


def _poses(rows: np.ndarray, evidence: np.ndarray) -> Poses:
    is_lost, *others = evidence.T
    return Poses(rows, is_lost != 0, *others)


class Tracker:
    """The tracker of ``saccade run track``, fed with events as they come.

    Its map is the dataset's picture and depth. Its poses are those of the command over the same window,
    however the events are divided, but for the rows that a run adds where no event came.

    Parameters
    ----------
    dataset : Dataset or path
    config : path or dict, optional
        Configuration of ``track``; default all defaults.
    start_s, duration_s : float, optional
        When it begins and how long it goes on, for the choice of the views that make up the map; default
        the dataset's first event and all.
    **overrides
        As of :func:`run`.

    Examples
    --------
    >>> tracker = saccade.Tracker(data, config="configs/tracking/fast.yaml")  # doctest: +SKIP
    >>> for events in data.events.slices(dt=0.01):                            # doctest: +SKIP
    ...     poses = tracker.feed(events)
    >>> last = tracker.finish()                                               # doctest: +SKIP
    """

    def __init__(self, dataset: Union[Dataset, PathLike], config: Config = None, *,
                 start_s: Optional[float] = None, duration_s: Optional[float] = None, **overrides: Any) -> None:
        self._native = _native.LiveTracker(document(config, overrides), os.fspath(dataset), start_s, duration_s)

    def feed(self, events: Union[Events, np.ndarray]) -> Poses:
        """The poses that can be told with the next events, which are not before those of the last call.

        The interpreter's lock is released during the work.
        """
        data = events.data if isinstance(events, Events) else events
        return _poses(*self._native.feed(data))

    def finish(self) -> Poses:
        """When no more events come: the poses that can be told with those that wait, often none."""
        return _poses(*self._native.finish())

    @property
    def waiting(self) -> int:
        """Events that wait for a pose."""
        return self._native.waiting

    @property
    def map(self) -> np.ndarray:
        """The map's edge points in the world [m], (N, 3)."""
        return self._native.map

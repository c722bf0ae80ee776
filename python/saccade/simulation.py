"""Simulating datasets, streams of events, and cameras that a policy moves."""
from __future__ import annotations

import dataclasses
import os
import sys
import tempfile
from typing import Any, Callable, Iterator, Mapping, Optional, Union

import numpy as np

from saccade import _native
from saccade.camera import Camera
from saccade.config import Config, document
from saccade.dataset import Dataset
from saccade.events import Events

#: None shows progress where stderr is a terminal; a function is called as ``progress(label, done, total)``.
Progress = Union[bool, None, Callable[[str, int, int], None]]


def _show(progress: Progress) -> Any:
    """Sets what the library shows; returns what it is to call."""
    if callable(progress):
        _native.set_quiet(True)
        return progress
    _native.set_quiet(not (sys.stderr.isatty() if progress is None else progress))
    return None


def simulate(config: Config, output: Optional[Union[str, os.PathLike]] = None, *, progress: Progress = None,
             **overrides: Any) -> Dataset:
    """Renders a scene along a trajectory into events, frames, depth, IMU and poses.

    Parameters
    ----------
    config : path or dict
        Simulation configuration (docs/reference/simulate.md).
    output : path, optional
        Dataset folder to write. Without it the dataset lies in a temporary folder, which is removed
        with the last reference to it.
    progress : bool, callable or None
        Whether it is shown on stderr; default where that is a terminal.
    **overrides
        Keys in place of the configuration's, ``__`` for each dot: ``events__contrast_on=0.2``.

    Returns
    -------
    Dataset
        The bytes are those of ``saccade simulate``.

    Raises
    ------
    InputError
        For anything wrong with the configuration or the files that it names.
    KeyboardInterrupt
        On Ctrl-C; the same call goes on from there where ``output`` is stated.
    """
    stated = document(config, overrides)
    keep = None
    if output is None:
        keep = tempfile.TemporaryDirectory(prefix="saccade-")
        output = os.path.join(keep.name, _name_of(config))
    _native.simulate(stated, os.fspath(output), _show(progress))
    return Dataset(output, keep)


def _name_of(config: Config) -> str:
    is_file = isinstance(config, (str, os.PathLike))
    return os.path.splitext(os.path.basename(os.fspath(config)))[0] if is_file else "dataset"


def _rows_of(trajectory: Callable[[float], Any], duration_s: float, rate_hz: float) -> np.ndarray:
    """A function of time, sampled, as rows t x y z qx qy qz qw."""
    times = np.linspace(0, duration_s, max(int(np.ceil(duration_s * rate_hz)), 1) + 1)
    return np.array([[t, *_seven(trajectory(t))] for t in times])


def _seven(pose: Any) -> np.ndarray:
    """x y z qx qy qz qw of seven numbers or a 4 x 4 matrix."""
    pose = np.asarray(pose, float)
    if pose.shape == (7,):
        return pose
    if pose.shape == (4, 4):
        return np.concatenate([pose[:3, 3], quaternion_of(pose[:3, :3])])
    raise _native.InputError(
        f"trajectory: a pose is x y z qx qy qz qw or a 4 x 4 matrix, not of shape {pose.shape}")


def quaternion_of(rotation: np.ndarray) -> np.ndarray:
    """qx qy qz qw of a 3 x 3 rotation matrix (Bar-Itzhack, 2000: the eigenvector of the largest eigenvalue)."""
    r = np.asarray(rotation, float)
    k = np.array([
        [r[0, 0] - r[1, 1] - r[2, 2], r[1, 0] + r[0, 1], r[2, 0] + r[0, 2], r[2, 1] - r[1, 2]],
        [r[1, 0] + r[0, 1], r[1, 1] - r[0, 0] - r[2, 2], r[2, 1] + r[1, 2], r[0, 2] - r[2, 0]],
        [r[2, 0] + r[0, 2], r[2, 1] + r[1, 2], r[2, 2] - r[0, 0] - r[1, 1], r[1, 0] - r[0, 1]],
        [r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1], np.trace(r)]]) / 3
    q = np.linalg.eigh(k)[1][:, -1]
    return q if q[3] >= 0 else -q


def _sections(scene: Any, camera: Any, sensor: Any) -> tuple[Config, dict[str, Any]]:
    """A configuration for ``scene`` and what stands on top of it."""
    stated: dict[str, Any] = {}
    config: Config = None
    if isinstance(scene, Mapping):
        stated["scene"] = dict(scene)
    elif os.fspath(scene).endswith((".yaml", ".yml")):
        config = os.fspath(scene)
    else:
        stated["scene"] = {"meshes": [{"file": os.path.abspath(scene)}]}
    if camera is not None:
        stated["camera"] = camera.as_dict() if isinstance(camera, Camera) else dict(camera)
    if sensor is not None:
        stated["events"] = {"preset": sensor} if isinstance(sensor, str) else dict(sensor)
    return config, stated


class Simulator:
    """A simulated camera whose events are taken as they come.

    Parameters
    ----------
    scene : path or dict
        A simulation configuration, whose scene (and what else is not stated here) is taken, a mesh file,
        or the section ``scene``.
    trajectory : array, callable, path, dict or None
        Rows ``t x y z qx qy qz qw`` (world from camera) of shape (N, 8), through which the motion passes;
        a function from seconds to ``x y z qx qy qz qw`` or a 4 x 4 matrix, for ``duration_s``; a file; the
        section ``trajectory``; or that of ``scene``.
    camera : Camera or dict, optional
    sensor : str or dict, optional
        A preset (``"davis240c"``) or the section ``events``.
    duration_s : float, optional
        Default: the trajectory's span.
    rate_hz : float
        At which a function is sampled; between the samples the motion is a cubic spline.
    **overrides
        Further keys, as in :func:`simulate`.

    Examples
    --------
    >>> simulator = saccade.Simulator("configs/simulation/walls.yaml", duration_s=0.1)  # doctest: +SKIP
    >>> for events in simulator.stream(dt=0.01):                                        # doctest: +SKIP
    ...     print(len(events))
    """

    def __init__(self, scene: Any, trajectory: Any = None, camera: Any = None, sensor: Any = None, *,
                 duration_s: Optional[float] = None, rate_hz: float = 200.0, **overrides: Any) -> None:
        config, stated = _sections(scene, camera, sensor)
        if callable(trajectory):
            if duration_s is None or not duration_s > 0:
                raise _native.InputError("duration_s: state how long the function's trajectory lasts")
            trajectory = _rows_of(trajectory, duration_s, rate_hz)
        if isinstance(trajectory, Mapping):
            stated["trajectory"] = dict(trajectory)
        elif isinstance(trajectory, (str, os.PathLike)):
            stated["trajectory"] = {"source": "file", "file": os.path.abspath(trajectory)}
        elif trajectory is not None:
            stated["trajectory"] = {"source": "waypoints", "waypoints": np.asarray(trajectory, float)}
            stated["start_s"] = 0
        if duration_s is not None:
            stated["duration_s"] = duration_s
        elif trajectory is not None:
            stated["duration_s"] = None
        self._config: Config = config
        self._stated = {**stated, **overrides}
        self._native = _native.LiveSimulation(self._document())
        self.camera = Camera.of(self._native.camera)
        self.duration_s: float = self._native.duration_s

    def _document(self) -> _native.Document:
        return document(self._config, self._stated)

    def stream(self, dt: float = 0.01) -> Iterator[Events]:
        """Slices of ``dt`` seconds from time 0 to the end, simulated as they are asked for.

        Together they are the events of :meth:`record`; a new call begins anew and ends the one before.
        """
        if not dt > 0:
            raise _native.InputError("dt: must be above 0 s")
        self._native.restart()
        self._turn = turn = object()
        k, end = 0, 0.0
        while end < self.duration_s:
            if self._turn is not turn:
                raise RuntimeError("another stream() of this simulator was begun")
            k += 1
            end = k * dt
            yield self._events(self._native.take_until(end))

    def events(self) -> Events:
        """All events."""
        self._native.restart()
        self._turn = None
        return self._events(self._native.take_until(np.inf))

    def _events(self, data: np.ndarray) -> Events:
        return Events(data, self.camera.width, self.camera.height)

    def pose(self, t_s: float) -> np.ndarray:
        """The true pose ``x y z qx qy qz qw`` (world from camera)."""
        return self._native.poses([self._time(t_s)])[0, 1:]

    def poses(self, times: Any) -> np.ndarray:
        """Rows ``t x y z qx qy qz qw`` at given times."""
        return self._native.poses([self._time(t) for t in np.atleast_1d(times)])

    def frame(self, t_s: float) -> np.ndarray:
        """Linear radiance at an instant, (height, width) float32."""
        return self._native.frame(self._time(t_s))

    def depth(self, t_s: float) -> np.ndarray:
        """z depth [m], 0 where nothing is hit, (height, width) float32."""
        return self._native.depth(self._time(t_s))

    def flow(self, t_s: float) -> np.ndarray:
        """Motion field [px/s], to the right and down, (2, height, width) float32."""
        return np.stack(self._native.flow(self._time(t_s)))

    def record(self, output: Optional[Union[str, os.PathLike]] = None, *, progress: Progress = None) -> Dataset:
        """The whole dataset, as :func:`simulate` gives it."""
        keep = None
        if output is None:
            keep = tempfile.TemporaryDirectory(prefix="saccade-")
            output = os.path.join(keep.name, _name_of(self._config if self._config else {}))
        _native.simulate(self._document(), os.fspath(output), _show(progress))
        return Dataset(output, keep)

    def _time(self, t_s: float) -> float:
        t_s = float(t_s)
        if not 0 <= t_s <= self.duration_s:
            raise _native.InputError(f"t_s: {t_s:g} s is not within 0 and {self.duration_s:g} s")
        return t_s


@dataclasses.dataclass
class Observation:
    """What a policy sees: the events of the last interval, and on request what a camera would."""

    events: Events
    t: float  #: now [s]
    pose: np.ndarray  #: true, ``x y z qx qy qz qw``
    frame: Callable[[], np.ndarray]  #: linear radiance now
    depth: Callable[[], np.ndarray]  #: z depth [m] now


@dataclasses.dataclass
class ClosedLoop:
    """What came of a closed loop."""

    events: Events
    poses: np.ndarray  #: ``t x y z qx qy qz qw`` at the end of every interval, from time 0
    commands: np.ndarray  #: twists ``vx vy vz wx wy wz``, one per interval


def closed_loop(scene: Any, camera: Any, policy: Callable[[Observation], Any], dt: float, *,
                duration_s: float, start: Any = (0, 0, 0, 0, 0, 0, 1), sensor: Any = None,
                **overrides: Any) -> ClosedLoop:
    """A policy moves the camera by what it sees.

    Parameters
    ----------
    scene, camera, sensor
        As of :class:`Simulator`.
    policy : callable
        From an :class:`Observation` to the twist ``vx vy vz wx wy wz`` of the next interval, in the
        camera's axes [m/s, rad/s].
    dt : float
        The interval [s] at which it is asked.
    duration_s : float
    start : array
        The first pose, ``x y z qx qy qz qw`` or a 4 x 4 matrix.

    Notes
    -----
    The camera moves along a cubic spline whose control poses the commands are, as a body with inertia:
    a command acts over the interval that it begins and the three after it.
    """
    config, stated = _sections(scene, camera, sensor)
    # The trajectory of a configuration does not count; this one is always valid.
    stated["trajectory"] = {"source": "slider"}
    first = np.concatenate([[0.0], _seven(start)])
    steered = _native.SteeredCamera(document(config, {**stated, **overrides}), first[None], dt)
    size = steered.camera["width"], steered.camera["height"]
    parts, poses, commands = [Events(np.empty(0, _native.EVENT_DTYPE), *size)], [first], []
    for _ in range(int(np.ceil(duration_s / dt - 1e-9))):
        seen = Observation(parts[-1], steered.t_s, steered.pose[0, 1:], steered.frame, steered.depth)
        command = np.asarray(policy(seen), float).ravel()
        parts.append(Events(steered.advance(command.tolist()), *size))
        poses.append(steered.pose[0])
        commands.append(command)
    return ClosedLoop(Events(np.concatenate([part.data for part in parts]), *size), np.array(poses),
                      np.array(commands).reshape(-1, 6))

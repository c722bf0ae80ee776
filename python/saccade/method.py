"""Estimators in Python: registered, run in this process or in a sweep, timed, scored and ranked.

``python3 -m saccade.method FILE ...`` runs the estimator of a file; an adapter with ``python: FILE`` calls it.
"""
from __future__ import annotations

import argparse
import dataclasses
import importlib.util
import inspect
import os
import time
from typing import Any, Callable, Optional, Sequence

import numpy as np

from saccade import _native
from saccade.camera import Camera
from saccade.events import Events, read_events


@dataclasses.dataclass
class Setup:
    """What an estimator is given before the first event."""

    camera: Camera
    start: np.ndarray  #: true poses of the first ``truth_s`` seconds, rows ``t x y z qx qy qz qw``
    imu: np.ndarray  #: rows ``t ax ay az gx gy gz``, where the inputs hold ``imu``
    seed: int


@dataclasses.dataclass
class Method:
    """A registered estimator."""

    name: str
    make: Callable[..., Any]
    inputs: tuple[str, ...]
    processing: str
    truth_s: float
    dt_s: float

    def adapter(self) -> dict[str, Any]:
        """What an adapter states of it (docs/own_estimator.md)."""
        return {"name": self.name, "class": {"inputs": list(self.inputs), "processing": self.processing},
                "start": {"truth_s": self.truth_s}}

    def run(self, camera: dict[str, Any], events: np.ndarray, start: np.ndarray, imu: np.ndarray,
            seed: int) -> tuple[np.ndarray, float]:
        """Its poses, (N, 8), and the seconds that it took."""
        setup = Setup(Camera.of(camera), start, imu, seed)
        stream = Events(events, setup.camera.width, setup.camera.height)
        begin = time.perf_counter()
        if inspect.isclass(self.make):
            estimator = self.make(setup)
            found = [estimator.feed(part) for part in stream.slices(dt=self.dt_s)]
            poses = np.concatenate([_rows(rows, self.name) for rows in found]) if found else _rows([], self.name)
        else:
            poses = _rows(self.make(setup, stream), self.name)
        return poses, time.perf_counter() - begin


def _rows(rows: Any, name: str) -> np.ndarray:
    array = np.asarray([] if rows is None else rows, float)
    if array.size == 0:
        return np.empty((0, 8))
    array = np.atleast_2d(array)
    if array.ndim != 2 or array.shape[1] != 8:
        raise _native.InputError(f"{name}: gave poses of shape {array.shape}; rows are t x y z qx qy qz qw")
    return array


_registered: dict[str, Method] = {}


def estimator(name: str, *, inputs: Sequence[str] = ("events",), processing: Optional[str] = None,
              truth_s: float = 0.0, dt_s: float = 0.01) -> Callable[[Any], Any]:
    """Registers a class or a function as an estimator.

    A class is made with a :class:`Setup`; its ``feed(events)`` gets slices of ``dt_s`` and gives the poses that it
    can tell by then, rows ``t x y z qx qy qz qw`` (world from camera), in order of time. A function
    ``f(setup, events)`` gets all events and gives all poses.

    Parameters
    ----------
    name : str
        By which :func:`saccade.run` and tables know it.
    inputs : sequence of str
        What it is given, of ``events``, ``frames``, ``imu``, ``start``, ``map``, ``poses``, ``depth``: it is
        ranked among methods of the same inputs and processing.
    processing : {"causal", "fixed_lag", "batch"}, optional
        How far it looks ahead; default causal for a class, batch for a function.
    truth_s : float
        Seconds of true poses that it may see (``setup.start``); what is scored begins where they end.
    dt_s : float
        Slices that a class is fed with.

    Examples
    --------
    >>> @saccade.estimator("stands still", inputs=["events", "start"], truth_s=0.05)  # doctest: +SKIP
    ... class StandsStill:
    ...     def __init__(self, setup):
    ...         self.pose = setup.start[-1, 1:]
    ...     def feed(self, events):
    ...         return [[events.t_s[-1], *self.pose]] if len(events) else []
    >>> run = saccade.run("stands still", "data/walls")                              # doctest: +SKIP
    """
    if not dt_s > 0:
        raise _native.InputError("dt_s: must be above 0 s")
    if name in _native.module_names():
        raise _native.InputError(f"name: {name!r} is a module of saccade; choose another")

    def register(make: Any) -> Any:
        default = "causal" if inspect.isclass(make) else "batch"
        _registered[name] = Method(name, make, tuple(inputs), processing or default, truth_s, dt_s)
        return make

    return register


def is_registered(stated: Any) -> bool:
    """Whether a name, class or function was registered."""
    return _find(stated) is not None


def find(stated: Any) -> Method:
    """What was registered under a name, as a class or as a function."""
    found = _find(stated)
    if found is None:
        raise _native.InputError(f"estimator: {stated!r} was not registered by saccade.estimator")
    return found


def _find(stated: Any) -> Optional[Method]:
    for own in _registered.values():
        if own.make is stated or (isinstance(stated, str) and own.name == stated):
            return own
    return None


def _load(file: str) -> Method:
    """The one estimator that a file registers."""
    spec = importlib.util.spec_from_file_location(os.path.splitext(os.path.basename(file))[0], file)
    if spec is None or spec.loader is None:
        raise _native.InputError(f"{file}: is no Python file")
    spec.loader.exec_module(importlib.util.module_from_spec(spec))
    if len(_registered) != 1:
        raise _native.InputError(f"{file}: registers {len(_registered)} estimators; an adapter runs a file with one")
    return next(iter(_registered.values()))


def _table(file: Optional[str], columns: int) -> np.ndarray:
    return np.loadtxt(file, ndmin=2) if file else np.empty((0, columns))


def main(arguments: Optional[Sequence[str]] = None) -> None:
    """Runs the estimator of a file over what ``saccade run external`` hands over."""
    parser = argparse.ArgumentParser(prog="python3 -m saccade.method", description=main.__doc__)
    parser.add_argument("file")
    for name in ("events", "calib", "out"):
        parser.add_argument("--" + name, required=True)
    for name in ("width", "height", "seed"):
        parser.add_argument("--" + name, type=int, required=True)
    for name in ("start", "imu"):
        parser.add_argument("--" + name)
    stated = parser.parse_args(arguments)
    own = _load(stated.file)
    fx, fy, cx, cy, *distortion = np.loadtxt(stated.calib).tolist()
    camera = {"width": stated.width, "height": stated.height, "fx": fx, "fy": fy, "cx": cx, "cy": cy,
              "distortion": distortion}
    poses, wall_s = own.run(camera, read_events(stated.events).data, _table(stated.start, 8),
                            _table(stated.imu, 7), stated.seed)
    _native.write_trajectory(os.path.join(stated.out, "trajectory.txt"), poses)
    with open(os.path.join(stated.out, "wall_s.txt"), "w", encoding="utf-8") as out:
        out.write(f"{wall_s:.9f}\n")
    print(f"{own.name}: {len(poses)} poses in {wall_s:.3f} s")


if __name__ == "__main__":
    # The file registers its estimator in the package's module, not in this copy of it.
    from saccade import method as package
    package.main()

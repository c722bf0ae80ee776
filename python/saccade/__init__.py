"""saccade: simulate event cameras, estimate motion from their events, score the result.

Examples
--------
>>> import saccade
>>> data = saccade.simulate("configs/simulation/walls.yaml", duration_s=0.5)  # doctest: +SKIP
>>> run = saccade.run("track", data, config="configs/tracking/fast.yaml")     # doctest: +SKIP
>>> print(saccade.evaluate(run))                                              # doctest: +SKIP

Poses are rows ``t x y z qx qy qz qw``: seconds, metres, world from camera. Times of events are int64 nanoseconds.
"""
from saccade import _native, plot
from saccade._native import InputError
from saccade.camera import Camera
from saccade.dataset import Dataset, EventWindows, Images, pose_at
from saccade.events import EVENT_DTYPE, Events, EventsIterator, read_events
from saccade.method import Setup, estimator
from saccade.runs import Poses, Run, Tracker, View, run
from saccade.scores import GateResult, Metrics, ate, errors, evaluate, gate, results, rpe
from saccade.simulation import ClosedLoop, Observation, Simulator, closed_loop, simulate

__version__: str = _native.version


def set_threads(count: int) -> None:
    """Threads that all work may use from now on; 0 means one per core. Results do not depend on it."""
    if count < 0:
        raise InputError("count: must be 0 or more")
    _native.set_threads(count)


__all__ = [
    "Camera", "ClosedLoop", "Dataset", "EVENT_DTYPE", "EventWindows", "Events", "EventsIterator", "GateResult",
    "Images", "InputError", "Metrics", "Observation", "Poses", "Run", "Setup", "Simulator", "Tracker", "View", "ate",
    "closed_loop", "errors", "estimator", "evaluate", "gate", "plot", "pose_at", "read_events", "results", "rpe",
    "run", "set_threads", "simulate",
]

"""Extrapolates the motion of the given start: the smallest estimator in Python (docs/python.md).

Of the events it takes nothing but their times. A camera that keeps its velocity is followed exactly, and no other: the
baseline that an estimator which looks at the events must beat.
"""
import numpy as np

import saccade

POSE_EVERY_S = 0.001


def multiply(a, b):
    """Hamilton product of quaternions x y z w."""
    v = a[3] * b[:3] + b[3] * a[:3] + np.cross(a[:3], b[:3])
    return np.append(v, a[3] * b[3] - a[:3] @ b[:3])


def power(q, exponent):
    """The rotation by `exponent` times the angle of q, the short way."""
    q = q if q[3] >= 0 else -q
    sine = np.linalg.norm(q[:3])
    if sine < 1e-12:
        return np.array([0.0, 0.0, 0.0, 1.0])
    half = np.arctan2(sine, q[3]) * exponent
    return np.append(q[:3] / sine * np.sin(half), np.cos(half))


@saccade.estimator("constant velocity in Python", inputs=["events", "start"], truth_s=0.05)
class ConstantVelocity:
    def __init__(self, setup):
        first, self.last = setup.start[0], setup.start[-1]
        self.span_s = self.last[0] - first[0]
        self.step = self.last[1:4] - first[1:4]
        self.turn = multiply(self.last[4:8], first[4:8] * [-1, -1, -1, 1])  # in the world
        self.next_s = -np.inf

    def pose(self, t_s):
        part = (t_s - self.last[0]) / self.span_s
        return [t_s, *(self.last[1:4] + part * self.step), *multiply(power(self.turn, part), self.last[4:8])]

    def feed(self, events):
        poses = []
        for t_s in events.t_s:
            if t_s >= self.next_s:
                poses.append(self.pose(t_s))
                self.next_s = t_s + POSE_EVERY_S
        return poses

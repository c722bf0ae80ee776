#!/usr/bin/env python3
"""Extrapolates the motion of the given start: the worked example of an external estimator for saccade.

Of the events it takes nothing but their times: one pose for every millisecond that holds any. A camera that keeps its
velocity is followed exactly, and no other: the baseline that an estimator which looks at the events must beat.
Needs Python 3.8 and nothing else.
"""
import argparse
import math

VERSION = "constant velocity 1.0"
POSE_EVERY_S = 0.001


def read_rows(file):
    """Lists of numbers, a line at a time."""
    with open(file) as lines:
        for line in lines:
            if line.strip() and not line.startswith("#"):
                yield [float(word) for word in line.split()]


def multiply(a, b):
    """Hamilton product of quaternions (x, y, z, w)."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz)


def conjugate(q):
    return (-q[0], -q[1], -q[2], q[3])


def power(q, exponent):
    """The rotation by `exponent` times the angle of q, the short way."""
    if q[3] < 0:
        q = tuple(-x for x in q)
    sine = math.sqrt(q[0] ** 2 + q[1] ** 2 + q[2] ** 2)
    if sine < 1e-12:
        return (0.0, 0.0, 0.0, 1.0)
    half = math.atan2(sine, q[3]) * exponent
    return tuple(x / sine * math.sin(half) for x in q[:3]) + (math.cos(half),)


class ConstantVelocity:
    """The poses from the first to the last of the start, carried on."""

    def __init__(self, start):
        first, self.last = start[0], start[-1]
        self.span_s = self.last[0] - first[0]
        self.step = [b - a for a, b in zip(first[1:4], self.last[1:4])]
        self.turn = multiply(self.last[4:8], conjugate(first[4:8]))  # in the world

    def pose(self, t_s):
        """t x y z qx qy qz qw, world from camera."""
        share = (t_s - self.last[0]) / self.span_s if self.span_s > 0 else 0.0
        position = [p + share * d for p, d in zip(self.last[1:4], self.step)]
        return [t_s, *position, *multiply(power(self.turn, share), self.last[4:8])]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--version", action="version", version=VERSION)
    parser.add_argument("--events", required=True, help="text: t x y p")
    parser.add_argument("--start", required=True, help="true poses of the start (TUM)")
    parser.add_argument("--out", required=True, help="trajectory to write (TUM)")
    options = parser.parse_args()

    motion = ConstantVelocity(list(read_rows(options.start)))
    poses, next_s = [], -math.inf
    for t_s, _x, _y, _polarity in read_rows(options.events):
        if t_s >= next_s:
            poses.append(motion.pose(t_s))
            next_s = t_s + POSE_EVERY_S
    with open(options.out, "w") as out:
        for pose in poses:
            out.write(f"{pose[0]:.9f} " + " ".join(f"{x:.9f}" for x in pose[1:]) + "\n")
    print(f"{len(poses)} poses")


if __name__ == "__main__":
    main()

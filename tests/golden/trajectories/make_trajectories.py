#!/usr/bin/env python3
"""Writes the trajectories that score_by_evo.py scores: make_trajectories.py, in this folder."""
import pathlib

import numpy as np
from scipy.spatial.transform import Rotation

HERE = pathlib.Path(__file__).parent


def true_pose(t):
    """world_from_camera on a path that bends in all directions."""
    position = np.array([0.6 * np.sin(1.3 * t), 0.4 * np.cos(2.1 * t) - 0.4, 0.3 * t + 0.1 * np.sin(4 * t)])
    return position, Rotation.from_rotvec([0.3 * np.sin(1.1 * t), 0.5 * t, 0.2 * np.cos(1.7 * t)])


def write(file, rows):
    lines = []
    for t, position, rotation in rows:
        numbers = " ".join(f"{x:.9f}" for x in [*position, *rotation.as_quat()])
        lines.append(f"{t:.6f} {numbers}\n")
    file.parent.mkdir(exist_ok=True)
    file.write_text("".join(lines))


def truth(times):
    return [(t, *true_pose(t)) for t in times]


def noisy(times, random, position_m, angle_rad, scale=1.0, turn=(0, 0, 0), shift=(0, 0, 0)):
    """Poses with noise, seen in a world that is scaled, turned and shifted."""
    world = Rotation.from_rotvec(turn)
    rows = []
    for t in times:
        position, rotation = true_pose(t)
        position = scale * world.apply(position + random.normal(0, position_m, 3)) + np.array(shift)
        rows.append((t, position, world * rotation * Rotation.from_rotvec(random.normal(0, angle_rad, 3))))
    return rows


def write_covariances(file, times, random):
    lines = []
    for t in times:
        root = random.normal(0, 0.004, (6, 6)) + np.diag([0.02] * 6)
        upper = (root @ root.T)[np.triu_indices(6)]
        lines.append(f"{t:.6f} " + " ".join(f"{x:.12e}" for x in upper) + "\n")
    file.write_text("".join(lines))


def main():
    random = np.random.default_rng(8)
    # Noise alone; every stamp of the estimate is one of the truth.
    write(HERE / "noise/truth.txt", truth(np.arange(0, 2.0001, 0.01)))
    times = np.arange(0, 2.0001, 0.02)
    write(HERE / "noise/estimate.txt", noisy(times, random, 0.004, 0.01))
    write_covariances(HERE / "noise/covariance.txt", times[::5], random)
    # 150 ms without a pose, a late start and an early end.
    write(HERE / "gap/truth.txt", truth(np.arange(5, 6.5001, 0.01)))
    times = np.arange(5.1234, 6.4, 1 / 90)
    times = times[(times < 5.7) | (times > 5.85)]
    write(HERE / "gap/estimate.txt", noisy(times, random, 0.003, 0.008, shift=(0.02, -0.01, 0.015)))
    # Other rates on both sides, an unknown scale and another world.
    write(HERE / "rates/truth.txt", truth(np.arange(0, 2.4001, 1 / 50)))
    times = np.arange(0.0031, 2.39, 1 / 83)
    write(HERE / "rates/estimate.txt",
          noisy(times, random, 0.006, 0.015, scale=0.4, turn=(0.7, -0.4, 1.2), shift=(3, -2, 1)))
    # Poses farther apart than a held pose covers, on and off the grid.
    write(HERE / "sparse/truth.txt", truth(np.arange(0, 1.5001, 0.005)))
    times = np.arange(0.0005, 1.5, 0.03)
    write(HERE / "sparse/estimate.txt", noisy(times, random, 0.01, 0.05))
    # Longer than the five seconds by which some protocols align; drifts.
    write(HERE / "long/truth.txt", truth(np.arange(2, 10.0001, 0.04)))
    rows = noisy(np.arange(2.01, 9.99, 1 / 22), random, 0.004, 0.01, turn=(0.1, 0.05, -0.2), shift=(0.5, 0, 1))
    write(HERE / "long/estimate.txt", [(t, p + 0.01 * (t - 2) ** 2 * np.array([1, -0.5, 0.2]), q) for t, p, q in rows])
    # The fewest poses whose positions say a rotation.
    write(HERE / "three/truth.txt", truth(np.arange(0, 1.0001, 0.02)))
    write(HERE / "three/estimate.txt", noisy([0.1, 0.5, 0.9], random, 0.002, 0.02, turn=(0.01, 0.02, 0)))


main()

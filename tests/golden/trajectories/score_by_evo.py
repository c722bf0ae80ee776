#!/usr/bin/env python3
"""Scores the trajectories beside this file by evo and writes expected.json: score_by_evo.py EVO_CHECKOUT.

Written against docs/metrics.md, not against the program. Alignment, errors of poses and relative errors are evo's
(github.com/MichaelGrupp/evo); interpolation is scipy's. What evo does not have is computed here: the choice of
pairs by path length, coverage, time lost, NEES, the roll of nearly straight paths,
the alignment by yaw.
"""
import json
import pathlib
import sys

import numpy as np
from scipy.linalg import logm
from scipy.spatial.transform import Rotation, Slerp

HERE = pathlib.Path(__file__).parent
sys.path.insert(0, sys.argv[1])
from evo.core.metrics import APE, RPE, PoseRelation, Unit  # noqa: E402
from evo.core.trajectory import PoseTrajectory3D  # noqa: E402

STEP_S, MAX_AGE_S, ROUNDING_S = 0.001, 0.02, 2e-9
MEAN_DEPTH_M = 1.7


class Poses:
    def __init__(self, times, positions, rotations):
        self.times, self.positions, self.rotations = times, positions, rotations

    @staticmethod
    def read(file):
        table = np.loadtxt(file, ndmin=2)
        return Poses(table[:, 0], table[:, 1:4], Rotation.from_quat(table[:, 4:8]))

    def evo(self, chosen=slice(None)):
        wxyz = np.roll(self.rotations.as_quat()[chosen], 1, axis=1)
        return PoseTrajectory3D(self.positions[chosen].copy(), wxyz, self.times[chosen].copy())

    def at(self, times):
        """Straight line and slerp between neighbours, held at the ends."""
        times = np.asarray(times)
        inside = np.clip(times, self.times[0], self.times[-1])
        if len(self.times) == 1:
            return Poses(times, np.repeat(self.positions, len(times), 0), Rotation.concatenate([self.rotations] * len(times)))
        positions = np.stack([np.interp(inside, self.times, self.positions[:, i]) for i in range(3)], 1)
        return Poses(times, positions, Slerp(self.times, self.rotations)(inside))

    def held(self, times):
        """The same, but the pose before a gap above 20 ms is held through it."""
        asked = []
        for t in times:
            before = np.searchsorted(self.times, t, side="right") - 1
            in_gap = 0 <= before < len(self.times) - 1 and \
                self.times[before + 1] - self.times[before] > MAX_AGE_S + ROUNDING_S
            asked.append(self.times[before] if in_gap else t)
        poses = self.at(asked)
        return Poses(np.asarray(times), poses.positions, poses.rotations)


def statistics(metric):
    s = metric.get_all_statistics()
    return {"mean": s["mean"], "sigma": s["std"], "max": s["max"], "rmse": s["rmse"]}


def ape(reference, estimate, relation):
    metric = APE(relation)
    metric.process_data((reference, estimate))
    return metric


def roll_by_orientations(truth, estimate, with_scale):
    """For a path that bends by less than ten times its error: degrees of what the best roll about it leaves.

    The best rotation about an axis as an eigenvector of Davenport's matrix, restricted to quaternions (cos, sin axis).
    None where the positions decide.
    """
    compared = estimate.evo()
    rotation, _, scale = compared.align(truth.evo(), correct_scale=with_scale)
    y = truth.positions - truth.positions.mean(0)
    x = estimate.positions - estimate.positions.mean(0)
    left, singular, _ = np.linalg.svd(y.T @ x / len(x))
    left_over = np.mean(np.sum((y - scale * x @ rotation.T) ** 2, axis=1))
    if scale * singular[1] > 100 * left_over:
        return None
    axis, by_positions = left[:, 0], Rotation.from_matrix(rotation)
    # Sum of the rotations that are still missing, each as the outer product of its quaternion.
    missing = (truth.rotations * (by_positions * estimate.rotations).inv()).as_quat()
    davenport = missing.T @ missing
    basis = np.array([[*axis, 0.0], [0.0, 0.0, 0.0, 1.0]])
    _, vectors = np.linalg.eigh(basis @ davenport @ basis.T)
    roll = Rotation.from_quat(vectors[:, -1] @ basis)
    errors = (truth.rotations * (roll * by_positions * estimate.rotations).inv()).magnitude()
    return rmse(np.rad2deg(errors))


def yaw_scores(truth, estimate):
    """After a translation and a rotation about z, the plane as complex numbers; evo has no such alignment.

    The orientations choose the rotation of the orientations where the horizontal path is not ten times its error.
    """
    x, y = estimate.positions - estimate.positions.mean(0), truth.positions - truth.positions.mean(0)
    product = np.mean((y[:, 0] + 1j * y[:, 1]) * np.conj(x[:, 0] + 1j * x[:, 1]))
    by_positions = Rotation.from_euler("z", np.angle(product))
    errors = y - by_positions.apply(x)
    left_over = np.mean(np.sum(errors**2, axis=1))
    chosen = by_positions
    if abs(product) <= 100 * left_over:
        missing = (truth.rotations * estimate.rotations.inv()).as_matrix().mean(0)
        chosen = Rotation.from_euler("z", np.arctan2(missing[1, 0] - missing[0, 1], missing[0, 0] + missing[1, 1]))
    rotations = (truth.rotations.inv() * (chosen * estimate.rotations)).magnitude()
    return {"yaw.ate_rmse_m": float(np.sqrt(left_over)), "yaw.rot_rmse_deg": rmse(np.rad2deg(rotations)), "yaw.scale": 1.0}


def aligned_scores(pairs_truth, pairs_estimate):
    scores = yaw_scores(pairs_truth, pairs_estimate)
    for name, options in {"none": None, "se3": {"correct_scale": False}, "sim3": {"correct_scale": True}}.items():
        reference, estimate, scale = pairs_truth.evo(), pairs_estimate.evo(), 1.0
        if options:
            scale = float(estimate.align(reference, **options)[2])
        scores[f"{name}.ate_rmse_m"] = statistics(ape(reference, estimate, PoseRelation.translation_part))["rmse"]
        scores[f"{name}.rot_rmse_deg"] = statistics(ape(reference, estimate, PoseRelation.rotation_angle_deg))["rmse"]
        scores[f"{name}.scale"] = scale
        by_orientations = roll_by_orientations(pairs_truth, pairs_estimate, name == "sim3") if options else None
        if by_orientations is not None:
            scores[f"{name}.rot_rmse_deg"] = by_orientations
    return scores


def relative_errors(reference, estimate, pairs):
    """evo's E_ij for chosen pairs: metres and degrees."""
    trans, rot = [], []
    for i, j in pairs:
        e = RPE.rpe_base(reference.poses_se3[i], reference.poses_se3[j], estimate.poses_se3[i], estimate.poses_se3[j])
        trans.append(np.linalg.norm(e[:3, 3]))
        rot.append(np.rad2deg(np.linalg.norm(Rotation.from_matrix(e[:3, :3]).as_rotvec())))
    return np.array(trans), np.array(rot)


def rmse(values):
    return float(np.sqrt(np.mean(np.square(values))))


def relative_scores(truth, estimate):
    reference, compared = truth.evo(), estimate.evo()
    path = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(truth.positions, axis=0), axis=1))])
    scores = {}
    for percent in range(10, 60, 10):
        # All pairs, brute force: j is the first with a path of at least the share (to 1e-9) from i.
        reached = path[-1] * percent / 100 * (1 - 1e-9)
        far = path[None, :] - path[:, None] >= reached
        pairs = [(i, int(np.argmax(row))) for i, row in enumerate(far) if row.any()]
        trans, rot = relative_errors(reference, compared, pairs)
        length = np.array([path[j] - path[i] for i, j in pairs])
        key = f"rpe.length_{percent}_percent."
        scores |= {key + "pairs": len(pairs), key + "trans_rmse_m": rmse(trans), key + "rot_rmse_deg": rmse(rot),
                   key + "trans_percent": float(np.mean(100 * trans / length)),
                   key + "rot_deg_per_m": float(np.mean(rot / length))}
    second = round(1 / STEP_S)
    pairs = max(0, len(path) - second)
    scores["rpe.per_second.pairs"] = pairs
    for key, relation in {"trans_rmse_m": PoseRelation.translation_part,
                          "rot_rmse_deg": PoseRelation.rotation_angle_deg}.items():
        scores[f"rpe.per_second.{key}"] = None
        if pairs > 0:
            metric = RPE(relation, delta=second, delta_unit=Unit.frames, all_pairs=True)
            metric.process_data((reference, compared))
            scores[f"rpe.per_second.{key}"] = statistics(metric)["rmse"]
    trans, _ = relative_errors(reference, compared, [(0, len(path) - 1)])
    scores["drift_percent"] = float(100 * trans[0] / path[-1])
    scores["path_length_m"] = float(reference.path_length)
    return scores


def error_after_begin(truth, estimate, start, end, path_m):
    """Mean position error over the path, aligned by evo with the poses of the first five seconds."""
    if end - start <= 5:
        return None
    count = int(np.sum(estimate.times <= start + 5))
    reference, compared = truth.evo(), estimate.evo()
    compared.align(reference, correct_scale=False, n=count)
    return float(100 * np.mean(ape(reference, compared, PoseRelation.translation_part).error) / path_m)


def coverage(times, start, end):
    """Share of [start, end] within 20 ms after a pose, from a list of merged intervals."""
    merged = []
    for t in times:
        low, high = max(t, start), min(t + MAX_AGE_S, end)
        if high < low:
            continue
        if merged and low <= merged[-1][1]:
            merged[-1][1] = max(merged[-1][1], high)
        else:
            merged.append([low, high])
    return sum(high - low for low, high in merged) / (end - start)


def nees(truth, estimate, file):
    values = []
    for row in np.loadtxt(file, ndmin=2):
        covariance = np.zeros((6, 6))
        covariance[np.triu_indices(6)] = row[1:]
        covariance = covariance + np.triu(covariance, 1).T
        t, e = truth.at([row[0]]).evo().poses_se3[0], estimate.at([row[0]]).evo().poses_se3[0]
        log = np.real(logm(np.linalg.inv(t) @ e))
        twist = np.array([*log[:3, 3], log[2, 1], log[0, 2], log[1, 0]])
        values.append(twist @ np.linalg.inv(covariance) @ twist)
    return float(np.mean(values))


def score(folder):
    truth, estimate = Poses.read(folder / "truth.txt"), Poses.read(folder / "estimate.txt")
    start, end = truth.times[0], truth.times[-1]
    steps = int(np.floor((end - start + ROUNDING_S) / STEP_S))
    grid = np.minimum(start + np.arange(steps + 1) * STEP_S, end)
    true_grid, held_grid = truth.at(grid), estimate.held(grid)
    translation = ape(true_grid.evo(), held_grid.evo(), PoseRelation.translation_part)
    rotation = ape(true_grid.evo(), held_grid.evo(), PoseRelation.rotation_angle_deg)
    scores = {f"dt_m.{k}": v for k, v in statistics(translation).items()}
    scores |= {f"dt_rel_percent.{k}": 100 * v / MEAN_DEPTH_M for k, v in statistics(translation).items()}
    scores |= {f"dtheta_deg.{k}": v for k, v in statistics(rotation).items()}
    inside = (estimate.times >= start) & (estimate.times <= end)
    pairs = Poses(estimate.times[inside], estimate.positions[inside], estimate.rotations[inside])
    scores |= aligned_scores(truth.at(pairs.times), pairs)
    scores |= relative_scores(true_grid, held_grid)
    scores["se3_5s.mean_percent"] = error_after_begin(truth.at(pairs.times), pairs, start, end, scores["path_length_m"])
    lost = (100 * translation.error / MEAN_DEPTH_M > 5) | (rotation.error > 5)
    scores |= {"lost_s": float((end - start) * np.mean(lost)), "reported_lost_s": None,
               "coverage": coverage(estimate.times, start, end), "duration_s": float(end - start),
               "poses": len(estimate.times), "mean_depth_m": MEAN_DEPTH_M, "aligned_freedoms": None}
    covariance = folder / "covariance.txt"
    scores["nees"] = nees(truth, estimate, covariance) if covariance.exists() else None
    return {k: scores[k] if scores[k] is None or isinstance(scores[k], int) else float(scores[k]) for k in sorted(scores)}


for truth_file in sorted(HERE.glob("*/truth.txt")):
    folder = truth_file.parent
    (folder / "expected.json").write_text(json.dumps(score(folder), indent=1) + "\n")
    print(folder.name)

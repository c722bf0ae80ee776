#!/usr/bin/python3
"""Fits the logistic regression of estimator/tracking/check/pose_probability.cpp.

    tests/calibration/fit_probability.py RUN... [--test RUN...]

RUN are run folders of track and odometry over simulated datasets, good runs and lost ones (README.md beside this
file says how they are made). Each row of poses.csv at which the evidence was taken is one observation: its features
are those of pose_probability.cpp, and it is good where the pose is within 5 % of the mean scene depth and 5 degrees
of the truth; good ones of recordings named *-noise and *-other are left out. Newton's method with a small ridge; every run counts alike, but for the observations that are left out. Prints the constants, and for the runs
behind --test, or else those it was fitted to, the log loss and how many of the observations are judged rightly.
"""
import csv
import sys
from pathlib import Path

import numpy as np

LIMIT_DEPTH, LIMIT_DEG = 0.05, 5.0
LEAST_EXPLAINED, MOST_EXPLAINED, MOST_SEEN, LEAST_LOG_SIGMA, MOST_LOG_SIGMA = 0.03, 0.4, 0.1, 0.0, 1.0
# A pose that is still right although its recording shows nothing of the map is right by accident.
ACCIDENTS = "-noise", "-other"
RIDGE = 1e-3
NAMES = ["kConstant", "kExplainedWeight", "kSeenWeight", "kSigmaWeight", "kInMapWeight", "kTrackerLostWeight"]


def read_yaml_number(file, key):
    for line in file.read_text().splitlines():
        if line.strip().startswith(key + ":"):
            return float(line.split(":")[1])
    raise SystemExit(f"{file} states no {key}")


def dataset_of(run):
    lines = (run / "run.yaml").read_text().splitlines()
    inside = lines[lines.index("dataset:") + 1:]
    return Path(next(line for line in inside if line.strip().startswith("path:")).split(":", 1)[1].strip().strip('"'))


def interpolate(table, t):
    i = np.clip(np.searchsorted(table[:, 0], t), 1, len(table) - 1)
    w = np.clip((t - table[i - 1, 0]) / (table[i, 0] - table[i - 1, 0]), 0, 1)[:, None]
    q0, q1 = table[i - 1, 4:], table[i, 4:]
    q1 = np.where((q0 * q1).sum(1, keepdims=True) < 0, -q1, q1)
    q = q0 * (1 - w) + q1 * w
    return table[i - 1, 1:4] * (1 - w) + table[i, 1:4] * w, q / np.linalg.norm(q, axis=1, keepdims=True)


def above_chance(fraction, chance):
    return (fraction - chance) / np.maximum(1 - chance, 1e-3)


def features(rows):
    column = lambda name: np.array([float(row[name] or "nan") for row in rows])
    depth = column("depth_m")
    with np.errstate(divide="ignore", invalid="ignore"):
        sigma = column("rotation_sigma_deg") / LIMIT_DEG
        sigma = np.where(depth > 0, np.maximum(sigma, column("position_sigma_m") / (LIMIT_DEPTH * depth)), sigma)
        log_sigma = np.where(np.isfinite(sigma) & (sigma > 0), np.log(sigma), LEAST_LOG_SIGMA)
    return np.column_stack([
        np.ones(len(rows)),
        np.log(np.clip(above_chance(column("explained"), column("chance")), LEAST_EXPLAINED, MOST_EXPLAINED)),
        np.clip(above_chance(column("edges_confirmed"), column("confirmed_if_wrong")), -MOST_SEEN, MOST_SEEN),
        np.clip(log_sigma, LEAST_LOG_SIGMA, MOST_LOG_SIGMA),
        column("in_map"),
        column("tracker_lost"),
    ])


def observations(run):
    """Features and labels of the rows with evidence of their own, and the weight of each."""
    rows = list(csv.DictReader((run / "poses.csv").open()))
    evidence = ["explained", "chance", "edges_confirmed", "confirmed_if_wrong", "depth_m"]
    rows = [row for i, row in enumerate(rows) if i == 0 or any(row[k] != rows[i - 1][k] for k in evidence)]
    estimate = np.loadtxt(run / "trajectory.txt", ndmin=2)
    dataset = dataset_of(run)
    t = np.array([float(row["t_s"]) for row in rows])
    position, rotation = interpolate(estimate, t)
    true_position, true_rotation = interpolate(np.loadtxt(dataset / "groundtruth.txt"), t)
    depth = read_yaml_number(dataset / "dataset.yaml", "mean_scene_depth_m")
    error = np.linalg.norm(position - true_position, axis=1) / depth
    angle = 2 * np.degrees(np.arccos(np.clip(np.abs((rotation * true_rotation).sum(1)), 0, 1)))
    x, y = features(rows), (error <= LIMIT_DEPTH) & (angle <= LIMIT_DEG)
    kept = ~y if dataset.name.endswith(ACCIDENTS) else np.full(len(y), True)
    return x[kept], y[kept], 1 / len(y)


def gather(runs):
    x, y, w = [], [], []
    for run in runs:
        xi, yi, weight = observations(run)
        x.append(xi), y.append(yi), w.append(np.full(len(yi), weight))
    weights = np.concatenate(w)
    return np.concatenate(x), np.concatenate(y).astype(float), weights / weights.mean()


def fit(x, y, w):
    beta = np.zeros(x.shape[1])
    for _ in range(50):
        p = 1 / (1 + np.exp(-x @ beta))
        gradient = x.T @ (w * (y - p)) - RIDGE * len(y) * np.r_[0, beta[1:] * 1e-3]
        hessian = (x * (w * p * (1 - p))[:, None]).T @ x + RIDGE * len(y) * np.diag(np.r_[0, np.full(len(beta) - 1, 1e-3)])
        step = np.linalg.solve(hessian, gradient)
        beta += step
        if np.abs(step).max() < 1e-8:
            break
    return beta


def report(name, beta, x, y):
    p = np.clip(1 / (1 + np.exp(-x @ beta)), 1e-9, 1 - 1e-9)
    loss = -np.mean(y * np.log(p) + (1 - y) * np.log(1 - p))
    bad, told = y == 0, p < 0.5
    print(f"// {name}: {len(y)} observations, {int(bad.sum())} lost, log loss {loss:.3f}, "
          f"recall {np.sum(bad & told) / max(bad.sum(), 1):.3f}, precision {np.sum(bad & told) / max(told.sum(), 1):.3f}")


def main(arguments):
    split = arguments.index("--test") if "--test" in arguments else len(arguments)
    x, y, w = gather([Path(a) for a in arguments[:split]])
    beta = fit(x, y, w)
    for name, value in zip(NAMES, beta):
        print(f"constexpr double {name} = {value:.3g};")
    report("fitted to", beta, x, y)
    if arguments[split + 1:]:
        x, y, _ = gather([Path(a) for a in arguments[split + 1:]])
        report("tested on", beta, x, y)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        raise SystemExit(__doc__)
    main(sys.argv[1:])

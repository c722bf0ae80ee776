#!/usr/bin/env python3
"""Scores what make_views.py wrote and writes expected.json: score_views.py, in this folder.

Written against docs/metrics.md, not against the program. Fits and correlations are scipy.stats's, gradients
numpy's, interpolation and neighbourhoods scipy.ndimage's. Where a window lies wholly in the image, the
structural similarity is held against scikit-image's.
"""
import json
import pathlib

import numpy as np
from scipy import ndimage, signal, stats
from scipy.spatial.transform import Rotation, Slerp
from skimage.metrics import structural_similarity

HERE = pathlib.Path(__file__).parent
RADIUS, SIGMA = 5, 1.5


def similarity(truth, fitted, observed):
    """Mean over the observed pixels; every window's weights are those of its observed pixels."""
    side = np.exp(-np.arange(-RADIUS, RADIUS + 1) ** 2 / (2 * SIGMA**2))
    window = np.outer(side, side)

    def local(values):
        total = signal.convolve2d(np.where(observed, values, 0), window, mode="same")
        return total / signal.convolve2d(observed.astype(float), window, mode="same")

    extent = np.ptp(truth[observed])
    c1, c2 = (0.01 * extent) ** 2, (0.03 * extent) ** 2
    mean_a, mean_b = local(truth), local(fitted)
    var_a, var_b = local(truth**2) - mean_a**2, local(fitted**2) - mean_b**2
    covariance = local(truth * fitted) - mean_a * mean_b
    each = (2 * mean_a * mean_b + c1) * (2 * covariance + c2) / \
        ((mean_a**2 + mean_b**2 + c1) * (var_a + var_b + c2))
    if observed.all():
        _, theirs = structural_similarity(truth, fitted, data_range=extent, gaussian_weights=True, sigma=SIGMA,
                                          use_sample_covariance=False, full=True)
        whole = np.s_[RADIUS:-RADIUS, RADIUS:-RADIUS]
        np.testing.assert_allclose(each[whole], theirs[whole], rtol=1e-10)
    return each[observed].mean()


def slope_size(image):
    across = np.gradient(image)
    return np.hypot(across[0], across[1])


def correlation(a, b):
    return 0.0 if np.ptp(a) == 0 or np.ptp(b) == 0 else stats.pearsonr(a, b)[0]


def image_scores(folder):
    truth = np.loadtxt(folder.parent / "truth.txt", dtype=np.float32)
    estimate = np.loadtxt(folder / "estimate.txt", dtype=np.float32)
    observed = np.loadtxt(folder / "observed.txt") > 0
    x, y = estimate[observed].astype(float), truth[observed].astype(float)
    scale, offset = (0.0, y.mean()) if np.ptp(x) == 0 else stats.linregress(x, y)[:2]
    mse = np.mean((scale * x + offset - y) ** 2)
    fitted = (scale * estimate.astype(float) + offset).astype(np.float32)
    cross = ndimage.generate_binary_structure(2, 1)
    inner = ndimage.binary_erosion(observed, cross, border_value=1)
    gradients = [slope_size(image)[inner].astype(float) for image in (estimate, truth)]
    return {"ssim": similarity(truth.astype(float), fitted.astype(float), observed), "pearson": correlation(x, y),
            "mse": mse, "rmse_log": np.sqrt(mse), "gradient_pearson": correlation(*gradients),
            "observed": observed.mean(), "fit.scale": scale, "fit.offset": offset}


def relative_errors(points, depth):
    """Of the points whose truth is known: estimate, truth, deviation; by the best of 3 x 3, and at the place."""
    best, strict = [], []
    known = np.pad(np.where(depth > 0, depth, np.nan), 1, constant_values=np.nan)
    for x, y, z, sigma in points:
        column, row = int(np.floor(x + 0.5)), int(np.floor(y + 0.5))
        around = known[row:row + 3, column:column + 3].ravel()
        if np.isfinite(around).any():
            best.append((z, around[np.nanargmin(np.abs(z - around) / around)], sigma))
        left, top = min(int(x), depth.shape[1] - 2), min(int(y), depth.shape[0] - 2)
        cell = depth[top:top + 2, left:left + 2]
        truth = depth[row, column]
        if cell.min() > 0 and cell.max() <= 1.1 * cell.min():
            truth = 1 / ndimage.map_coordinates(1 / cell, [[y - top], [x - left]], order=1)[0]
        if truth > 0:
            strict.append((z, truth, sigma))
    return np.array(best), np.array(strict)


def error_scores(prefix, errors):
    z, truth, sigma = errors.T
    relative, has_sigma = np.abs(z - truth) / truth, sigma > 0
    within = [np.mean(np.abs(z - truth)[has_sigma] <= k * sigma[has_sigma]) for k in (1, 2)]
    scores = {"rel_mean": relative.mean(), "rel_median": np.median(relative),
              "rmse_m": np.sqrt(np.mean((z - truth) ** 2)), "delta_1_25": np.mean(np.maximum(z / truth, truth / z) < 1.25),
              "outlier_5_percent": np.mean(relative > 0.05), "within_1_sigma": within[0], "within_2_sigma": within[1]}
    return {prefix + key: value for key, value in scores.items()}


def depth_view(folder):
    depth = np.loadtxt(folder / "depth.txt", dtype=np.float32).astype(float)
    edges = np.loadtxt(folder / "edges.txt") > 0
    x, y, *_ = points = np.loadtxt(folder / "points.txt").T
    inside = (x >= 0) & (x <= depth.shape[1] - 1) & (y >= 0) & (y <= depth.shape[0] - 1)
    points = points.T[inside]
    marked = np.zeros_like(edges)
    marked[np.floor(points[:, 1] + 0.5).astype(int), np.floor(points[:, 0] + 0.5).astype(int)] = True
    found = edges & ndimage.binary_dilation(marked, np.ones((3, 3)))
    return *relative_errors(points, depth), len(points), int(edges.sum()), int(found.sum())


def depth_scores(folder):
    views = [depth_view(view) for view in sorted(folder.iterdir())]
    best, strict = (np.concatenate([view[i] for view in views]) for i in (0, 1))
    points, edges, found = (sum(view[i] for view in views) for i in (2, 3, 4))
    scores = error_scores("", best) | error_scores("strict.", strict)
    scores |= {"points": points, "completeness": found / edges, "views.count": len(views)}
    each = [error_scores("", view[0]) | {"points": view[2], "completeness": view[4] / view[3]} for view in views]
    for key, worst in {"rel_mean": max, "rel_median": max, "outlier_5_percent": max, "completeness": min,
                       "points": min}.items():
        values = [view[key] for view in each]
        scores |= {f"views.{key}.median": np.median(values), f"views.{key}.worst": worst(values)}
    return scores


def reprojection_scores(folder):
    """Of tests/golden/trajectories/noise, every pose of which is a truth's; camera 240 x 180, 200 px, centred."""
    table = {name: np.loadtxt(HERE.parent / f"trajectories/noise/{name}.txt") for name in ("truth", "estimate")}
    start, end = table["truth"][[0, -1], 0]
    grid = np.minimum(start + 0.001 * np.arange(np.floor((end - start) / 0.001 + 1e-6) + 1), end)
    grid = grid[::-(-len(grid) // 2000)]
    seen = {}
    world = np.loadtxt(folder / "map.txt", dtype=np.float32).astype(float)
    for name, rows in table.items():
        turns = Slerp(rows[:, 0], Rotation.from_quat(rows[:, 4:]))(grid)
        places = np.stack([np.interp(grid, rows[:, 0], rows[:, i]) for i in (1, 2, 3)], 1)
        seen[name] = np.stack([turn.inv().apply(world - place) for turn, place in zip(turns, places)])
    pixels = {name: 200 * p[..., :2] / p[..., 2:] + [119.5, 89.5] for name, p in seen.items()}
    at = pixels["truth"]
    visible = (seen["truth"][..., 2] > 0) & (at >= 0).all(2) & (at <= [239, 179]).all(2)
    error = np.minimum(np.linalg.norm(pixels["estimate"] - at, axis=2), np.hypot(240, 180))
    error[seen["estimate"][..., 2] <= 0] = np.hypot(240, 180)
    squares = np.where(visible, error**2, 0)
    per_instant = np.sqrt(squares.sum(1)[visible.any(1)] / visible.sum(1)[visible.any(1)])
    return {"rms": np.sqrt(squares.sum() / visible.sum()), "max": np.sqrt(squares.max()), "rms_max": per_instant.max()}


def plain(scores):
    return {key: value if isinstance(value, int) else float(value) for key, value in sorted(scores.items())}


def main():
    images = {folder.name: plain(image_scores(folder)) for folder in sorted(HERE.glob("images/*/"))}
    truth = np.loadtxt(HERE / "images/truth.txt", dtype=np.float32).astype(float)
    expected = {"images": images, "sharpness": float(np.var(truth)), "depth": plain(depth_scores(HERE / "depth")),
                "reprojection_px": plain(reprojection_scores(HERE / "reprojection"))}
    (HERE / "expected.json").write_text(json.dumps(expected, indent=1) + "\n")


main()

#!/usr/bin/env python3
"""Writes the images, depths and points that score_views.py scores: make_views.py, in this folder."""
import pathlib

import numpy as np
from scipy.ndimage import gaussian_filter

HERE = pathlib.Path(__file__).parent
WIDTH, HEIGHT = 34, 26
ROWS, COLUMNS = np.mgrid[0:HEIGHT, 0:WIDTH]


def write(file, table, form="%.3f"):
    path = HERE / file
    path.parent.mkdir(parents=True, exist_ok=True)
    np.savetxt(path, table, form)


def write_images(random):
    truth = np.sin(0.4 * COLUMNS) + (COLUMNS // 5 + ROWS // 4) % 2 - 2
    write("images/truth.txt", truth)
    noise = gaussian_filter(random.normal(0, 1, truth.shape), 1)
    holes = random.uniform(size=truth.shape) > 0.2
    holes[5:14, 20:30] = False
    everywhere = np.ones_like(holes)
    for name, estimate, observed in [("full", 0.7 * truth + 0.4 * noise + 0.3, everywhere),
                                     ("holes", 1.6 * truth + 0.9 * noise, holes),
                                     ("negative", -truth + 0.2 * noise, holes),
                                     ("constant", np.full(truth.shape, 0.1), everywhere)]:
        write(f"images/{name}/estimate.txt", estimate)
        write(f"images/{name}/observed.txt", observed, "%d")


def write_depth_view(name, depth, random, points):
    """Points about the truth, some far off, some out of the image, half of them with a deviation."""
    depth[3:6, 2:7] = 0
    edges = (random.uniform(size=depth.shape) < 0.1) & (depth > 0)
    x, y = random.uniform(-2, WIDTH + 1, points), random.uniform(-2, HEIGHT + 1, points)
    there = depth[np.clip(np.rint(y), 0, HEIGHT - 1).astype(int), np.clip(np.rint(x), 0, WIDTH - 1).astype(int)]
    guess = np.where(there > 0, there, 2) * np.exp(random.normal(0, 0.04, points))
    guess[::9] *= 1.4
    sigma = np.where(np.arange(points) % 2 == 0, random.uniform(0.02, 0.2, points), 0)
    write(f"depth/{name}/depth.txt", depth)
    write(f"depth/{name}/edges.txt", edges, "%d")
    write(f"depth/{name}/points.txt", np.stack([x, y, guess, sigma], 1), "%.5f")


def write_depths(random):
    slope = 1 / (0.5 - 0.006 * COLUMNS + 0.004 * ROWS)
    write_depth_view("slope", slope, random, 120)
    write_depth_view("step", np.where(COLUMNS < 17, 1.8 + 0.01 * ROWS, 3.1), random, 81)


def main():
    random = np.random.default_rng(11)
    write_images(random)
    write_depths(random)
    write("reprojection/map.txt", random.uniform([-2, -1.5, -1], [2, 1.5, 5], (60, 3)))


main()

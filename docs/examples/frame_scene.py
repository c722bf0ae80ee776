#!/usr/bin/env python3
"""Hangs one frame of a recording before its own camera: a scene as like the recording as one picture can make it.

    frame_scene.py RECORDING FRAME DEPTH_M OUT

RECORDING: a folder in the layout of the Event Camera Dataset; FRAME: index of a grey frame, linear in the light; DEPTH_M: of
the plane. OUT gets scene.obj with its texture, groundtruth.txt, and simulation.yaml, which repeats the first 0.15 s of the
recorded motion with the recording's calibration, the distortion left out. The frame's noise, which a moving camera would see
as texture, is smoothed away first. Needs Pillow, NumPy and SciPy.
"""
import pathlib
import sys

import numpy
from PIL import Image
from scipy.spatial.transform import Rotation

DURATION_S = 0.15
BORDER_PX = 40  # mirrored, so that nothing else comes into view


def srgb(linear):
    """Code of a linear value, both 0..1: the simulator decodes 8-bit textures by its inverse."""
    return numpy.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def smooth(picture, radius=3):
    """Bilateral filter: means over neighbours that differ by no more than noise does (3 sigma)."""
    noise = 1.4826 * numpy.median(abs(numpy.diff(picture, axis=1))) / 2**0.5
    padded = numpy.pad(picture, radius, mode="reflect")
    total, weights = 0.0, 0.0
    for j in range(2 * radius + 1):
        for i in range(2 * radius + 1):
            other = padded[j : j + picture.shape[0], i : i + picture.shape[1]]
            weight = numpy.exp(-(((other - picture) / (3 * noise)) ** 2) / 2)
            total, weights = total + weight * other, weights + weight
    return total / weights


def write_plane(out, picture, calibration, depth_m, pose):
    fx, fy, cx, cy = calibration
    height, width = picture.shape
    padded = numpy.pad(picture / 255.0, BORDER_PX, mode="reflect")
    Image.fromarray(numpy.round(255 * srgb(padded)).astype(numpy.uint8)).save(out / "frame.png")
    left, right = (-BORDER_PX - 0.5 - cx) * depth_m / fx, (width + BORDER_PX - 0.5 - cx) * depth_m / fx
    top, bottom = (-BORDER_PX - 0.5 - cy) * depth_m / fy, (height + BORDER_PX - 0.5 - cy) * depth_m / fy
    corners = [(left, top, 0, 1), (right, top, 1, 1), (right, bottom, 1, 0), (left, bottom, 0, 0)]
    places = Rotation.from_quat(pose[4:]).apply([[x, y, depth_m] for x, y, _, _ in corners]) + pose[1:4]
    (out / "scene.mtl").write_text("newmtl frame\nmap_Kd frame.png\n")
    (out / "scene.obj").write_text(
        "mtllib scene.mtl\nusemtl frame\n"
        + "".join(f"v {x} {y} {z}\nvt {u} {v}\n" for (x, y, z), (_, _, u, v) in zip(places, corners))
        + "f 1/1 2/2 3/3 4/4\n"
    )


def main(recording, frame, depth_m, out):
    out.mkdir(parents=True, exist_ok=True)
    stamp, name = (recording / "images.txt").read_text().splitlines()[frame].split()
    picture = smooth(numpy.asarray(Image.open(recording / name).convert("L"), dtype=float))
    calibration = [float(word) for word in (recording / "calib.txt").read_text().split()[:4]]
    poses = numpy.loadtxt(recording / "groundtruth.txt")
    pose = poses[numpy.argmin(abs(poses[:, 0] - float(stamp)))]
    write_plane(out, picture, calibration, depth_m, pose)
    numpy.savetxt(out / "groundtruth.txt", poses[poses[:, 0] < poses[0, 0] + 2 * DURATION_S], fmt="%.9f")
    fx, fy, cx, cy = calibration
    (out / "simulation.yaml").write_text(
        "scene: {meshes: [{file: scene.obj}]}\n"
        "trajectory: {source: file, file: groundtruth.txt, fit: smooth, knot_spacing_s: 0.04}\n"
        f"duration_s: {DURATION_S}\n"
        f"camera: {{width: {picture.shape[1]}, height: {picture.shape[0]}, fx: {fx}, fy: {fy}, cx: {cx}, cy: {cy}}}\n"
        # The light that a pixel takes its dark current for, beside a white of 0.5.
        "events: {log_eps: 0.04}\n"
    )


if __name__ == "__main__":
    if len(sys.argv) != 5:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]), int(sys.argv[2]), float(sys.argv[3]), pathlib.Path(sys.argv[4]))

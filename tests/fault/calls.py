"""Small calls of every verb and module, for the campaigns beside this file (`kills`, `races`)."""

import shutil
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
CAMERA = "camera={width: 64, height: 48, fx: 54, fy: 54, cx: 31.5, cy: 23.5}"
START = ["--set", "start.truth_s=0.1", "--set", "start.truth_fraction=1"]


def config(name):
    return ROOT / "configs" / f"{name}.yaml"


def simulation(scene, out, duration_s, *settings):
    words = ["simulate", config(f"simulation/{scene}"), "-o", out, "--set", f"duration_s={duration_s}", "--set", CAMERA, "-q"]
    for setting in settings:
        words += ["--set", setting]
    return words


def run(module, data, settings, out, *more):
    return ["run", module, "--data", data, "-c", config(settings), "-o", out, "-q", *more]


# Name -> (what is written, words of the call by the folder of the inputs and the output).
CALLS = {
    "simulate": ("d", lambda i, o: simulation("walls", o, 0.1)),
    "simulate_noisy": ("d", lambda i, o: simulation("planes", o, 0.1, "events.preset=davis240c")),
    "simulate_lit": ("d", lambda i, o: simulation("office", o, 0.02)),
    "simulate_adaptive": ("d", lambda i, o: simulation("desk", o, 0.05, "events.sampling=adaptive")),
    "simulate_rig": ("d", lambda i, o: simulation("stereo_planes", o, 0.05)),
    "track": ("r", lambda i, o: run("track", i / "walls", "tracking/accurate", o)),
    "track_best": ("r", lambda i, o: run("track", i / "walls", "tracking/best", o)),
    "depth": ("r", lambda i, o: run("depth", i / "walls", "depth/best", o)),
    "reconstruct": ("r", lambda i, o: run("reconstruct", i / "walls", "reconstruction/fast", o)),
    "odometry": ("r", lambda i, o: run("odometry", i / "walls", "odometry/fast", o, *START)),
    "refine": ("r", lambda i, o: run("refine", i / "walls", "refinement/depth", o, "--from", i / "depth")),
    "stabilize": ("r", lambda i, o: run("stabilize", i / "shake", "stabilization/best", o)),
    "mosaic": ("r", lambda i, o: run("mosaic", i / "shake", "mosaic/best", o)),
    "rotation": ("r", lambda i, o: run("rotation", i / "shake", "rotation/both", o)),
    "sweep": ("s", lambda i, o: ["sweep", i / "sweep.yaml", "-o", o, "--jobs", "1", "-q"]),
    "convert": ("e.h5", lambda i, o: ["convert", i / "walls/events.h5", o, "-q"]),
    "convert_text": ("e.txt", lambda i, o: ["convert", i / "walls/events.h5", o, "-q"]),
    "convert_bag": ("e.bag", lambda i, o: ["convert", i / "walls", o, "-q"]),
    "convert_mcap": ("e.mcap", lambda i, o: ["convert", i / "walls", o, "-q"]),
    "calibrate": ("c.yaml", lambda i, o: ["calibrate", i / "noisy", "-o", o, "--page", i / "c.html", "--events-only", "-q"]),
    "render": ("p.png", lambda i, o: ["render", i / "walls", "-o", o, "-q"]),
    "report": ("r.html", lambda i, o: ["report", i / "track", "-o", o, "-q"]),
    "publish": ("site", lambda i, o: ["report", i / "track", "--publish", o, "-q"]),
    "view_export": ("v.html", lambda i, o: ["view", i / "walls", "--export", o, "-q"]),
}

# What needs a cluster (tests/slurm/single_node): the jobs outlive a call that is killed, and the next call takes what they did.
SLURM_CALLS = {
    "sweep_slurm": ("s", lambda i, o: ["sweep", i / "sweep.yaml", "-o", o, "--launcher", "slurm", "-q"]),
}


def make_inputs(saccade, folder):
    """What the calls read; where it is whole already it stays."""
    if (folder / "done").exists():
        return
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for words in [simulation("walls", folder / "walls", 0.3), simulation("shake", folder / "shake", 0.3),
                  simulation("walls", folder / "noisy", 0.2, "events.preset=davis240c"),
                  run("track", folder / "walls", "tracking/accurate", folder / "track"), ["eval", folder / "track", "-q"],
                  run("depth", folder / "walls", "depth/best", folder / "depth")]:
        subprocess.run([str(word) for word in [saccade, *words]], check=True)
    (folder / "sweep.yaml").write_text(
        f"datasets:\n  - {{path: {folder}/walls}}\n"
        f"configurations:\n  - {{file: {config('tracking/accurate')}}}\n  - {{file: {config('tracking/fast')}}}\nseeds: [1, 2]\n")
    (folder / "done").touch()

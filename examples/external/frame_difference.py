#!/usr/bin/env python3
"""Makes events from the grey frames of a dataset: the worked example of an external simulator for saccade.

Between two frames the log intensity of every pixel is a straight line, and an event is where this line crosses the next
threshold. What moves by more than a pixel from one frame to the next is not seen on its way: frames at a higher rate give
better events. Needs Python 3.8 and numpy.
"""
import argparse
import pathlib
import struct
import zlib

import numpy

VERSION = "frame difference 1.0"


def read_exr(file):
    """The one channel of a scanline OpenEXR file of 32-bit numbers, not compressed or by ZIP, as height x width."""
    data = file.read_bytes()
    attributes, at = {}, 8
    while data[at] != 0:
        name, kind = data[at:].split(b"\0", 2)[:2]
        at += len(name) + len(kind) + 2
        size, = struct.unpack_from("<i", data, at)
        attributes[name.decode()] = data[at + 4:at + 4 + size]
        at += 4 + size
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
    compression = attributes["compression"][0]
    if compression not in (0, 2, 3):
        raise SystemExit(f"{file}: compression {compression} of OpenEXR is not read here, only none and ZIP")
    width, height = right - left + 1, bottom - top + 1
    lines = 16 if compression == 3 else 1
    offsets = struct.unpack_from(f"<{-(-height // lines)}Q", data, at + 1)
    rows = []
    for k, offset in enumerate(offsets):
        size, = struct.unpack_from("<i", data, offset + 4)
        block, whole = data[offset + 8:offset + 8 + size], 4 * width * min(lines, height - k * lines)
        if size < whole:  # differences of bytes, the even ones before the odd ones
            steps = numpy.frombuffer(zlib.decompress(block), numpy.uint8).astype(numpy.int64)
            steps[1:] -= 128
            halves = numpy.cumsum(steps).astype(numpy.uint8)
            block = numpy.empty(whole, numpy.uint8)
            block[0::2], block[1::2] = numpy.split(halves, [(whole + 1) // 2])
        rows.append(numpy.frombuffer(block, "<f4").reshape(-1, width))
    return numpy.concatenate(rows)


def crossings(reference, before, after, contrast, start_s, duration_s):
    """Events (t, x, y, p) of the lines from `before` to `after`; moves `reference` by the thresholds they cross."""
    events = []
    for sign in (1, -1):
        rising = sign * (after - before) > 0
        count = numpy.where(rising, numpy.floor(sign * (after - reference) / contrast), 0).clip(0).astype(int)
        for k in range(1, count.max(initial=0) + 1):
            y, x = numpy.nonzero(count >= k)
            level = reference[y, x] + sign * k * contrast
            t_s = start_s + duration_s * (level - before[y, x]) / (after[y, x] - before[y, x])
            events.append(numpy.stack([t_s.clip(start_s, start_s + duration_s), x, y, numpy.full(len(x), sign > 0)], 1))
        reference += sign * count * contrast
    return events


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--version", action="version", version=VERSION)
    parser.add_argument("--dataset", type=pathlib.Path, required=True, help="folder with images.txt and images/*.exr")
    parser.add_argument("--contrast", type=float, required=True, help="threshold of both polarities")
    parser.add_argument("--log-eps", type=float, default=0.001, help="log intensity is ln(eps + radiance)")
    parser.add_argument("--every", type=int, default=1, help="reads every n-th frame alone")
    parser.add_argument("--out", required=True, help="events to write: t x y p")
    options = parser.parse_args()

    frames = [line.split() for line in (options.dataset / "images.txt").read_text().splitlines()]
    frames = frames[::options.every]
    level = [numpy.log(options.log_eps + read_exr((options.dataset / name).with_suffix(".exr")).astype(float))
             for _, name in frames]
    times_s = [float(t_s) for t_s, _ in frames]
    reference, events = level[0].copy(), []
    for k in range(1, len(frames)):
        events += crossings(reference, level[k - 1], level[k], options.contrast, times_s[k - 1], times_s[k] - times_s[k - 1])
    events = numpy.concatenate(events) if events else numpy.empty((0, 4))
    numpy.savetxt(options.out, events[numpy.argsort(events[:, 0], kind="stable")], fmt="%.9f %d %d %d")
    print(f"{len(events)} events from {len(frames)} frames")


if __name__ == "__main__":
    main()

#!/usr/bin/env bash
# The same bytes from two builds of the command: simulates small datasets with both and compares the files' hashes.
# Meant for the presets `asan` and `reproducible`, whose arithmetic is the same on every x86-64 machine.
set -euo pipefail

usage="usage: tests/system/compare_builds.sh SACCADE OTHER_SACCADE [CONFIG...]"
[[ $# -ge 2 ]] || { echo "$usage" >&2; exit 2; }
first=$(realpath "$1")
second=$(realpath "$2")
shift 2
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
configs=("$@")
[[ ${#configs[@]} -gt 0 ]] || configs=(walls planes moving_box office dunes)

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# simulate COMMAND CONFIG FOLDER: a short stretch before a small camera, with ideal pixels and with each preset's.
simulate() {
  "$1" simulate "configs/simulation/$2.yaml" -o "$3/ideal" -q --set duration_s=0.05 --set "$camera"
  "$1" simulate "configs/simulation/$2.yaml" -o "$3/noisy" -q --set duration_s=0.05 --set "$camera" \
    --set events.preset=davis240c --set events.samples_per_pixel=4
  "$1" simulate "configs/simulation/$2.yaml" -o "$3/filtered" -q --set duration_s=0.05 --set "$camera" \
    --set events.preset=dvxplorer --set events.texture_filter=mipmap --set groundtruth.event_labels=true
}
camera="camera={width: 48, height: 36, fx: 40, fy: 40, cx: 23.5, cy: 17.5}"

status=0
for config in "${configs[@]}"; do
  mkdir -p "$work/first/$config" "$work/second/$config"
  simulate "$first" "$config" "$work/first/$config"
  simulate "$second" "$config" "$work/second/$config"
  if diff -rq "$work/first/$config" "$work/second/$config"; then
    echo "$config: the same bytes ($(sha256sum <"$work/first/$config/ideal/events.h5" | cut -c1-16))"
  else
    echo "$config: DIFFERENT"
    status=1
  fi
done
exit $status

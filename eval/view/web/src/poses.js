import { firstNotBefore } from "./event_store.js";

/// Position and orientation [x, y, z, qx, qy, qz, qw] of a path {t, p} at `t`, between its neighbours; null outside.
export function poseAt(path, t) {
  const { t: times, p } = path;
  if (!times.length || t < times[0] || t > times.at(-1)) return null;
  const after = firstNotBefore(times, t);
  if (after === 0 || times[after] === t) return p[after];
  const a = p[after - 1], b = p[after], w = (t - times[after - 1]) / (times[after] - times[after - 1]);
  // The same rotation has two quaternions: the nearer one.
  const sign = a[3] * b[3] + a[4] * b[4] + a[5] * b[5] + a[6] * b[6] < 0 ? -1 : 1;
  const mixed = a.map((v, i) => (1 - w) * v + w * (i < 3 ? b[i] : sign * b[i]));
  const length = Math.hypot(...mixed.slice(3));
  return mixed.map((v, i) => (i < 3 ? v : v / length));
}

import { BufferAttribute, BufferGeometry, LineBasicMaterial, LineSegments, Quaternion, Vector3 } from "three";
import { SpaceView } from "../../../report/web/src/space_view.js";
import { colour } from "../../../report/web/src/theme.js";
import { poseAt } from "./poses.js";

// Of the size of the scene.
const kFrustumSize = 0.25;

const positions = ({ p }) => p.map((pose) => pose.slice(0, 3));

/// The corners of the image at depth 1 in the camera, from its size and [fx, fy, cx, cy].
const corners = ({ width, height, camera: [fx, fy, cx, cy] }) =>
  [[-0.5, -0.5], [width - 0.5, -0.5], [width - 0.5, height - 0.5], [-0.5, height - 0.5]].map(([x, y]) => new Vector3((x - cx) / fx, (y - cy) / fy, 1));

/// Paths, map and, at the time of the page, the camera of every path. `traces`: [{name, colour, path: {t, p}}], the truth first
/// where it is known.
export class PathSpace extends SpaceView {
  constructor(box, title, recording, traces, cloud) {
    super(box, () => ({
      title,
      times: [],
      truth: [],
      cloud,
      paths: traces.map(({ name, colour: of, path }) => ({ name, colour: of, points: positions(path) })),
    }));
    this.traces = traces;
    this.corners = recording && corners(recording);
  }

  /// Takes the path of a run that is being written, as far as it has come.
  setPath(unfinished, path) {
    const at = this.traces.findIndex((trace) => trace.unfinished === unfinished);
    if (at < 0) return;
    this.traces[at].path = path;
    if (!this.scene) return;
    this.content.paths[at].points = positions(path);
    this.fit();
    this.build();
  }

  draw() {
    if (this.scene && this.scene !== this.frustaScene) this.addFrusta();
    this.frusta?.forEach((frustum, i) => this.place(frustum, this.poses()[i]));
    super.draw();
  }

  poses() {
    return this.traces.map(({ path }) => this.time !== null && poseAt(path, this.time));
  }

  addFrusta() {
    this.frustaScene = this.scene;
    this.frusta = this.corners && this.traces.map((trace) => {
      const geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(new Float32Array(48), 3));
      const frustum = new LineSegments(geometry, new LineBasicMaterial({ color: colour(trace.colour) }));
      frustum.frustumCulled = false;
      this.scene.add(frustum);
      return frustum;
    });
  }

  place(frustum, pose) {
    frustum.visible = Boolean(pose);
    if (!pose) return;
    const centre = new Vector3(...pose.slice(0, 3)), rotation = new Quaternion(...pose.slice(3));
    const size = kFrustumSize * this.radius;
    const ends = this.corners.map((corner) => corner.clone().multiplyScalar(size).applyQuaternion(rotation).add(centre));
    const points = ends.flatMap((end, i) => [centre, end, end, ends[(i + 1) % 4]]);
    const position = frustum.geometry.getAttribute("position");
    points.forEach((point, i) => position.setXYZ(i, point.x, point.y, point.z));
    position.needsUpdate = true;
  }

  drawMarks(g) {
    this.poses().forEach((pose, i) => {
      if (!pose) return;
      g.beginPath();
      g.arc(...this.project(pose.slice(0, 3)), 4.5, 0, 7);
      g.fillStyle = colour(this.traces[i].colour);
      g.fill();
    });
  }
}

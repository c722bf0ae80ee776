import { BufferAttribute, BufferGeometry, LineBasicMaterial, LineSegments, OrthographicCamera, Points, PointsMaterial, Scene, Vector3,
  WebGLRenderer } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { Line2 } from "three/addons/lines/Line2.js";
import { LineGeometry } from "three/addons/lines/LineGeometry.js";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { buttons, download, fileName } from "./download.js";
import { whenNear } from "./lazy.js";
import { nearest, short } from "./number.js";
import { spaceSvg } from "./space_svg.js";
import { colour, onTheme } from "./theme.js";

// A browser grants a page some sixteen contexts: all views share one renderer and copy its picture.
let renderer;
function sharedRenderer() {
  if (renderer === undefined)
    try {
      renderer = new WebGLRenderer({ antialias: true, alpha: true });
    } catch {
      renderer = null;
    }
  return renderer;
}

const kExaggerations = [1, 2, 5, 10, 20, 50, 100];

// Smallest and largest coordinate of the points; a side without extent gets a tenth of the longest.
function limits(points) {
  const low = [0, 1, 2].map((k) => points.reduce((least, p) => Math.min(least, p[k]), Infinity));
  const high = [0, 1, 2].map((k) => points.reduce((most, p) => Math.max(most, p[k]), -Infinity));
  const longest = Math.max(...low.map((v, k) => high[k] - v), 1e-3);
  const flat = low.map((v, k) => high[k] - v < longest * 0.1);
  low.forEach((v, k) => {
    const missing = Math.max(0, longest * 0.1 - (high[k] - v)) / 2;
    low[k] -= missing;
    high[k] += missing;
  });
  return { low, high, flat };
}

// Without the farthest hundredths to each side, which a few wild points would own.
function withoutFar(cloud) {
  const bounds = [0, 1, 2].map((k) => {
    const sorted = cloud.map((p) => p[k]).sort((a, b) => a - b);
    return [sorted[Math.floor(sorted.length * 0.02)], sorted[Math.ceil(sorted.length * 0.98) - 1]];
  });
  return cloud.filter((p) => bounds.every(([low, high], k) => p[k] >= low && p[k] <= high));
}

/// Paths and a map in 3-D, without perspective and with equal axes, turned by dragging. `content()` says what:
///   {title, times, truth: [[x, y, z]], paths: [{name, colour, points}], cloud: [[x, y, z]]}
/// `points` of a path stand at `times`, as do those of `truth`.
export class SpaceView {
  constructor(box, content) {
    this.box = box;
    this.time = null;
    this.canvas = box.querySelector("canvas");
    this.slider = box.querySelector("input[type=range]");
    this.map = box.querySelector("input[type=checkbox]");
    whenNear(box, () => this.start(content()));
  }

  start(content) {
    this.content = { ...content, cloud: withoutFar(content.cloud || []) };
    if (this.map) this.map.closest("label").hidden = !this.content.cloud.length;
    if (!sharedRenderer()) {
      this.box.dataset.drawn = "no";
      this.canvas.replaceWith(Object.assign(document.createElement("p"), { className: "note", textContent: "The view in 3-D needs WebGL, which this browser does not offer." }));
      return;
    }
    this.camera = new OrthographicCamera();
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.canvas.style.touchAction = "pan-y";
    // The wheel scrolls the page until the view is chosen.
    this.controls.enableZoom = this.controls.enablePan = false;
    this.canvas.addEventListener("focus", () => (this.controls.enableZoom = true));
    this.canvas.addEventListener("blur", () => (this.controls.enableZoom = false));
    this.controls.addEventListener("change", () => this.draw());
    this.slider?.addEventListener("input", () => this.build());
    this.map?.addEventListener("change", () => this.look());
    onTheme(() => this.build());
    new ResizeObserver(() => this.draw()).observe(this.canvas);
    this.box.querySelector("figcaption").append(buttons({ SVG: () => this.save() }));
    this.look();
  }

  // Bounds, middle and radius of what is shown.
  measure() {
    const { truth, paths, cloud } = this.content;
    this.bounds = limits([...truth, ...paths.flatMap((path) => path.points), ...(this.map?.checked ? cloud : [])]);
    const { low, high } = this.bounds;
    this.radius = Math.hypot(...low.map((v, k) => (high[k] - v) / 2));
    return new Vector3(...low.map((v, k) => (v + high[k]) / 2));
  }

  // Frames what is shown, from the side.
  look() {
    const middle = this.measure();
    this.controls.target.copy(middle);
    this.camera.position.copy(middle).add(new Vector3(-0.5, -0.72, 0.48).multiplyScalar(4 * this.radius));
    this.camera.near = 0;
    this.camera.far = 8 * this.radius;
    this.camera.zoom = 1;
    this.build();
  }

  /// Frames what is shown, from where the reader looks at it.
  fit() {
    const before = this.radius, from = this.camera.position.clone().sub(this.controls.target), middle = this.measure();
    this.controls.target.copy(middle);
    this.camera.position.copy(middle).add(from.multiplyScalar(this.radius / before));
    this.camera.far = 8 * this.radius;
  }

  /// The points of a path with its deviation from the truth made larger.
  shown(path) {
    const by = kExaggerations[this.slider?.value ?? 0];
    const { truth } = this.content;
    return path.points.map((p, i) => (truth[i] ? p.map((v, k) => truth[i][k] + by * (v - truth[i][k])) : p));
  }

  lines() {
    const { truth, paths } = this.content;
    return [{ points: truth, colour: "truth", width: 3.2 },
      ...paths.map((path) => ({ points: this.shown(path), colour: path.colour, width: 1.6 }))].filter((line) => line.points.length > 1);
  }

  build() {
    this.scene?.traverse((object) => {
      object.geometry?.dispose();
      object.material?.dispose();
    });
    this.scene = new Scene();
    const { low, high } = this.bounds;
    const corner = (i) => [0, 1, 2].map((k) => (i >> k & 1 ? high[k] : low[k]));
    const edges = [];
    for (let i = 0; i < 8; ++i) for (let k = 0; k < 3; ++k) if (!(i >> k & 1)) edges.push(...corner(i), ...corner(i | 1 << k));
    const geometry = (numbers) => new BufferGeometry().setAttribute("position", new BufferAttribute(new Float32Array(numbers), 3));
    this.scene.add(new LineSegments(geometry(edges), new LineBasicMaterial({ color: colour("line") })));
    if (this.map?.checked)
      this.scene.add(new Points(geometry(this.content.cloud.flat()), new PointsMaterial({ color: colour("map"), size: 1.8, sizeAttenuation: false })));
    for (const line of this.lines())
      this.scene.add(new Line2(new LineGeometry().setPositions(line.points.flat()), new LineMaterial({ color: colour(line.colour), linewidth: line.width })));
    const output = this.box.querySelector("output");
    if (output) output.textContent = `deviation × ${kExaggerations[this.slider.value]}`;
    this.controls.update();
    this.draw();
  }

  /// Marks the instant t [s] on every path; null marks none.
  showTime(t) {
    this.time = t;
    if (this.scene) this.draw();
  }

  draw() {
    const width = this.canvas.clientWidth, height = this.canvas.clientHeight;
    if (!width || !this.scene) return;
    const reach = 1.06 * this.radius / Math.min(width, height);
    Object.assign(this.camera, { left: -width * reach, right: width * reach, top: height * reach, bottom: -height * reach });
    this.camera.updateProjectionMatrix();
    renderer.setPixelRatio(devicePixelRatio);
    renderer.setSize(width, height, false);
    renderer.render(this.scene, this.camera);
    this.canvas.width = renderer.domElement.width;
    this.canvas.height = renderer.domElement.height;
    const g = this.canvas.getContext("2d");
    g.drawImage(renderer.domElement, 0, 0);
    g.scale(devicePixelRatio, devicePixelRatio);
    this.drawAxes(g);
    this.drawMarks(g);
    this.box.dataset.drawn = "yes";
  }

  /// The pixel of the view that shows a point of the world.
  project(p) {
    const v = new Vector3(...p).project(this.camera);
    return [(v.x + 1) / 2 * this.canvas.clientWidth, (1 - v.y) / 2 * this.canvas.clientHeight];
  }

  // Of the four edges along an axis, the one that lies outermost on the screen carries its length.
  axisLabels() {
    const { low, high, flat } = this.bounds;
    const width = this.canvas.clientWidth, height = this.canvas.clientHeight;
    return [0, 1, 2].filter((k) => !flat[k]).map((k) => {
      const middles = [];
      for (let i = 0; i < 8; ++i)
        if (!(i >> k & 1)) middles.push(this.project([0, 1, 2].map((j) => (j === k ? (low[j] + high[j]) / 2 : i >> j & 1 ? high[j] : low[j]))));
      const outermost = middles.reduce((best, m) => ((k === 2 ? -m[0] > -best[0] : m[1] > best[1]) ? m : best));
      const away = [outermost[0] - width / 2, outermost[1] - height / 2], far = Math.hypot(...away) || 1;
      const text = `${"xyz"[k]}  ${short(high[k] - low[k])} m`, reach = Math.abs(away[0]) / far * 40 + 14;
      const at = away.map((v, i) => outermost[i] + v / far * reach);
      return { text, at: [Math.min(width - 46, Math.max(46, at[0])), Math.min(height - 8, Math.max(14, at[1]))] };
    });
  }

  drawAxes(g) {
    g.fillStyle = colour("muted");
    g.font = "12px system-ui, sans-serif";
    g.textAlign = "center";
    for (const { text, at } of this.axisLabels()) g.fillText(text, ...at);
  }

  drawMarks(g) {
    const i = this.time === null ? 0 : nearest(this.content.times, this.time);
    for (const line of this.lines()) {
      if (!line.points[i]) continue;
      g.beginPath();
      g.arc(...this.project(line.points[i]), this.time === null ? line.width + 1.5 : 5.5, 0, 7);
      g.fillStyle = colour(line.colour);
      g.fill();
    }
  }

  save() {
    download(`${fileName(this.content.title)}.svg`, "image/svg+xml", spaceSvg(this));
  }
}

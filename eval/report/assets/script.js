"use strict";
(() => {
  const data = JSON.parse(document.getElementById("report-data").textContent);
  const SVG = "http://www.w3.org/2000/svg";
  const cursors = {};  // run id -> functions of a time (or null) that show it

  const showTime = (run, t) => (cursors[run] || []).forEach((show) => show(t));
  const onTime = (run, show) => (cursors[run] = cursors[run] || []).push(show);

  const element = (name, attributes, parent) => {
    const node = document.createElementNS(SVG, name);
    for (const key in attributes) node.setAttribute(key, attributes[key]);
    if (parent) parent.appendChild(node);
    return node;
  };

  /// About `count` round values within [low, high].
  const ticks = (low, high, count) => {
    const rough = (high - low) / count;
    const power = Math.pow(10, Math.floor(Math.log10(rough)));
    const step = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= rough * 0.8);
    const values = [];
    for (let i = Math.ceil(low / step - 1e-9); i * step <= high + step * 1e-9; ++i) values.push(i * step);
    return { values, digits: Math.max(0, -Math.floor(Math.log10(step) + 1e-9)) };
  };

  /// Index of the sample nearest to t in an ascending list.
  const nearest = (times, t) => {
    let low = 0, high = times.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (times[middle] < t) low = middle; else high = middle;
    }
    return Math.abs(times[low] - t) <= Math.abs(times[high] - t) ? low : high;
  };

  // One error over time, with a crosshair that all plots of a run share.
  const drawPlot = (box, run, series) => {
    const width = Math.max(260, box.clientWidth), height = 170;
    const left = 46, right = 8, top = 8, bottom = 34;
    const [t0, t1] = run.span;
    const high = Math.max(series.max * 1.06, 1e-3);
    const x = (t) => left + (t - t0) / (t1 - t0 || 1) * (width - left - right);
    const y = (v) => height - bottom - v / high * (height - top - bottom);
    box.textContent = "";
    const svg = element("svg", { viewBox: `0 0 ${width} ${height}`, height, role: "img", "aria-label": series.label + " over time" }, null);
    box.appendChild(svg);
    for (const [from, to] of run.gaps)
      element("rect", { class: "gap", x: x(from), width: Math.max(1, x(to) - x(from)), y: top, height: height - top - bottom }, svg);
    const vertical = ticks(0, high, 4);
    for (const v of vertical.values) {
      element("line", { class: "gridline", x1: left, x2: width - right, y1: y(v), y2: y(v) }, svg);
      element("text", { x: left - 7, y: y(v) + 4, "text-anchor": "end" }, svg).textContent = v.toFixed(vertical.digits);
    }
    const horizontal = ticks(t0, t1, width / 90);
    for (const t of horizontal.values)
      element("text", { x: x(t), y: height - bottom + 16, "text-anchor": "middle" }, svg).textContent = t.toFixed(horizontal.digits);
    element("text", { x: (left + width - right) / 2, y: height - 2, "text-anchor": "middle" }, svg).textContent = "time [s]";
    element("line", { class: "mean", x1: left, x2: width - right, y1: y(series.mean), y2: y(series.mean) }, svg);
    element("path", { class: "curve", d: "M" + series.t.map((t, i) => x(t).toFixed(1) + " " + y(series.v[i]).toFixed(1)).join("L") }, svg);
    const cursor = element("line", { class: "cursor", y1: top, y2: height - bottom, visibility: "hidden" }, svg);
    const dot = element("circle", { class: "dot", r: 3.5, visibility: "hidden" }, svg);
    const tip = document.createElement("div");
    tip.className = "tip";
    tip.hidden = true;
    box.appendChild(tip);
    const point = (event) => {
      const bounds = svg.getBoundingClientRect();
      const share = ((event.clientX - bounds.left) / bounds.width * width - left) / (width - left - right);
      showTime(run.id, t0 + Math.min(1, Math.max(0, share)) * (t1 - t0));
    };
    svg.addEventListener("pointermove", point);
    svg.addEventListener("pointerdown", point);
    svg.addEventListener("pointerleave", () => showTime(run.id, null));
    box.showTime = (t) => {
      tip.hidden = t === null;
      for (const node of [cursor, dot]) node.setAttribute("visibility", t === null ? "hidden" : "visible");
      if (t === null) return;
      const i = nearest(series.t, t), px = x(series.t[i]);
      cursor.setAttribute("x1", px);
      cursor.setAttribute("x2", px);
      dot.setAttribute("cx", px);
      dot.setAttribute("cy", y(series.v[i]));
      tip.textContent = `${series.t[i].toFixed(3)} s   ${series.v[i].toPrecision(3)} ${series.unit}`;
      const scale = svg.getBoundingClientRect().width / width;
      tip.style.left = Math.min(box.clientWidth - tip.offsetWidth, Math.max(0, px * scale + 10)) + "px";
    };
  };

  // Truth and estimate in 3-D: orthographic, equal axes, turned by dragging.
  const trajectoryView = (box, run) => {
    const canvas = box.querySelector("canvas"), slider = box.querySelector("input"), shown = box.querySelector("output");
    const steps = [1, 2, 5, 10, 20, 50, 100];
    let azimuth = -0.6, elevation = 0.5, time = null;
    const all = run.truth.concat(run.estimate);
    const low = [0, 1, 2].map((k) => Math.min(...all.map((p) => p[k])));
    const high = [0, 1, 2].map((k) => Math.max(...all.map((p) => p[k])));
    const longest = Math.max(...low.map((v, k) => high[k] - v), 1e-3);
    const padded = low.map((v, k) => high[k] - v < longest * 0.1);  // a side without extent says nothing
    for (let k = 0; k < 3; ++k) {
      const missing = Math.max(0, longest * 0.1 - (high[k] - low[k]));
      low[k] -= missing / 2;
      high[k] += missing / 2;
    }
    const middle = low.map((v, k) => (v + high[k]) / 2);
    const radius = Math.hypot(...low.map((v, k) => (high[k] - v) / 2));
    const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

    const draw = () => {
      const ratio = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
      canvas.width = width * ratio;
      canvas.height = height * ratio;
      const g = canvas.getContext("2d");
      g.scale(ratio, ratio);
      g.lineJoin = "round";
      const scale = Math.min(width, height) * 0.47 / radius;
      const ca = Math.cos(azimuth), sa = Math.sin(azimuth), ce = Math.cos(elevation), se = Math.sin(elevation);
      const project = (p) => {
        const a = p[0] - middle[0], b = p[1] - middle[1], c = p[2] - middle[2];
        const depth = sa * a + ca * b;
        return [width / 2 + scale * (ca * a - sa * b), height / 2 - scale * (se * depth + ce * c)];
      };
      const exaggeration = steps[slider.value];
      const estimate = run.estimate.map((p, i) => run.truth[i] ? p.map((v, k) => run.truth[i][k] + exaggeration * (v - run.truth[i][k])) : p);
      const corner = (i) => project([0, 1, 2].map((k) => (i >> k & 1 ? high[k] : low[k])));
      g.strokeStyle = colour("--line");
      g.lineWidth = 1;
      for (let i = 0; i < 8; ++i)
        for (let k = 0; k < 3; ++k)
          if (!(i >> k & 1)) {
            g.beginPath();
            g.moveTo(...corner(i));
            g.lineTo(...corner(i | 1 << k));
            g.stroke();
          }
      g.fillStyle = colour("--muted");
      g.font = "12px system-ui, sans-serif";
      g.textAlign = "center";
      for (let k = 0; k < 3; ++k) {
        if (padded[k]) continue;
        // Of the four edges along an axis, the one that lies outermost on the screen carries the label.
        let best = null;
        for (let i = 0; i < 8; ++i) {
          if (i >> k & 1) continue;
          const a = corner(i), b = corner(i | 1 << k), m = [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
          const rank = k === 2 ? -m[0] : m[1];
          if (!best || rank > best.rank) best = { rank, m };
        }
        const label = `${"xyz"[k]}  ${(high[k] - low[k]).toPrecision(3)} m`, half = g.measureText(label).width / 2 + 6;
        const away = [best.m[0] - width / 2, best.m[1] - height / 2], far = Math.hypot(...away) || 1;
        const reach = Math.abs(away[0]) / far * half + 14;
        const at = [best.m[0] + away[0] / far * reach, best.m[1] + away[1] / far * reach + 4];
        g.fillText(label, Math.min(width - half, Math.max(half, at[0])), Math.min(height - 6, at[1]));
      }
      const curve = (points, name, line) => {
        if (!points.length) return;
        g.strokeStyle = g.fillStyle = colour(name);
        g.lineWidth = line;
        g.beginPath();
        points.forEach((p, i) => (i ? g.lineTo(...project(p)) : g.moveTo(...project(p))));
        g.stroke();
        g.beginPath();
        g.arc(...project(points[0]), line + 2, 0, 7);
        g.fill();
      };
      curve(run.truth, "--truth", 3);
      curve(estimate, "--estimate", 1.4);
      if (time !== null) {
        const i = nearest(run.times, time);
        for (const [points, name] of [[run.truth, "--truth"], [estimate, "--estimate"]]) {
          if (!points[i]) continue;
          g.fillStyle = colour(name);
          g.strokeStyle = colour("--panel");
          g.lineWidth = 1.5;
          g.beginPath();
          g.arc(...project(points[i]), 5.5, 0, 7);
          g.fill();
          g.stroke();
        }
      }
      shown.textContent = "deviation × " + exaggeration;
    };

    let last = null;
    canvas.addEventListener("pointerdown", (event) => {
      last = [event.clientX, event.clientY];
      canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener("pointerup", () => (last = null));
    canvas.addEventListener("pointercancel", () => (last = null));
    canvas.addEventListener("pointermove", (event) => {
      if (!last) return;
      azimuth -= (event.clientX - last[0]) * 0.009;
      elevation = Math.min(Math.PI / 2, Math.max(-Math.PI / 2, elevation + (event.clientY - last[1]) * 0.009));
      last = [event.clientX, event.clientY];
      draw();
    });
    slider.addEventListener("input", draw);
    onTime(run.id, (t) => {
      time = t;
      draw();
    });
    return draw;
  };

  const redraws = [];
  for (const run of data.runs) {
    const view = document.querySelector(`[data-space="${run.id}"]`);
    if (view) redraws.push(trajectoryView(view, run));
    for (const box of document.querySelectorAll(`[data-plot^="${run.id}/"]`)) {
      const series = run.series[box.dataset.plot.split("/")[1]];
      redraws.push(() => drawPlot(box, run, series));
      onTime(run.id, (t) => box.showTime(t));
    }
  }
  const redraw = () => redraws.forEach((draw) => draw());
  let width = 0;
  addEventListener("resize", () => {
    if (width !== innerWidth) redraw();
    width = innerWidth;
  });
  addEventListener("beforeprint", redraw);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
  redraw();
})();

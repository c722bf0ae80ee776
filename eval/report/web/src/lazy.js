// A page of many runs opens at once: what is drawn is drawn when it comes near the window, and all of it for paper.
const waiting = new Map();

const start = (box) => {
  const draw = waiting.get(box);
  if (!draw) return;
  waiting.delete(box);
  observer.unobserve(box);
  draw();
};

const observer = new IntersectionObserver(
  (entries) => entries.forEach((entry) => entry.isIntersecting && start(entry.target)), { rootMargin: "500px" });

/// Calls `draw` once, before `box` is seen.
export function whenNear(box, draw) {
  waiting.set(box, draw);
  observer.observe(box);
}

/// Draws what still waits below `parent`, also what comes to wait by that.
export function drawAll(parent = document) {
  for (let boxes; (boxes = [...waiting.keys()].filter((box) => parent.contains(box))).length > 0;) boxes.forEach(start);
}

// style.css leaves runs that are far from the window without layout, so that the page opens at once. What is not in the window
// catches up afterwards: a picture of the whole page shows it, and the scrollbar is right.
const whenIdle = globalThis.requestIdleCallback ?? setTimeout;

function settleNext(runs) {
  const run = runs.shift();
  if (!run) return;
  run.style.contentVisibility = "visible";
  whenIdle(() => settleNext(runs));
}

/// Lays the runs out one by one once the page is open and the browser has nothing else to do.
export const settle = () => addEventListener("load", () => whenIdle(() => settleNext([...document.querySelectorAll(".run:not(:has(> .packed))")])));

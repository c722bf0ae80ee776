// style.css leaves sections that are far from the window without layout, so that the page opens at once. What is not in the window
// catches up afterwards: a picture of the whole page shows it, and the scrollbar is right.
const whenIdle = globalThis.requestIdleCallback ?? setTimeout;

function settleNext(sections) {
  const section = sections.shift();
  if (!section) return;
  section.style.contentVisibility = "visible";
  whenIdle(() => settleNext(sections));
}

/// Lays the sections out one by one once the page is open and the browser has nothing else to do.
export const settle = () => addEventListener("load", () => whenIdle(() => settleNext([...document.querySelectorAll(".report > section:not(:has(> .packed)), .run:not(:has(> .packed))")])));

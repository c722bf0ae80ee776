const kHelp = [
  ["Space", "play or pause"],
  ["← →", "back, forward by half a window of events; with Shift by ten"],
  ["Home End", "first, last moment; while a run is being written, End follows it"],
  [", .", "slower, faster"],
  ["[ ]", "shorter, longer window of events"],
  ["m", "next way to draw events"],
  ["1 2 3", "polarity, accumulated, time surface"],
  ["r", "next recording"],
  ["?", "these keys"],
];

function fill(dialog) {
  const table = document.createElement("table");
  for (const row of kHelp) {
    const line = table.insertRow();
    for (const text of row) line.insertCell().textContent = text;
  }
  const close = Object.assign(document.createElement("button"), { type: "button", textContent: "Close" });
  close.addEventListener("click", () => dialog.close());
  dialog.append(table, close);
}

/// The keys of the page; `nextRecording` does nothing where there is one alone.
export function startKeys(dialog, help, clock, style, nextRecording) {
  fill(dialog);
  const showHelp = () => (dialog.open ? dialog.close() : dialog.showModal());
  help.addEventListener("click", showHelp);
  const step = (sign, event) => clock.seek(clock.time + sign * style.windowMs / 2000 * (event.shiftKey ? 10 : 1));
  const actions = {
    " ": () => clock.play(),
    ArrowLeft: (event) => step(-1, event),
    ArrowRight: (event) => step(1, event),
    Home: () => clock.seek(clock.start),
    End: () => clock.toEnd(),
    ",": () => clock.shift(-1),
    ".": () => clock.shift(1),
    "[": () => style.shiftWindow(-1),
    "]": () => style.shiftWindow(1),
    m: () => style.nextMode(),
    1: () => style.setMode(0),
    2: () => style.setMode(1),
    3: () => style.setMode(2),
    r: nextRecording,
    "?": showHelp,
  };
  addEventListener("keydown", (event) => {
    const action = actions[event.key];
    // A chosen button is pressed by the space bar, a list moved by its arrows.
    const own = event.target.closest("select, dialog") || (event.key === " " && event.target.closest("button"));
    if (!action || event.ctrlKey || event.altKey || event.metaKey || (own && event.key !== "?")) return;
    event.preventDefault();
    action(event);
  });
}

// Colours come from style.css alone, where each is light-dark(): a probe element resolves them for the canvases.
const root = document.documentElement;
const probe = document.createElement("i");
probe.hidden = true;
document.body.append(probe);

const listeners = [];

/// Calls `redraw` whenever colours change: by the switch, by the system, for paper and back.
export const onTheme = (redraw) => listeners.push(redraw);

const changed = () => listeners.forEach((redraw) => redraw());

/// The colour of a custom property, "#rrggbb" or "rgb(...)"; `scheme` "light" is that of exported figures.
export function colour(name, scheme = "") {
  probe.style.colorScheme = scheme;
  probe.style.color = `var(--${name})`;
  return getComputedStyle(probe).color;
}

export function startTheme() {
  const button = document.getElementById("theme");
  const system = matchMedia("(prefers-color-scheme: dark)");
  const dark = () => (root.style.colorScheme ? root.style.colorScheme === "dark" : system.matches);
  const label = () => (button.textContent = dark() ? "Light" : "Dark");
  button.hidden = false;
  button.addEventListener("click", () => {
    root.style.colorScheme = dark() ? "light" : "dark";
    label();
    changed();
  });
  system.addEventListener("change", () => {
    label();
    changed();
  });
  let before = "";
  addEventListener("beforeprint", () => {
    before = root.style.colorScheme;
    root.style.colorScheme = "light";
    changed();
  });
  addEventListener("afterprint", () => {
    root.style.colorScheme = before;
    changed();
  });
  label();
}

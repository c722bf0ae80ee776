import { strFromU8, unzlibSync } from "fflate";
import { whenNear } from "./lazy.js";

/// Puts what the report compressed in the place of `script`, once it comes near the window; `start(section)` then starts the
/// tables and charts in it. Inflated at once and not by a stream, so that a page that is printed can wait for it.
export function unpackWhenNear(script, start) {
  const section = script.parentElement;
  whenNear(section, () => {
    const bytes = Uint8Array.from(atob(script.textContent.trim()), (c) => c.charCodeAt(0));
    script.outerHTML = strFromU8(unzlibSync(bytes));
    start(section);
  });
}

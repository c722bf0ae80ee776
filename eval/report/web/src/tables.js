import { buttons, download } from "./download.js";

const isNumber = (cell) => cell.dataset.value !== undefined;

const compare = (a, b) => (isNumber(a) ? a.dataset.value - b.dataset.value : a.textContent.localeCompare(b.textContent));

function sortBy(table, head) {
  const column = head.cellIndex, body = table.tBodies[0];
  const sign = head.ariaSort === "ascending" ? -1 : 1;
  for (const other of head.parentNode.cells) other.removeAttribute("aria-sort");
  head.ariaSort = sign > 0 ? "ascending" : "descending";
  const rows = [...body.rows].sort((a, b) => {
    const [x, y] = [a.cells[column], b.cells[column]];
    // In both directions what has no number stands last.
    return isNumber(y) - isNumber(x) || sign * compare(x, y);
  });
  body.append(...rows);
}

/// Sorts the table by a column when its head is pressed, and offers it as the files that the report put beside it.
export function startTable(table) {
  for (const head of table.tHead.rows[0].cells) {
    head.tabIndex = 0;
    head.title = "Sort";
    head.addEventListener("click", () => sortBy(table, head));
    head.addEventListener("keydown", (event) => {
      if (event.key !== "Enter" && event.key !== " ") return;
      event.preventDefault();
      sortBy(table, head);
    });
  }
  const { name, csv, latex } = table.dataset;
  const scroll = table.closest(".scroll"), caption = scroll.previousElementSibling;
  // Beside the caption: beside the table they would make it narrower.
  (caption?.matches("h4") ? caption : scroll).before(buttons({
    CSV: () => download(`${name}.csv`, "text/csv", csv),
    LaTeX: () => download(`${name}.tex`, "application/x-tex", latex),
  }));
}

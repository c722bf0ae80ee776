// The index of a site (eval/report/site): its tables keep the rows that hold what is typed, and the runs that do are listed. The
// list of all runs is long and lies beside the page: it is loaded with the first letter, as a script, since a page that is opened
// as a file may load nothing else.
const kShown = 50;

function loadRuns(address) {
  return new Promise((resolve) => {
    if (globalThis.saccadeRuns) return resolve(globalThis.saccadeRuns);
    const script = Object.assign(document.createElement("script"), { src: address });
    script.onload = () => resolve(globalThis.saccadeRuns);
    script.onerror = () => resolve([]);
    document.head.append(script);
  });
}

const holds = (text, words) => words.every((word) => text.includes(word));

function showFound(list, runs, words) {
  const found = words.length ? runs.filter(([text]) => holds(text.toLowerCase(), words)) : [];
  list.replaceChildren(...found.slice(0, kShown).map(([text, address]) => {
    const item = document.createElement("li");
    item.append(Object.assign(document.createElement("a"), { href: address, textContent: text }));
    return item;
  }));
  if (found.length > kShown) list.append(Object.assign(document.createElement("li"), { textContent: `and ${found.length - kShown} more runs` }));
}

export function startSearch() {
  const field = document.getElementById("search");
  if (!field) return;
  const list = document.getElementById("found");
  field.addEventListener("input", async () => {
    const words = field.value.toLowerCase().split(/\s+/).filter(Boolean);
    for (const row of document.querySelectorAll("table.sortable tbody tr")) row.hidden = !holds(row.textContent.toLowerCase(), words);
    showFound(list, words.length ? await loadRuns(field.dataset.runs) : [], words);
    document.documentElement.dataset.searched = field.value;
  });
}

/// Offers `text` as a file.
export function download(name, type, text) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

/// "Tracking accuracy [%]" as part of a file's name.
export const fileName = (text) => text.toLowerCase().replace(/[^a-z0-9]+/g, "_").replace(/^_|_$/g, "") || "report";

/// A row of small buttons, {label: action}.
export function buttons(actions) {
  const row = document.createElement("span");
  row.className = "tools";
  for (const [label, action] of Object.entries(actions)) {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = label;
    button.addEventListener("click", action);
    row.append(button);
  }
  return row;
}

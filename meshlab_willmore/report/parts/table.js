// Sorts the table of a batch: by text or by number, up or down; what is unknown is always last.
const body = document.querySelector("tbody");

function keyOf(row, column) {
  const { number, value } = row.cells[column].dataset;
  return number === undefined ? value : Number(number);
}

function compared(one, other) {
  return typeof one === "number" ? one - other : one.localeCompare(other, "en", { numeric: true });
}

function sortBy(head) {
  const isUp = head.getAttribute("aria-sort") !== "ascending";
  document.querySelectorAll("th").forEach((other) => other.removeAttribute("aria-sort"));
  head.setAttribute("aria-sort", isUp ? "ascending" : "descending");
  const rows = [...body.rows].map((row) => ({ row, key: keyOf(row, head.cellIndex) }));
  const known = rows.filter(({ key }) => key !== undefined);
  known.sort((one, other) => (isUp ? 1 : -1) * compared(one.key, other.key));
  const unknown = rows.filter(({ key }) => key === undefined);
  body.append(...[...known, ...unknown].map(({ row }) => row));
}

document.querySelector("thead").addEventListener("click", (event) => {
  const head = event.target.closest("button")?.parentElement;
  if (head) sortBy(head);
});
document.documentElement.dataset.state = "ready";

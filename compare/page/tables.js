// Tables can be taken along as comma-separated values (RFC 4180): numbers as exact as they are known.
function csvOf(table) {
  const quoted = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
  const textOf = (cell) => cell.dataset.value ?? cell.textContent.trim().replaceAll(/\s+/g, " ");
  return [...table.rows].map((row) => [...row.cells].map((cell) => quoted(textOf(cell))).join(",")).join("\r\n") + "\r\n";
}

function offerCsv(table) {
  const button = document.createElement("button");
  button.type = "button";
  button.className = "csv";
  button.textContent = "CSV";
  button.title = "Save this table as comma-separated values";
  button.addEventListener("click", () => {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([csvOf(table)], { type: "text/csv" }));
    link.download = `${table.caption.firstChild.textContent.slice(0, 40).trim().replaceAll(/[^A-Za-z0-9]+/g, "-")}.csv`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  });
  table.caption.append(" ", button);
}

// Tables sort by a click on a column's header: rising, falling, and back as they were. Rows without a value stay last,
// and equal rows in their order.

function makeSortable(table) {
  const body = table.tBodies[0];
  const original = [...body.rows];
  if (original.length < 2) return;
  const valueOf = (row, column) => {
    const cell = row.cells[column];
    if (cell.dataset.value !== undefined) return Number(cell.dataset.value);
    const text = cell.textContent.trim();
    return text === "–" || text === "" ? NaN : text;
  };
  const compare = (a, b) => (typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b)));
  [...table.tHead.rows[0].cells].forEach((header, column) => {
    const button = document.createElement("button");
    button.type = "button";
    button.append(...header.childNodes);
    header.append(button);
    button.addEventListener("click", () => {
      const before = header.getAttribute("aria-sort");
      for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
      if (before === "descending") {
        body.append(...original);
        return;
      }
      const order = before === "ascending" ? "descending" : "ascending";
      header.setAttribute("aria-sort", order);
      const known = original.filter((row) => !Number.isNaN(valueOf(row, column)));
      known.sort((a, b) => (order === "ascending" ? 1 : -1) * compare(valueOf(a, column), valueOf(b, column)));
      body.append(...known, ...original.filter((row) => !known.includes(row)));
    });
  });
}

document.querySelectorAll("table.sortable").forEach((table) => {
  makeSortable(table);
  offerCsv(table);
});

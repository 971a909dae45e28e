// SPDX-License-Identifier: Apache-2.0
// Tables: built from numbers, sorted by a click on a column's header, and saved as comma-separated values.

// A cell is a text, or {text, value, small, href, best, picture}: `value` is used for sorting and saving the column,
// `small` is a second, paler line, `picture` an element below the text.
function cellOf(cell, isFirst) {
  const { text, value, small, href, best, picture } = typeof cell === "object" ? cell : { text: cell };
  const label = href ? make("a", { href }, text) : best ? make("span", { class: "best" }, text) : text;
  return make(isFirst ? "th" : "td", { scope: isFirst ? "row" : null, "data-value": value }, label,
    small ? make("small", {}, small) : null, picture);
}

let captions = 0;

// Returns a table; null if there are no rows. The first cell of a row is its header.
function tableOf(caption, headers, rows) {
  if (rows.length === 0) return null;
  const id = `caption-${++captions}`;
  const table = make("table", { class: "sortable" }, make("caption", {}, make("span", { id }, caption)),
    make("thead", {}, make("tr", {}, headers.map((header) => make("th", { scope: "col" }, header)))),
    make("tbody", {}, rows.map((row) => make("tr", {}, row.map((cell, i) => cellOf(cell, i === 0))))));
  makeSortable(table);
  offerCsv(table);
  return make("div", { class: "scroll", tabindex: 0, role: "region", "aria-labelledby": id }, table);
}

// Returns the table as comma-separated values (RFC 4180), with numbers in full precision.
function csvOf(table) {
  const quoted = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
  const textOf = (cell) => cell.dataset.value ?? cell.textContent.trim().replaceAll(/\s+/g, " ");
  return [...table.rows].map((row) => [...row.cells].map((cell) => quoted(textOf(cell))).join(",")).join("\r\n") + "\r\n";
}

function offerCsv(table) {
  const button = make("button", { type: "button", class: "csv", title: "Save this table as comma-separated values" }, "CSV");
  button.addEventListener("click", () => {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([csvOf(table)], { type: "text/csv" }));
    link.download = `${table.caption.firstChild.textContent.slice(0, 40).trim().replaceAll(/[^A-Za-z0-9]+/g, "-")}.csv`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  });
  table.caption.append(" ", button);
}

// Makes a click on a header sort the column: ascending, descending, then in the original order. Rows without a value
// stay last, and equal rows keep their order.
function makeSortable(table) {
  const body = table.tBodies[0];
  const original = [...body.rows];
  if (original.length < 2) return;
  const valueOf = (row, column) => {
    const cell = row.cells[column];
    if (cell.dataset.value !== undefined) return Number(cell.dataset.value);
    const text = cell.textContent.trim();
    return text === kNotThere || text === "" ? NaN : text;
  };
  const compare = (a, b) => (typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b)));
  [...table.tHead.rows[0].cells].forEach((header, column) => {
    const button = make("button", { type: "button" }, ...header.childNodes);
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

// The table of the sites of a list; a click shows the sky of one.
(() => {
  const { data, state, cutsOf, digits } = Core;
  const region = data.region;
  const table = document.getElementById("sites");
  const MOST_SITES = 500;
  if (!table || !region || region.step_deg || region.rows_deg.length > 0 || region.name.length > MOST_SITES) return;
  const side = (value, plus, minus) => digits(Math.abs(value)) + "° " + (value < 0 ? minus : plus);
  const COLUMNS = [["mean visible", "mean-visible"], ["mean PDOP", "mean-pdop"], ["availability", "availability"], ["longest outage (s)", "longest-outage-s"]];

  const head = document.createElement("tr");
  for (const title of ["site", "latitude", "longitude", ...COLUMNS.map((column) => column[0])]) {
    const cell = document.createElement("th");
    cell.textContent = title;
    head.append(cell);
  }
  const rows = region.name.map((name, n) => {
    const row = document.createElement("tr"), first = document.createElement("td"), button = document.createElement("button");
    button.type = "button";
    button.textContent = name || "site " + (n + 1);
    button.addEventListener("click", () => Globe.look(n));
    first.append(button);
    row.append(first);
    for (const text of [side(region.latitude_deg[n], "N", "S"), side(region.longitude_deg[n], "E", "W"), ...COLUMNS.map(() => "")]) {
      const cell = document.createElement("td");
      cell.textContent = text;
      row.append(cell);
    }
    return row;
  });
  const body = document.createElement("tbody"), heading = document.createElement("thead");
  heading.append(head);
  body.append(...rows);
  table.append(heading, body);
  table.hidden = false;

  function fill() {
    const maps = cutsOf(state.place)?.maps;
    rows.forEach((row, n) => COLUMNS.forEach(([, measure], k) => {
      row.cells[3 + k].textContent = maps ? digits(maps[measure][n]) : "";
    }));
  }
  Core.listeners.push(fill);
  fill();
})();

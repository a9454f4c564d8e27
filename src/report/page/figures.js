// The figures, from the numbers of the page.
(() => {
  const { data, state, count, total, cutsOf, nameOf, notationOf, mark, unpack, plain, digits, figure, layout, select } = Core;
  const { front, objectives } = data;
  const shown = { x: 0, y: objectives.length > 1 ? 1 : null, shell: front.shells.length > 0 ? front.shells.length - 1 : null };

  // A narrow screen has no room for more than the name.
  const label = (n) => plain(innerWidth < 600 ? objectives[n].name : objectives[n].label);
  const members = [...Array(count).keys()];

  /** What is compared in curves: the selected one, the fuzzy pick, and the other constellations. */
  function compared(colours) {
    const list = [];
    const add = (place, name, color, dash, symbol) => {
      const selected = place === state.place;
      list.push({ place, name, cuts: cutsOf(place), selected, line: { color, width: selected ? 2.5 : 1.5, dash },
        ...(symbol && { marker: { symbol, size: selected ? 9 : 7, color, maxdisplayed: 9 } }) });
    };
    if (state.place < count) add(state.place, notationOf(state.place), colours.accent);
    if (data.chosen !== null && data.chosen !== state.place) add(data.chosen, "fuzzy pick", colours.second);
    for (let place = count; place < total; place++) {
      const { colour, symbol } = mark(place);
      add(place, nameOf(place), colours[colour], count > 0 ? "dash" : "solid", symbol);
    }
    // The selected one is drawn last, on top.
    return list.filter((one) => one.cuts).sort((a, b) => a.selected - b.selected);
  }

  /** A curve of one of them. */
  const curve = (one, more) => ({ type: "scatter", mode: one.marker ? "lines+markers" : "lines", name: plain(one.name),
    legendrank: 1000 + one.place, line: one.line, ...(one.marker && { marker: one.marker }), ...more });

  /** An axis range that contains some values, with a margin. */
  function around(values) {
    const lo = Math.min(...values), hi = Math.max(...values);
    const margin = 0.08 * (hi - lo) || 0.05 * Math.abs(hi) || 1;
    return [lo - margin, hi + margin];
  }

  /** The values of an objective, of the members and then of the constellations; of satellites for null. */
  const alongAxis = (n) => (n === null ? [...front.variables[0][1], ...data.baselines.map(() => null)]
    : [...front.objectives[n], ...data.baselines.map((b) => b.objectives[n])]);

  /** The marks of the front: in one colour, or coloured by the satellites of a shell. */
  function marker(colours) {
    if (shown.shell === null) return { size: 9, color: colours.accent };
    const [letter, satellites] = front.shells[shown.shell];
    return { size: 10, color: satellites, colorscale: "Viridis", cmin: 0, line: { width: 1, color: colours.ink },
      colorbar: { title: { text: "satellites of shell " + letter, side: "right" }, thickness: 12, outlinewidth: 0, tickcolor: colours.line } };
  }

  /** The satellites of each shell of a member, in words. */
  const byShell = (n) => (front.shells.length === 0 ? ""
    : "<br>" + front.shells.map(([letter, satellites]) => letter + ": " + satellites[n]).join(", ") + " satellites");

  function pareto(colours) {
    const { x, y } = shown;
    const first = alongAxis(x), second = alongAxis(y);
    const traces = [];
    if (data.generations.length > 0 && y !== null) {
      traces.push({ type: "scatter", mode: "markers", name: "earlier generations",
        x: data.generations.map((g) => g[1][x]), y: data.generations.map((g) => g[1][y]),
        hoverinfo: "skip", // Many lie under the front, whose points must stay clickable.
        marker: { size: 4, color: colours.faint, opacity: 0.45 } });
    }
    for (const other of data.fronts) {
      if (y === null) break;
      traces.push({ type: "scatter", mode: "markers", name: plain(other.name), x: other.objectives[x],
        y: other.objectives[y], text: other.notation.map(plain), hovertemplate: "%{text}<br>%{x}, %{y}<extra></extra>",
        marker: { size: 6, color: colours.third, symbol: "x-thin", line: { width: 1.5, color: colours.third } } });
    }
    if (count > 0) {
      traces.push({ type: "scatter", mode: "markers", name: "front", x: first.slice(0, count), y: second.slice(0, count),
        customdata: members, text: members.map((n) => plain(front.notation[n]) + byShell(n) + "<br>membership " + front.memberships_shown[n]),
        hovertemplate: "%{text}<br>%{x}, %{y}<extra></extra>", marker: marker(colours) });
    }
    for (let place = count; place < total; place++) {
      const { colour, symbol } = mark(place);
      const made = notationOf(place) === nameOf(place) ? "" : "<br>" + plain(notationOf(place));
      traces.push({ type: "scatter", mode: "markers", name: plain(nameOf(place)), x: [first[place]], y: [second[place]],
        customdata: [place], text: [plain(nameOf(place)) + made], hovertemplate: "%{text}<br>%{x}, %{y}<extra></extra>",
        marker: { size: 12, symbol, color: colours[colour] } });
    }
    const ring = (name, place, color, size) => traces.push({ type: "scatter", mode: "markers", name,
      x: [first[place]], y: [second[place]], hoverinfo: "skip",
      marker: { size, symbol: "circle-open", color, line: { width: 2.5, color } } });
    if (data.chosen !== null) ring("fuzzy pick", data.chosen, colours.second, 16);
    ring("selected", state.place, colours.ink, 22);
    const close = document.getElementById("close-up")?.checked;
    return { data: traces, layout: layout(colours, {
      xaxis: { title: { text: label(x) }, ...(close && { range: around(first.slice(0, count)) }) },
      yaxis: { title: { text: y === null ? "satellites" : label(y) }, ...(close && { range: around(second.slice(0, count)) }) } }) };
  }

  function membership(colours) {
    const x = front.objectives[0];
    const order = [...members].sort((a, b) => x[a] - x[b]);
    const pickOf = (values) => order.map((n) => values[n]);
    const trace = (name, values, axis, color, mode) => ({ type: "scatter", mode, name, x: pickOf(x),
      y: pickOf(values), yaxis: axis, customdata: order, text: order.map((n) => plain(front.notation[n])),
      hovertemplate: "%{text}<br>%{y}<extra></extra>", line: { color, width: 1, dash: "dot" },
      marker: { color, size: 7 } });
    const traces = [trace("worst-case membership", front.membership, "y", colours.accent, "lines+markers"),
      trace("normalised sum (right)", front.membership_sum, "y2", colours.faint, "lines")];
    if (state.place < count) traces.push({ type: "scatter", mode: "markers", name: "selected", x: [x[state.place]],
      y: [front.membership[state.place]], hoverinfo: "skip",
      marker: { size: 18, symbol: "circle-open", color: colours.ink, line: { width: 2.5, color: colours.ink } } });
    return { data: traces, layout: layout(colours, { xaxis: { title: { text: label(0) } },
      yaxis: { title: { text: "membership" }, rangemode: "tozero" },
      yaxis2: { overlaying: "y", side: "right", rangemode: "tozero", showgrid: false, automargin: true, tickcolor: colours.line } }) };
  }

  const LABELS = { "mean-visible": "satellites", "mean-pdop": "PDOP", "p95-pdop": "PDOP", "max-pdop": "PDOP",
    "availability": "fraction", "longest-outage-s": "s", "coverage-4": "fraction", "gain-mean-pdop": "gain" };

  /** Measures of which less is better: their colours run the other way, so that light is good on every map. */
  const LESS_IS_BETTER = ["mean-pdop", "p95-pdop", "max-pdop", "longest-outage-s"];

  /** A range so many times as high as its low end has logarithmic colours. */
  const LOG_RATIO = 20;

  /** The colour of a value, its scale and the bar beside it, for a range of values. */
  function colouring(measure, range, colours) {
    const bar = { title: { text: LABELS[measure], side: "right" }, thickness: 12, outlinewidth: 0, tickcolor: colours.line };
    const scale = { colorscale: "Viridis", reversescale: LESS_IS_BETTER.includes(measure) };
    if (!range) return { shade: (value) => value, ends: [undefined, undefined], scale, bar };
    const [low, high] = range;
    if (low === high) return { shade: (value) => value, ends: [low - 0.01 * (Math.abs(high) || 1), high], scale, bar: { ...bar, tickvals: [high] } };
    if (!(low > 0 && high / low >= LOG_RATIO)) return { shade: (value) => value, ends: range, scale, bar };
    const decades = [...Array(Math.ceil(Math.log10(high / low)) + 2).keys()].map((n) => 10 ** (Math.floor(Math.log10(low)) + n));
    const ticks = decades.flatMap((decade) => [decade, 2 * decade, 5 * decade]).filter((tick) => tick >= low && tick <= high);
    return { shade: (value) => (value === null ? null : Math.log10(value)), ends: range.map(Math.log10), scale,
      bar: { ...bar, tickvals: ticks.map(Math.log10), ticktext: ticks.map((tick) => digits(tick, 3)) } };
  }

  /** The range of a measure over all maps of it that the page has. */
  function commonRange(measure) {
    let lo = Infinity, hi = -Infinity;
    for (const place of Core.withCuts) {
      for (const value of cutsOf(place).maps[measure]) {
        if (value === null) continue;
        lo = Math.min(lo, value);
        hi = Math.max(hi, value);
      }
    }
    return lo <= hi ? [lo, hi] : undefined;
  }

  /** The range of the values of one map. */
  function ownRange(values) {
    const present = values.filter((v) => v !== null);
    return present.length > 0 ? [Math.min(...present), Math.max(...present)] : undefined;
  }

  const coast = (() => {
    const x = [], y = [];
    for (const line of data.region?.coast ?? []) {
      for (let n = 0; n < line.length; n += 2) { x.push(line[n] / 100); y.push(line[n + 1] / 100); }
      x.push(null); y.push(null);
    }
    return { x, y };
  })();

  const border = (() => {
    const x = [], y = [];
    for (const line of data.region?.border ?? []) {
      for (let n = 0; n < line.length; n += 2) { x.push(line[n] / 100); y.push(line[n + 1] / 100); }
      x.push(null); y.push(null);
    }
    return { x, y };
  })();

  /** Most sites whose names are on a map. */
  const MOST_NAMES = 40;

  /** Sides of a site on which its name may be, the best first: across and down from its mark. */
  const SIDES = [["top center", 0, -1], ["bottom center", 0, 1], ["middle right", 1, 0], ["middle left", -1, 0]];

  /** On which side of its site each name goes so that none covers another; null for one that has no room. */
  function sidesOfNames(region, element) {
    const [south, north, west, east] = region.bounds;
    const shrunk = Math.max(0.1, Math.cos((south + north) / 2 * Math.PI / 180));
    // Pixels of a degree of longitude, without margins and colours.
    const { width, height } = element.getBoundingClientRect();
    const each = Math.min((width - 150) / (east - west), (height - 60) / (north - south) * shrunk);
    const taken = [];
    const isTaken = (box) => taken.some((other) => box[0] < other[2] && other[0] < box[2] && box[1] < other[3] && other[1] < box[3]);
    return region.name.map((name, n) => {
      if (name === "") return null;
      const x = region.longitude_deg[n] * each, y = -region.latitude_deg[n] / shrunk * each, half = 3 * name.length + 2;
      const box = ([, across, down]) => [x + across * (half + 8) - half, y + down * 14 - 7, x + across * (half + 8) + half, y + down * 14 + 7];
      const side = SIDES.find((side) => !isTaken(box(side)));
      if (!side) return null;
      taken.push(box(side));
      return side[0];
    });
  }

  /** Columns of the raster that shows cells of equal area. */
  const COLUMNS = 720;

  /** Cells in rows of different widths, on a raster of their rows and of many columns. */
  function raster(region, values) {
    const [, , west, east] = region.bounds;
    const first = region.row.reduce((a, b) => Math.min(a, b)), last = region.row.reduce((a, b) => Math.max(a, b));
    const rows = region.rows_deg.slice(first, last + 1);
    const column = (longitude) => Math.max(0, Math.min(COLUMNS, Math.round((longitude - west) / (east - west) * COLUMNS)));
    const z = rows.map(() => new Array(COLUMNS).fill(null));
    values.forEach((value, n) => {
      const row = region.row[n] - first, half = rows[row][2] / 2;
      z[row].fill(value, column(region.longitude_deg[n] - half), column(region.longitude_deg[n] + half));
    });
    const x = [...Array(COLUMNS + 1).keys()].map((n) => west + (east - west) * n / COLUMNS);
    return { x, y: [...rows.map((row) => row[0]), rows[rows.length - 1][1]], z };
  }

  /** Cells of a lattice between their edges; columns and rows without points stay empty. */
  function lattice(region, values) {
    const axis = (all, step) => {
      const low = all.reduce((a, b) => Math.min(a, b)), high = all.reduce((a, b) => Math.max(a, b));
      const place = (value) => Math.round((value - low) / step);
      const edges = [...Array(place(high) + 2).keys()].map((n) => low + (n - 0.5) * step);
      return { place, edges };
    };
    const rows = axis(region.latitude_deg, region.step_deg[0]), columns = axis(region.longitude_deg, region.step_deg[1]);
    const z = rows.edges.slice(1).map(() => new Array(columns.edges.length - 1).fill(null));
    values.forEach((value, n) => { z[rows.place(region.latitude_deg[n])][columns.place(region.longitude_deg[n])] = value; });
    return { x: columns.edges, y: rows.edges, z };
  }

  function map(measure) {
    return (colours) => {
      const region = data.region;
      const cuts = cutsOf(state.place);
      const values = cuts ? cuts.maps[measure] : region.latitude_deg.map(() => null);
      const range = document.getElementById("common-scale").checked ? commonRange(measure) : ownRange(values);
      const { shade, ends: [low, high], scale, bar } = colouring(measure, range, colours);
      /** Cells in their colours; the pointer shows their values. */
      const cells = ({ x, y, z }) => ({ type: "heatmap", x, y, z: z.map((row) => row.map(shade)), customdata: z, ...scale,
        zsmooth: false, colorbar: bar, zmin: low, zmax: high });
      const traces = [];
      const hasCells = region.step_deg || region.rows_deg.length > 0;
      if (region.rows_deg.length > 0) {
        traces.push({ ...cells(raster(region, values)), hovertemplate: "%{y:.2f}° N, %{x:.2f}° E<br>%{customdata:.5~g}<extra></extra>" });
      } else if (region.step_deg) {
        traces.push({ ...cells(lattice(region, values)), hovertemplate: "%{y}° N, %{x}° E<br>%{customdata:.5~g}<extra></extra>" });
      } else {
        const isNamed = region.name.length <= MOST_NAMES && region.name.some((name) => name !== "");
        const sides = isNamed ? sidesOfNames(region, document.getElementById("map-" + measure)) : [];
        traces.push({ type: "scatter", mode: isNamed ? "markers+text" : "markers", x: region.longitude_deg, y: region.latitude_deg,
          ...(isNamed && { texttemplate: "%{customdata}", customdata: region.name.map((name, n) => sides[n] ? plain(name) : ""),
            textposition: sides.map((side) => side ?? "top center"), textfont: { size: 10 } }),
          marker: { size: 12, color: values.map(shade), ...scale, colorbar: bar, cmin: low, cmax: high,
            line: { width: 1, color: colours.ink } },
          text: values.map((v, n) => (region.name[n] ? plain(region.name[n]) + "<br>" : "") + digits(v)), hovertemplate: "%{y}° N, %{x}° E<br>%{text}<extra></extra>" });
      }
      traces.push({ type: "scatter", mode: "lines", x: coast.x, y: coast.y, hoverinfo: "skip",
        line: { color: hasCells ? "rgba(0,0,0,0.75)" : colours.coast, width: 1 } });
      traces.push({ type: "scatter", mode: "lines", x: border.x, y: border.y, hoverinfo: "skip",
        line: { color: "rgba(0,0,0,0.9)", width: 2 } });
      const [south, north, west, east] = region.bounds;
      const square = 1 / Math.max(0.1, Math.cos((south + north) / 2 * Math.PI / 180));
      return { data: traces, layout: { ...layout(colours, {
        showlegend: false, margin: { l: 52, r: 8, t: 8, b: 44 },
        xaxis: { title: { text: "longitude (° E)" }, range: [west, east], constrain: "domain", showgrid: false },
        yaxis: { title: { text: "latitude (° N)" }, range: [south, north], scaleanchor: "x", scaleratio: square,
          constrain: "domain", showgrid: false } }), plot_bgcolor: colours.nothing } };
    };
  }

  function cdfVisible(colours) {
    const traces = compared(colours).map((one) => curve(one, { x: one.cuts.overTime["mean-visible"], y: data.levels,
      line: { ...one.line, shape: "vh" }, hovertemplate: "%{x:.4~g} or less for %{y:.1%} of the time<extra></extra>" }));
    return { data: traces, layout: layout(colours, { xaxis: { title: { text: "E<sub>g</sub>(N<sub>visible</sub>)" } },
      yaxis: { title: { text: "fraction of the time" }, range: [0, 1.02] } }) };
  }

  /** The distribution of a measure over the points. */
  function overPoints(measure, title) {
    return (colours) => {
      const traces = compared(colours).map((one) => curve(one, { x: one.cuts.overPoints[measure], y: data.levels,
        line: { ...one.line, shape: "vh" }, hovertemplate: "%{x:.5~g} or less at %{y:.1%} of the points<extra></extra>" }));
      return { data: traces, layout: layout(colours, { xaxis: { title: { text: title } },
        yaxis: { title: { text: "fraction of the points" }, range: [0, 1.02] } }) };
    };
  }

  /** How often so many satellites are in view, of the selected constellation. */
  function histogram(colours) {
    const cuts = cutsOf(state.place);
    const names = ["LEO", "GNSS", "LEO and GNSS"], colour = [colours.accent, colours.second, colours.third];
    const traces = (cuts?.histograms ?? []).map((shares, n) => ({ type: "bar", name: names[n], x: shares.map((_, k) => k), y: shares,
      marker: { color: colour[n] }, opacity: 0.75, width: 0.9, hovertemplate: "%{x} in view: %{y:.3%}<extra>" + names[n] + "</extra>" }))
      .filter((_, n) => n === 0 || data.region.has_gnss);
    return { data: traces, layout: layout(colours, { barmode: "overlay", xaxis: { title: { text: "satellites in view" } },
      yaxis: { title: { text: "fraction of points and instants" }, rangemode: "tozero" } }) };
  }

  const hours = unpack(data.region?.elapsed_h);

  /** The outages of the points that are out longest: a bar for each. */
  function timeline(colours) {
    const rows = cutsOf(state.place)?.timeline ?? [];
    const width = hours.length > 1 ? hours[1] - hours[0] : data.region.step_s / 3600;
    const x = [], y = [], base = [], text = [];
    rows.forEach(({ bits }, r) => {
      const bytes = atob(bits);
      const isOut = (n) => n < hours.length && ((bytes.charCodeAt(n >> 3) >> (n & 7)) & 1) === 1;
      for (let n = 0; n < hours.length; n++) {
        if (!isOut(n) || isOut(n - 1)) continue;
        let end = n;
        while (isOut(end)) end++;
        base.push(hours[n]); x.push((end - n) * width); y.push(r);
        text.push(digits(hours[n], 4) + " h to " + digits(hours[n] + (end - n) * width, 4) + " h");
      }
    });
    const shown = [{ type: "bar", orientation: "h", x, y, base, text, textposition: "none", width: 0.7, marker: { color: colours.second },
      hovertemplate: "out from %{text}<extra></extra>" }];
    const none = rows.length > 0 ? [] : [{ text: "no outage at any point", showarrow: false, xref: "paper", yref: "paper", x: 0.5, y: 0.5 }];
    const last = hours.length > 0 ? hours[hours.length - 1] + width : 1;
    return { data: shown, layout: layout(colours, { showlegend: false, annotations: none,
      xaxis: { title: { text: "time since the epoch (h)" }, range: [0, last] },
      yaxis: { tickvals: rows.map((_, r) => r), ticktext: rows.map((row) => plain(row.label)), range: [Math.max(rows.length, 1) - 0.5, -0.5], showgrid: false } }) };
  }

  function overTime(measure, title) {
    return (colours) => {
      const traces = compared(colours).map((one) => curve(one, { x: hours, y: one.cuts.series[measure],
        line: { ...one.line, dash: "solid", width: one.line.width - 1 }, hovertemplate: "%{y:.4~g} at %{x:.2f} h<extra></extra>" }));
      return { data: traces, layout: layout(colours, { xaxis: { title: { text: "time since the epoch (h)" } },
        yaxis: { title: { text: title } } }) };
    };
  }

  function tail(colours) {
    const larger = data.levels.map((level) => Math.max(1 - level, 1e-6));
    const last = data.levels.length - 1;
    const traces = compared(colours).filter((one) => one.cuts.pdop.length > 0).map((one) => curve(one, {
      x: one.cuts.pdop.slice(0, last), y: larger.slice(0, last), hovertemplate: "PDOP above %{x:.4~g}: fraction %{y:.2~g}<extra></extra>" }));
    const selected = cutsOf(state.place);
    const shapes = [], annotations = [];
    if (selected?.tail) {
      const [level, atRisk, cvar] = selected.tail;
      const upright = (x, text, dash, color, [xanchor, yanchor]) => {
        shapes.push({ type: "line", x0: x, x1: x, y0: 0, y1: 1, yref: "paper", line: { color, dash, width: 1.5 } });
        annotations.push({ x, y: yanchor === "top" ? 0.98 : 0.02, yref: "paper", text, showarrow: false, xanchor, yanchor,
          font: { size: 11, color } });
      };
      upright(atRisk, digits(100 * level) + " % quantile " + selected.tailShown[0] + " ", "dot", colours.soft, ["right", "bottom"]);
      upright(cvar, " CVaR of PDOP " + selected.tailShown[1], "dash", colours.second, ["left", "top"]);
    }
    return { data: traces, layout: layout(colours, { shapes, annotations, xaxis: { title: { text: "PDOP" } },
      yaxis: { title: { text: "fraction with a higher PDOP" }, type: "log", dtick: 1 } }) };
  }

  function convergence(colours) {
    const volume = data.history.some((record) => record.hypervolume !== null);
    const at = data.reference ? " at " + data.reference : "";
    const traces = [{ type: "scatter", mode: "lines+markers", x: data.history.map((r) => r.generation),
      y: data.history.map((r) => (volume ? r.hypervolume : r.front_size)), marker: { size: 5, color: colours.accent },
      line: { color: colours.accent }, text: data.history.map((r) => r.evaluations + " designs, front of " + r.front_size),
      hovertemplate: "generation %{x}: %{y:.6~g}<br>%{text}<extra></extra>" }];
    return { data: traces, layout: layout(colours, { showlegend: false, xaxis: { title: { text: "generation" } },
      yaxis: { title: { text: volume ? "hypervolume" + at : "designs on the front" } } }) };
  }

  /** The columns of the parallel coordinates: the variables, and the objectives that are none, that differ between designs. */
  const isVariable = (name) => front.variables.some(([variable]) => variable === name);
  const columns = [...front.variables,
    ...objectives.map((o, n) => [o.name, front.objectives[n]]).filter(([name]) => !isVariable(name))]
    .map(([name, values]) => {
      const present = values.filter((v) => v !== null);
      return { name, values, lo: Math.min(...present), hi: Math.max(...present) };
    }).filter((column) => (count > 1 ? column.lo < column.hi : column.lo <= column.hi));
  const MOST_LINES = 300;

  function parallel(colours) {
    const height = (column, n) => (column.values[n] === null ? null
      : column.hi > column.lo ? (column.values[n] - column.lo) / (column.hi - column.lo) : 0.5);
    const stride = Math.max(1, Math.ceil(count / MOST_LINES));
    const lines = (places) => {
      const x = [], y = [], customdata = [];
      for (const n of places) {
        columns.forEach((column, c) => { x.push(c); y.push(height(column, n)); customdata.push(n); });
        x.push(null); y.push(null); customdata.push(n);
      }
      return { x, y, customdata };
    };
    const hover = { hovertemplate: "%{text}<extra></extra>" };
    const all = lines(members.filter((n) => n % stride === 0));
    const one = lines(state.place < count ? [state.place] : []);
    const named = (l) => l.customdata.map((n, k) => plain(front.notation[n]) + (l.x[k] === null ? "" : "<br>"
      + plain(columns[l.x[k]].name) + " " + digits(columns[l.x[k]].values[n])));
    const traces = [
      { type: "scatter", mode: "lines", ...all, text: named(all), ...hover, line: { color: colours.faint, width: 1 } },
      { type: "scatter", mode: "lines+markers", ...one, text: named(one), ...hover, line: { color: colours.accent, width: 3 } },
    ];
    const ends = columns.flatMap((column, c) => [
      { x: c, y: 1.03, text: digits(column.hi, 4), yanchor: "bottom" },
      { x: c, y: -0.03, text: digits(column.lo, 4), yanchor: "top" },
    ]).map((a) => ({ ...a, showarrow: false, font: { size: 11, color: colours.soft } }));
    return { data: traces, layout: layout(colours, { showlegend: false, annotations: ends, margin: { l: 24, r: 24, t: 12, b: 70 },
      xaxis: { tickvals: columns.map((_, c) => c), ticktext: columns.map((column) => plain(column.name)), tickangle: 30, range: [-0.4, columns.length - 0.6] },
      yaxis: { showticklabels: false, ticks: "", range: [-0.15, 1.15], showgrid: false } }) };
  }

  function budget(colours) {
    const cases = data.budget.map((line) => plain(line.case));
    const bar = (name, axis, color) => ({ type: "bar", name, x: cases, y: data.budget.map((line) => line.rms_km[axis]),
      marker: { color }, hovertemplate: "%{y:.3~g} km<extra>" + name + "</extra>" });
    return { data: [bar("radial", 0, colours.accent), bar("in-track", 1, colours.second), bar("cross-track", 2, colours.third)],
      layout: layout(colours, { barmode: "group", xaxis: { type: "category" }, yaxis: { type: "log", title: { text: "RMS difference (km)" }, dtick: 1 } }) };
  }

  const clicked = (point) => { if (point.customdata !== undefined) select(point.customdata); };

  if (total > 0) {
    figure("pareto", { build: pareto, click: clicked });
    figure("membership", { build: membership, click: clicked });
    figure("parallel", { build: parallel, click: clicked });
    if (data.region) {
      for (const measure of Object.keys(LABELS)) figure("map-" + measure, { build: map(measure) });
      figure("cdf-visible", { build: cdfVisible });
      figure("series-max-pdop", { build: overTime("max-pdop", "maximum PDOP over the points") });
      figure("series-mean-pdop", { build: overTime("mean-pdop", "E<sub>g</sub>(PDOP)") });
      figure("tail", { build: tail });
      figure("series-availability", { build: overTime("availability", "fraction of the points that are available") });
      figure("histogram", { build: histogram });
      figure("timeline", { build: timeline });
      figure("cdf-availability", { build: overPoints("availability", "availability (fraction of the time)") });
      figure("cdf-longest-outage-s", { build: overPoints("longest-outage-s", "longest outage (s)") });
      figure("cdf-coverage-4", { build: overPoints("coverage-4", "fraction of the time with at least 4 LEO satellites") });
      figure("cdf-gain-mean-pdop", { build: overPoints("gain-mean-pdop", "gain in mean PDOP") });
    }
  }
  if (data.history.length > 0) figure("convergence", { build: convergence, follows: false });
  if (data.budget.length > 0) figure("budget", { build: budget, follows: false });

  // A front that others would squash is shown close up.
  const closeUp = document.getElementById("close-up");
  if (closeUp) {
    const extent = (values) => Math.max(...values) - Math.min(...values);
    const isSquashed = (n) => n !== null && count > 1
      && extent(alongAxis(n).slice(0, count).filter((v) => v !== null)) < 0.4 * extent(alongAxis(n).filter((v) => v !== null));
    closeUp.checked = isSquashed(shown.x) || isSquashed(shown.y);
    closeUp.addEventListener("change", () => Core.refresh(true));
  }

  const axes = document.getElementById("axes");
  // With several shells, the reader chooses the one that gives the colours.
  if (axes && front.shells.length > 0) {
    axes.hidden = false;
    const chooser = document.createElement("select");
    chooser.id = "colour";
    front.shells.forEach(([letter], n) => chooser.add(new Option("satellites of shell " + letter, n, false, n === shown.shell)));
    chooser.add(new Option("none", "", false, false));
    chooser.addEventListener("change", () => { shown.shell = chooser.value === "" ? null : Number(chooser.value); Core.refresh(true); });
    const text = document.createElement("label");
    text.append("colour ", chooser);
    axes.append(text);
  }
  // With more than two objectives, the reader chooses the two axes.
  if (axes && objectives.length > 2) {
    axes.hidden = false;
    for (const axis of ["x", "y"]) {
      const chooser = document.createElement("select");
      objectives.forEach((o, n) => chooser.add(new Option(o.label, n, false, n === shown[axis])));
      chooser.addEventListener("change", () => { shown[axis] = Number(chooser.value); Core.refresh(true); });
      const text = document.createElement("label");
      text.append(axis === "x" ? "x axis " : "y axis ", chooser);
      axes.append(text);
    }
  }
})();

// Maps of the region: cells in colours, or sites, with coasts and borders.
const Maps = (() => {
  const { data, state, cutsOf, plain, digits, layout } = Core;

  const LABELS = { "mean-visible": "satellites", "mean-pdop": "PDOP", "p95-pdop": "PDOP", "max-pdop": "PDOP",
    "availability": "fraction", "longest-outage-s": "s", "coverage-4": "fraction", "gain-mean-pdop": "gain" };

  /** Measures of which less is better: their colours run the other way, so that light is good on every map. */
  const LESS_IS_BETTER = ["mean-pdop", "p95-pdop", "max-pdop", "longest-outage-s"];

  /** A range so many times as high as its low end has logarithmic colours. */
  const LOG_RATIO = 20;

  /** The colour of a value, its scale and the bar beside it, for a range of values. */
  function colouring({ label, lessIsBetter, range }, colours) {
    const bar = { title: { text: label, side: "right" }, thickness: 12, outlinewidth: 0, tickcolor: colours.line };
    const scale = { colorscale: "Viridis", reversescale: lessIsBetter };
    if (!range) return { shade: (value) => value, ends: [undefined, undefined], scale, bar };
    const [low, high] = range;
    if (low === high) return { shade: (value) => value, ends: [low - 0.01 * (Math.abs(high) || 1), high], scale, bar: { ...bar, tickvals: [high] } };
    if (!(low > 0 && high / low >= LOG_RATIO)) return { shade: (value) => value, ends: range, scale, bar };
    const decades = [...Array(Math.ceil(Math.log10(high / low)) + 2).keys()].map((n) => 10 ** (Math.floor(Math.log10(low)) + n));
    const ticks = decades.flatMap((decade) => [decade, 2 * decade, 5 * decade]).filter((tick) => tick >= low && tick <= high);
    return { shade: (value) => (value === null ? null : Math.log10(value)), ends: range.map(Math.log10), scale,
      bar: { ...bar, tickvals: ticks.map(Math.log10), ticktext: ticks.map((tick) => digits(tick, 3)) } };
  }

  /** The range of the values of some maps; undefined if there are none. */
  function rangeOf(maps) {
    let lo = Infinity, hi = -Infinity;
    for (const values of maps) {
      for (const value of values) {
        if (value === null) continue;
        lo = Math.min(lo, value);
        hi = Math.max(hi, value);
      }
    }
    return lo <= hi ? [lo, hi] : undefined;
  }

  /** Whether all maps of a kind have one scale of colours. */
  const isCommon = () => document.getElementById("common-scale").checked;

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
  function sidesOfNames(region, id) {
    const [south, north, west, east] = region.bounds;
    const shrunk = Math.max(0.1, Math.cos((south + north) / 2 * Math.PI / 180));
    // Pixels of a degree of longitude, without margins and colours.
    const { width, height } = document.getElementById(id).getBoundingClientRect();
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

  /** The map of a measure over the whole span. */
  function measure(name) {
    const every = () => Core.withCuts.map((place) => cutsOf(place).maps[name]);
    return (colours) => {
      const values = cutsOf(state.place)?.maps[name] ?? data.region.latitude_deg.map(() => null);
      return drawn({ id: "map-" + name, values, label: LABELS[name], lessIsBetter: LESS_IS_BETTER.includes(name),
        range: rangeOf(isCommon() ? every() : [values]) }, colours);
    };
  }

  /** A map of some values, point by point, for the element of this id. */
  function drawn(shown, colours) {
    const { region } = data, { values } = shown;
    const { shade, ends: [low, high], scale, bar } = colouring(shown, colours);
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
      const sides = isNamed ? sidesOfNames(region, shown.id) : [];
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
  }

  return { MEASURES: Object.keys(LABELS), measure, drawn, rangeOf, isCommon };
})();

"use strict";
// The numbers of the page, the selected design, and figures that are drawn when they scroll into view.
const Core = (() => {
  const data = JSON.parse(document.getElementById("data").textContent);

  // What is fixed in a search is on the globe with every member of the front.
  if (data.fixed_tracks) for (const cuts of Object.values(data.cuts)) cuts.tracks = data.fixed_tracks;

  const MISSING = 65535;

  /** The numbers of a packed row; null where there is none. */
  function unpack(row) {
    if (!row) return [];
    const text = atob(row.codes);
    const step = (row.hi - row.lo) / (MISSING - 1);
    const values = new Array(text.length / 2);
    for (let n = 0; n < values.length; n++) {
      const code = text.charCodeAt(2 * n) | (text.charCodeAt(2 * n + 1) << 8);
      values[n] = code === MISSING ? null : row.lo + step * code;
    }
    return values;
  }

  const unpacked = new Map();

  /** The cuts of a design with their rows unpacked; undefined when the page has none. */
  function open(cuts) {
    if (!cuts) return undefined;
    if (!unpacked.has(cuts)) {
      const rows = (pairs) => Object.fromEntries(pairs.map(([name, row]) => [name, unpack(row)]));
      unpacked.set(cuts, {
        maps: rows(cuts.maps),
        series: rows(cuts.series),
        overTime: rows(cuts.over_time),
        overPoints: rows(cuts.over_points),
        histograms: cuts.histograms.map(unpack),
        timeline: cuts.timeline,
        pdop: unpack(cuts.pdop),
        tail: cuts.tail,
        tailShown: cuts.tail_shown,
        orbits: cuts.orbits.map((orbit) => ({ ...orbit, meanAnomalyDeg: unpack(orbit.mean_anomaly_deg) })),
        instants: cuts.instants && { visible: unpack(cuts.instants.visible).map((value) => Math.round(value)),
          pdop: unpack(cuts.instants.pdop) },
        tracks: cuts.tracks && { ...cuts.tracks, positionsKm: unpack(cuts.tracks.positions_km) },
      });
    }
    return unpacked.get(cuts);
  }

  // What can be selected: the members of the front, then the constellations compared with them.
  const count = data.front.index.length;
  const compared = data.baselines;
  const total = count + compared.length;
  const cutsOf = (place) => open(place < count ? data.cuts[place] : compared[place - count]?.cuts);
  const notationOf = (place) => (place < count ? data.front.notation[place] : compared[place - count].notation);
  const nameOf = (place) => (place < count ? data.front.notation[place] : compared[place - count].name);
  const withCuts = [...Array(total).keys()].filter((place) => place >= count ? compared[place - count].cuts : data.cuts[place]);
  const first = data.chosen ?? withCuts[0] ?? 0;
  const listeners = [];
  const state = { place: total > 0 ? first : null };

  // Colour and mark of a compared constellation. Beside a front, its two colours are not used again. The numbers
  // of colours and marks have no common divisor, so that few have the same of both.
  const COLOURS = ["c0", "c1", "c2", "c3", "c4", "c5", "c6"].slice(count > 0 ? 2 : 0);
  const MARKS = [
    ["diamond", "M0-9 9 0 0 9-9 0Z"],
    ["square", "M-7-7H7V7H-7Z"],
    ["triangle-up", "M0-8 9 7H-9Z"],
    ["cross", "M-3-9H3V-3H9V3H3V9H-3V3H-9V-3H-3Z"],
    ["triangle-down", "M0 8 9-7H-9Z"],
    ["star", "M0-10 2.6-3.2 9.5-3.1 4.2 1.2 5.9 8.1 0 4.3-5.9 8.1-4.2 1.2-9.5-3.1-2.6-3.2Z"],
  ];

  /** The name of the colour, the symbol and its outline of a compared constellation. */
  function mark(place) {
    const n = place - count;
    const [symbol, path] = MARKS[n % MARKS.length];
    return { colour: COLOURS[n % COLOURS.length], symbol, path };
  }

  /** Selects the design or constellation at a place; everything that depends on it follows. */
  function select(place) {
    if (!(place >= 0 && place < total)) return;
    state.place = place;
    for (const listener of listeners) listener(place);
  }

  /** Text from a file, escaped because Plotly interprets a few HTML tags. */
  function plain(text) {
    return String(text).replace(/[&<>]/g, (c) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;" })[c]);
  }

  /** A number as text, with the six digits that the page holds: rounded only once. */
  function digits(value, significant = 6) {
    if (value === null || value === undefined) return "none";
    return String(Number(value.toPrecision(significant)));
  }

  /** The colours of the current theme. */
  function theme() {
    const style = getComputedStyle(document.documentElement);
    const names = ["paper", "ink", "soft", "line", "panel", "accent", "second", "third", "faint",
      "land", "sea", "coast", "nothing", "c0", "c1", "c2", "c3", "c4", "c5", "c6"];
    return Object.fromEntries(names.map((n) => [n, style.getPropertyValue("--" + n).trim()]));
  }

  const figures = new Map();
  const CONFIG = { displaylogo: false, responsive: true, displayModeBar: matchMedia("(hover: hover)").matches ? "hover" : false,
    modeBarButtonsToRemove: ["toImage", "select2d", "lasso2d", "autoScale2d"] };
  const SAVED = { svg: "SVG", png: "PNG" };

  /** Buttons in the caption of a figure that save it: as vectors, or in four times the pixels of the screen. */
  function offerToSave(figure) {
    const { element } = figure;
    const caption = element.parentElement.querySelector("figcaption");
    for (const [format, name] of Object.entries(SAVED)) {
      const button = document.createElement("button");
      button.type = "button";
      button.className = "save";
      button.textContent = name;
      button.setAttribute("aria-label", "save " + element.id + " as " + name);
      button.addEventListener("click", async () => {
        if (!figure.drawn) await draw(figure);
        const { width, height } = element.getBoundingClientRect();
        Plotly.downloadImage(element, { format, width, height, scale: format === "png" ? 4 : 1, filename: element.id });
      });
      caption?.append(" ", button);
    }
  }

  function draw(figure) {
    const { data: traces, layout } = figure.build(theme());
    const done = Plotly.react(figure.element, traces, layout, CONFIG);
    if (!figure.drawn) {
      figure.drawn = true;
      if (figure.click) {
        done.then(() => figure.element.on("plotly_click", (event) => figure.click(event.points[0])));
      }
    }
    return done;
  }

  const seen = new IntersectionObserver((entries) => {
    for (const entry of entries) {
      const figure = figures.get(entry.target.id);
      if (entry.isIntersecting && figure && !figure.drawn) draw(figure);
    }
  }, { rootMargin: "200px" });

  /** A figure: `build` gives its traces and layout, `click` handles a clicked point. */
  function figure(id, { build, click, follows = true }) {
    const element = document.getElementById(id);
    if (!element) return;
    const made = { element, build, click, follows, drawn: false };
    figures.set(id, made);
    offerToSave(made);
    seen.observe(element);
  }

  /** Redraws the figures drawn so far. */
  function refresh(onlyFollowing) {
    for (const figure of figures.values()) {
      if (figure.drawn && (figure.follows || !onlyFollowing)) draw(figure);
    }
  }

  /** Redraws some figures, those of them that are drawn. */
  function redraw(...ids) {
    for (const figure of ids.map((id) => figures.get(id))) if (figure.drawn) draw(figure);
  }

  listeners.push(() => refresh(true));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => refresh(false));
  // Print uses the light colours, and draws figures that have not been scrolled to.
  // A sheet is narrower than the window, but figures do not notice: each gets half the width of a sheet.
  const SHEET = { width: 345, height: 310 };
  let printing = false;
  function print(begins) {
    printing = begins;
    document.documentElement.classList.toggle("printing", begins);
    for (const f of figures.values()) if (begins || f.drawn) draw(f);
  }
  addEventListener("beforeprint", () => print(true));
  addEventListener("afterprint", () => print(false));

  /** The layout that all figures share. */
  function layout(colours, more) {
    const axis = { gridcolor: colours.line, zeroline: false, linecolor: colours.soft, automargin: true,
      ticks: "outside", tickcolor: colours.line, exponentformat: "power" };
    return {
      paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)",
      font: { family: "system-ui, sans-serif", size: 12, color: colours.ink },
      margin: { l: 58, r: 16, t: 12, b: 48 }, hovermode: "closest", showlegend: true,
      legend: { orientation: "h", y: 1.02, yanchor: "bottom", x: 0 },
      modebar: { bgcolor: "rgba(0,0,0,0)", color: colours.faint, activecolor: colours.ink, orientation: "v" },
      ...(printing ? SHEET : { autosize: true }),
      ...more,
      xaxis: { ...axis, ...more.xaxis }, yaxis: { ...axis, ...more.yaxis },
    };
  }

  return { data, state, count, total, listeners, withCuts, select, cutsOf, notationOf, nameOf, mark, unpack, plain, digits, theme, figure,
    refresh, redraw, layout };
})();

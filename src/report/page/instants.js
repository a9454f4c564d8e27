// The maps at an instant, which a slider chooses.
(() => {
  const { data, state, withCuts, cutsOf, nameOf, figure, redraw, listeners } = Core;
  const slider = document.getElementById("instant");
  if (!slider || !data.region || !data.world || data.instants_s.length === 0) return;

  const MAPS = {
    "instant-visible": { measure: "visible", label: "satellites", lessIsBetter: false },
    "instant-pdop": { measure: "pdop", label: "PDOP", lessIsBetter: true },
  };
  const points = data.region.latitude_deg.length;
  const at = (values, n) => values.slice(n * points, (n + 1) * points);
  const shown = () => Number(slider.value);
  const hasInstants = (place) => Boolean(cutsOf(place)?.instants);

  const ranges = new Map();
  /** The range over all instants of all constellations that have them, found once. */
  function common(measure) {
    if (!ranges.has(measure)) {
      ranges.set(measure, Maps.rangeOf(withCuts.filter(hasInstants).map((place) => cutsOf(place).instants[measure])));
    }
    return ranges.get(measure);
  }

  const build = (id, { measure, label, lessIsBetter }) => (colours) => {
    const all = cutsOf(state.place)?.instants?.[measure];
    const values = all ? at(all, shown()) : data.region.latitude_deg.map(() => null);
    return Maps.drawn({ id, values, label, lessIsBetter, range: Maps.isCommon() ? common(measure) : Maps.rangeOf([values]) }, colours);
  };
  for (const [id, map] of Object.entries(MAPS)) figure(id, { build: build(id, map) });

  /** Says the instant, to those who hear the page as well. */
  function tell() {
    const elapsed_s = data.instants_s[shown()];
    const text = Globe.utc(elapsed_s) + ", " + Core.digits(elapsed_s / 3600, 4) + " h after the epoch";
    document.getElementById("instant-time").textContent = text;
    slider.setAttribute("aria-valuetext", text);
  }

  /** The maps of a constellation without instants are left out. */
  function follow(place) {
    const has = hasInstants(place);
    document.getElementById("instant-maps").hidden = !has;
    const missing = document.getElementById("no-instants");
    missing.hidden = has;
    missing.textContent = "This page has maps at instants of " + withCuts.filter(hasInstants).map(nameOf).join(", ") + " alone.";
  }

  let isWaiting = false;
  slider.addEventListener("input", () => {
    tell();
    if (isWaiting) return;
    // A slider moves faster than maps are drawn.
    isWaiting = true;
    requestAnimationFrame(() => { isWaiting = false; redraw(...Object.keys(MAPS)); });
  });
  slider.max = String(data.instants_s.length - 1);
  slider.value = "0";
  document.getElementById("instants").hidden = false;
  listeners.push(follow);
  follow(state.place);
  tell();
})();

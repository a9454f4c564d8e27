// The bar of the selected design, and the other controls.
(() => {
  const { data, state, count, total, mark, select } = Core;
  const front = data.front;
  const choose = document.getElementById("choose");

  function tile(name, value) {
    const box = document.createElement("div");
    const term = document.createElement("dt"), number = document.createElement("dd");
    term.textContent = name;
    number.textContent = value;
    box.append(term, number);
    return box;
  }

  /** The mark of a compared constellation; none for a member of the front. */
  function picture(place) {
    if (place < count) return [];
    const SVG = "http://www.w3.org/2000/svg";
    const { colour, path } = mark(place);
    const svg = document.createElementNS(SVG, "svg"), outline = document.createElementNS(SVG, "path");
    svg.setAttribute("viewBox", "-10 -10 20 20");
    svg.setAttribute("aria-hidden", "true");
    outline.setAttribute("d", path);
    outline.style.fill = "var(--" + colour + ")";
    svg.append(outline);
    return [svg];
  }

  function show(place) {
    choose.value = String(place);
    document.getElementById("badge").hidden = place !== data.chosen;
    document.getElementById("no-cuts").hidden = data.region === null || Core.withCuts.includes(place);
    document.getElementById("mark").replaceChildren(...picture(place));
    const text = (values, n) => (place < count ? values[place] : data.baselines[place - count].tiles[n]);
    const tiles = front.tiles.map(([name, values], n) => tile(name, text(values, n)));
    document.getElementById("tiles").replaceChildren(...tiles);
    for (const row of document.querySelectorAll("tr[data-place]")) {
      row.classList.toggle("current", Number(row.dataset.place) === place);
    }
  }

  /** The options of a list, under a heading if there are two lists. */
  function offer(heading, options) {
    if (count === 0 || total === count) return options.forEach((option) => choose.add(option));
    const group = document.createElement("optgroup");
    group.label = heading;
    group.append(...options);
    choose.append(group);
  }

  if (total > 0) {
    offer("front", front.notation.map((notation, n) => new Option(front.index[n] + ": " + notation, n)));
    offer("compared", data.baselines.map((one, n) => new Option(one.name === one.notation ? one.name
      : one.name + ": " + one.notation, count + n)));
    for (const place of document.querySelectorAll("#compared .mark")) {
      place.replaceChildren(...picture(Number(place.dataset.place)));
    }
    choose.addEventListener("change", () => select(Number(choose.value)));
    document.getElementById("previous").addEventListener("click", () => select(state.place - 1));
    document.getElementById("next").addEventListener("click", () => select(state.place + 1));
    document.getElementById("common-scale").addEventListener("change", () => Core.refresh(true));
    for (const button of document.querySelectorAll("button.pick")) {
      button.addEventListener("click", () => select(Number(button.dataset.place)));
    }
    Core.listeners.push(show);
    show(state.place);
    if (data.region) {
      if (!data.region.has_gnss) {
        for (const id of ["map-gain-mean-pdop", "cdf-gain-mean-pdop"]) document.getElementById(id).closest("figure").hidden = true;
      }
      document.getElementById("unseen").textContent = "An outage is a run of samples of a point that are unsolved or above a PDOP of "
        + data.region.availability_pdop + ". What is shorter than a step of " + data.region.step_s + " s is unseen.";
      document.getElementById("availability-caption").textContent =
        "Availability: fraction of the time with PDOP at most " + data.region.availability_pdop + ".";
    } else {
      document.getElementById("maps").hidden = true;
      document.getElementById("curves").hidden = true;
      document.getElementById("outages").hidden = true;
    }
  }
  const search = document.getElementById("search");
  if (search && data.history.length === 0) document.getElementById("convergence").closest("figure").hidden = true;
  if (search && data.history.length === 0 && count === 0) search.hidden = true;
  if (data.budget.length === 0) document.getElementById("budget")?.closest("figure").remove();

  // For tests of the page.
  window.navwalker = { select, state, frames: Globe.frames, sky: Globe.sky };
})();

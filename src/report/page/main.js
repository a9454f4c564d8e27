// The bar of the selected design, and the other controls.
(() => {
  const { data, state, count, select } = Core;
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

  function show(place) {
    choose.value = String(place);
    document.getElementById("badge").hidden = place !== data.chosen;
    document.getElementById("no-cuts").hidden = data.region === null || data.cuts[place] !== undefined;
    const tiles = front.tiles.map(([name, values]) => tile(name, values[place]));
    document.getElementById("tiles").replaceChildren(...tiles);
    for (const row of document.querySelectorAll("#members tr[data-place]")) {
      row.classList.toggle("current", Number(row.dataset.place) === place);
    }
  }

  if (count > 0) {
    front.notation.forEach((notation, n) => choose.add(new Option(front.index[n] + ": " + notation, n)));
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
      document.getElementById("availability-caption").textContent =
        "Availability: fraction of the time with PDOP at most " + data.region.availability_pdop + ".";
    } else {
      document.getElementById("maps").hidden = true;
      document.getElementById("curves").hidden = true;
    }
  }
  if (data.history.length === 0) document.getElementById("convergence").closest("figure").hidden = true;
  if (data.history.length === 0 && count === 0) document.getElementById("search").hidden = true;
  if (data.budget.length === 0) document.getElementById("budget")?.closest("figure").remove();

  // For tests of the page.
  window.navwalker = { select, state, frames: Globe.frames, sky: Globe.sky };
})();

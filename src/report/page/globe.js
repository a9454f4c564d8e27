// The constellation over a rotating Earth, and the sky above a place.
const Globe = (() => {
  const { data, state, cutsOf, digits, theme } = Core;
  const world = data.world;
  const globe = document.getElementById("globe");
  if (!globe || !world) {
    for (const id of ["constellation"]) { const e = document.getElementById(id); if (e) e.hidden = true; }
    return { frames: () => [], sky: () => [], look: () => {} };
  }
  const sky = document.getElementById("sky");
  const RAD = Math.PI / 180;
  const REVOLUTION = 72;
  const circle = [...Array(REVOLUTION + 1).keys()].map((n) => {
    const angle = 2 * Math.PI * n / REVOLUTION;
    return [Math.cos(angle), Math.sin(angle)];
  });
  /** Simulated seconds per second of real time. */
  const SPEEDS = [10, 60, 240, 600, 1800];

  const view = { longitude: 0, latitude: 20 * RAD };
  const time = { elapsed: 0, playing: !matchMedia("(prefers-reduced-motion: reduce)").matches, speed: SPEEDS[2] };
  const place = { latitude: 0, longitude: 0, name: "", site: -1 };
  const frames = [];
  let colours = theme();
  let visibleNow = false;
  /** The satellites that the sky plot shows. */
  let drawn = [];

  /** Earth-fixed unit vector. */
  const unit = (latitude, longitude) => [Math.cos(latitude) * Math.cos(longitude),
    Math.cos(latitude) * Math.sin(longitude), Math.sin(latitude)];

  // Coasts and region, in units of the Earth's radius.
  const polyline = (flat) => {
    const points = new Float64Array(flat.length / 2 * 3);
    for (let n = 0; n < flat.length / 2; n++) {
      points.set(unit(flat[2 * n + 1] / 100 * RAD, flat[2 * n] / 100 * RAD), 3 * n);
    }
    return points;
  };
  const coasts = world.coast.map(polyline);
  /** A line straight in longitude and latitude, in steps of at most two degrees. */
  const dense = (flat) => {
    const steps = [];
    for (let n = 0; n + 3 < flat.length; n += 2) {
      const [x0, y0, x1, y1] = flat.slice(n, n + 4);
      const count = Math.max(1, Math.ceil(Math.hypot(x1 - x0, y1 - y0) / 200));
      for (let k = n === 0 ? 0 : 1; k <= count; k++) steps.push(x0 + (x1 - x0) * k / count, y0 + (y1 - y0) * k / count);
    }
    return steps;
  };
  const region = (() => {
    const r = data.region;
    if (!r) return [];
    const [south, north, west, east] = r.bounds;
    const edge = [];
    const STEPS = 24;
    const walk = (a, b, c, d) => {
      for (let n = 0; n <= STEPS; n++) edge.push(100 * (a + (b - a) * n / STEPS), 100 * (c + (d - c) * n / STEPS));
    };
    if (r.is_rectangle && east - west < 359) {
      walk(west, east, south, south); walk(east, east, south, north);
      walk(east, west, north, north); walk(west, west, north, south);
    }
    place.latitude = (south + north) / 2 * RAD;
    place.longitude = (west + east) / 2 * RAD;
    // A list has no middle: its first site.
    if (!r.step_deg && r.rows_deg.length === 0) {
      place.latitude = r.latitude_deg[0] * RAD;
      place.longitude = r.longitude_deg[0] * RAD;
      place.name = r.name[0];
      place.site = 0;
    }
    view.longitude = place.longitude;
    view.latitude = Math.max(-1.2, Math.min(1.2, place.latitude));
    return edge.length > 0 ? [polyline(edge)] : r.border.map((line) => polyline(dense(line)));
  })();

  const MOST_MARKS = 500;
  const marks = (() => {
    const r = data.region;
    if (!r || r.step_deg || r.rows_deg.length > 0 || r.latitude_deg.length > MOST_MARKS) return [];
    return r.latitude_deg.map((latitude, n) => unit(latitude * RAD, r.longitude_deg[n] * RAD));
  })();

  /** Rows of the rotation from Earth-fixed to the screen: right, up, towards the reader. */
  function screenAxes() {
    const { longitude: l, latitude: b } = view;
    return [[-Math.sin(l), Math.cos(l), 0],
      [-Math.sin(b) * Math.cos(l), -Math.sin(b) * Math.sin(l), Math.cos(b)],
      [Math.cos(b) * Math.cos(l), Math.cos(b) * Math.sin(l), Math.sin(b)]];
  }

  /** The eccentric anomaly: a few steps of Newton's method are enough to draw. */
  function eccentricAnomaly(mean, e) {
    if (e === 0) return mean;
    let anomaly = mean + e * Math.sin(mean);
    for (let n = 0; n < 5; n++) anomaly -= (anomaly - e * Math.sin(anomaly) - mean) / (1 - e * Math.cos(anomaly));
    return anomaly;
  }

  /** Axes of each plane's ellipse at an instant, Earth-fixed, in radii of the Earth. */
  function planes(orbit, elapsed) {
    const [nodeRate, perigeeRate] = orbit.rates_deg_s;
    const a = orbit.semi_major_axis_km / world.radius_km;
    const b = a * Math.sqrt(1 - orbit.eccentricity ** 2);
    const w = (orbit.arg_perigee_deg + perigeeRate * elapsed) * RAD;
    const gmst = world.gmst_deg + world.gmst_rate_deg_s * elapsed;
    const ci = Math.cos(orbit.inclination_deg * RAD), si = Math.sin(orbit.inclination_deg * RAD);
    const cw = Math.cos(w), sw = Math.sin(w);
    return orbit.raan_deg.map((raan) => {
      const node = (raan + nodeRate * elapsed - gmst) * RAD;
      const cn = Math.cos(node), sn = Math.sin(node);
      const p = [cn, sn, 0], q = [-sn * ci, cn * ci, si];
      return { x: [0, 1, 2].map((k) => a * (cw * p[k] + sw * q[k])), y: [0, 1, 2].map((k) => b * (cw * q[k] - sw * p[k])) };
    });
  }

  /** Earth-fixed positions of the satellites of a shell, three numbers each, in radii of the Earth. */
  function positions(orbit, axes, elapsed) {
    const e = orbit.eccentricity;
    const advance = orbit.rates_deg_s[2] * elapsed;
    const found = new Float64Array(3 * orbit.meanAnomalyDeg.length);
    orbit.meanAnomalyDeg.forEach((mean, n) => {
      const { x, y } = axes[Math.floor(n / orbit.per_plane)];
      const anomaly = eccentricAnomaly((mean + advance) * RAD % (2 * Math.PI), e);
      const c = Math.cos(anomaly) - e, s = Math.sin(anomaly);
      for (let k = 0; k < 3; k++) found[3 * n + k] = c * x[k] + s * y[k];
    });
    return found;
  }

  /** Weights of the cubic through four samples at -1, 0, 1 and 2. */
  const cubic = (t) => [-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2, -(t + 1) * t * (t - 2) / 2,
    (t + 1) * t * (t - 1) / 6];

  /** Earth-fixed positions of sampled satellites, as for a shell; those in a gap are left out. */
  function sampled(tracks, elapsed) {
    const { instants, positionsKm: km } = tracks;
    const gmst = (world.gmst_deg + world.gmst_rate_deg_s * elapsed) * RAD;
    const c = Math.cos(gmst) / world.radius_km, s = Math.sin(gmst) / world.radius_km;
    const first = Math.max(0, Math.min(instants - 4, Math.floor(elapsed / tracks.step_s) - 1));
    const weights = instants < 4 ? [1] : cubic(elapsed / tracks.step_s - first - 1);
    const found = [];
    for (let n = 0; n < km.length; n += 3 * instants) {
      const at = [0, 0, 0];
      const isWhole = weights.every((weight, k) => [0, 1, 2].every((axis) => {
        const value = km[n + 3 * (first + k) + axis];
        at[axis] += weight * value;
        return value !== null;
      }));
      if (isWhole) found.push(c * at[0] + s * at[1], c * at[1] - s * at[0], at[2] / world.radius_km);
    }
    return found;
  }

  /** Position and axes of the place: east, north, up by its vertical. */
  function site() {
    const { latitude: b, longitude: l } = place;
    const e2 = world.flattening * (2 - world.flattening);
    const normal = 1 / Math.sqrt(1 - e2 * Math.sin(b) ** 2);
    const up = unit(b, l);
    return { position: [normal * up[0], normal * up[1], normal * (1 - e2) * up[2]], up,
      east: [-Math.sin(l), Math.cos(l), 0],
      north: [-Math.sin(b) * Math.cos(l), -Math.sin(b) * Math.sin(l), Math.cos(b)] };
  }

  /** The skyline of the place: that of all points, or that of the site; empty if none is known. */
  const skylineHere = () => (world.skyline_of.length === 0 ? world.skylines_deg[0] : world.skylines_deg[world.skyline_of[place.site]]) || [];

  /** Elevation of the skyline at an azimuth, linear between its points, degrees; 0 without one. */
  function skyline(azimuth) {
    const points = skylineHere();
    const n = points.findIndex((point) => point[0] > azimuth);
    if (points.length === 0) return 0;
    if (n < 0) return points[points.length - 1][1];
    const [[a0, e0], [a1, e1]] = [points[n - 1], points[n]];
    return e0 + (e1 - e0) * (azimuth - a0) / (a1 - a0);
  }

  /** The lowest elevation at which a satellite counts: its mask or the skyline, degrees. */
  const lowest = (mask, azimuth) => Math.max(mask, skyline(azimuth));

  /** Azimuth and elevation of the satellites over the horizon of the place, radians. */
  function overhead(found) {
    const { position, up, east, north } = site();
    const seen = [];
    for (let n = 0; n < found.length / 3; n++) {
      const d = [0, 1, 2].map((k) => found[3 * n + k] - position[k]);
      const along = (axis) => d[0] * axis[0] + d[1] * axis[1] + d[2] * axis[2];
      const height = along(up);
      if (height <= 0) continue;
      const elevation = Math.asin(height / Math.hypot(...d));
      const azimuth = Math.atan2(along(east), along(north));
      const degrees = (azimuth / RAD + 360) % 360;
      seen.push({ n, elevation, azimuth, visible: elevation >= lowest(world.mask_deg, degrees) * RAD });
    }
    return seen;
  }

  /** Fits a canvas to its place on the page; gives its context in CSS pixels. */
  function fitted(canvas) {
    const ratio = Math.min(2, devicePixelRatio || 1);
    const width = canvas.clientWidth, height = canvas.clientHeight;
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(height * ratio);
    }
    const context = canvas.getContext("2d");
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    return { context, width, height };
  }

  let size = { x: 0, y: 0, radius: 1 };

  function drawGlobe(orbits, axes, found, groups, seen) {
    const { context: c, width, height } = fitted(globe);
    let reach = Math.max(1.1, ...orbits.map((o) => o.semi_major_axis_km * (1 + o.eccentricity) / world.radius_km));
    for (let n = orbits.reduce((sum, o) => sum + 3 * o.meanAnomalyDeg.length, 0); n < found.length; n += 3) {
      reach = Math.max(reach, Math.hypot(found[n], found[n + 1], found[n + 2]));
    }
    const radius = 0.47 * Math.min(width, height) / Math.min(reach, 3);
    size = { x: width / 2, y: height / 2, radius };
    const [right, upward, towards] = screenAxes();
    const project = (v, n) => [
      size.x + radius * (right[0] * v[n] + right[1] * v[n + 1]),
      size.y - radius * (upward[0] * v[n] + upward[1] * v[n + 1] + upward[2] * v[n + 2]),
      towards[0] * v[n] + towards[1] * v[n + 1] + towards[2] * v[n + 2]];
    c.fillStyle = colours.sea;
    c.beginPath(); c.arc(size.x, size.y, radius, 0, 2 * Math.PI); c.fill();
    c.strokeStyle = colours.faint; c.lineWidth = 1; c.stroke();
    const strokeFront = (lines, color, lineWidth) => {
      c.beginPath();
      for (const line of lines) {
        let down = false;
        for (let n = 0; n < line.length; n += 3) {
          const [x, y, depth] = project(line, n);
          if (depth < 0) { down = false; continue; }
          if (down) c.lineTo(x, y); else c.moveTo(x, y);
          down = true;
        }
      }
      c.strokeStyle = color; c.lineWidth = lineWidth; c.stroke();
    };
    strokeFront(coasts, colours.coast, 0.8);
    strokeFront(region, colours.second, 2);
    axes.forEach((shell, n) => drawOrbits(c, shell, axes.length > 1 ? groupColour(n) : colours.faint, project, radius));
    drawSatellites(c, found, groups, seen, project, radius);
    // The sites of a list, as marks.
    c.strokeStyle = colours.ink; c.lineWidth = 1.2;
    for (const mark of marks) {
      const [x, y, depth] = project(mark, 0);
      if (depth > 0) { c.beginPath(); c.arc(x, y, 3, 0, 2 * Math.PI); c.stroke(); }
    }
    const here = site().up;
    const [x, y, depth] = project(here, 0);
    if (depth > 0) {
      c.fillStyle = colours.second; c.strokeStyle = colours.paper; c.lineWidth = 1.5;
      c.beginPath(); c.arc(x, y, 5, 0, 2 * Math.PI); c.fill(); c.stroke();
    }
  }

  /** Whether the Earth hides a point of the screen at a depth. */
  const hidden = (x, y, depth, radius) => depth < 0 && (x - size.x) ** 2 + (y - size.y) ** 2 < radius * radius;

  /** The colour of a shell among several, or of the satellites from files beside shells. */
  const groupColour = (n) => colours["c" + n % 7];

  function drawOrbits(c, axes, color, project, radius) {
    const point = [0, 0, 0];
    c.beginPath();
    for (const { x: ax, y: ay } of axes) {
      let down = false;
      for (const [cos, sin] of circle) {
        for (let k = 0; k < 3; k++) point[k] = cos * ax[k] + sin * ay[k];
        const [x, y, depth] = project(point, 0);
        if (hidden(x, y, depth, radius)) { down = false; continue; }
        if (down) c.lineTo(x, y); else c.moveTo(x, y);
        down = true;
      }
    }
    c.strokeStyle = color; c.globalAlpha = 0.6; c.lineWidth = 0.7; c.stroke(); c.globalAlpha = 1;
  }

  function drawSatellites(c, found, groups, seen, project, radius) {
    const visible = new Set(seen.filter((s) => s.visible).map((s) => s.n));
    const [px, py] = project(site().position, 0);
    const dots = (wanted, group, color, dot, lines) => {
      c.fillStyle = color; c.strokeStyle = color; c.lineWidth = 0.8;
      c.beginPath();
      for (let n = group.from; n < group.to; n++) {
        if (visible.has(n) !== wanted) continue;
        const [x, y, depth] = project(found, 3 * n);
        if (hidden(x, y, depth, radius)) continue;
        if (lines) { c.moveTo(px, py); c.lineTo(x, y); }
        c.moveTo(x + dot, y); c.arc(x, y, dot, 0, 2 * Math.PI);
      }
      c.fill();
      if (lines) { c.globalAlpha = 0.5; c.stroke(); c.globalAlpha = 1; }
    };
    groups.forEach((group, n) => {
      dots(false, group, groups.length > 1 ? groupColour(n) : colours.accent, 2.2, false);
      dots(true, group, groups.length > 1 ? groupColour(n) : colours.second, 3.6, true);
    });
  }

  function drawSky(seen, groups) {
    const { context: c, width, height } = fitted(sky);
    const radius = 0.42 * Math.min(width, height), x0 = width / 2, y0 = height / 2;
    const ring = (elevation, dash, color) => {
      c.setLineDash(dash); c.strokeStyle = color;
      c.beginPath(); c.arc(x0, y0, radius * (1 - elevation / 90), 0, 2 * Math.PI); c.stroke();
    };
    c.lineWidth = 1;
    c.fillStyle = colours.panel;
    c.beginPath(); c.arc(x0, y0, radius, 0, 2 * Math.PI); c.fill();
    for (const elevation of [0, 30, 60]) ring(elevation, [], colours.line);
    const outline = (mask, dash, color) => {
      // Every degree and the corners of the skyline.
      const azimuths = [...Array(361).keys(), ...skylineHere().map((point) => point[0])].sort((a, b) => a - b);
      c.setLineDash(dash); c.strokeStyle = color;
      c.beginPath();
      for (const azimuth of azimuths) {
        const r = radius * (1 - lowest(mask, azimuth) / 90);
        c.lineTo(x0 + r * Math.sin(azimuth * RAD), y0 - r * Math.cos(azimuth * RAD));
      }
      c.stroke();
    };
    outline(world.mask_deg, [5, 4], colours.second);
    if (world.gnss_mask_deg !== world.mask_deg) outline(world.gnss_mask_deg, [2, 3], colours.third);
    c.setLineDash([]);
    c.fillStyle = colours.soft; c.font = "12px system-ui, sans-serif"; c.textAlign = "center"; c.textBaseline = "middle";
    ["N", "E", "S", "W"].forEach((name, n) => c.fillText(name, x0 + (radius + 14) * Math.sin(n * Math.PI / 2), y0 - (radius + 14) * Math.cos(n * Math.PI / 2)));
    for (const elevation of [30, 60]) c.fillText(elevation + "°", x0, y0 - radius * (1 - elevation / 90) - 8);
    for (const s of seen) {
      const r = radius * (1 - s.elevation / RAD / 90);
      const group = groups.findIndex((one) => s.n < one.to);
      c.fillStyle = !s.visible ? colours.faint : groups.length > 1 ? groupColour(group) : colours.second;
      c.beginPath(); c.arc(x0 + r * Math.sin(s.azimuth), y0 - r * Math.cos(s.azimuth), s.visible ? 5 : 3, 0, 2 * Math.PI); c.fill();
    }
  }

  const caption = document.getElementById("sky-caption");
  const beyond = () => (skylineHere().length > 0
    ? " and the skyline of up to " + Math.max(...skylineHere().map((point) => point[1])) + "° (dashed)" : " (dashed)")
    + (world.gnss_mask_deg !== world.mask_deg ? "; the mask of GNSS satellites, which are not drawn, is "
      + world.gnss_mask_deg + "° (dotted)" : "") + ".";
  const clock = document.getElementById("clock");
  const epoch = Date.parse(world.epoch);
  // Dates in a browser have no leap seconds: the clock stands still during one.
  const ofBrowser = (elapsed) => elapsed - world.leap_seconds_s.filter((start) => start <= elapsed).length;
  /** An instant so many seconds after the epoch, to the minute. */
  const utc = (elapsed) => new Date(epoch + 1000 * ofBrowser(elapsed)).toISOString().slice(0, 16).replace("T", " ") + " UTC";

  function tell(seen, elapsed) {
    const latitude = place.latitude / RAD, longitude = place.longitude / RAD;
    const side = (value, plus, minus) => digits(Math.abs(value), 4) + "° " + (value < 0 ? minus : plus);
    const text = "Sky at " + (place.name ? place.name + ", " : "") + side(latitude, "N", "S") + ", " + side(longitude, "E", "W") + ": "
      + seen.filter((s) => s.visible).length + " LEO satellites above the mask of " + world.mask_deg + "°" + beyond();
    if (caption.textContent !== text) caption.textContent = text;
    const now = utc(elapsed);
    if (clock.textContent !== now) clock.textContent = now;
  }

  /** What the selected satellites are drawn from, and a legend of several shells. */
  function explain() {
    const cuts = cutsOf(state.place);
    const notes = [];
    if (cuts?.orbits.length > 0) notes.push("Drawn from mean elements and their secular rates.");
    if (cuts?.tracks) notes.push(cuts.tracks.note);
    document.getElementById("drawn-from").textContent = notes.join(" ");
    const names = [...(cuts?.orbits.map((orbit) => orbit.notation) ?? []), ...(cuts?.tracks ? ["satellites from files"] : [])];
    const legend = document.getElementById("shells");
    legend.hidden = names.length < 2;
    legend.replaceChildren(...names.map((name, n) => {
      const entry = document.createElement("span"), dot = document.createElement("i");
      dot.style.background = "var(--c" + n % 7 + ")";
      entry.append(dot, name);
      return entry;
    }));
  }

  function draw() {
    const start = performance.now();
    const cuts = cutsOf(state.place);
    const orbits = cuts?.orbits ?? [], tracks = cuts?.tracks;
    // Samples begin again where they end.
    const elapsed = tracks ? time.elapsed % Math.max(1, tracks.step_s * (tracks.instants - 1)) : time.elapsed;
    const axes = orbits.map((orbit) => planes(orbit, elapsed));
    const parts = orbits.map((orbit, n) => positions(orbit, axes[n], elapsed));
    if (tracks) parts.push(sampled(tracks, elapsed));
    const found = parts.flatMap((part) => [...part]);
    let to = 0;
    const groups = parts.map((part) => ({ from: to, to: (to += part.length / 3) }));
    const seen = overhead(found);
    drawn = seen;
    drawGlobe(orbits, axes, found, groups, seen);
    drawSky(seen, groups);
    tell(seen, elapsed);
    frames.push(performance.now() - start);
    if (frames.length > 600) frames.shift();
  }

  let before = null;
  function tick(now) {
    if (visibleNow && !document.hidden) {
      if (time.playing) {
        // A page that was hidden resumes where it stopped.
        time.elapsed += time.speed * Math.min(0.1, (now - (before ?? now)) / 1000);
        draw();
      }
      before = now;
      requestAnimationFrame(tick);
    } else {
      before = null;
    }
  }

  new IntersectionObserver((entries) => {
    const now = entries[entries.length - 1].isIntersecting;
    if (now && !visibleNow) { visibleNow = true; draw(); requestAnimationFrame(tick); }
    visibleNow = now;
  }).observe(globe);
  document.addEventListener("visibilitychange", () => { if (!document.hidden && visibleNow) requestAnimationFrame(tick); });
  Core.listeners.push(() => { explain(); if (visibleNow) draw(); });
  explain();
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { colours = theme(); draw(); });
  addEventListener("beforeprint", () => { colours = theme(); draw(); });
  addEventListener("afterprint", () => { colours = theme(); draw(); });
  addEventListener("resize", () => { if (visibleNow) draw(); });

  const play = document.getElementById("play");
  const showPlay = () => { play.textContent = time.playing ? "pause" : "play"; };
  play.addEventListener("click", () => { time.playing = !time.playing; showPlay(); });
  showPlay();
  document.getElementById("speed").addEventListener("input", (event) => { time.speed = SPEEDS[event.target.value]; });

  // A drag rotates the globe; a click without a drag shows the sky of a point.
  let grip = null;
  globe.addEventListener("pointerdown", (event) => {
    grip = { x: event.clientX, y: event.clientY, longitude: view.longitude, latitude: view.latitude, moved: false };
    globe.setPointerCapture(event.pointerId);
  });
  globe.addEventListener("pointermove", (event) => {
    if (!grip) return;
    const dx = event.clientX - grip.x, dy = event.clientY - grip.y;
    if (!grip.moved && Math.hypot(dx, dy) < 4) return;
    grip.moved = true;
    view.longitude = grip.longitude - dx / size.radius;
    view.latitude = Math.max(-1.5, Math.min(1.5, grip.latitude + dy / size.radius));
    draw();
  });
  globe.addEventListener("pointercancel", () => { grip = null; });
  globe.addEventListener("pointerup", (event) => {
    const clickedIt = grip && !grip.moved;
    grip = null;
    if (!clickedIt) return;
    const box = globe.getBoundingClientRect();
    const x = (event.clientX - box.left - size.x) / size.radius, y = (size.y - event.clientY + box.top) / size.radius;
    const depth2 = 1 - x * x - y * y;
    if (depth2 < 0) return;
    const [right, upward, towards] = screenAxes();
    const v = [0, 1, 2].map((k) => x * right[k] + y * upward[k] + Math.sqrt(depth2) * towards[k]);
    place.latitude = Math.asin(Math.max(-1, Math.min(1, v[2])));
    place.longitude = Math.atan2(v[1], v[0]);
    place.name = "";
    place.site = -1;
    draw();
  });
  globe.addEventListener("keydown", (event) => {
    const turn = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] }[event.key];
    if (!turn) return;
    event.preventDefault();
    view.longitude += turn[0];
    view.latitude = Math.max(-1.5, Math.min(1.5, view.latitude + turn[1]));
    draw();
  });

  /** Shows the sky of a site of a list. */
  function look(n) {
    place.latitude = data.region.latitude_deg[n] * RAD;
    place.longitude = data.region.longitude_deg[n] * RAD;
    place.name = data.region.name[n];
    place.site = n;
    view.longitude = place.longitude;
    view.latitude = Math.max(-1.2, Math.min(1.2, place.latitude));
    draw();
    sky.scrollIntoView({ block: "nearest" });
  }

  return { frames: () => [...frames], sky: () => drawn, look, utc };
})();

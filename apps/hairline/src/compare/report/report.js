"use strict";
// The slider, the magnifier and the exposure of a comparison. Everything is in the page: nothing is loaded.
(() => {
  const byId = (id) => document.getElementById(id);
  const all = (selector) => [...document.querySelectorAll(selector)];
  const data = JSON.parse(byId("data").textContent);
  const [width, height] = data.size;
  const layerOf = Object.fromEntries(data.layers.map((layer) => [layer.name, layer]));
  const stages = { pictures: byId("pictures"), map: byId("map") };
  const state = {
    layer: data.layers[0].name,
    kind: data.layers[0].kinds[0],
    split: 50,
    stops: 0, // above the exposure of the embedded pictures
    factor: 8,
    pixel: null,
    pinned: false,
  };
  const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

  // --- What is packed in the page -------------------------------------------------------------------------------

  const bytesOf = (base64) => Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));

  async function unpacked(id) {
    const stream = new Blob([bytesOf(byId(id).textContent)]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
  }

  function halfToNumber(code) {
    const sign = code & 0x8000 ? -1 : 1;
    const exponent = (code >> 10) & 31;
    const fraction = code & 1023;
    if (exponent === 31) return fraction ? NaN : sign * Infinity;
    return sign * (exponent ? 2 ** (exponent - 25) * (1024 + fraction) : 2 ** -24 * fraction);
  }

  const halves = (() => {
    let table;
    return () => (table ??= Float32Array.from({ length: 65536 }, (_, code) => halfToNumber(code)));
  })();

  // Planes of half floats, high bytes before low ones.
  async function planes(id, channels) {
    const bytes = await unpacked(id);
    const count = width * height;
    return Array.from({ length: channels }, (_, channel) => {
      const start = channel * 2 * count;
      return Float32Array.from({ length: count }, (_, i) => halves()[(bytes[start + i] << 8) | bytes[start + count + i]]);
    });
  }

  const linearOf = {};
  // The reference and the difference of A from it; null where they are not embedded.
  function linear(name) {
    const { channels, hasLinear } = layerOf[name];
    linearOf[name] ??= hasLinear
      ? Promise.all(["b", "d"].map((part) => planes(`linear-${name}-${part}`, channels))).then(([b, d]) => ({ b, d }))
      : Promise.resolve(null);
    return linearOf[name];
  }

  // --- Choosing -------------------------------------------------------------------------------------------------

  const shot = (role) => document.querySelector(`#pictures img.${role}[data-layer="${state.layer}"]`);
  const mapShot = () => document.querySelector(`#map img[data-layer="${state.layer}"][data-kind="${state.kind}"]`);
  const exposed = { a: byId("exposed-a"), b: byId("exposed-b") };
  const isExposed = () => state.stops !== 0 && layerOf[state.layer].isLight && layerOf[state.layer].hasLinear;
  const source = (role) => (role === "map" ? mapShot() : isExposed() ? exposed[role] : shot(role));

  let values = null; // of the layer that is shown
  let mapIndices = null; // of the map that is shown, into its palette

  async function choose(layer, kind) {
    state.layer = layer;
    const kinds = layerOf[layer].kinds;
    state.kind = kinds.includes(kind) ? kind : kinds[0];
    for (const input of all('input[name="layer"]')) input.checked = input.value === state.layer;
    for (const input of all('input[name="kind"]')) {
      input.disabled = !kinds.includes(input.value);
      input.checked = input.value === state.kind;
    }
    for (const row of all(".figures tbody tr")) row.classList.toggle("chosen", row.dataset.layer === layer);
    for (const legend of all(".legend")) legend.hidden = legend.dataset.kind !== state.kind;
    values = null;
    showShots();
    const [found, indices] = await Promise.all([linear(layer), indicesOfMap()]);
    if (state.layer !== layer) return;
    values = found;
    if (state.kind === indices.kind) mapIndices = indices;
    expose();
    draw();
  }

  function showShots() {
    for (const image of all("#pictures img")) image.hidden = image.dataset.layer !== state.layer || isExposed();
    for (const image of all("#map img")) image.hidden = image !== mapShot();
    for (const canvas of Object.values(exposed)) canvas.hidden = !isExposed();
    const slider = byId("exposure");
    if (slider) slider.disabled = !(layerOf[state.layer].isLight && layerOf[state.layer].hasLinear);
    draw();
  }

  for (const input of all('input[name="layer"]')) input.addEventListener("change", () => choose(input.value, state.kind));
  for (const input of all('input[name="kind"]')) input.addEventListener("change", () => choose(state.layer, input.value));
  for (const row of all(".figures tbody tr[data-layer]")) {
    row.addEventListener("click", () => choose(row.dataset.layer, state.kind));
  }

  // --- The slider between A and B -------------------------------------------------------------------------------

  const slider = byId("slider");

  function setSplit(percent) {
    state.split = clamp(percent, 0, 100);
    stages.pictures.style.setProperty("--split", `${state.split}%`);
    slider.setAttribute("aria-valuenow", Math.round(state.split));
    slider.setAttribute("aria-valuetext", `${Math.round(state.split)} % A`);
    for (const [side, bare] of [["left", 4], ["right", 96]]) {
      const corner = stages.pictures.querySelector(`.corner.${side}`);
      corner.hidden = side === "left" ? state.split < bare : state.split > bare;
    }
  }

  const splitAt = (event) => {
    const box = stages.pictures.getBoundingClientRect();
    return (100 * (event.clientX - box.left)) / box.width;
  };

  slider.addEventListener("keydown", (event) => {
    const step = event.shiftKey ? 10 : 1;
    const moves = {
      ArrowLeft: -step, ArrowDown: -step, ArrowRight: step, ArrowUp: step, PageUp: 10, PageDown: -10, Home: -100, End: 100,
    };
    if (!(event.key in moves)) return;
    setSplit(state.split + moves[event.key]);
    event.preventDefault();
    event.stopPropagation();
  });

  // A press that moves drags the line, one that does not pins the pixel.
  let press = null;
  stages.pictures.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    press = { x: event.clientX, onSlider: event.target === slider, moved: false };
    stages.pictures.setPointerCapture(event.pointerId);
  });
  stages.pictures.addEventListener("pointermove", (event) => {
    if (press && (press.moved || Math.abs(event.clientX - press.x) > 3)) {
      press.moved = true;
      setSplit(splitAt(event));
    }
  });
  stages.pictures.addEventListener("pointerup", (event) => {
    if (press && !press.moved && !press.onSlider) togglePin(event, stages.pictures);
    press = null;
  });
  stages.pictures.addEventListener("pointercancel", () => (press = null));

  // --- The magnifier --------------------------------------------------------------------------------------------

  const pixelAt = (event, stage) => {
    const box = stage.getBoundingClientRect();
    const along = (at, start, length, count) => clamp(Math.floor(((at - start) / length) * count), 0, count - 1);
    return { x: along(event.clientX, box.left, box.width, width), y: along(event.clientY, box.top, box.height, height) };
  };

  function setPixel(pixel) {
    state.pixel = { x: clamp(pixel.x, 0, width - 1), y: clamp(pixel.y, 0, height - 1) };
    draw();
  }

  function setPinned(pinned) {
    state.pinned = pinned;
    byId("pinned").hidden = !pinned;
    for (const field of all(".field")) field.classList.toggle("pinned", pinned);
  }

  function togglePin(event, stage) {
    setPinned(!state.pinned);
    setPixel(pixelAt(event, stage));
  }

  const factors = [...byId("factor").options].map((option) => Number(option.value));
  function setFactor(factor) {
    state.factor = factor;
    byId("factor").value = factor;
    draw();
  }
  function stepFactor(step) {
    setFactor(factors[clamp(factors.indexOf(state.factor) + step, 0, factors.length - 1)]);
  }
  byId("factor").addEventListener("change", (event) => setFactor(Number(event.target.value)));

  for (const stage of Object.values(stages)) {
    stage.addEventListener("pointermove", (event) => {
      if (!state.pinned && !press?.moved) setPixel(pixelAt(event, stage));
    });
    let turned = 0; // trackpads send many small turns
    stage.addEventListener("wheel", (event) => {
      if (event.ctrlKey) return; // the browser's own zoom
      event.preventDefault();
      turned += event.deltaY;
      if (Math.abs(turned) < 40) return;
      stepFactor(turned < 0 ? 1 : -1);
      turned = 0;
    }, { passive: false });
    stage.addEventListener("keydown", (event) => {
      if (event.target !== stage) return;
      const step = event.shiftKey ? 10 : 1;
      const moves = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step], ArrowDown: [0, step] };
      const move = moves[event.key];
      if (!move) return;
      const from = state.pixel ?? { x: width >> 1, y: height >> 1 };
      setPixel({ x: from.x + move[0], y: from.y + move[1] });
      setPinned(true);
      event.preventDefault();
    });
  }
  stages.map.addEventListener("click", (event) => togglePin(event, stages.map));

  let drawing = 0;
  function draw() {
    drawing ||= requestAnimationFrame(() => {
      drawing = 0;
      if (!state.pixel) return;
      for (const role of ["a", "b", "map"]) drawZoom(byId(`zoom-${role}`), source(role));
      drawFields();
      readOut();
    });
  }

  // Whole pixels across, an odd number of them, so that one is in the middle.
  const across = (canvas) => {
    const fit = Math.floor(canvas.clientWidth / state.factor);
    return Math.max(3, fit % 2 ? fit : fit - 1);
  };

  function drawZoom(canvas, image) {
    const side = Math.round(canvas.clientWidth * devicePixelRatio);
    if (canvas.width !== side) canvas.width = canvas.height = side;
    const context = canvas.getContext("2d");
    context.clearRect(0, 0, side, side);
    if (!image || (image.complete === false)) return;
    const count = across(canvas);
    const scale = side / count;
    const left = state.pixel.x - (count >> 1);
    const top = state.pixel.y - (count >> 1);
    // Only what is in the picture: browsers differ in what they do with the rest.
    const [x0, y0] = [Math.max(left, 0), Math.max(top, 0)];
    const [x1, y1] = [Math.min(left + count, width), Math.min(top + count, height)];
    context.imageSmoothingEnabled = false;
    context.drawImage(image, x0, y0, x1 - x0, y1 - y0,
      (x0 - left) * scale, (y0 - top) * scale, (x1 - x0) * scale, (y1 - y0) * scale);
    const at = (count >> 1) * scale;
    context.lineWidth = Math.max(1, Math.round(devicePixelRatio));
    context.strokeStyle = "#000a";
    context.strokeRect(at - 1.5, at - 1.5, scale + 3, scale + 3);
    context.strokeStyle = "#fff";
    context.strokeRect(at - 0.5, at - 0.5, scale + 1, scale + 1);
  }

  function drawFields() {
    const count = across(byId("zoom-a"));
    for (const stage of Object.values(stages)) {
      const field = stage.querySelector(".field");
      field.hidden = false;
      field.style.left = `${(100 * (state.pixel.x - (count >> 1))) / width}%`;
      field.style.top = `${(100 * (state.pixel.y - (count >> 1))) / height}%`;
      field.style.width = `${(100 * count) / width}%`;
      field.style.height = `${(100 * count) / height}%`;
    }
  }

  // --- The values of a pixel ------------------------------------------------------------------------------------

  const typeset = (text) => text.replaceAll("-", "\u2212");
  function number(value) {
    if (!Number.isFinite(value)) return Number.isNaN(value) ? "NaN" : typeset(value < 0 ? "-\u221e" : "\u221e");
    const size = Math.abs(value);
    if (size === 0) return "0";
    if (size >= 1e4 || size < 1e-3) return typeset(value.toExponential(2));
    return typeset(value.toFixed(size >= 100 ? 1 : size >= 10 ? 2 : size >= 1 ? 3 : 4));
  }

  const codesOf = new WeakMap();
  // Codes on the display, 8 bits a channel.
  function codes(image) {
    if (!codesOf.has(image)) {
      const canvas = document.createElement("canvas");
      [canvas.width, canvas.height] = [width, height];
      const context = canvas.getContext("2d", { willReadFrequently: true });
      context.drawImage(image, 0, 0);
      codesOf.set(image, context.getImageData(0, 0, width, height).data);
    }
    return codesOf.get(image);
  }

  function fillRow(id, cells) {
    const targets = byId(id).querySelectorAll("td");
    targets.forEach((cell, i) => (cell.textContent = cells[i] ?? ""));
  }

  function readOut() {
    const { x, y } = state.pixel;
    const i = y * width + x;
    byId("where").textContent = `x ${x}   y ${y}`;
    if (values) {
      byId("unit").textContent = "linear";
      const b = values.b.map((plane) => plane[i]);
      const d = values.d.map((plane) => plane[i]);
      fillRow("va", d.map((difference, c) => number(b[c] + difference)));
      fillRow("vb", b.map(number));
      fillRow("vd", d.map(number));
    } else if (shot("a").complete && shot("b").complete) {
      byId("unit").textContent = "displayed, 0\u2013255";
      const [a, b] = ["a", "b"].map((role) => [...codes(shot(role)).subarray(4 * i, 4 * i + 3)]);
      fillRow("va", a.map(String));
      fillRow("vb", b.map(String));
      fillRow("vd", a.map((code, c) => typeset(String(code - b[c]))));
    }
    byId("vm").querySelector("th").textContent = { flip: "FLIP", relative: "relative error", z: "z" }[state.kind];
    fillRow("vm", [mapValue(i)]);
  }

  const indexOfColor = {};
  // The map's colours back to steps of its palette; beyond 255: no value.
  async function indicesOfMap() {
    const kind = state.kind;
    const image = mapShot();
    await image.decode();
    if (!indexOfColor[kind]) {
      const palette = bytesOf(data.palettes[kind]);
      indexOfColor[kind] = new Map(Array.from({ length: 256 }, (_, k) => [
        (palette[3 * k] << 16) | (palette[3 * k + 1] << 8) | palette[3 * k + 2], k,
      ]));
    }
    const rgba = codes(image);
    const steps = Uint16Array.from({ length: width * height }, (_, i) =>
      indexOfColor[kind].get((rgba[4 * i] << 16) | (rgba[4 * i + 1] << 8) | rgba[4 * i + 2]) ?? 256);
    return { kind, steps };
  }

  function mapValue(i) {
    if (!mapIndices || mapIndices.kind !== state.kind) return "";
    const step = mapIndices.steps[i];
    if (step > 255) return "not finite, or noise unknown";
    const share = step / 255;
    if (state.kind === "flip") return share.toFixed(3);
    if (state.kind === "relative") {
      if (step === 0) return "0.1 % or less";
      return step === 255 ? "100 % or more" : `${number(0.1 * 1000 ** share)} %`;
    }
    const z = data.zMax * (2 * share - 1);
    return (Math.abs(share - 0.5) > 0.49 ? "beyond " : "") + typeset(z.toFixed(1));
  }

  function toWorst() {
    if (!mapIndices) return;
    const height_of = (step) => (step > 255 ? 1e3 : state.kind === "z" ? Math.abs(step - 127.5) : step);
    let worst = 0;
    mapIndices.steps.forEach((step, i) => {
      if (height_of(step) > height_of(mapIndices.steps[worst])) worst = i;
    });
    setPixel({ x: worst % width, y: Math.floor(worst / width) });
  }
  byId("worst").addEventListener("click", () => {
    toWorst();
    setPinned(true);
  });

  // --- Exposure -------------------------------------------------------------------------------------------------

  let tone = null;
  const ToneMax = data.tone.max;

  // Within the display's gamut by mixing with the grey of the same luminance, as the curves do it.
  function intoGamut(rgb) {
    const lowest = Math.min(rgb[0], rgb[1], rgb[2]);
    if (lowest >= 0) return;
    const luminance = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
    const keep = luminance > 0 ? luminance / (luminance - lowest) : 0;
    for (let c = 0; c < 3; c++) rgb[c] = luminance > 0 ? Math.max(luminance + keep * (rgb[c] - luminance), 0) : 0;
  }

  // The tone curve's table, linear between its nodes.
  function toneMap(rgb, out, at) {
    const { nodes, gain } = data.tone;
    const scale = (nodes - 1) / Math.log1p(gain * ToneMax);
    intoGamut(rgb);
    const cell = [0, 0, 0];
    const share = [0, 0, 0];
    for (let axis = 0; axis < 3; axis++) {
      const place = Math.min(Math.log1p(gain * rgb[axis]) * scale, nodes - 1);
      cell[axis] = Math.min(Math.floor(place), nodes - 2);
      share[axis] = place - cell[axis];
    }
    let [r, g, b] = [0, 0, 0];
    for (let corner = 0; corner < 8; corner++) {
      let weight = 1;
      let index = 0;
      for (let axis = 0; axis < 3; axis++) {
        const up = (corner >> axis) & 1;
        weight *= up ? share[axis] : 1 - share[axis];
        index = index * nodes + cell[axis] + up;
      }
      r += weight * tone[3 * index];
      g += weight * tone[3 * index + 1];
      b += weight * tone[3 * index + 2];
    }
    out[at] = r;
    out[at + 1] = g;
    out[at + 2] = b;
    out[at + 3] = 255;
  }

  async function expose() {
    showShots();
    if (!isExposed() || !values) return;
    tone ??= await unpacked("tone");
    const light = 2 ** (data.exposureEv + state.stops);
    const rgb = [0, 0, 0];
    for (const role of ["a", "b"]) {
      const context = exposed[role].getContext("2d");
      const picture = context.createImageData(width, height);
      for (let i = 0; i < width * height; i++) {
        for (let c = 0; c < 3; c++) {
          const value = values.b[c][i] + (role === "a" ? values.d[c][i] : 0);
          // NaN is black, as in the embedded pictures.
          rgb[c] = Number.isNaN(value) ? 0 : clamp(light * value, -1e9, 1e9);
        }
        toneMap(rgb, picture.data, 4 * i);
      }
      context.putImageData(picture, 0, 0);
    }
    draw();
  }

  function setStops(stops) {
    state.stops = stops;
    byId("exposure").value = stops;
    const ev = data.exposureEv + stops;
    byId("exposure-value").textContent = typeset(`${ev > 0 ? "+" : ""}${Number(ev.toFixed(2))} EV`);
    byId("exposure-reset").disabled = stops === 0;
    expose();
  }
  if (byId("exposure")) {
    byId("exposure").addEventListener("input", (event) => setStops(Number(event.target.value)));
    byId("exposure-reset").addEventListener("click", () => setStops(0));
    setStops(0);
  }

  // --- Keys for the whole page ----------------------------------------------------------------------------------

  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.target.matches("input, select, button, summary") && event.key === " ") return;
    const acts = {
      a: () => setSplit(100),
      b: () => setSplit(0),
      " ": () => setSplit(state.split > 50 ? 0 : 100),
      w: () => { toWorst(); setPinned(true); },
      "+": () => stepFactor(1),
      "=": () => stepFactor(1),
      "-": () => stepFactor(-1),
      Escape: () => setPinned(false),
    };
    const act = acts[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!act || event.target.matches("select")) return;
    act();
    event.preventDefault();
  });

  // --- Start ----------------------------------------------------------------------------------------------------

  function measure() {
    for (const stage of Object.values(stages)) {
      stage.classList.toggle("pixelated", (stage.clientWidth * devicePixelRatio) / width >= 2);
    }
    draw();
  }
  addEventListener("resize", measure);
  measure();
  setSplit(50);
  choose(state.layer, state.kind).then(() => {
    // Something to see before the pointer comes.
    if (!state.pixel) toWorst();
  });
})();

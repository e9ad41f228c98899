// Loads the viewer and shows it, or says what is missing; and does for it what only a page can do.

import start, { filesOf, open } from "./hairline.js";

const cover = document.getElementById("cover");
const words = document.getElementById("words");
const bar = document.getElementById("progress");
const gallery = document.getElementById("gallery");
const chooser = document.getElementById("chooser");

function fail(message) {
  bar.hidden = true;
  words.textContent = message;
  words.setAttribute("role", "alert");
  cover.hidden = false;
}

// Reasons that the viewer could show only in a window, which it cannot draw then.
async function missing() {
  if (typeof WebAssembly !== "object") return "This browser has no WebAssembly, which Hairline is made of.";
  const browsers = "Chrome and Edge have WebGPU from version 113 on, Safari from 26 on, Firefox from 141 on; some of them not on Linux yet.";
  if (!window.isSecureContext) return "This page was not loaded by https, and browsers lend WebGPU, by which Hairline draws, to such pages alone.";
  if (!navigator.gpu) return `This browser has no WebGPU, by which Hairline draws.\n${browsers}`;
  if (!(await navigator.gpu.requestAdapter())) {
    return "This browser has WebGPU, by which Hairline draws, but lends no graphics by it. Is hardware acceleration switched off in the settings, or the driver too old?";
  }
  return null;
}

async function fetched(url) {
  const answer = await fetch(url);
  if (!answer.ok) throw new Error(`${url}: the server answers ${answer.status} ${answer.statusText}`);
  return answer;
}

// The program as a stream that tells how much of it is there.
async function download(url, total) {
  const answer = await fetched(url);
  let received = 0;
  const count = new TransformStream({
    transform(chunk, stream) {
      received += chunk.byteLength;
      bar.value = Math.min(received / total, 1);
      stream.enqueue(chunk);
    },
  });
  return new Response(answer.body.pipeThrough(count), { headers: { "content-type": "application/wasm" } });
}

let page = null;

async function take(files) {
  const contents = await Promise.all(files.map(async (file) => new Uint8Array(await file.arrayBuffer())));
  page.take(files.map((file) => file.name), contents);
}

// A scene of the gallery, after the files that it names.
async function openScene(name) {
  const url = (file) => new URL(`scenes/${file}`, import.meta.url);
  const text = await (await fetched(url(name))).text();
  const names = [...filesOf(text), name];
  const contents = names.map(async (file) => new Uint8Array(await (await fetched(url(file))).arrayBuffer()));
  page.take(names, await Promise.all(contents));
}

async function fillGallery() {
  for (const { file, title, about } of await (await fetched("scenes.json")).json()) {
    const button = document.createElement("button");
    const picture = document.createElement("img");
    picture.src = `scenes/${title}.jpg`;
    picture.alt = "";
    picture.loading = "lazy";
    const name = document.createElement("b");
    name.textContent = title;
    const sentence = document.createElement("span");
    sentence.textContent = about;
    button.append(picture, name, sentence);
    button.onclick = () => {
      gallery.close();
      openScene(file).catch((error) => alert(`The scene could not be opened: ${error.message}`));
    };
    document.getElementById("scenes").append(button);
  }
}

// Functions that the viewer calls, in the middle of its own work: calls back to the viewer must
// wait.
window.hairlinePage = {
  gallery() {
    gallery.showModal();
  },
  pick(endings) {
    chooser.accept = endings.split(",").map((ending) => `.${ending}`).join(",");
    chooser.value = "";
    chooser.click();
  },
  save(name, bytes) {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([bytes]));
    link.download = name.split("/").pop();
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
  },
};

function listen() {
  chooser.onchange = () => take([...chooser.files]);
  // Before the window's own listeners, which know no contents.
  const stop = (event) => {
    event.preventDefault();
    event.stopImmediatePropagation();
  };
  window.addEventListener("dragover", stop, true);
  window.addEventListener(
    "drop",
    (event) => {
      stop(event);
      take([...event.dataTransfer.files]);
    },
    true,
  );
  window.addEventListener("hashchange", () => page.openLink(location.hash));
  // A mistake of the program leaves a window that does nothing any more: better to say so.
  window.addEventListener("error", () => {
    const failure = page.failure();
    if (failure) fail(`Hairline has a fault and has stopped: ${failure}\nLoad the page anew.`);
  });
}

async function run() {
  const reason = await missing();
  if (reason) return fail(reason);
  const { bytes } = await (await fetched("size.json")).json();
  await start({ module_or_path: download(new URL("hairline_bg.wasm", import.meta.url), bytes) });
  words.textContent = "Starting";
  const lost = (why) => fail(`The graphics device was lost (${why}). Load the page anew to go on.`);
  const backend = new URLSearchParams(location.search).get("backend") ?? undefined;
  page = await open(document.getElementById("window"), backend, lost);
  window.hairline = page;
  listen();
  page.openLink(location.hash);
  cover.hidden = true;
  await fillGallery();
}

run().catch((error) => fail(`Hairline could not start: ${error.message ?? error}`));

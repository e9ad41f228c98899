// <hairline-viewer src="worn.glb">: a worn model that turns under the pointer, with its scratches in colour. It is loaded when it comes into view. Until
// then, and where it cannot be shown, it is its poster, or its words.
import { Shown } from './shown.js';

const STYLE = `
:host { display: block; position: relative; aspect-ratio: 16 / 9; overflow: hidden; background: #000; color: #ddd; font: 14px/1.5 system-ui, sans-serif; }
:host([hidden]) { display: none; }
canvas, img { position: absolute; inset: 0; width: 100%; height: 100%; object-fit: cover; border: 0; }
canvas:focus-visible { outline: 2px solid #9cd; outline-offset: -2px; }
img { transition: opacity 0.3s; }
img[hidden] { display: block; opacity: 0; pointer-events: none; }
p { position: absolute; inset: auto 0 0; margin: 0; padding: 0.5em 0.8em; background: #000b; white-space: pre-line; overflow-wrap: anywhere; }
p:empty { display: none; }
@media (prefers-reduced-motion: reduce) { img { transition: none; } }
`;

/** Times that a graphics device may be lost before the element gives up. */
const LOSSES = 3;

export class HairlineViewer extends HTMLElement {
  static get observedAttributes() {
    return ['src', 'poster', 'alt', 'exposure'];
  }

  #poster = document.createElement('img');

  #words = document.createElement('p');

  #watch = null;

  #shown = null;

  #losses = 0;

  /** Why there is no model. */
  #reason = '';

  #hasPoster = false;

  constructor() {
    super();
    const style = document.createElement('style');
    style.textContent = STYLE;
    this.attachShadow({ mode: 'open' }).append(style, this.#poster, this.#words);
    this.#poster.setAttribute('part', 'poster');
    this.#poster.onerror = () => {
      this.#hasPoster = false;
      this.#tell();
    };
    this.#words.setAttribute('part', 'words');
    this.#words.setAttribute('role', 'status');
  }

  connectedCallback() {
    this.#showPoster();
    // Ahead of the scroll, so that most are there when they are seen.
    this.#watch = new IntersectionObserver((entries) => {
      if (entries.some((entry) => entry.isIntersecting)) this.#load();
    }, { rootMargin: '200px' });
    this.#watch.observe(this);
  }

  disconnectedCallback() {
    this.#watch?.disconnect();
    this.#watch = null;
    this.#forget();
  }

  attributeChangedCallback(name, before, after) {
    if (before === after || !this.#watch) return;
    if (name === 'exposure') this.#shown?.expose(this.#exposure);
    else if (name === 'src') {
      this.#forget();
      this.#losses = 0;
      this.#watch.unobserve(this);
      this.#watch.observe(this);
    } else if (name === 'poster') this.#showPoster();
    else this.#tell();
  }

  get src() {
    return this.getAttribute('src');
  }

  set src(value) {
    this.setAttribute('src', value);
  }

  get #exposure() {
    const given = Number(this.getAttribute('exposure') ?? 0);
    return Number.isFinite(given) ? given : 0;
  }

  get #alt() {
    return this.getAttribute('alt') ?? '';
  }

  #showPoster() {
    const poster = this.getAttribute('poster');
    this.#hasPoster = Boolean(poster);
    if (poster) this.#poster.src = poster;
    else this.#poster.removeAttribute('src');
    this.#tell();
  }

  /** What stands for the model in sight and in words: the model itself, its poster, or what its `alt` says; and why there is no model. One of them has the name. */
  #tell() {
    const isDrawn = this.#shown?.isDrawn === true;
    const isPoster = this.#hasPoster && !isDrawn;
    this.#poster.hidden = !isPoster;
    this.#poster.alt = isPoster ? this.#alt : '';
    this.#poster.ariaHidden = String(!isPoster);
    this.#shown?.name(this.#alt || 'a model that can be turned');
    this.#words.textContent = isDrawn ? '' : [isPoster ? '' : this.#alt, this.#reason].filter(Boolean).join('\n');
  }

  #forget() {
    this.#shown?.end();
    this.#shown = null;
    this.#reason = '';
    this.#tell();
  }

  #fail(error) {
    this.#forget();
    this.#reason = `The model cannot be shown: ${error.message}.`;
    this.#tell();
    this.dispatchEvent(new CustomEvent('error', { detail: error }));
  }

  /** The address of something that lies beside this script, or where an attribute says. */
  #beside(attribute, file) {
    const given = this.getAttribute(attribute);
    return given ? new URL(given, document.baseURI).href : new URL(file, import.meta.url).href;
  }

  /** From a view that it was seen from before, if there is one. */
  async #load(view = null) {
    if (this.#shown || !this.src) return;
    this.#reason = '';
    const shown = new Shown(this, (message) => this.#lost(shown, message));
    this.#shown = shown;
    try {
      const [engine, decoders] = [this.#beside('engine', 'engine_bg.wasm'), this.#beside('decoders', 'decoders/')];
      await shown.begin({ src: this.src, engine, decoders, exposure: this.#exposure, view });
      if (this.#shown !== shown) return;
      this.#tell();
      this.dispatchEvent(new CustomEvent('load'));
    } catch (error) {
      if (this.#shown === shown) this.#fail(error);
    }
  }

  /** The graphics device is gone: all is made anew on another one. */
  #lost(shown, message) {
    if (this.#shown !== shown) return;
    this.#forget();
    this.#losses += 1;
    if (this.#losses < LOSSES) this.#load(shown.view());
    else this.#fail(new Error(`the graphics device was lost ${LOSSES} times: ${message}`));
  }
}

if (!customElements.get('hairline-viewer')) customElements.define('hairline-viewer', HairlineViewer);

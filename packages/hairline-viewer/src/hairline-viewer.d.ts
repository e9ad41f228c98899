/** `<hairline-viewer src="worn.glb" poster="worn.png">`: see README.md. */
export class HairlineViewer extends HTMLElement {
  src: string | null;
}
/** `load` when the model is there, `error` with the reason in `detail` when it cannot be shown. */
export interface HairlineViewerEventMap {
  load: CustomEvent<null>;
  error: CustomEvent<Error>;
}

declare global {
  interface HTMLElementTagNameMap {
    'hairline-viewer': HairlineViewer;
  }
}

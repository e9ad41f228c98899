/** `<hairline-viewer src="worn.glb" poster="worn.png">`: see README.md. */
export class HairlineViewer extends HTMLElement {
  src: string | null;
}

declare global {
  interface HTMLElementTagNameMap {
    'hairline-viewer': HairlineViewer;
  }
}

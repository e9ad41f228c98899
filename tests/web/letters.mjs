// Words in a picture of the page against the same words drawn by the browser itself, in the same font.
import { readFileSync } from 'node:fs';
import { join } from 'node:path';

const FONT = readFileSync(join(import.meta.dirname, '../../crates/document/assets/text.ttf')).toString('base64');
/** Of the page's text, in pixels. */
const SIZE = 13;

/**
 * Where `word` fits best into the left 230 columns of `picture` (PNG, base64): by how much of full brightness its most wrong pixel is off, and how
 * well the two correlate. Two rasterisers differ by up to a quarter at the rims of letters; a part that is missing is off by 0.8.
 */
export function fit(page, picture, word) {
  return page.evaluate(
    async (picture, word, font, size) => {
      const face = new FontFace('viewer', `url(data:font/ttf;base64,${font})`);
      document.fonts.add(await face.load());
      const canvas = (w, h) => new OffscreenCanvas(w, h).getContext('2d', { alpha: false, willReadFrequently: true });
      const greens = (context, w, h) => Float64Array.from(context.getImageData(0, 0, w, h).data.filter((_, i) => i % 4 === 1));

      const image = await createImageBitmap(await (await fetch(`data:image/png;base64,${picture}`)).blob());
      const [across, down] = [Math.min(image.width, 230), image.height];
      const shown = canvas(across, down);
      shown.drawImage(image, 0, 0);
      const seen = greens(shown, across, down);

      const [right, h] = [canvas(across, 20), size + 2];
      right.font = `${size}px viewer`;
      right.textRendering = 'geometricPrecision';
      const w = Math.ceil(right.measureText(word).width) + 3;
      right.fillStyle = '#fff';
      right.fillText(word, 1, 11);
      const want = greens(right, w, h);
      const mean = want.reduce((a, b) => a + b) / want.length;
      const [centred, spread] = [want.map((x) => x - mean), want.reduce((sum, x) => sum + (x - mean) ** 2, 0)];

      let best = { correlation: -1 };
      for (let y = 0; y + h <= down; y += 1) {
        for (let x = 0; x + w <= across; x += 1) {
          const at = (i) => seen[(y + Math.floor(i / w)) * across + x + (i % w)];
          let [sum, squares, product] = [0, 0, 0];
          for (let i = 0; i < w * h; i += 1) {
            sum += at(i);
            squares += at(i) ** 2;
            product += at(i) * centred[i];
          }
          const correlation = product / Math.sqrt(Math.max(squares - sum ** 2 / (w * h), 1) * spread);
          if (correlation > best.correlation) {
            const [gain, middle] = [product / spread, sum / (w * h)];
            const off = centred.map((wanted, i) => Math.abs(at(i) - middle - gain * wanted) / (255 * gain));
            best = { correlation, off: Math.max(...off) };
          }
        }
      }
      return best;
    },
    picture,
    word,
    FONT,
    SIZE,
  );
}

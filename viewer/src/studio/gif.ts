// Animated GIF: 256 colours, chosen from sample pictures, and of each picture the part that has changed.
const colours = 256;
const clear = colours, ending = colours + 1, mostCodes = 4096; // codes of GIF's compression
const bins = 32768; // of colours, 5 bits a channel

const binOf = (data: Uint8ClampedArray, at: number) =>
  ((data[at] >> 3) << 10) | ((data[at + 1] >> 3) << 5) | (data[at + 2] >> 3);
const channel = (bin: number, axis: number) => (bin >> (10 - 5 * axis)) & 31;

/** Choose colours by median cut, as bins: boxes of bins are halved where most pixels spread farthest. */
function paletteOf(samples: ImageData[]): number[][] {
  const counts = new Uint32Array(bins);
  for (const { data } of samples) for (let at = 0; at < data.length; at += 4) ++counts[binOf(data, at)];
  const pixels = (box: number[]) => box.reduce((sum, bin) => sum + counts[bin], 0);
  const described = (box: number[]) => {
    const spans = [0, 1, 2].map((axis) => {
      const values = box.map((bin) => channel(bin, axis));
      return Math.max(...values) - Math.min(...values);
    });
    const span = Math.max(...spans);
    return { box, axis: spans.indexOf(span), weight: span * Math.sqrt(pixels(box)) };
  };
  const used = Array.from(counts.keys()).filter((bin) => counts[bin] > 0);
  const boxes = [described(used)];
  while (boxes.length < colours) {
    const widest = boxes.reduce((best, one) => (one.weight > best.weight ? one : best));
    if (widest.weight === 0) break;
    const sorted = [...widest.box].sort((a, b) => channel(a, widest.axis) - channel(b, widest.axis));
    const half = pixels(sorted) / 2;
    let [cut, below] = [1, counts[sorted[0]]];
    while (cut < sorted.length - 1 && below < half) below += counts[sorted[cut++]];
    boxes.splice(boxes.indexOf(widest), 1, described(sorted.slice(0, cut)), described(sorted.slice(cut)));
  }
  return boxes.map(({ box }) => [0, 1, 2].map((axis) =>
    Math.round(box.reduce((sum, bin) => sum + counts[bin] * channel(bin, axis), 0) / pixels(box) * 255 / 31)));
}

/** Compress numbers below 256 by LZW with codes of 9 to 12 bits. */
function compressed(pixels: Uint8Array, table: Int16Array): number[] {
  const bytes: number[] = [];
  let [buffer, bits, size, next] = [0, 0, 9, ending + 1];
  const put = (code: number) => {
    buffer |= code << bits;
    for (bits += size; bits >= 8; bits -= 8, buffer >>= 8) bytes.push(buffer & 255);
  };
  table.fill(0);
  put(clear);
  let prefix = pixels[0];
  for (let i = 1; i < pixels.length; ++i) {
    const place = prefix * colours + pixels[i];
    if (table[place] > 0) {
      prefix = table[place];
      continue;
    }
    put(prefix);
    if (next < mostCodes) {
      if (next >= 1 << size) ++size;
      table[place] = next++;
    } else {
      put(clear);
      table.fill(0);
      [size, next] = [9, ending + 1];
    }
    prefix = pixels[i];
  }
  put(prefix);
  put(ending);
  if (bits > 0) bytes.push(buffer & 255);
  return bytes;
}

const short = (value: number) => [value & 255, value >> 8];
const letters = (text: string) => [...text].map((letter) => letter.charCodeAt(0));

export class Gif {
  private readonly parts: Uint8Array<ArrayBuffer>[] = [];
  private readonly palette: number[][];
  private readonly nearest = new Int16Array(bins).fill(-1); // colour of a bin
  private readonly table = new Int16Array(mostCodes * colours);
  private readonly width: number;
  private readonly height: number;
  private before: Uint8Array | null = null;

  constructor(samples: ImageData[]) {
    [this.width, this.height] = [samples[0].width, samples[0].height];
    this.palette = paletteOf(samples);
    const listed = Array.from({ length: colours }, (_, i) => this.palette[i] ?? [0, 0, 0]).flat();
    const forever = [0x21, 0xff, 11, ...letters("NETSCAPE2.0"), 3, 1, 0, 0, 0];
    this.write([...letters("GIF89a"), ...short(this.width), ...short(this.height), 0xf7, 0, 0, ...listed, ...forever]);
  }

  private write(bytes: number[]): void {
    this.parts.push(Uint8Array.from(bytes));
  }

  private colourOf(bin: number): number {
    if (this.nearest[bin] >= 0) return this.nearest[bin];
    const wanted = [0, 1, 2].map((axis) => (channel(bin, axis) * 255) / 31);
    const apart = (colour: number[]) => colour.reduce((sum, value, axis) => sum + (value - wanted[axis]) ** 2, 0);
    let best = 0;
    this.palette.forEach((colour, i) => apart(colour) < apart(this.palette[best]) && (best = i));
    return (this.nearest[bin] = best);
  }

  /** Add a picture, to be shown for `ms`, a multiple of 10. */
  add({ data }: ImageData, ms: number): void {
    const { width, height, before } = this;
    const now = new Uint8Array(width * height);
    let [left, top, right, bottom] = before ? [width, height, 0, 0] : [0, 0, width, height];
    for (let at = 0; at < now.length; ++at) {
      now[at] = this.colourOf(binOf(data, 4 * at));
      if (!before || now[at] === before[at]) continue;
      const [x, y] = [at % width, Math.floor(at / width)];
      [left, top, right, bottom] = [Math.min(left, x), Math.min(top, y), Math.max(right, x + 1), Math.max(bottom, y + 1)];
    }
    this.before = now;
    if (right <= left) [left, top, right, bottom] = [0, 0, 1, 1];
    const part = new Uint8Array((right - left) * (bottom - top));
    for (let y = top; y < bottom; ++y)
      part.set(now.subarray(y * width + left, y * width + right), (y - top) * (right - left));
    const bytes = compressed(part, this.table);
    this.write([0x21, 0xf9, 4, 4, ...short(ms / 10), 0, 0,
      0x2c, ...short(left), ...short(top), ...short(right - left), ...short(bottom - top), 0, 8]);
    for (let at = 0; at < bytes.length; at += 255) {
      const block = bytes.slice(at, at + 255);
      this.write([block.length, ...block]);
    }
    this.write([0]);
  }

  end(): Blob {
    this.write([0x3b]);
    return new Blob(this.parts, { type: "image/gif" });
  }
}

// Decoder of src/show/report_frames.hpp: integers as differences, byte by byte, deflated, base64.

export interface ArrayEntry {
  name: string;
  bits: 16 | 32;
  period: number;
  count: number;
  offset: number;
}

export type Numbers = Uint16Array | Uint32Array;

export async function inflate(base64: string): Promise<Uint8Array> {
  const text = atob(base64);
  const packed = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) packed[i] = text.charCodeAt(i);
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

export class PackedArrays {
  private readonly entries = new Map<string, ArrayEntry>();

  constructor(private readonly bytes: Uint8Array, index: ArrayEntry[]) {
    for (const entry of index) this.entries.set(entry.name, entry);
  }

  get(name: string): Numbers {
    const entry = this.entries.get(name);
    if (!entry) throw new Error(`the page has no array ${name}`);
    const { bits, period, count, offset } = entry;
    const size = bits / 8;
    if (offset + count * size > this.bytes.length) throw new Error(`the array ${name} ends early`);
    const numbers = bits === 16 ? new Uint16Array(count) : new Uint32Array(count);
    for (let b = 0; b < size; ++b) {
      const plane = offset + b * count;
      for (let i = 0; i < count; ++i) numbers[i] |= this.bytes[plane + i] << (8 * b);
    }
    // Typed arrays wrap around, as the differences do.
    for (let i = period; i < count; ++i) numbers[i] += numbers[i - period];
    return numbers;
  }
}

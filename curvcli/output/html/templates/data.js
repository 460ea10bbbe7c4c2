const $ = (id) => document.getElementById(id);
const data = JSON.parse($("data").textContent);

/** The bytes behind a text: base64, then deflated. */
async function inflated(text) {
  const packed = Uint8Array.fromBase64
    ? Uint8Array.fromBase64(text)
    : Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** The numbers of a block of the page, component after component; they are stored as planes of bytes. */
async function numbers(name, Type) {
  const planes = await inflated($("block-" + name).textContent);
  const size = Type.BYTES_PER_ELEMENT;
  if (size === 1) return new Type(planes.buffer);
  const n = planes.length / size;
  const bytes = new Uint8Array(planes.length);
  for (let byte = 0; byte < size; byte++) {
    for (let i = 0, from = byte * n, to = byte; i < n; i++, from++, to += size) bytes[to] = planes[from];
  }
  return new Type(bytes.buffer);
}

/** Undo steps(): rows of k indices, each row's first from the last row's first, the others from the one before. */
function rows(packed, k) {
  const n = packed.length / k;
  const found = new Uint32Array(packed.length);
  for (let i = 0, first = 0; i < n; i++) {
    for (let j = 0, at = first; j < k; j++) {
      const code = packed[j * n + i];
      at += code & 1 ? -((code + 1) / 2) : code / 2;
      if (j === 0) first = at;
      found[i * k + j] = at;
    }
  }
  return found;
}

/** The number that a stored one stands for, and what float32 left of it where that is stored too. */
const real = (stored, of, rest = 0) => (stored + rest) * 2 ** of.exponent;

/** A number with so many digits, small ones as 1.5e-7. */
function written(value, digits) {
  const small = value !== 0 && Math.abs(value) < 1e-4;
  return small ? value.toExponential(digits - 1).replace(/\.?0+e/, "e") : String(Number(value.toPrecision(digits)));
}

/** The shortest text that is the same float32; a few digits more where no float32 is near. */
function shortest(value) {
  const single = Math.fround(value);
  const subnormal = value !== 0 && Math.abs(value) < 1.2e-38;
  if (Number.isFinite(single) && !subnormal) {
    for (let digits = 6; digits < 9; digits++) {
      const text = written(value, digits);
      if (Math.fround(Number(text)) === single) return text;
    }
  }
  return written(value, 9);
}

/** A column's stored numbers, unpacked when they are first asked for. */
const unpacked = new Map();
function column(index) {
  if (!unpacked.has(index)) unpacked.set(index, numbers("column-" + index, Float32Array));
  return unpacked.get(index);
}

// Decodes the numeric arrays that engine/report/packed_array.hpp encodes: "kind:base64" or "q16:lower:upper:base64".

function bytesOf(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

function unpack(packed) {
  const parts = packed.split(":");
  const bytes = bytesOf(parts[parts.length - 1]);
  switch (parts[0]) {
    case "f32":
      return new Float32Array(bytes.buffer);
    case "u16":
      return new Uint16Array(bytes.buffer);
    case "u32":
      return new Uint32Array(bytes.buffer);
    case "u8":
      return bytes;
    case "bits":
      return Uint8Array.from({ length: 8 * bytes.length }, (_, i) => (bytes[i >> 3] >> (i & 7)) & 1);
    case "q16": {
      // A loop, because Float64Array.from() with a function is ten times slower.
      const lower = Number(parts[1]),
        upper = Number(parts[2]),
        levels = new Uint16Array(bytes.buffer),
        values = new Float64Array(levels.length);
      for (let i = 0; i < levels.length; ++i)
        values[i] = levels[i] === 65535 ? NaN : lower + ((upper - lower) * levels[i]) / 65534;
      return values;
    }
  }
  throw new Error("packed array: unknown kind " + parts[0]);
}

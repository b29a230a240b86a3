// Frames of the server, see web_viewer/page_frames.h.

const ALIGNMENT = 8;

/** Splits a frame (ArrayBuffer) into its header and a reader of the lists behind it. Throws for what is none. */
export function decodeFrame(buffer) {
  const size = new DataView(buffer).getUint32(0, true);
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, size)));
  return {header, lists: new ListReader(buffer, 4 + size)};
}

class ListReader {
  constructor(buffer, position) {
    this.buffer = buffer;
    this.position = position;
  }

  uint16(count) {
    return this.#take(Uint16Array, count);
  }

  int8(count) {
    return this.#take(Int8Array, count);
  }

  #take(Type, count) {
    const list = new Type(this.buffer, this.position, count);
    this.position += Math.ceil(list.byteLength / ALIGNMENT) * ALIGNMENT;
    return list;
  }
}

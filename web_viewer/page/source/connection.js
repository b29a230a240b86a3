import {decodeFrame} from './frames.js';

const FIRST_PAUSE_MS = 500;
const LONGEST_PAUSE_MS = 5000;

/**
 * Talks to the server and comes back when the connection breaks. The server sends one frame at a time and
 * waits for shown(): who is slow gets fewer frames, each the newest.
 */
export class Connection {
  #socket = null;
  #pause = FIRST_PAUSE_MS;

  /** onFrame({header, lists}), onState('open' or 'lost'). */
  constructor(onFrame, onState) {
    this.onFrame = onFrame;
    this.onState = onState;
    this.#open();
  }

  /** The last frame is on the screen. */
  shown() {
    this.send({type: 'shown'});
  }

  send(request) {
    if (this.#socket?.readyState === WebSocket.OPEN) this.#socket.send(JSON.stringify(request));
  }

  #open() {
    const scheme = location.protocol === 'https:' ? 'wss' : 'ws';
    const socket = new WebSocket(`${scheme}://${location.host}/`, 'rimod-web');
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => {
      this.#pause = FIRST_PAUSE_MS;
      this.onState('open');
    };
    socket.onmessage = ({data}) => this.onFrame(decodeFrame(data));
    socket.onclose = () => {
      this.onState('lost');
      setTimeout(() => this.#open(), this.#pause);
      this.#pause = Math.min(2 * this.#pause, LONGEST_PAUSE_MS);
    };
    this.#socket = socket;
  }
}

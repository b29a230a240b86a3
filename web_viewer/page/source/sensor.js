import {BufferAttribute, BufferGeometry, LineBasicMaterial, LineSegments} from 'three';
import {canBeDrawn, matrixOf} from './poses.js';

const ARC_STEP = Math.PI / 36;

/** The sensor: its axes' forward direction and the edges of what it looks at. */
export class Sensor {
  constructor() {
    this.lines = new LineSegments(new BufferGeometry(), new LineBasicMaterial({transparent: true, opacity: 0.75}));
    this.lines.frustumCulled = false;
    this.lines.visible = false;
    this.lines.matrixAutoUpdate = false;
  }

  /** header: a frame of type scan. */
  show({sensor, view}, origin) {
    const ends = [];
    const reach = Math.min(2, Math.max(0.4, 0.22 * view.range));
    const at = (azimuth, elevation, range) => [
      range * Math.cos(elevation) * Math.cos(azimuth), range * Math.cos(elevation) * Math.sin(azimuth),
      range * Math.sin(elevation)];
    const arc = (from, to, point) => {
      const parts = Math.max(1, Math.ceil(Math.abs(to - from) / ARC_STEP));
      for (let i = 0; i < parts; ++i)
        ends.push(...point(from + ((to - from) * i) / parts), ...point(from + ((to - from) * (i + 1)) / parts));
    };
    const [right, left] = view.azimuth;
    const [bottom, top] = view.elevation;
    const full = left - right > 2 * Math.PI - 1e-6;
    for (const elevation of [bottom, top]) arc(right, left, (azimuth) => at(azimuth, elevation, reach));
    for (const azimuth of full ? [] : [right, left]) {
      arc(bottom, top, (elevation) => at(azimuth, elevation, reach));
      for (const elevation of [bottom, top]) ends.push(0, 0, 0, ...at(azimuth, elevation, reach));
    }
    this.#addMark(ends);
    this.lines.geometry.dispose();
    this.lines.geometry = new BufferGeometry();
    this.lines.geometry.setAttribute('position', new BufferAttribute(new Float32Array(ends), 3));
    this.lines.matrix.copy(matrixOf(sensor, origin));
    this.lines.visible = canBeDrawn(...sensor);
  }

  recolour(theme) {
    this.lines.material.color.set(theme.sensor);
  }

  // A small arrow forward on a cross.
  #addMark(ends) {
    const size = 0.12;
    ends.push(0, -size, 0, 0, size, 0, 0, 0, -size, 0, 0, size, 0, 0, 0, 3 * size, 0, 0);
    for (const side of [-1, 1]) ends.push(3 * size, 0, 0, 2 * size, side * 0.5 * size, 0);
  }
}

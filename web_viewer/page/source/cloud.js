import {BufferAttribute, BufferGeometry, Color, Points, ShaderMaterial, Vector3} from 'three';
import {matrixOf} from './poses.js';

const STEPS = 65535;
// Points whose heights are looked at for the colours' ends, about.
const SAMPLED = 5000;

const vertexShader = `
  uniform vec3 origin, extent, sensor, low, middle, high;
  uniform float viewHeight, angle, begin, end;
  uniform int colouring;
  varying vec3 colour;
  void main() {
    vec3 p = origin + position * extent;
    vec4 seen = viewMatrix * vec4(p, 1.0);
    gl_Position = projectionMatrix * seen;
    float range = distance(p, sensor);
    float size = range * angle * projectionMatrix[1][1] * 0.5 * viewHeight / max(-seen.z, 0.1);
    gl_PointSize = clamp(size, 1.5, 8.0);
    float value = colouring == 0 ? p.z : log(max(range, 0.01));
    float share = clamp((value - begin) / (end - begin), 0.0, 1.0);
    colour = colouring == 2 ? middle
        : share < 0.5 ? mix(low, middle, 2.0 * share) : mix(middle, high, 2.0 * share - 1.0);
  }`;

const fragmentShader = `
  varying vec3 colour;
  void main() {
    gl_FragColor = vec4(colour, 1.0);
  }`;

/** The points of a scan. */
export class Cloud {
  #uniforms = {
    origin: {value: new Vector3()}, extent: {value: new Vector3()}, sensor: {value: new Vector3()},
    low: {value: new Color()}, middle: {value: new Color()}, high: {value: new Color()},
    viewHeight: {value: 1}, angle: {value: 0.007}, begin: {value: 0}, end: {value: 1}, colouring: {value: 0},
  };
  #spans = {height: [0, 1], distance: [0, 1], plain: [0, 1]};
  #scan = null;

  constructor() {
    this.colouring = 'height';
    const material = new ShaderMaterial({uniforms: this.#uniforms, vertexShader, fragmentShader});
    this.points = new Points(new BufferGeometry(), material);
    this.points.frustumCulled = false;
    this.points.visible = false;
  }

  /** header, lists: a frame of type scan; origin: of the scene. */
  show(header, lists, origin) {
    const {count, origin: first, step} = header.points;
    this.#scan = {count, first, step, positions: lists.uint16(3 * count)};
    this.points.geometry.dispose();
    this.points.geometry = new BufferGeometry();
    this.points.geometry.setAttribute('position', new BufferAttribute(this.#scan.positions, 3, true));
    this.#uniforms.origin.value.set(first[0] - origin.x, first[1] - origin.y, first[2] - origin.z);
    this.#uniforms.extent.value.set(...step).multiplyScalar(STEPS);
    this.#uniforms.sensor.value.setFromMatrixPosition(matrixOf(header.sensor, origin));
    const {azimuth, elevation, range} = header.view;
    const area = (azimuth[1] - azimuth[0]) * (elevation[1] - elevation[0]);
    this.#uniforms.angle.value = Math.min(0.03, Math.sqrt(area / Math.max(count, 1)));
    this.#spans.height = this.#heightSpan(origin);
    this.#spans.distance = [Math.log(0.5), Math.log(Math.max(range, 1))];
    this.points.visible = count > 0;
  }

  hide() {
    this.#scan = null;
    this.points.visible = false;
  }

  recolour(theme) {
    const {low, middle, high, colouring, begin, end} = this.#uniforms;
    const plain = this.colouring === 'plain';
    low.value.set(theme.ramp[0]);
    middle.value.set(plain ? theme.plain : theme.ramp[1]);
    high.value.set(theme.ramp[2]);
    for (const colour of [low, middle, high]) colour.value.convertLinearToSRGB();  // the shader writes as it is
    colouring.value = ['height', 'distance', 'plain'].indexOf(this.colouring);
    [begin.value, end.value] = this.#spans[this.colouring];
  }

  set viewHeight(pixels) {
    this.#uniforms.viewHeight.value = pixels;
  }

  /** The values at the ends of the colours, m; heights in the local frame. */
  rampEnds(origin) {
    const [begin, end] = this.#spans[this.colouring];
    return this.colouring === 'distance' ? [Math.exp(begin), Math.exp(end)] : [begin + origin.z, end + origin.z];
  }

  /** Height of the floor, or of what is lowest, about the scene's origin. */
  get floor() {
    return this.#spans.height[0];
  }

  /** The point nearest to a ray of the camera, among those within the angle (rad); null without one. */
  pick(ray, angle) {
    if (!this.#scan || !this.points.visible) return null;
    const p = new Vector3();
    let best = null;
    let nearest = Infinity;
    for (let i = 0; i < this.#scan.count; ++i) {
      this.#position(i, p);
      const along = p.clone().sub(ray.origin).dot(ray.direction);
      if (along <= 0 || along >= nearest) continue;
      if (ray.distanceToPoint(p) > along * angle) continue;
      nearest = along;
      best = p.clone();
    }
    return best;
  }

  #position(i, p) {
    const {positions} = this.#scan;
    p.set(positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]).divideScalar(STEPS);
    p.multiply(this.#uniforms.extent.value).add(this.#uniforms.origin.value);
  }

  #heightSpan(origin) {
    const {count, first, step, positions} = this.#scan;
    const heights = [];
    for (let i = 0; i < count; i += Math.ceil(count / SAMPLED))
      heights.push(first[2] - origin.z + positions[3 * i + 2] * step[2]);
    if (heights.length === 0) return [0, 1];
    heights.sort((a, b) => a - b);
    const at = (share) => heights[Math.floor(share * (heights.length - 1))];
    return [at(0.02), Math.max(at(0.98), at(0.02) + 0.1)];
  }
}

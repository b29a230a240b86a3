import {
  Box3, BufferAttribute, BufferGeometry, Color, Group, LineBasicMaterial, LineSegments, Points, Ray, ShaderMaterial,
  Vector3,
} from 'three';
import {canBeDrawn, matrixOf} from './poses.js';

const STEPS = 65535;
// Hypotheses drawn as surfaces; the others are left to their number.
const MAX_GHOSTS = 40;
const UNKNOWN_BOX = [[-0.15, -0.15, 0], [0.15, 0.15, 0.3]];

// Discs that face their normals' side; a little nearer than they are, so that the measured points do not shine through.
const vertexShader = `
  attribute vec4 facing;
  uniform vec3 origin, extent;
  uniform float viewHeight, spacing;
  varying float light;
  void main() {
    vec4 seen = modelViewMatrix * vec4(origin + position * extent, 1.0);
    vec3 n = normalize(mat3(modelViewMatrix) * facing.xyz);
    vec3 toEye = -normalize(seen.xyz);
    light = dot(n, toEye);
    gl_Position = projectionMatrix * (seen + vec4(toEye * 0.03, 0.0));
    gl_PointSize = clamp(2.5 * spacing * projectionMatrix[1][1] * 0.5 * viewHeight / max(-seen.z, 0.1), 2.0, 40.0);
  }`;

// Ghosts leave pixels out in a pattern instead of blending: discs overlap, and are in no order.
const fragmentShader = `
  uniform vec3 colour;
  uniform float opacity;
  varying float light;
  float threshold(ivec2 p) {
    int bayer = ((p.x ^ p.y) & 1) * 8 + (p.y & 1) * 4 + (((p.x ^ p.y) >> 1) & 1) * 2 + ((p.y >> 1) & 1);
    return (float(bayer) + 0.5) / 16.0;
  }
  void main() {
    vec2 p = gl_PointCoord - 0.5;
    if (light < 0.0 || dot(p, p) > 0.25 || opacity < threshold(ivec2(gl_FragCoord.xy))) discard;
    gl_FragColor = vec4(colour * (0.42 + 0.58 * light), 1.0);
  }`;

const viewHeight = {value: 1};

/** Found objects and hypotheses, drawn with their models' surfaces. */
export class Objects {
  #surfaces = new Map();  // by model name: {geometry, origin, extent, spacing, box}
  #colours;

  constructor(colours) {
    this.#colours = colours;
    this.found = new Group();
    this.ghosts = new Group();
    this.items = [];  // what is found: {detection, matrix, box, provisional}
  }

  set viewHeight(pixels) {
    viewHeight.value = pixels;
  }

  /** header, lists: a frame of type model. */
  addModel(header, lists) {
    const {count, origin, step} = header.points;
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(lists.uint16(3 * count), 3, true));
    geometry.setAttribute('facing', new BufferAttribute(lists.int8(4 * count), 4, true));
    const extent = new Vector3(...step).multiplyScalar(STEPS);
    this.#surfaces.set(header.name,
                       {geometry, origin: new Vector3(...origin), extent, spacing: header.spacing, box: header.box});
  }

  has(name) {
    return this.#surfaces.has(name);
  }

  /** objects: a frame's header of type objects, or null; faded: they are of another scan; selected: an index. */
  show(objects, origin, {faded, selected}) {
    clear(this.found);
    clear(this.ghosts);
    const provisional = !objects?.detections;
    const detections = objects?.detections ?? objects?.early ?? [];
    this.items = [];
    detections.forEach((detection, index) => {
      if (!canBeDrawn(...detection.pose, ...detection.box.flat())) return;
      const item = {detection, index, provisional, matrix: matrixOf(detection.pose, origin), box: detection.box};
      this.items.push(item);
      const opacity = faded ? 0.35 : provisional ? 0.6 : 1;
      this.#addSurface(this.found, detection.class, item.matrix, opacity);
      this.#addBox(this.found, item, index === selected ? 1 : faded ? 0.25 : 0.55, index === selected);
    });
    this.#showGhosts(objects?.hypotheses ?? [], origin);
  }

  /** The found object that a ray meets first; null without one. */
  pick(ray) {
    let nearest = Infinity;
    let best = null;
    for (const item of this.items) {
      const inverse = item.matrix.clone().invert();
      const local = new Ray().copy(ray).applyMatrix4(inverse);
      const box = new Box3(new Vector3(...item.box[0]), new Vector3(...item.box[1])).expandByScalar(0.02);
      const hit = local.intersectBox(box, new Vector3());
      if (!hit) continue;
      const distance = hit.applyMatrix4(item.matrix).distanceTo(ray.origin);
      if (distance < nearest) [nearest, best] = [distance, item];
    }
    return best;
  }

  #showGhosts(hypotheses, origin) {
    const open = hypotheses.filter(({stage, pose}) => stage !== 'validated' && canBeDrawn(...pose));
    for (const hypothesis of open.slice(0, MAX_GHOSTS)) {
      const matrix = matrixOf(hypothesis.pose, origin);
      const surface = this.#surfaces.get(hypothesis.class);
      const detection = {class: hypothesis.class};
      if (surface) this.#addSurface(this.ghosts, hypothesis.class, matrix, 0.2);
      this.#addBox(this.ghosts, {detection, matrix, box: surface?.box ?? UNKNOWN_BOX}, 0.3, false);
    }
  }

  #addSurface(group, name, matrix, opacity) {
    const surface = this.#surfaces.get(name);
    if (!surface) return;
    const colour = new Color(this.#colours.ofClass(name)).convertLinearToSRGB();
    const uniforms = {
      origin: {value: surface.origin}, extent: {value: surface.extent}, spacing: {value: surface.spacing}, viewHeight,
      colour: {value: colour}, opacity: {value: opacity},
    };
    const points = new Points(surface.geometry, new ShaderMaterial({uniforms, vertexShader, fragmentShader}));
    points.frustumCulled = false;
    place(points, matrix);
    group.add(points);
  }

  #addBox(group, {detection, matrix, box}, opacity, selected) {
    const [low, high] = box;
    const corner = (i) => [i & 1 ? high[0] : low[0], i & 2 ? high[1] : low[1], i & 4 ? high[2] : low[2]];
    const ends = [];
    for (let i = 0; i < 8; ++i)
      for (const bit of [1, 2, 4])
        if (!(i & bit)) ends.push(...corner(i), ...corner(i | bit));
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(new Float32Array(ends), 3));
    const color = selected ? this.#colours.theme.selection : this.#colours.ofClass(detection.class);
    const lines = new LineSegments(geometry, new LineBasicMaterial({color, transparent: true, opacity}));
    lines.userData.ownsGeometry = true;
    place(lines, matrix);
    group.add(lines);
  }
}

function place(object, matrix) {
  object.matrixAutoUpdate = false;
  object.matrix.copy(matrix);
}

function clear(group) {
  for (const child of group.children) {
    child.material.dispose();
    if (child.userData.ownsGeometry) child.geometry.dispose();
  }
  group.clear();
}

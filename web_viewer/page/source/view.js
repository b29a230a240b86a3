import {
  BufferAttribute, BufferGeometry, Color, LineBasicMaterial, LineSegments, PerspectiveCamera, Raycaster, Scene, Vector2,
  Vector3, WebGLRenderer,
} from 'three';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';
import {matrixOf} from './poses.js';

const CLICK_PIXELS = 4;  // a pointer that moved more turns the view
const FAR_AWAY = 1000;   // m from the scene's origin, where single precision gets coarse
const GRID_REACH = 10;   // m to each side

/** The window into the scene: camera, its handling, drawing when something has changed. */
export class View {
  #renderer;
  #wanted = false;
  #after = [];

  /** onClick(ray, angle of a few pixels in rad), onDraw(camera, width, height). */
  constructor(canvas, onClick, onDraw) {
    this.canvas = canvas;
    this.onDraw = onDraw;
    this.origin = null;  // of the scene, in the local frame
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(50, 1, 0.05, 500);
    this.camera.up.set(0, 0, 1);
    this.#renderer = new WebGLRenderer({canvas, antialias: true});
    this.#renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener('change', () => this.draw());
    this.grid = makeGrid();
    this.scene.add(this.grid);
    new ResizeObserver(() => this.draw()).observe(canvas.parentElement);
    this.#listenForClicks(canvas, onClick);
  }

  /** Draws soon; after, if given, is called when it is done. */
  draw(after) {
    if (after) this.#after.push(after);
    if (this.#wanted) return;
    this.#wanted = true;
    requestAnimationFrame(() => this.#drawNow());
  }

  /** Height of the drawing, in its own pixels. */
  get pixels() {
    return this.canvas.height;
  }

  recolour(theme) {
    this.scene.background = new Color(theme.background);
    this.grid.material.color.set(theme.grid);
  }

  /** Puts the origin of the scene near the sensor, if it is not: true when it moved. */
  centre([x, y, z]) {
    const sensor = new Vector3(x, y, z);
    if (this.origin && this.origin.distanceTo(sensor) < FAR_AWAY) return false;
    this.origin = sensor.round();
    return true;
  }

  /** Looks over the sensor's shoulder. header: a frame of type scan. */
  lookAlong({sensor, view}, floor) {
    const matrix = matrixOf(sensor, this.origin);
    const position = new Vector3().setFromMatrixPosition(matrix);
    const middle = (view.azimuth[0] + view.azimuth[1]) / 2;
    const forward = new Vector3(Math.cos(middle), Math.sin(middle), 0).transformDirection(matrix);
    const reach = Math.min(12, Math.max(2, view.range));
    this.controls.target.copy(position).addScaledVector(forward, 0.5 * reach).setZ(floor + 0.4);
    const back = position.clone().addScaledVector(forward, -0.55 * reach);
    this.camera.position.copy(back).setZ(Math.max(position.z, floor) + 0.62 * reach);
    this.controls.update();
    this.draw();
  }

  #drawNow() {
    this.#wanted = false;
    const {clientWidth: width, clientHeight: height} = this.canvas.parentElement;
    const size = this.#renderer.getSize(new Vector2());
    if (width > 0 && height > 0 && (size.x !== width || size.y !== height)) {
      this.#renderer.setSize(width, height);
      this.camera.aspect = width / height;
      this.camera.updateProjectionMatrix();
    }
    this.camera.updateMatrixWorld();
    this.onDraw(this.camera, width, height);
    this.#renderer.render(this.scene, this.camera);
    for (const after of this.#after.splice(0)) after();
  }

  #listenForClicks(canvas, onClick) {
    let pressed = null;
    canvas.addEventListener('pointerdown', (event) => { pressed = event; });
    canvas.addEventListener('pointerup', (event) => {
      const moved = !pressed || Math.hypot(event.clientX - pressed.clientX, event.clientY - pressed.clientY);
      if (moved > CLICK_PIXELS || event.button !== 0) return;
      const box = canvas.getBoundingClientRect();
      const at = new Vector2((2 * (event.clientX - box.left)) / box.width - 1,
                             1 - (2 * (event.clientY - box.top)) / box.height);
      const raycaster = new Raycaster();
      raycaster.setFromCamera(at, this.camera);
      onClick(raycaster.ray, (CLICK_PIXELS * this.camera.fov * Math.PI) / 180 / box.height);
    });
  }
}

// Squares of 1 m, each side a line of its own: software renderers leave out lines that end behind the camera.
function makeGrid() {
  const ends = [];
  for (let i = -GRID_REACH; i <= GRID_REACH; ++i)
    for (let j = -GRID_REACH; j < GRID_REACH; ++j) ends.push(i, j, 0, i, j + 1, 0, j, i, 0, j + 1, i, 0);
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(new Float32Array(ends), 3));
  return new LineSegments(geometry, new LineBasicMaterial());
}

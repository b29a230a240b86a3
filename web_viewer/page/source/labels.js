import {Vector3} from 'three';

const GAP = 4;  // pixels between labels

/** Names beside the found objects, moved up where they would lie on each other. */
export class Labels {
  #element;
  #elements = [];

  constructor(element) {
    this.#element = element;
    this.visible = true;
  }

  /** items: of Objects. */
  show(items, colours, faded) {
    this.#element.replaceChildren();
    this.#elements = items.map(({detection, matrix, box, provisional}) => {
      const label = document.createElement('div');
      label.className = 'label';
      label.classList.toggle('provisional', provisional || faded);
      label.style.setProperty('--colour', colours.ofClass(detection.class));
      label.textContent = `${detection.class} ${detection.score.toFixed(2)}`;
      this.#element.append(label);
      const [low, high] = box;
      const top = new Vector3((low[0] + high[0]) / 2, (low[1] + high[1]) / 2, high[2]).applyMatrix4(matrix);
      return {label, top};
    });
  }

  /** Moves the labels to where the camera sees their objects. */
  place(camera, width, height) {
    const placed = [];
    const seen = this.#elements.map(({label, top}) => ({label, at: top.clone().project(camera)}));
    seen.sort((a, b) => b.at.y - a.at.y || a.at.x - b.at.x);
    for (const {label, at} of seen.reverse()) {
      const inView = this.visible && Math.abs(at.x) < 1 && Math.abs(at.y) < 1 && Math.abs(at.z) < 1;
      label.hidden = !inView;
      if (!inView) continue;
      const size = {width: label.offsetWidth, height: label.offsetHeight};
      const x = clamp(((at.x + 1) / 2) * width - size.width / 2, GAP, width - size.width - GAP);
      let y = clamp(((1 - at.y) / 2) * height - size.height - GAP, GAP, height - size.height - GAP);
      for (let moved = true; moved && y > GAP;) {
        moved = false;
        for (const other of placed) {
          const overlaps = x < other.x + other.width + GAP && other.x < x + size.width + GAP &&
              y < other.y + other.height + GAP && other.y < y + size.height + GAP;
          if (!overlaps) continue;
          y = other.y - size.height - GAP;
          moved = true;
        }
      }
      placed.push({x, y, ...size});
      label.style.transform = `translate(${Math.round(x)}px, ${Math.round(y)}px)`;
    }
  }
}

function clamp(value, low, high) {
  return Math.max(low, Math.min(high, value));
}

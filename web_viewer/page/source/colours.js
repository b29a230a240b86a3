// Colours of things in the scene; those of the page around it are in page.css. Class colours differ in hue and lightness
// and, in the dark, are those of rimod's pictures (viewer_tools/palette.cpp).

const THEMES = {
  dark: {
    background: '#14171c', grid: '#2c323b', sensor: '#e8ecf2', selection: '#ffffff',
    ramp: ['#3a5aa0', '#4a9aa0', '#d2cc9e'], plain: '#8b97a6',
    classes: ['#ff8c00', '#3cdc3c', '#ff3cdc', '#ffeb00', '#00c8ff', '#ff4646', '#9a9aff', '#00c48c'],
  },
  light: {
    background: '#f6f7f9', grid: '#d3d8df', sensor: '#2a3038', selection: '#000000',
    ramp: ['#233f7d', '#2f858c', '#a8954e'], plain: '#6b7684',
    classes: ['#c75b00', '#1c8a1c', '#b3149a', '#8f7200', '#0077b3', '#c8102e', '#4a3fd1', '#00735c'],
  },
};

const STORED = 'rimod-theme';

/** The theme and the colour of each class. */
export class Colours {
  #names = [];

  constructor() {
    const system = matchMedia('(prefers-color-scheme: light)');
    this.themeName = localStorage.getItem(STORED) ?? (system.matches ? 'light' : 'dark');
  }

  get theme() {
    return THEMES[this.themeName];
  }

  switchTheme() {
    this.themeName = this.themeName === 'dark' ? 'light' : 'dark';
    localStorage.setItem(STORED, this.themeName);
  }

  /** Classes with models, sorted; others get the further colours as they come. */
  setNames(names) {
    this.#names = [...names];
  }

  ofClass(name) {
    let index = this.#names.indexOf(name);
    if (index < 0) index = this.#names.push(name) - 1;
    return this.theme.classes[index % this.theme.classes.length];
  }
}

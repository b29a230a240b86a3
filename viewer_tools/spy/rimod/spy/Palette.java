package rimod.spy;

import java.awt.Color;

/** The colours of the pictures: those of rimod-view. */
final class Palette {
  static final Color BACKGROUND = new Color(28, 30, 32);
  static final Color AREA = new Color(18, 20, 22);
  static final Color GRID = new Color(54, 56, 58);
  static final Color TEXT = new Color(230, 230, 230);
  static final Color NO_RETURN = new Color(64, 24, 84);
  static final Color HATCH_DARK = new Color(22, 22, 22);
  static final Color HATCH_LIGHT = new Color(60, 60, 60);
  static final Color NOT_RECEIVED = new Color(120, 20, 20);
  static final Color POINT = Color.WHITE;

  private static final Color NEAR = new Color(240, 232, 214);
  private static final Color MIDDLE = new Color(100, 140, 160);
  private static final Color FAR = new Color(22, 36, 64);
  private static final Color[] OBJECTS = {
    new Color(255, 140, 0), new Color(60, 220, 60), new Color(255, 60, 220),
    new Color(255, 235, 0), new Color(0, 200, 255), new Color(255, 70, 70),
    new Color(110, 110, 255), new Color(0, 150, 100),
  };

  private Palette() {}

  static Color object(int index) {
    return OBJECTS[Math.floorMod(index, OBJECTS.length)];
  }

  /** From near (share 0) to far (1). */
  static Color range(double share) {
    double s = Math.max(0.0, Math.min(1.0, share));
    return s < 0.5 ? between(NEAR, MIDDLE, 2 * s) : between(MIDDLE, FAR, 2 * s - 1);
  }

  private static Color between(Color a, Color b, double share) {
    return new Color(
        mix(a.getRed(), b.getRed(), share),
        mix(a.getGreen(), b.getGreen(), share),
        mix(a.getBlue(), b.getBlue(), share));
  }

  private static int mix(int a, int b, double share) {
    return (int) Math.round(a * (1 - share) + b * share);
  }
}

package rimod.spy;

import java.awt.Graphics;
import java.awt.Rectangle;
import java.awt.Shape;

/** What stands for pixels that no beam looked at. */
final class Hatch {
  private static final int PERIOD = 8;

  private Hatch() {}

  static void fill(Graphics graphics, Rectangle area) {
    Shape clip = graphics.getClip();
    graphics.clipRect(area.x, area.y, area.width, area.height);
    graphics.setColor(Palette.HATCH_DARK);
    graphics.fillRect(area.x, area.y, area.width, area.height);
    graphics.setColor(Palette.HATCH_LIGHT);
    for (int x = area.x; x < area.x + area.width + area.height; x += PERIOD) {
      graphics.drawLine(x, area.y, x - area.height, area.y + area.height);
      graphics.drawLine(x + 1, area.y, x + 1 - area.height, area.y + area.height);
    }
    graphics.setClip(clip);
  }
}

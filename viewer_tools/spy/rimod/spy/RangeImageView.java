package rimod.spy;

import java.awt.Color;
import java.awt.Graphics;
import java.awt.Point;
import java.awt.Rectangle;
import java.awt.event.MouseEvent;
import java.awt.event.MouseMotionAdapter;
import java.awt.image.BufferedImage;
import java.util.ArrayList;
import java.util.List;

/**
 * A range image in colours of distance with the interest points on it. Shows the last one that is
 * whole; where sections were lost and nothing more of it comes, what came.
 */
final class RangeImageView extends ChannelView {
  private static final long serialVersionUID = 1;
  private static final int TITLE_HEIGHT = 24;
  private static final int FOOTER_HEIGHT = 52;
  private static final int BORDER = 8;
  private static final long PATIENCE_NS = 300_000_000; // for further sections

  private final String imageChannel;
  private final String featureChannel;
  private transient RangeImageParts incoming;
  private transient RangeImageParts shown;
  private transient FeatureParts features;
  private transient BufferedImage picture;
  private transient Point mouse;
  private long incomingAt;
  private double near = 0.5; // m
  private double far = 5.0; // m

  RangeImageView(String channel) {
    super(940, 540);
    imageChannel = channel;
    featureChannel = channel.replace("RANGE_IMAGE", "FEATURES");
    addMouseMotionListener(
        new MouseMotionAdapter() {
          @Override
          public void mouseMoved(MouseEvent event) {
            mouse = event.getPoint();
            repaint();
          }
        });
  }

  @Override
  List<String> channels() {
    List<String> channels = new ArrayList<>(List.of(imageChannel));
    if (!featureChannel.equals(imageChannel)) channels.add(featureChannel);
    return channels;
  }

  @Override
  void take(String channel, byte[] bytes) throws BadMessage {
    if (!channel.equals(imageChannel)) {
      features = FeatureParts.add(features, bytes);
      return;
    }
    RangeImageParts before = incoming;
    incoming = RangeImageParts.add(incoming, bytes);
    incomingAt = System.nanoTime();
    if (before != null && before != incoming && before != shown) show(before);
    if (incoming.complete()) show(incoming);
  }

  @Override
  synchronized boolean refresh() {
    boolean stalled = incoming != null && incoming != shown;
    if (stalled && System.nanoTime() - incomingAt > PATIENCE_NS) {
      show(incoming);
      return true;
    }
    return super.refresh();
  }

  private void show(RangeImageParts image) {
    shown = image;
    near = image.quantile(0.01) * image.rangeUnit;
    far = Math.max(image.quantile(0.9) * image.rangeUnit, 1.1 * near);
    picture = new BufferedImage(image.width, image.height, BufferedImage.TYPE_INT_ARGB);
    for (int row = 0; row < image.height; ++row)
      for (int column = 0; column < image.width; ++column)
        picture.setRGB(column, row, colourOf(image, row, column));
  }

  private int colourOf(RangeImageParts image, int row, int column) {
    if (!image.hasRow(row)) return Palette.NOT_RECEIVED.getRGB();
    int steps = image.steps(row, column);
    if (steps == RangeImageParts.NEVER_OBSERVED) return 0; // lets the hatch through
    if (steps == RangeImageParts.NO_RETURN) return Palette.NO_RETURN.getRGB();
    return rangeColour(steps * image.rangeUnit).getRGB();
  }

  private Color rangeColour(double range) {
    return Palette.range(Math.log(range / near) / Math.log(far / near));
  }

  /** Where the image is on the panel: as large as fits, pixels square. */
  private Rectangle area() {
    int width = Math.max(1, getWidth() - 2 * BORDER);
    int height = Math.max(1, getHeight() - TITLE_HEIGHT - FOOTER_HEIGHT);
    double scale = Math.min((double) width / shown.width, (double) height / shown.height);
    if (scale >= 1.0) scale = Math.floor(scale);
    int w = Math.max(1, (int) (shown.width * scale));
    int h = Math.max(1, (int) (shown.height * scale));
    return new Rectangle(BORDER + (width - w) / 2, TITLE_HEIGHT, w, h);
  }

  @Override
  protected synchronized void paintComponent(Graphics graphics) {
    graphics.setColor(Palette.BACKGROUND);
    graphics.fillRect(0, 0, getWidth(), getHeight());
    graphics.setColor(Palette.TEXT);
    if (shown == null) {
      graphics.drawString("waiting for " + imageChannel + complaint(), BORDER, 18);
      return;
    }
    graphics.drawString(title(), BORDER, 16);
    Rectangle area = area();
    Hatch.fill(graphics, area);
    graphics.drawImage(picture, area.x, area.y, area.width, area.height, null);
    if (features != null && features.utime == shown.utime) paintPoints(graphics, area);
    paintLegend(graphics, area.y + area.height + 8);
    graphics.setColor(Palette.TEXT);
    graphics.drawString(readOut(area), BORDER, area.y + area.height + 44);
  }

  private String title() {
    String text = "scan " + shown.utime + ", " + shown.width + " x " + shown.height + " pixels";
    if (shown.isPinhole()) text += ", pinhole";
    if (!shown.complete()) text += ", " + shown.progress();
    if (features != null && features.utime == shown.utime)
      text += ", " + features.points.size() + " interest points";
    return text + complaint();
  }

  private void paintPoints(Graphics graphics, Rectangle area) {
    double pixel = (double) area.width / shown.width;
    for (float[] p : features.points) {
      double[] position = shown.positionOf(p);
      if (position == null) continue;
      double x = area.x + position[0] * pixel;
      double y = area.y + position[1] * pixel;
      if (!area.contains(x, y)) continue;
      graphics.setColor(Color.BLACK);
      graphics.fillRect((int) x - 2, (int) y - 2, 4, 4);
      graphics.setColor(Palette.POINT);
      graphics.fillRect((int) x - 1, (int) y - 1, 2, 2);
    }
  }

  private void paintLegend(Graphics graphics, int y) {
    int x = text(graphics, String.format("%.1f m", near), BORDER, y);
    for (int i = 0; i < 140; ++i) {
      graphics.setColor(Palette.range(i / 140.0));
      graphics.fillRect(x + i, y, 1, 14);
    }
    x = text(graphics, String.format("%.1f m and farther", far), x + 146, y) + 12;
    graphics.setColor(Palette.NO_RETURN);
    graphics.fillRect(x, y, 22, 14);
    x = text(graphics, "no return", x + 28, y) + 12;
    Hatch.fill(graphics, new Rectangle(x, y, 22, 14));
    x = text(graphics, "never observed", x + 28, y) + 12;
    graphics.setColor(Palette.NOT_RECEIVED);
    graphics.fillRect(x, y, 22, 14);
    x = text(graphics, "not received", x + 28, y) + 12;
    graphics.setColor(Palette.POINT);
    graphics.fillRect(x + 9, y + 5, 4, 4);
    text(graphics, "interest point", x + 22, y);
  }

  /** Returns where the text ends. */
  private static int text(Graphics graphics, String text, int x, int y) {
    graphics.setColor(Palette.TEXT);
    graphics.drawString(text, x, y + 12);
    return x + graphics.getFontMetrics().stringWidth(text) + 6;
  }

  private String readOut(Rectangle area) {
    if (mouse == null || !area.contains(mouse)) return "point with the mouse: range";
    int column = (int) ((double) (mouse.x - area.x) / area.width * shown.width);
    int row = (int) ((double) (mouse.y - area.y) / area.height * shown.height);
    double[] direction = shown.directionOf(row, column);
    int steps = shown.steps(row, column);
    String what = String.format("range %.3f m", steps * shown.rangeUnit);
    if (steps == RangeImageParts.NO_RETURN) what = "no return";
    if (steps == RangeImageParts.NEVER_OBSERVED)
      what = shown.hasRow(row) ? "never observed" : "not received";
    return String.format(
        "row %d, column %d: azimuth %+.1f, elevation %+.1f deg, %s",
        row, column, direction[0], direction[1], what);
  }
}

package rimod.spy;

import java.awt.BasicStroke;
import java.awt.Color;
import java.awt.Graphics;
import java.awt.Graphics2D;
import java.awt.Rectangle;
import java.awt.RenderingHints;
import java.awt.geom.Path2D;
import java.util.ArrayList;
import java.util.List;
import java.util.TreeSet;

/** The objects of the last detections message from above: x upwards, y to the left. */
final class DetectionsView extends ChannelView {
  private static final long serialVersionUID = 1;
  private static final int TITLE_HEIGHT = 26;
  private static final int BORDER = 40; // for the grid's numbers
  private static final double MARGIN = 1.0; // m
  private static final double FARTHEST = 1000.0; // m from the sensor: others are left out

  private final String channel;
  private transient FoundObjects found;
  private transient List<FoundObject> near = new ArrayList<>();
  private transient Rectangle area;
  private double scale; // pixels a metre
  private double maxX; // m, upper edge
  private double maxY; // m, left edge

  DetectionsView(String channel) {
    super(640, 640);
    this.channel = channel;
  }

  @Override
  List<String> channels() {
    return List.of(channel);
  }

  @Override
  void take(String from, byte[] bytes) throws BadMessage {
    found = FoundObjects.read(bytes);
    near = new ArrayList<>();
    for (FoundObject object : found.objects) if (isNear(object)) near.add(object);
  }

  private boolean isNear(FoundObject object) {
    for (double[] corner : object.corners())
      if (!(Math.hypot(corner[0] - found.sensor[0], corner[1] - found.sensor[1]) < FARTHEST))
        return false;
    return true;
  }

  @Override
  protected synchronized void paintComponent(Graphics graphics) {
    Graphics2D g = (Graphics2D) graphics;
    g.setRenderingHint(RenderingHints.KEY_ANTIALIASING, RenderingHints.VALUE_ANTIALIAS_ON);
    g.setColor(Palette.BACKGROUND);
    g.fillRect(0, 0, getWidth(), getHeight());
    g.setColor(Palette.TEXT);
    if (found == null) {
      g.drawString("waiting for " + channel + complaint(), 8, 18);
      return;
    }
    g.drawString(title(), 8, 18);
    layOut();
    g.setColor(Palette.AREA);
    g.fill(area);
    paintGrid(g);
    paintSensor(g);
    List<String> names = new ArrayList<>(new TreeSet<>(namesOf(near)));
    for (FoundObject object : near)
      paintObject(g, object, Palette.object(names.indexOf(object.name)));
    List<Rectangle> taken = new ArrayList<>(); // first the objects, then also labels
    for (FoundObject object : near) taken.add(outline(object));
    for (int i = 0; i < near.size(); ++i) {
      g.setColor(Palette.object(names.indexOf(near.get(i).name)));
      paintLabel(g, near.get(i), taken, i);
    }
  }

  private String title() {
    String text = near.size() + " objects found, " + found.numModels + " models, scan " + found.utime;
    return text + (found.early ? ", told early" : "") + complaint();
  }

  private static List<String> namesOf(List<FoundObject> objects) {
    List<String> names = new ArrayList<>();
    for (FoundObject object : objects) names.add(object.name);
    return names;
  }

  /** Sensor and objects fill the panel. */
  private void layOut() {
    double[] min = {found.sensor[0], found.sensor[1]};
    double[] max = min.clone();
    for (FoundObject object : near) {
      for (double[] corner : object.corners()) {
        for (int i = 0; i < 2; ++i) {
          min[i] = Math.min(min[i], corner[i]);
          max[i] = Math.max(max[i], corner[i]);
        }
      }
    }
    int width = Math.max(1, getWidth() - BORDER - 8);
    int height = Math.max(1, getHeight() - TITLE_HEIGHT - BORDER);
    area = new Rectangle(BORDER, TITLE_HEIGHT, width, height);
    scale = Math.min(width / (max[1] - min[1] + 2 * MARGIN), height / (max[0] - min[0] + 2 * MARGIN));
    maxX = 0.5 * (min[0] + max[0]) + 0.5 * height / scale;
    maxY = 0.5 * (min[1] + max[1]) + 0.5 * width / scale;
  }

  private double toU(double y) {
    return area.x + (maxY - y) * scale;
  }

  private double toV(double x) {
    return area.y + (maxX - x) * scale;
  }

  private void paintGrid(Graphics2D g) {
    int step = 1; // m
    while (step * scale < 40) step *= step % 3 == 2 ? 2 : 5; // 1, 5, 10, 50: wide enough for numbers
    for (long x = (long) Math.ceil((maxX - area.height / scale) / step) * step; x <= maxX; x += step) {
      g.setColor(Palette.GRID);
      g.drawLine(area.x, (int) toV(x), area.x + area.width, (int) toV(x));
      g.setColor(Palette.TEXT);
      g.drawString(Long.toString(x), 8, (int) toV(x) + 5);
    }
    for (long y = (long) Math.ceil((maxY - area.width / scale) / step) * step; y <= maxY; y += step) {
      g.setColor(Palette.GRID);
      g.drawLine((int) toU(y), area.y, (int) toU(y), area.y + area.height);
      g.setColor(Palette.TEXT);
      g.drawString(Long.toString(y), (int) toU(y) - 4, area.y + area.height + 15);
    }
    g.drawString("x [m] up, y [m] left, local frame", area.x, area.y + area.height + 32);
  }

  private void paintSensor(Graphics2D g) {
    Path2D triangle = new Path2D.Double();
    double cos = Math.cos(found.sensorHeading), sin = Math.sin(found.sensorHeading);
    double[][] corners = {{16, 0}, {-8, 9}, {-8, -9}}; // pixels, forward and left
    for (int i = 0; i < 3; ++i) {
      double forward = cos * corners[i][0] - sin * corners[i][1];
      double left = sin * corners[i][0] + cos * corners[i][1];
      double u = toU(found.sensor[1]) - left, v = toV(found.sensor[0]) - forward;
      if (i == 0) triangle.moveTo(u, v);
      else triangle.lineTo(u, v);
    }
    g.setColor(Color.WHITE);
    g.fill(triangle);
    g.drawString("sensor", (float) toU(found.sensor[1]) + 14, (float) toV(found.sensor[0]) + 6);
  }

  private void paintObject(Graphics2D g, FoundObject object, Color colour) {
    double[][] corners = object.corners();
    g.setColor(colour);
    g.setStroke(stroke());
    for (int i = 0; i < 4; ++i) {
      line(g, corners[i], corners[(i + 1) % 4]);
      line(g, corners[4 + i], corners[4 + (i + 1) % 4]);
      line(g, corners[i], corners[4 + i]);
    }
    g.setStroke(new BasicStroke(2));
    line(g, object.place(0, 0, 0), object.front());
  }

  /** The rectangle round an object, pixels. */
  private Rectangle outline(FoundObject object) {
    Rectangle outline = null;
    for (double[] corner : object.corners()) {
      Rectangle point = new Rectangle((int) toU(corner[1]), (int) toV(corner[0]), 1, 1);
      outline = outline == null ? point : outline.union(point);
    }
    return outline;
  }

  private BasicStroke stroke() {
    float[] dashes = {6, 5};
    return found.early
        ? new BasicStroke(2, BasicStroke.CAP_BUTT, BasicStroke.JOIN_MITER, 10, dashes, 0)
        : new BasicStroke(2);
  }

  private void line(Graphics2D g, double[] a, double[] b) {
    g.drawLine((int) toU(a[1]), (int) toV(a[0]), (int) toU(b[1]), (int) toV(b[0]));
  }

  /** Above the object taken.get(own), or higher where another object or label stands. */
  private void paintLabel(Graphics2D g, FoundObject object, List<Rectangle> taken, int own) {
    Rectangle outline = taken.get(own);
    int width = g.getFontMetrics().stringWidth(object.label()) + 8;
    int x = (int) outline.getCenterX() - width / 2;
    x = Math.max(area.x, Math.min(x, area.x + area.width - width));
    Rectangle place = new Rectangle(x, Math.max(outline.y - 24, area.y), width, 19);
    for (int tries = 0; tries < 40 && hitsAny(place, taken, own); ++tries) place.y -= 5;
    place.y = Math.max(place.y, area.y);
    taken.add(place);
    g.setStroke(new BasicStroke(1));
    Color colour = g.getColor();
    g.setColor(new Color(16, 16, 16));
    g.fill(place);
    g.setColor(colour);
    g.draw(place);
    g.drawString(object.label(), place.x + 4, place.y + 14);
  }

  private static boolean hitsAny(Rectangle place, List<Rectangle> taken, int own) {
    for (int i = 0; i < taken.size(); ++i)
      if (i != own && taken.get(i).intersects(place)) return true;
    return false;
  }
}

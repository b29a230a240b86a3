package rimod.spy;

import java.util.BitSet;
import rimod.range_image_t;

/**
 * A range image that comes in sections, as far as it is there: lcm-spy has the stock receive buffer and
 * may lose some.
 */
final class RangeImageParts {
  static final int NEVER_OBSERVED = 0;
  static final int NO_RETURN = 65535;
  private static final int MAX_PIXELS = 4000000;

  final long utime;
  final int width;
  final int height;
  final double resolution; // rad a pixel
  private final double left; // rad, or a tangent: rimod.range_image_t
  private final double top;
  private final boolean pinhole;
  private final double[][] axes; // of a pinhole image: along its axis, to the left, upwards
  final double rangeUnit; // m
  private final int numSections;
  private final BitSet sections = new BitSet();
  private final BitSet rows = new BitSet();
  private final short[] ranges;

  /** The image that the section of a message begins; add() puts the section itself in. */
  private RangeImageParts(
      long utime, int numSections, int width, int height, double[] grid, int projection, double[] axis)
      throws BadMessage {
    boolean bad = numSections < 1 || width < 1 || height < 1;
    if (bad || (long) width * height > MAX_PIXELS) throw new BadMessage("has an absurd size");
    for (double value : grid)
      if (!Double.isFinite(value)) throw new BadMessage("has an absurd grid");
    for (double value : axis)
      if (!Double.isFinite(value)) throw new BadMessage("has an absurd axis");
    if (projection != range_image_t.SPHERICAL && projection != range_image_t.PINHOLE)
      throw new BadMessage("has an unknown projection");
    if (!(grid[0] > 0.0) || !(grid[3] > 0.0)) throw new BadMessage("has an absurd grid");
    this.utime = utime;
    this.numSections = numSections;
    this.width = width;
    this.height = height;
    resolution = grid[0];
    left = grid[1];
    top = grid[2];
    pinhole = projection == range_image_t.PINHOLE;
    double ca = Math.cos(axis[0]), sa = Math.sin(axis[0]);
    double ce = Math.cos(axis[1]), se = Math.sin(axis[1]);
    axes = new double[][] {{ce * ca, ce * sa, se}, {-sa, ca, 0}, {-se * ca, -se * sa, ce}};
    rangeUnit = grid[3];
    ranges = new short[width * height];
  }

  /** The image so far with the section in the message; a new image where it is of another one. */
  static RangeImageParts add(RangeImageParts current, byte[] message) throws BadMessage {
    MessageReader reader = new MessageReader(message, range_image_t.LCM_FINGERPRINT);
    long utime = reader.readLong();
    int section = reader.readInt();
    int numSections = reader.readInt();
    reader.readDoubles(7); // the sensor's pose
    int width = reader.readInt();
    int height = reader.readInt();
    double[] grid = reader.readDoubles(4);
    int projection = reader.readInt();
    double[] axis = reader.readDoubles(2);
    int firstRow = reader.readInt();
    int numRows = reader.readInt();
    int numPixels = reader.readCount(4);
    if (section < 0 || section >= numSections) throw new BadMessage("has a bad section number");
    if (firstRow < 0 || numRows < 0 || (long) firstRow + numRows > height)
      throw new BadMessage("has rows outside of its image");
    if ((long) numRows * width != numPixels) throw new BadMessage("has a bad number of pixels");
    RangeImageParts image = current;
    boolean fits = image != null && image.utime == utime && image.numSections == numSections
        && image.width == width && image.height == height;
    if (!fits) image = new RangeImageParts(utime, numSections, width, height, grid, projection, axis);
    for (int i = 0; i < numPixels; ++i) image.ranges[firstRow * width + i] = reader.readShort();
    image.rows.set(firstRow, firstRow + numRows);
    image.sections.set(section);
    return image;
  }

  /** Where a point in the sensor's frame is seen, in columns and rows; null: nowhere. */
  double[] positionOf(float[] p) {
    double a = Math.atan2(p[1], p[0]);
    double e = Math.atan2(p[2], Math.hypot(p[0], p[1]));
    if (pinhole) {
      double depth = dot(axes[0], p);
      if (!(depth > 0.0)) return null;
      a = dot(axes[1], p) / depth;
      e = dot(axes[2], p) / depth;
    }
    return new double[] {(left - a) / resolution, (top - e) / resolution};
  }

  /** Azimuth and elevation, in degrees, along which the middle of a pixel looks. */
  double[] directionOf(int row, int column) {
    double a = left - (column + 0.5) * resolution;
    double e = top - (row + 0.5) * resolution;
    if (pinhole) {
      double[] p = new double[3];
      for (int i = 0; i < 3; ++i) p[i] = axes[0][i] + a * axes[1][i] + e * axes[2][i];
      a = Math.atan2(p[1], p[0]);
      e = Math.atan2(p[2], Math.hypot(p[0], p[1]));
    }
    return new double[] {Math.toDegrees(a), Math.toDegrees(e)};
  }

  private static double dot(double[] a, float[] b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }

  boolean isPinhole() {
    return pinhole;
  }

  boolean complete() {
    return sections.cardinality() == numSections;
  }

  boolean hasRow(int row) {
    return rows.get(row);
  }

  String progress() {
    return sections.cardinality() + " of " + numSections + " sections";
  }

  /** In steps of rangeUnit, or NEVER_OBSERVED or NO_RETURN. */
  int steps(int row, int column) {
    return ranges[row * width + column] & 0xffff;
  }

  /** The range, in steps, below which a share of the measured ones lies. */
  int quantile(double share) {
    int[] counts = new int[NO_RETURN];
    int total = 0;
    for (short range : ranges) {
      int steps = range & 0xffff;
      if (steps == NEVER_OBSERVED || steps == NO_RETURN) continue;
      ++counts[steps];
      ++total;
    }
    int below = 0;
    for (int steps = 1; steps < NO_RETURN; ++steps) {
      below += counts[steps];
      if (below > share * total) return steps;
    }
    return 1;
  }
}

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
  final double azimuthLeft; // rad
  final double elevationTop; // rad
  final double rangeUnit; // m
  private final int numSections;
  private final BitSet sections = new BitSet();
  private final BitSet rows = new BitSet();
  private final short[] ranges;

  /** The image that the section of a message begins; add() puts the section itself in. */
  private RangeImageParts(
      long utime, int numSections, int width, int height, double[] grid) throws BadMessage {
    boolean bad = numSections < 1 || width < 1 || height < 1;
    if (bad || (long) width * height > MAX_PIXELS) throw new BadMessage("has an absurd size");
    for (double value : grid)
      if (!Double.isFinite(value)) throw new BadMessage("has an absurd grid");
    if (!(grid[0] > 0.0) || !(grid[3] > 0.0)) throw new BadMessage("has an absurd grid");
    this.utime = utime;
    this.numSections = numSections;
    this.width = width;
    this.height = height;
    resolution = grid[0];
    azimuthLeft = grid[1];
    elevationTop = grid[2];
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
    if (!fits) image = new RangeImageParts(utime, numSections, width, height, grid);
    for (int i = 0; i < numPixels; ++i) image.ranges[firstRow * width + i] = reader.readShort();
    image.rows.set(firstRow, firstRow + numRows);
    image.sections.set(section);
    return image;
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

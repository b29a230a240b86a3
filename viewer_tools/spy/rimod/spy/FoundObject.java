package rimod.spy;

/** An object of a detections message. */
final class FoundObject {
  static final int MIN_BYTES = 5 + 14 * 8; // of an encoded one

  final String name;
  final double[] position; // m, local frame
  final double score;
  final String remark; // after the score; may be empty
  private final double[] rotation; // row by row
  private final double[] boxMin; // m, object frame
  private final double[] boxMax;

  private FoundObject(MessageReader reader, String remark) throws BadMessage {
    this.remark = remark;
    name = reader.readString();
    position = reader.readDoubles(3);
    rotation = rotation(reader.readDoubles(4));
    boxMin = reader.readDoubles(3);
    boxMax = reader.readDoubles(3);
    score = reader.readDouble();
    for (double[] values : new double[][] {position, rotation, boxMin, boxMax, {score}})
      for (double value : values)
        if (!Double.isFinite(value)) throw new BadMessage("has a number that is none");
  }

  static FoundObject read(MessageReader reader, String remark) throws BadMessage {
    return new FoundObject(reader, remark);
  }

  /** Where a place of the object frame is: x, y, local frame. */
  double[] place(double x, double y, double z) {
    return new double[] {
      position[0] + rotation[0] * x + rotation[1] * y + rotation[2] * z,
      position[1] + rotation[3] * x + rotation[4] * y + rotation[5] * z
    };
  }

  /** The corners of the box's bottom (0 .. 3, around) and top (4 .. 7): x, y, local frame. */
  double[][] corners() {
    double[][] corners = new double[8][];
    for (int i = 0; i < 8; ++i) {
      boolean right = i % 4 == 1 || i % 4 == 2;
      boolean back = i % 4 >= 2;
      corners[i] =
          place(right ? boxMax[0] : boxMin[0], back ? boxMax[1] : boxMin[1],
              i >= 4 ? boxMax[2] : boxMin[2]);
    }
    return corners;
  }

  /** Where an arrow along x ends. */
  double[] front() {
    return place(1.4 * boxMax[0], 0, 0);
  }

  String label() {
    return String.format("%s %.2f%s", name, score, remark);
  }

  private static double[] rotation(double[] q) throws BadMessage {
    double norm = Math.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(Math.abs(norm - 1.0) < 1e-3)) throw new BadMessage("has a turn that is none");
    double w = q[0], x = q[1], y = q[2], z = q[3];
    return new double[] {
      1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),
      2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
    };
  }
}

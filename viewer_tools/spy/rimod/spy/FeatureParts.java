package rimod.spy;

import java.util.ArrayList;
import java.util.List;
import rimod.feature_set_t;

/** The places of a scan's features, as far as their sections came. */
final class FeatureParts {
  final long utime;
  /** x, y, z, m, level sensor frame. */
  final List<float[]> points = new ArrayList<>();
  private static final int MAX_POINTS = 100000;

  private FeatureParts(long utime) {
    this.utime = utime;
  }

  /** The features so far with those of the message. */
  static FeatureParts add(FeatureParts current, byte[] message) throws BadMessage {
    MessageReader reader = new MessageReader(message, feature_set_t.LCM_FINGERPRINT);
    long utime = reader.readLong();
    reader.readInt(); // section
    reader.readInt(); // of so many
    reader.readString();
    reader.readInt();
    reader.readDouble();
    int count = reader.readCount(24);
    float[] x = reader.readFloats(count);
    float[] y = reader.readFloats(count);
    float[] z = reader.readFloats(count);
    FeatureParts features =
        current != null && current.utime == utime ? current : new FeatureParts(utime);
    for (int i = 0; i < count && features.points.size() < MAX_POINTS; ++i)
      features.points.add(new float[] {x[i], y[i], z[i]});
    return features;
  }
}

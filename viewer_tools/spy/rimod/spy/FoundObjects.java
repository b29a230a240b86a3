package rimod.spy;

import java.util.ArrayList;
import java.util.List;
import rimod.detections_t;
import rimod.early_detection_t;
import rimod.early_detections_t;

/** A message of detections, early ones or not. */
final class FoundObjects {
  long utime;
  double[] sensor; // m, local frame
  double sensorHeading; // rad
  int numModels;
  boolean early;
  final List<FoundObject> objects = new ArrayList<>();

  private static final double FARTHEST = 1e7; // m from the local frame's origin
  private static final int EARLY_BYTES = 8 + 1 + 8 + 8;

  static FoundObjects read(byte[] message) throws BadMessage {
    FoundObjects found = new FoundObjects();
    try {
      found.readEarly(new MessageReader(message, early_detections_t.LCM_FINGERPRINT));
    } catch (BadMessage problem) {
      if (found.early) throw problem;
      found.readDetections(new MessageReader(message, detections_t.LCM_FINGERPRINT));
    }
    return found;
  }

  private void readDetections(MessageReader reader) throws BadMessage {
    utime = reader.readLong();
    readSensor(reader);
    numModels = reader.readInt();
    int count = reader.readCount(FoundObject.MIN_BYTES);
    for (int i = 0; i < count; ++i) objects.add(FoundObject.read(reader, ""));
  }

  private void readEarly(MessageReader reader) throws BadMessage {
    early = true;
    utime = reader.readLong();
    reader.readLong(); // last beam known
    boolean isFinal = reader.readByte() != 0;
    readSensor(reader);
    numModels = reader.readInt();
    int count = reader.readCount(EARLY_BYTES + FoundObject.MIN_BYTES);
    for (int i = 0; i < count; ++i) {
      reader.readLong(); // id
      byte status = reader.readByte();
      reader.readLong(); // first told
      reader.readDouble(); // unseen share
      FoundObject object = FoundObject.read(reader, isFinal ? "" : " so far");
      if (status != early_detection_t.STATUS_WITHDRAWN) objects.add(object);
    }
  }

  private void readSensor(MessageReader reader) throws BadMessage {
    sensor = reader.readDoubles(3);
    double[] q = reader.readDoubles(4);
    sensorHeading = 2 * Math.atan2(q[3], q[0]);
    if (!(Math.abs(sensor[0]) + Math.abs(sensor[1]) < FARTHEST) || !Double.isFinite(sensorHeading))
      throw new BadMessage("has a sensor that is nowhere");
  }
}

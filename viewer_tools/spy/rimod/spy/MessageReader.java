package rimod.spy;

import java.nio.ByteBuffer;
import java.nio.charset.StandardCharsets;

/**
 * Reads the fields of an LCM message one after the other and believes no count that its bytes do not
 * cover: the generated decoders would allocate for it.
 */
final class MessageReader {
  private final ByteBuffer bytes;

  /** Throws BadMessage for bytes of another type. */
  MessageReader(byte[] message, long fingerprint) throws BadMessage {
    bytes = ByteBuffer.wrap(message);
    if (message.length < 8 || bytes.getLong() != fingerprint)
      throw new BadMessage("is of another type");
  }

  byte readByte() throws BadMessage {
    need(1);
    return bytes.get();
  }

  short readShort() throws BadMessage {
    need(2);
    return bytes.getShort();
  }

  int readInt() throws BadMessage {
    need(4);
    return bytes.getInt();
  }

  long readLong() throws BadMessage {
    need(8);
    return bytes.getLong();
  }

  float readFloat() throws BadMessage {
    need(4);
    return bytes.getFloat();
  }

  double readDouble() throws BadMessage {
    need(8);
    return bytes.getDouble();
  }

  double[] readDoubles(int count) throws BadMessage {
    double[] values = new double[count];
    for (int i = 0; i < count; ++i) values[i] = readDouble();
    return values;
  }

  float[] readFloats(int count) throws BadMessage {
    need(4L * count);
    float[] values = new float[count];
    for (int i = 0; i < count; ++i) values[i] = bytes.getFloat();
    return values;
  }

  /** A count of elements of at least so many bytes each. */
  int readCount(int elementBytes) throws BadMessage {
    int count = readInt();
    if (count < 0) throw new BadMessage("has a negative count");
    need((long) count * elementBytes);
    return count;
  }

  String readString() throws BadMessage {
    int length = readCount(1);
    if (length < 1) throw new BadMessage("has a string without an end");
    byte[] text = new byte[length - 1];
    bytes.get(text);
    bytes.get();
    return new String(text, StandardCharsets.UTF_8);
  }

  private void need(long count) throws BadMessage {
    if (count > bytes.remaining()) throw new BadMessage("is cut off");
  }
}

package rimod.spy;

/** A message that cannot be used; the text is the cause. */
final class BadMessage extends Exception {
  private static final long serialVersionUID = 1;

  BadMessage(String cause) {
    super(cause);
  }
}

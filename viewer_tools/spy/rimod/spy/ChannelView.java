package rimod.spy;

import java.awt.BorderLayout;
import java.awt.Dimension;
import java.util.List;
import javax.swing.JPanel;

/**
 * What a plugin's window shows of its channels. Messages come in on LCM's thread, painting happens on
 * Swing's: what both use is guarded by the view's lock.
 */
abstract class ChannelView extends JPanel {
  private static final long serialVersionUID = 1;

  private long numLeftOut;
  private String lastCause = "";
  private boolean changed = true;

  ChannelView(int width, int height) {
    super(new BorderLayout());
    setPreferredSize(new Dimension(width, height));
  }

  /** All channels that it wants to hear. */
  abstract List<String> channels();

  /** Takes a message in; whatever the bytes are, nothing but a count comes of bad ones. */
  final synchronized void receive(String channel, byte[] bytes) {
    try {
      take(channel, bytes);
    } catch (BadMessage | RuntimeException | OutOfMemoryError problem) {
      ++numLeftOut;
      lastCause = channel + " " + problem.getMessage();
    }
    changed = true;
  }

  /** Called with the lock held. */
  abstract void take(String channel, byte[] bytes) throws BadMessage;

  /** Called on Swing's thread ten times a second; true where there is something new to paint. */
  synchronized boolean refresh() {
    boolean result = changed;
    changed = false;
    return result;
  }

  /** Says what could not be used; empty while all was well. Call with the lock held. */
  final String complaint() {
    return numLeftOut == 0 ? "" : "   " + numLeftOut + " messages left out: " + lastCause;
  }
}

package rimod.spy;

import java.awt.event.ActionEvent;
import java.io.IOException;
import java.util.function.Function;
import javax.swing.AbstractAction;
import javax.swing.Action;
import javax.swing.JDesktopPane;
import lcm.lcm.LCMDataOutputStream;
import lcm.lcm.LCMEncodable;
import lcm.spy.ChannelData;

/**
 * What plugins that open a view on a channel of one type have in common. lcm-spy makes one of every class
 * that implements SpyPlugin itself: this one must not.
 */
abstract class ViewPlugin {
  private final long fingerprint;
  private final String name;
  private final Function<String, ChannelView> makeView;

  ViewPlugin(long fingerprint, String name, Function<String, ChannelView> makeView) {
    this.fingerprint = fingerprint;
    this.name = name;
    this.makeView = makeView;
  }

  public final boolean canHandle(long other) {
    return other == fingerprint;
  }

  public final Action getAction(JDesktopPane desktop, ChannelData channel) {
    return new AbstractAction(name) {
      private static final long serialVersionUID = 1;

      @Override
      public void actionPerformed(ActionEvent event) {
        ChannelView view = makeView.apply(channel.name);
        giveLast(channel, view);
        ViewWindow.open(desktop, channel.name + ": " + name, view);
      }
    };
  }

  /** What lcm-spy heard last, so that the window need not wait for more. */
  private static void giveLast(ChannelData channel, ChannelView view) {
    if (!(channel.last instanceof LCMEncodable)) return;
    LCMDataOutputStream bytes = new LCMDataOutputStream();
    try {
      ((LCMEncodable) channel.last).encode(bytes);
    } catch (IOException | RuntimeException exception) {
      return; // a message that does not even encode is not worth showing
    }
    view.receive(channel.name, bytes.toByteArray());
  }
}

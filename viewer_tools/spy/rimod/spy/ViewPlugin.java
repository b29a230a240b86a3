package rimod.spy;

import java.awt.event.ActionEvent;
import java.util.function.Function;
import javax.swing.AbstractAction;
import javax.swing.Action;
import javax.swing.JDesktopPane;
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
        ViewWindow.open(desktop, channel.name + ": " + name, makeView.apply(channel.name));
      }
    };
  }
}

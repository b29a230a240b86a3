package rimod.spy;

import java.awt.BorderLayout;
import java.awt.Window;
import java.awt.event.WindowAdapter;
import java.awt.event.WindowEvent;
import java.io.IOException;
import java.util.HashMap;
import java.util.Map;
import java.util.regex.Pattern;
import javax.swing.JDesktopPane;
import javax.swing.JFrame;
import javax.swing.SwingUtilities;
import javax.swing.Timer;
import lcm.lcm.LCM;
import lcm.lcm.LCMDataInputStream;
import lcm.lcm.LCMSubscriber;

/** A window with a view that listens while it is open; one a channel and kind of view. */
final class ViewWindow {
  private static final int REFRESH_PERIOD = 100; // ms
  private static final Map<String, JFrame> OPEN = new HashMap<>();

  private ViewWindow() {}

  /**
   * Shows the view in the window of the desktop that lcm-spy has opened for it; where the same view is open
   * already, that one instead.
   */
  static void open(JDesktopPane desktop, String title, ChannelView view) {
    Window given = desktop == null ? null : SwingUtilities.getWindowAncestor(desktop);
    JFrame open = OPEN.get(title);
    if (open != null) {
      if (given != null) given.dispose();
      open.toFront();
      return;
    }
    JFrame frame = given instanceof JFrame ? (JFrame) given : new JFrame();
    frame.getContentPane().removeAll();
    frame.getContentPane().add(view, BorderLayout.CENTER);
    frame.setTitle(title);
    frame.setDefaultCloseOperation(JFrame.DISPOSE_ON_CLOSE);
    OPEN.put(title, frame);
    listen(frame, view);
    frame.pack();
    frame.setVisible(true);
  }

  /** Until the window is closed. */
  private static void listen(JFrame frame, ChannelView view) {
    LCMSubscriber subscriber = (lcm, channel, input) -> deliver(view, channel, input);
    for (String channel : view.channels())
      LCM.getSingleton().subscribe(Pattern.quote(channel), subscriber);
    Timer timer =
        new Timer(
            REFRESH_PERIOD,
            event -> {
              if (view.refresh()) view.repaint();
            });
    frame.addWindowListener(
        new WindowAdapter() {
          @Override
          public void windowClosed(WindowEvent event) {
            timer.stop();
            OPEN.values().remove(frame);
            for (String channel : view.channels())
              LCM.getSingleton().unsubscribe(Pattern.quote(channel), subscriber);
          }
        });
    timer.start();
  }

  private static void deliver(ChannelView view, String channel, LCMDataInputStream input) {
    try {
      byte[] bytes = new byte[input.available()];
      input.readFully(bytes);
      view.receive(channel, bytes);
    } catch (IOException exception) {
      // There are as many bytes as are available.
      throw new IllegalStateException(exception);
    }
  }
}

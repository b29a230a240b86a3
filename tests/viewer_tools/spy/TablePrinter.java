import java.awt.Container;
import java.awt.Component;
import java.awt.Frame;
import java.awt.image.BufferedImage;
import java.io.File;
import javax.imageio.ImageIO;
import javax.swing.Action;
import javax.swing.JDesktopPane;
import javax.swing.JTable;
import javax.swing.SwingUtilities;
import javax.swing.table.TableModel;
import lcm.spy.ChannelData;
import lcm.spy.SpyPlugin;

/**
 * A plugin through which a test sees what lcm-spy shows: prints the channel table twice a second, a
 * line "ROW channel type undecodable" each. Where SPY_SCREENSHOT names a file it also draws the window into it.
 */
public class TablePrinter implements SpyPlugin {
  public TablePrinter() {
    Thread thread = new Thread(TablePrinter::printForever);
    thread.setDaemon(true);
    thread.start();
  }

  @Override
  public boolean canHandle(long fingerprint) {
    return false;
  }

  @Override
  public Action getAction(JDesktopPane desktop, ChannelData channel) {
    return null;
  }

  private static void printForever() {
    try {
      while (true) {
        Thread.sleep(500);
        SwingUtilities.invokeAndWait(TablePrinter::printFrames);
      }
    } catch (Exception exception) {
      exception.printStackTrace();
    }
  }

  private static void printFrames() {
    for (Frame frame : Frame.getFrames()) {
      JTable table = findTable(frame);
      if (table == null) continue;
      TableModel model = table.getModel();
      int undecodable = model.getColumnCount() - 1;
      for (int row = 0; row < model.getRowCount(); ++row)
        System.out.println("ROW " + model.getValueAt(row, 0) + " " + model.getValueAt(row, 1) + " "
            + model.getValueAt(row, undecodable));
      draw(frame);
    }
    System.out.flush();
  }

  private static JTable findTable(Container container) {
    for (Component component : container.getComponents()) {
      if (component instanceof JTable) return (JTable) component;
      if (component instanceof Container) {
        JTable table = findTable((Container) component);
        if (table != null) return table;
      }
    }
    return null;
  }

  private static void draw(Frame frame) {
    String path = System.getenv("SPY_SCREENSHOT");
    if (path == null || frame.getWidth() == 0) return;
    BufferedImage image =
        new BufferedImage(frame.getWidth(), frame.getHeight(), BufferedImage.TYPE_INT_RGB);
    frame.paint(image.getGraphics());
    try {
      ImageIO.write(image, "png", new File(path));
    } catch (java.io.IOException exception) {
      exception.printStackTrace();
    }
  }
}

import java.awt.Component;
import java.awt.Container;
import java.awt.Dimension;
import java.awt.Frame;
import java.awt.Point;
import java.awt.Rectangle;
import java.awt.Robot;
import java.awt.Toolkit;
import java.awt.event.InputEvent;
import java.awt.image.BufferedImage;
import java.io.File;
import java.nio.file.Files;
import java.nio.file.Path;
import java.nio.file.StandardCopyOption;
import java.util.Arrays;
import java.util.HashSet;
import java.util.LinkedHashSet;
import java.util.Set;
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
 * line "ROW channel type undecodable" each, and the other windows, "WINDOW title drawn" or "blank". Double-clicks the channels
 * that SPY_OPEN lists, comma between, with the mouse, and moves each window that opens out of the way. Where
 * SPY_SCREENSHOT names a file the whole screen is written into it after every round.
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

  private static final Set<String> toOpen = new LinkedHashSet<>(
      Arrays.asList(System.getenv().getOrDefault("SPY_OPEN", "").split(",")));
  // Where windows go, in the order in which they open, beside and below lcm-spy's own.
  private static final Point[] PLACES = {
    new Point(830, 0), new Point(0, 560), new Point(950, 560), new Point(660, 620)};

  private static void printForever() {
    try {
      Robot robot = new Robot();
      while (true) {
        Thread.sleep(500);
        SwingUtilities.invokeAndWait(TablePrinter::printFrames);
        openNext(robot);
        String path = System.getenv("SPY_SCREENSHOT");
        if (path != null) writeScreen(robot, path);
      }
    } catch (Exception exception) {
      exception.printStackTrace();
    }
  }

  private static void printFrames() {
    int numWindows = 0;
    for (Frame frame : Frame.getFrames()) {
      if (!frame.isVisible()) continue;
      JTable table = findTable(frame);
      if (!frame.getTitle().equals("LCM Spy")) {
        System.out.println("WINDOW " + frame.getTitle() + (isDrawn(frame, table) ? " drawn" : " blank"));
        frame.setLocation(PLACES[Math.min(numWindows++, PLACES.length - 1)]);
        continue;
      }
      frame.setBounds(0, 0, 820, 540);
      frame.validate();
      TableModel model = table.getModel();
      int undecodable = model.getColumnCount() - 1;
      for (int row = 0; row < model.getRowCount(); ++row)
        System.out.println("ROW " + model.getValueAt(row, 0) + " " + model.getValueAt(row, 1) + " "
            + model.getValueAt(row, undecodable));
    }
    System.out.flush();
  }

  /** A table has lines, a picture many colours. */
  private static boolean isDrawn(Frame frame, JTable table) {
    return table == null ? countColours(frame) > 4 : table.getRowCount() > 0;
  }

  private static int countColours(Frame frame) {
    BufferedImage image =
        new BufferedImage(frame.getWidth(), frame.getHeight(), BufferedImage.TYPE_INT_RGB);
    frame.paint(image.getGraphics());
    Set<Integer> colours = new HashSet<>();
    for (int y = 0; y < image.getHeight(); ++y)
      for (int x = 0; x < image.getWidth(); ++x) colours.add(image.getRGB(x, y));
    return colours.size();
  }

  /** Double-clicks the first channel that is still to be opened and in the table. */
  private static void openNext(Robot robot) throws Exception {
    Point[] place = new Point[1];
    SwingUtilities.invokeAndWait(() -> place[0] = findNext());
    if (place[0] == null) return;
    robot.mouseMove(place[0].x, place[0].y);
    for (int i = 0; i < 2; ++i) {
      robot.mousePress(InputEvent.BUTTON1_DOWN_MASK);
      robot.mouseRelease(InputEvent.BUTTON1_DOWN_MASK);
    }
  }

  private static Point findNext() {
    for (Frame frame : Frame.getFrames()) {
      JTable table = frame.getTitle().equals("LCM Spy") ? findTable(frame) : null;
      if (table == null || !table.isShowing()) continue;
      for (int row = 0; row < table.getRowCount(); ++row) {
        if (!toOpen.remove(String.valueOf(table.getValueAt(row, 0)))) continue;
        Rectangle cell = table.getCellRect(row, 0, true);
        Point corner = table.getLocationOnScreen();
        return new Point(corner.x + cell.x + cell.width / 2, corner.y + cell.y + cell.height / 2);
      }
    }
    return null;
  }

  private static void writeScreen(Robot robot, String path) throws Exception {
    Dimension size = Toolkit.getDefaultToolkit().getScreenSize();
    BufferedImage image = robot.createScreenCapture(new Rectangle(size));
    File half = new File(path + ".half");
    ImageIO.write(image, "png", half);
    Files.move(half.toPath(), Path.of(path), StandardCopyOption.REPLACE_EXISTING);
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
}

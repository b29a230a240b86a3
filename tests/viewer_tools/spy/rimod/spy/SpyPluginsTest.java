package rimod.spy;

import java.awt.Color;
import java.awt.image.BufferedImage;
import java.util.Arrays;
import java.util.Random;
import lcm.lcm.LCMDataOutputStream;
import lcm.lcm.LCMEncodable;
import lcm.spy.SpyPlugin;
import rimod.detection_t;
import rimod.detections_t;
import rimod.early_detection_t;
import rimod.early_detections_t;
import rimod.feature_set_t;
import rimod.range_image_t;
import rimod.stage_time_t;
import rimod.status_t;

/** The plugins' views without a screen: what they draw of messages, and that no message harms them. */
public final class SpyPluginsTest {
  private static final String IMAGES = "RIMOD_RANGE_IMAGE";
  private static final int WIDTH = 90;
  private static final int HEIGHT = 40;
  private static final int SECTIONS = 4;
  private static int failures;

  private SpyPluginsTest() {}

  public static void main(String[] arguments) throws Exception {
    drawsAWholeImage();
    drawsWhatCameOfAnImage();
    marksInterestPoints();
    laysOutPinholeImages();
    drawsDetections();
    drawsEarlyDetections();
    leavesOutWhatIsTooFar();
    listsStatus();
    hasOnePluginAType();
    survivesDamagedMessages();
    System.out.println(failures == 0 ? "all well" : failures + " failures");
    System.exit(failures == 0 ? 0 : 1);
  }

  private static void check(boolean good, String what) {
    if (good) return;
    ++failures;
    System.out.println("FAILED: " + what);
  }

  private static byte[] encode(LCMEncodable message) throws Exception {
    LCMDataOutputStream stream = new LCMDataOutputStream();
    message.encode(stream);
    return stream.toByteArray();
  }

  /** Left third near, middle far, right without return; the last row never observed. */
  private static range_image_t section(int number, long utime) {
    range_image_t message = new range_image_t();
    message.utime = utime;
    message.section = number;
    message.num_sections = SECTIONS;
    message.sensor_orientation[0] = 1;
    message.width = WIDTH;
    message.height = HEIGHT;
    message.resolution = 0.01;
    message.azimuth_left = 0.45;
    message.elevation_top = 0.2;
    message.range_unit = 0.00125;
    message.num_rows = HEIGHT / SECTIONS;
    message.first_row = number * message.num_rows;
    message.num_pixels = message.num_rows * WIDTH;
    message.range = new short[message.num_pixels];
    message.offset_azimuth = new byte[message.num_pixels];
    message.offset_elevation = new byte[message.num_pixels];
    for (int i = 0; i < message.num_pixels; ++i) {
      int third = i % WIDTH / (WIDTH / 3);
      boolean last = message.first_row + i / WIDTH == HEIGHT - 1;
      message.range[i] = (short) (last ? 0 : third == 0 ? 800 : third == 1 ? 8000 : 65535);
    }
    return message;
  }

  private static detection_t detection(String name, double x, double y) {
    detection_t detection = new detection_t();
    detection.class_name = name;
    detection.position = new double[] {x, y, 0};
    detection.orientation = new double[] {1, 0, 0, 0};
    detection.box_min = new double[] {-0.3, -0.2, 0};
    detection.box_max = new double[] {0.3, 0.2, 0.5};
    detection.score = 0.75;
    return detection;
  }

  private static detections_t detections(detection_t... found) {
    detections_t message = new detections_t();
    message.sensor_orientation[0] = 1;
    message.num_models = 3;
    message.detections = found;
    message.num_detections = found.length;
    message.stage_times = new stage_time_t[0];
    return message;
  }

  private static early_detections_t early(byte status) {
    early_detections_t message = new early_detections_t();
    message.sensor_orientation[0] = 1;
    early_detection_t object = new early_detection_t();
    object.status = status;
    object.detection = detection("fan", 2, 0);
    message.detections = new early_detection_t[] {object};
    message.num_detections = 1;
    return message;
  }

  private static status_t status(String process) {
    status_t message = new status_t();
    message.process = process;
    message.version = "1";
    message.host = "here";
    message.last_error = "";
    message.counters = new rimod.counter_t[0];
    stage_time_t stage = new stage_time_t();
    stage.stage = "matching";
    stage.ms = 12.5;
    message.stage_times = new stage_time_t[] {stage};
    message.num_stage_times = 1;
    return message;
  }

  private static BufferedImage paint(ChannelView view) {
    view.setSize(940, 540);
    view.doLayout();
    BufferedImage image = new BufferedImage(940, 540, BufferedImage.TYPE_INT_RGB);
    view.paint(image.getGraphics());
    return image;
  }

  private static int count(BufferedImage image, Color colour) {
    int count = 0;
    for (int y = 0; y < image.getHeight(); ++y)
      for (int x = 0; x < image.getWidth(); ++x)
        if (image.getRGB(x, y) == colour.getRGB()) ++count;
    return count;
  }

  private static RangeImageView imageView(int... sections) throws Exception {
    RangeImageView view = new RangeImageView(IMAGES);
    for (int number : sections) view.receive(IMAGES, encode(section(number, 5)));
    return view;
  }

  private static void drawsAWholeImage() throws Exception {
    BufferedImage picture = paint(imageView(2, 0, 3, 1));
    int pixels = 10 * 10; // of the panel a pixel of the image: 90 columns on 924
    int third = WIDTH / 3 * (HEIGHT - 1) * pixels;
    check(count(picture, Palette.NO_RETURN) >= third, "a third without return");
    check(count(picture, Palette.range(0)) >= third, "a near third");
    check(count(picture, Palette.range(1)) >= third, "a far third");
    check(count(picture, Palette.HATCH_DARK) >= WIDTH * pixels / 2, "a row never observed");
    check(count(picture, Palette.NOT_RECEIVED) == 22 * 14, "not received in the legend only");
  }

  /** A point seen in a pixel's middle lies along the direction told for it. */
  private static void laysOutPinholeImages() throws Exception {
    range_image_t message = section(0, 5);
    message.projection = range_image_t.PINHOLE;
    message.axis_azimuth = 0.3;
    message.axis_elevation = -1.4;
    RangeImageParts image = RangeImageParts.add(null, encode(message));
    check(image.isPinhole(), "a pinhole image");
    double[] direction = image.directionOf(8, 70);
    double a = Math.toRadians(direction[0]);
    double e = Math.toRadians(direction[1]);
    float[] p = {(float) (2 * Math.cos(e) * Math.cos(a)), (float) (2 * Math.cos(e) * Math.sin(a)),
        (float) (2 * Math.sin(e))};
    double[] position = image.positionOf(p);
    check(Math.abs(position[0] - 70.5) < 1e-3, "the column of a point below");
    check(Math.abs(position[1] - 8.5) < 1e-3, "the row of a point below");
    check(image.positionOf(new float[] {0, 0, 1}) == null, "what is behind is nowhere");
    message.projection = 7;
    boolean refused = false;
    try {
      RangeImageParts.add(null, encode(message));
    } catch (BadMessage bad) {
      refused = true;
    }
    check(refused, "an unknown projection is refused");
  }

  private static void drawsWhatCameOfAnImage() throws Exception {
    RangeImageView view = imageView(0, 1, 3);
    check(count(paint(view), Palette.NO_RETURN) == 0, "nothing is shown while sections may come");
    Thread.sleep(350);
    check(view.refresh(), "the rest is given up");
    BufferedImage picture = paint(view);
    check(count(picture, Palette.NOT_RECEIVED) > WIDTH * HEIGHT / SECTIONS * 90, "a missing section");
    view.receive(IMAGES, encode(section(2, 5)));
    check(count(paint(view), Palette.NOT_RECEIVED) == 22 * 14, "it came after all");
    view.receive(IMAGES, encode(section(0, 6)));
    view.receive(IMAGES, encode(section(0, 7)));
    check(count(paint(view), Palette.NOT_RECEIVED) > 30000, "a newer image ends the wait");
  }

  private static feature_set_t features() {
    feature_set_t message = new feature_set_t();
    message.utime = 5;
    message.num_sections = 1;
    message.descriptor = "kind";
    message.num_features = 1;
    message.x = new float[] {1};
    message.y = message.z = message.normal_x = message.normal_y = message.normal_z = new float[1];
    message.values = new short[0];
    return message;
  }

  private static void marksInterestPoints() throws Exception {
    RangeImageView view = imageView(0, 1, 2, 3);
    int before = count(paint(view), Palette.POINT);
    view.receive("RIMOD_FEATURES", encode(features()));
    BufferedImage picture = paint(view);
    check(count(picture, Palette.POINT) == before + 4, "a mark");
    int x = 8 + (924 - 900) / 2 + 450, y = 24 + 200; // straight ahead, on the horizon
    check(picture.getRGB(x, y) == Palette.POINT.getRGB(), "at its place");
  }

  private static void drawsDetections() throws Exception {
    DetectionsView view = new DetectionsView("D");
    view.receive("D", encode(detections(detection("fan", 2, 0.5), detection("table", 3, -1))));
    BufferedImage picture = paint(view);
    check(count(picture, Palette.object(0)) > 100, "the fan");
    check(count(picture, Palette.object(1)) > 100, "the table");
    view.receive("D", encode(detections()));
    check(count(paint(view), Palette.object(0)) == 0, "an empty message takes them away");
  }

  private static void drawsEarlyDetections() throws Exception {
    DetectionsView view = new DetectionsView("E");
    view.receive("E", encode(early(early_detection_t.STATUS_NEW)));
    check(count(paint(view), Palette.object(0)) > 100, "told early");
    view.receive("E", encode(early(early_detection_t.STATUS_WITHDRAWN)));
    check(count(paint(view), Palette.object(0)) == 0, "withdrawn");
  }

  private static void leavesOutWhatIsTooFar() throws Exception {
    DetectionsView view = new DetectionsView("D");
    detection_t endless = detection("fan", 2, 0.5);
    endless.box_max[0] = 1e300;
    view.receive("D", encode(detections(endless, detection("table", 1e300, -1e300))));
    check(count(paint(view), Palette.object(0)) == 0, "objects at the end of the world");
  }

  private static void listsStatus() throws Exception {
    StatusView view = new StatusView("S");
    for (int i = 0; i < 100; ++i) view.receive("S", encode(status("process" + i)));
    check(view.refresh(), "there is something new");
    check(view.numProcesses() == 64, "so many processes and no more");
  }

  private static void hasOnePluginAType() {
    SpyPlugin[] plugins = {
      new RangeImagePlugin(), new DetectionsPlugin(), new EarlyDetectionsPlugin(), new StatusPlugin()};
    long[] types = {
      range_image_t.LCM_FINGERPRINT, detections_t.LCM_FINGERPRINT,
      early_detections_t.LCM_FINGERPRINT, status_t.LCM_FINGERPRINT};
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j)
        check(plugins[i].canHandle(types[j]) == (i == j), "plugin " + i + ", type " + j);
  }

  /** Cut off, with bytes changed, with counts of all sizes: the views stay usable. */
  private static void survivesDamagedMessages() throws Exception {
    byte[][] messages = {
      encode(section(1, 5)), encode(features()), encode(detections(detection("fan", 2, 0))),
      encode(early(early_detection_t.STATUS_NEW)), encode(status("p"))};
    ChannelView[] views = {
      new RangeImageView(IMAGES), new RangeImageView(IMAGES), new DetectionsView("D"),
      new DetectionsView("D"), new StatusView("S")};
    String[] channels = {IMAGES, "RIMOD_FEATURES", "D", "D", "S"};
    Random random = new Random(1);
    for (int round = 0; round < 3000; ++round) {
      int which = round % messages.length;
      byte[] bytes = messages[which].clone();
      if (random.nextBoolean()) bytes = Arrays.copyOf(bytes, random.nextInt(bytes.length));
      for (int i = random.nextInt(4); i > 0 && bytes.length > 8; --i)
        bytes[8 + random.nextInt(Math.min(bytes.length - 8, 200))] = (byte) random.nextInt(256);
      views[which].receive(channels[which], bytes);
      if (round % 50 < messages.length) paint(views[which]);
    }
    views[0].receive(IMAGES, new byte[0]);
    for (int number = 0; number < SECTIONS; ++number)
      views[0].receive(IMAGES, encode(section(number, 99)));
    check(count(paint(views[0]), Palette.NO_RETURN) > 1000, "an image after all that");
    views[2].receive("D", encode(detections(detection("fan", 2, 0.5))));
    check(count(paint(views[2]), Palette.object(0)) > 100, "detections after all that");
  }
}

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <opencv2/imgcodecs.hpp>
#include <set>
#include <utility>

#include "io/message_codec.h"
#include "viewer_tools/matched_features.h"
#include "viewer_tools/meldis_messages.h"
#include "viewer_tools/preview.h"
#include "viewer_tools/view_picture.h"
#include "viewer_tools/view_state.h"

namespace rimod {
namespace {

// A wall 3 m before the sensor, which stands 1 m above the local frame's origin.
RangeImage MakeWall(int width = 120, int height = 60) {
  const PixelGrid grid{width, height, 0.01, 0.005 * width, 0.005 * height};
  Eigen::Isometry3d T_local_sensor = Eigen::Isometry3d::Identity();
  T_local_sensor.translation().z() = 1.0;
  RangeImage image(grid, T_local_sensor);
  for (int row = 5; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const double range = 3.0 / UnitVector(PixelDirection(grid, row + 0.5, column + 0.5)).x();
      RoundedPixel pixel;
      pixel.range = static_cast<std::uint16_t>(std::lround(range / PixelRounding::kRangeUnit));
      image.SetMeasured(row, column, pixel);
    }
  }
  return image;
}

// A plate of 0.4 x 0.4 m that faces the sensor, with a feature in its middle.
ObjectModel MakePlate() {
  ObjectModel model;
  model.name = "plate";
  model.box_min = {-0.01, -0.2, 0.0};
  model.box_max = {0.01, 0.2, 0.4};
  model.point_spacing = 0.02;
  for (int i = 0; i < 21; ++i) {
    for (int j = 0; j < 21; ++j) {
      model.points.push_back(Eigen::Vector3d(0.0, -0.2 + 0.02 * i, 0.02 * j).cast<float>());
      model.normals.emplace_back(-1.0f, 0.0f, 0.0f);
    }
  }
  model.descriptor_size = 4;
  Feature feature;
  feature.position = {0.0f, 0.0f, 0.2f};
  feature.normal = {-1.0f, 0.0f, 0.0f};
  feature.descriptor = {100, 200, 300, 400};
  model.views.resize(1);
  model.views[0].features = {feature};
  return model;
}

Detection PlateAt(double x, double y) {
  Detection detection;
  detection.class_name = "plate";
  detection.T_local_object = Eigen::Translation3d(x, y, 0.8) * Eigen::Isometry3d::Identity();
  detection.box_min = MakePlate().box_min;
  detection.box_max = MakePlate().box_max;
  detection.score = 0.8;
  return detection;
}

ViewedScan MakeScan(std::int64_t utime = 5) {
  ViewedScan scan;
  scan.utime = utime;
  scan.image = MakeWall();
  scan.detections.emplace();
  scan.detections->detections = {PlateAt(2.9, 0.0)};
  scan.features.emplace();
  scan.features->descriptor_size = 4;
  Feature feature = MakePlate().views[0].features[0];
  feature.position = {2.9f, 0.0f, 0.0f};  // the plate's middle from the sensor
  scan.features->features = {feature};
  PoseHypothesis hypothesis;
  hypothesis.class_name = "plate";
  hypothesis.T_local_object = PlateAt(2.9, 0.3).T_local_object;
  scan.hypotheses = ViewedHypotheses{9, {hypothesis}};
  return scan;
}

cv::Mat Draw(const ViewedScan& scan, const std::string& layers) {
  ViewStyle style;
  EXPECT_EQ(SetLayers(layers, &style.layers), "");
  return DrawView(scan, {MakePlate()}, style, "").canvas;
}

// Rectangle round where two pictures differ within the range image.
cv::Rect Difference(const cv::Mat& a, const cv::Mat& b, const RangeImageLayout& layout) {
  EXPECT_EQ(a.size(), b.size());
  std::vector<cv::Point> places;
  for (int y = layout.area.y; y < layout.area.br().y; ++y)
    for (int x = layout.area.x; x < layout.area.br().x; ++x)
      if (a.at<Colour>(y, x) != b.at<Colour>(y, x)) places.emplace_back(x, y);
  if (places.empty()) return {};
  cv::Rect rect(places[0], cv::Size(1, 1));
  for (const cv::Point& p : places) rect |= cv::Rect(p, cv::Size(1, 1));
  return rect;
}

TEST(ViewPictureTest, EachLayerDrawsAtItsPlace) {
  const ViewedScan scan = MakeScan();
  const RangeImageLayout layout = LayOutRangeImage(*scan.image, ViewStyle().range_image_width);
  const cv::Mat nothing = Draw(scan, "none");
  const auto place = [&](double y_local) {
    return cv::Point(
        layout.ToCanvas(Project(scan.image->grid(), Eigen::Vector3d(2.9, y_local, 0.0))));
  };
  for (const std::string layer : {"points", "matched", "detections"}) {
    const cv::Rect drawn = Difference(nothing, Draw(scan, layer), layout);
    EXPECT_TRUE(drawn.contains(place(0.0))) << layer;
    EXPECT_FALSE(drawn.contains(place(0.5))) << layer;
  }
  const cv::Rect drawn = Difference(nothing, Draw(scan, "hypotheses"), layout);
  EXPECT_TRUE(drawn.contains(place(0.3)));
  EXPECT_FALSE(drawn.contains(place(-0.1)));
  EXPECT_TRUE(Difference(nothing, Draw(scan, "validated"), layout).empty());
  EXPECT_TRUE(Difference(nothing, Draw(scan, "early"), layout).empty());
}

TEST(ViewPictureTest, EarlyDetectionsAreFainterAndEndWithTheDetections) {
  ViewedScan scan = MakeScan();
  scan.features.reset();
  const cv::Mat firm = Draw(scan, "detections,early");
  EarlyObject object;
  object.detection = PlateAt(2.9, 0.0);
  scan.early.emplace();
  scan.early->objects = {object};
  EXPECT_EQ(cv::norm(firm, Draw(scan, "detections,early")), 0.0);
  scan.detections.reset();
  const RangeImageLayout layout = LayOutRangeImage(*scan.image, ViewStyle().range_image_width);
  const cv::Mat early = Draw(scan, "detections,early");
  EXPECT_FALSE(Difference(firm, early, layout).empty());
  EXPECT_FALSE(Difference(Draw(scan, "none"), early, layout).empty());
  scan.early->objects[0].status = EarlyStatus::kWithdrawn;
  EXPECT_TRUE(Difference(Draw(scan, "none"), Draw(scan, "detections,early"), layout).empty());
}

TEST(ViewPictureTest, TheMouseReadsRangePointAndNormal) {
  const ViewedScan scan = MakeScan();
  const ViewPicture picture = DrawView(scan, {}, ViewStyle(), "");
  const cv::Point middle(picture.range_image.ToCanvas({30.5, 60.5}));
  const std::string text = ReadOut(scan, picture, middle);
  EXPECT_NE(text.find("row 30, column 60"), std::string::npos) << text;
  EXPECT_NE(text.find("range 3.000 m"), std::string::npos) << text;
  EXPECT_NE(text.find("normal (-1.00,"), std::string::npos) << text;
  const cv::Point top(picture.range_image.ToCanvas({2.5, 60.5}));
  EXPECT_NE(ReadOut(scan, picture, top).find("never observed"), std::string::npos);
  ASSERT_TRUE(picture.top_view);
  const cv::Point above =
      cv::Point(picture.top_view->ToCanvas({2.0, 0.0, 0.0})) + picture.top_view_corner;
  EXPECT_NE(ReadOut(scan, picture, above).find("x 2.0"), std::string::npos)
      << ReadOut(scan, picture, above);
  EXPECT_EQ(ReadOut(scan, picture, {-1, -1}), "");
  EXPECT_EQ(ReadOut(scan, picture, {picture.canvas.cols, picture.canvas.rows}), "");
}

TEST(ViewPictureTest, AnEmptyImageIsDrawn) {
  ViewedScan scan;
  scan.image.emplace();
  EXPECT_FALSE(DrawView(scan, {}, ViewStyle(), "").canvas.empty());
}

TEST(MatchedFeaturesTest, AreThoseThatThePoseExplains) {
  const ObjectModel model = MakePlate();
  const FeatureSet features = *MakeScan().features;
  const Eigen::Isometry3d pose =
      Eigen::Translation3d(2.9, 0.0, -0.2) * Eigen::Isometry3d::Identity();
  EXPECT_EQ(MatchedFeatures(features, model, pose), std::vector<int>{0});
  EXPECT_TRUE(MatchedFeatures(features, model, Eigen::Translation3d(0, 0.1, 0) * pose).empty());
  FeatureSet turned = features;
  turned.features[0].normal = {0.0f, 1.0f, 0.0f};
  EXPECT_TRUE(MatchedFeatures(turned, model, pose).empty());
  FeatureSet unlike = features;
  unlike.features[0].descriptor = {1000, -1000, 1000, -1000};
  EXPECT_TRUE(MatchedFeatures(unlike, model, pose).empty());
}

TEST(ViewStateTest, PausesAndSteps) {
  ViewState state{ViewLayers()};
  EXPECT_EQ(state.shown(), nullptr);
  for (int i = 1; i <= 3; ++i) state.Add(MakeScan(i));
  EXPECT_EQ(state.shown()->utime, 3);
  state.HandleKey('b');
  EXPECT_EQ(state.shown()->utime, 2);
  EXPECT_TRUE(state.paused());
  state.Add(MakeScan(4));
  EXPECT_EQ(state.shown()->utime, 2);
  EXPECT_EQ(state.Status(), "2 of the last 4, paused");
  state.HandleKey('n');
  state.HandleKey('n');
  EXPECT_EQ(state.shown()->utime, 4);
  EXPECT_FALSE(state.TakeNextWish());
  state.HandleKey('n');
  EXPECT_TRUE(state.TakeNextWish());
  EXPECT_FALSE(state.TakeNextWish());
  state.HandleKey('b');
  state.HandleKey(' ');
  EXPECT_EQ(state.shown()->utime, 4);
  EXPECT_EQ(state.Status(), "");
}

TEST(ViewStateTest, KeepsTheLastTwenty) {
  ViewState state{ViewLayers()};
  for (int i = 1; i <= 100; ++i) state.Add(MakeScan(i));
  for (int i = 0; i < 100; ++i) state.HandleKey('b');
  EXPECT_EQ(state.shown()->utime, 81);
}

TEST(ViewStateTest, KeysSwitchLayersSaveAndQuit) {
  ViewState state{ViewLayers()};
  for (const ViewLayerKey& key : kViewLayerKeys) {
    const bool before = state.layers().*key.layer;
    state.HandleKey(key.key);
    EXPECT_NE(state.layers().*key.layer, before) << key.name;
  }
  state.HandleKey('s');
  EXPECT_TRUE(state.TakeSaveWish());
  EXPECT_FALSE(state.TakeSaveWish());
  EXPECT_FALSE(state.quit());
  state.HandleKey('q');
  EXPECT_TRUE(state.quit());
}

TEST(ViewLayersTest, UnknownNamesAreRefused) {
  ViewLayers layers;
  EXPECT_NE(SetLayers("points,nonsense", &layers).find("nonsense"), std::string::npos);
  EXPECT_EQ(SetLayers("points", &layers), "");
  EXPECT_TRUE(layers.points);
  EXPECT_FALSE(layers.detections);
}

TEST(PreviewTest, IsAJpegThatFitsIntoAMessage) {
  cv::Mat noise(1500, 3000, CV_8UC3);
  cv::RNG random(1);
  random.fill(noise, cv::RNG::UNIFORM, 0, 255);
  for (const cv::Mat& picture : {noise, cv::Mat(40, 50, CV_8UC3, cv::Scalar(10, 20, 200))}) {
    const auto preview = MakePreview(picture, 5, 1200);
    ASSERT_TRUE(preview);
    EXPECT_LE(EncodeMessage(*preview).size(), static_cast<std::size_t>(kMaxMessageBytes));
    EXPECT_EQ(preview->utime, 5);
    EXPECT_EQ(preview->pixelformat, bot_core::image_t::PIXEL_FORMAT_MJPEG);
    const cv::Mat decoded = cv::imdecode(preview->data, cv::IMREAD_COLOR);
    EXPECT_EQ(decoded.size(), cv::Size(preview->width, preview->height));
    EXPECT_LE(preview->width, 1200);
  }
  EXPECT_FALSE(MakePreview(cv::Mat(), 5, 1200));
}

// Drake's own definitions, public in RobotLocomotion/drake, give these.
TEST(MeldisMessagesTest, HaveTheFingerprintsOfDrake) {
  const auto fingerprint = [](std::int64_t hash) { return static_cast<std::uint64_t>(hash); };
  EXPECT_EQ(fingerprint(drake::lcmt_viewer_load_robot::getHash()), 0x8987209b10aa2d39ULL);
  EXPECT_EQ(fingerprint(drake::lcmt_viewer_draw::getHash()), 0x414f0bfe5b2f4244ULL);
  EXPECT_EQ(fingerprint(drake::lcmt_point_cloud::getHash()), 0x17f2c128b5d25a95ULL);
}

TEST(MeldisMessagesTest, BoxesStandWhereTheObjectsDo) {
  const std::vector<Detection> found = {PlateAt(2.0, 0.5), PlateAt(3.0, -0.5)};
  const auto scene = MeldisScene(found);
  const auto poses = MeldisPoses(found, MakeWall().T_local_sensor(), 7000);
  ASSERT_EQ(scene.num_links, 3);
  ASSERT_EQ(poses.num_links, 3);
  EXPECT_EQ(poses.timestamp, 7);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(scene.link[i].name, poses.link_name[i]);
  const auto& box = scene.link[1].geom[0];
  EXPECT_EQ(box.type, drake::lcmt_viewer_geometry_data::BOX);
  EXPECT_FLOAT_EQ(box.float_data[2], 0.4f);
  EXPECT_FLOAT_EQ(box.position[2], 0.2f);
  EXPECT_FLOAT_EQ(poses.position[1][0], 2.0f);
  EXPECT_FLOAT_EQ(poses.quaternion[1][0], 1.0f);
  EXPECT_LE(EncodeMessage(MeldisScene(std::vector<Detection>(5000, found[0]))).size(),
            static_cast<std::size_t>(kMaxMessageBytes));
}

TEST(MeldisMessagesTest, TheCloudIsTheImagesPointsAsManyAsFit) {
  for (const auto& [width, height] : {std::pair(120, 60), std::pair(600, 300)}) {
    const RangeImage image = MakeWall(width, height);
    const drake::lcmt_point_cloud cloud = MeldisCloud(image, 5);
    EXPECT_LE(EncodeMessage(cloud).size(), static_cast<std::size_t>(kMaxMessageBytes));
    EXPECT_GT(cloud.width, width == 120 ? image.CountMeasured() - 1 : 5000);
    EXPECT_LE(cloud.width, image.CountMeasured());
    ASSERT_EQ(cloud.data.size(), static_cast<std::size_t>(16 * cloud.width));
    float first[3];
    std::memcpy(first, cloud.data.data(), sizeof first);
    const Eigen::Vector3f p_local = image.T_local_sensor().cast<float>() * image.point(5, 0);
    EXPECT_LT((Eigen::Vector3f(first[0], first[1], first[2]) - p_local).norm(), 1e-5f);
  }
}

}  // namespace
}  // namespace rimod

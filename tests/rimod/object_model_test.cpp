#include "rimod/object_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "tests/support/matchers.h"
#include "tests/support/surfel_models.h"

namespace rimod {
namespace {

ObjectModel GoodModel() {
  ObjectModel model = BoxModel("crate", {0.4, 0.3, 0.2}, 0.05);
  model.descriptor_kind = "test";
  model.descriptor_size = 4;
  ModelView view;
  view.viewpoint = Eigen::Vector3d(2, 0, 1);
  view.validation_points = {model.points[0]};
  view.validation_normals = {model.normals[0]};
  view.outside_points = {model.points[1]};
  Feature feature;
  feature.position = model.points[0];
  feature.normal = model.normals[0];
  feature.descriptor = {1, 2, 3, kEmptyCell};
  view.features = {feature};
  model.views = {view};
  return model;
}

TEST(ModelNameTest, AllowsWhatIsSafeInFileNames) {
  for (const char* name : {"a", "fan", "office_chair", "Box-2.1", "9", "x.."})
    EXPECT_TRUE(IsValidModelName(name)) << name;
  EXPECT_TRUE(IsValidModelName(std::string(64, 'x')));
}

TEST(ModelNameTest, RefusesTheRest) {
  for (const char* name : {"", ".", "..", ".hidden", "a b", "a/b", "../a", "a\n", "a\"", "\x1b[2J",
                           "b\xc3\xa4r", "a\\b"})
    EXPECT_FALSE(IsValidModelName(name)) << name;
  EXPECT_FALSE(IsValidModelName(std::string(65, 'x')));
  EXPECT_FALSE(IsValidModelName(std::string("a\0b", 3)));
}

TEST(ObjectModelTest, DiameterIsTheBoxsDiagonal) {
  EXPECT_DOUBLE_EQ(BoxModel("b", {0.3, 0.4, 1.2}, 0.1).Diameter(), 1.3);
}

TEST(ValidateModelTest, AcceptsAGoodModel) {
  EXPECT_NO_THROW(ValidateModel(GoodModel()));
  ObjectModel flat = PlateModel("plate", 0.5, 0.05);  // a box without thickness
  EXPECT_NO_THROW(ValidateModel(flat));
}

TEST(ValidateModelTest, SaysWhatIsWrong) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  struct Fault {
    std::string complaint;
    std::function<void(ObjectModel*)> make;
  };
  const std::vector<Fault> faults = {
      {"name", [](ObjectModel* m) { m->name = "no good"; }},
      {"box", [](ObjectModel* m) { m->box_min.x() = std::nan(""); }},
      {"box", [](ObjectModel* m) { m->box_max.z() = HUGE_VAL; }},
      {"box", [](ObjectModel* m) { m->box_min.y() = m->box_max.y() + 0.1; }},
      {"spacing", [](ObjectModel* m) { m->point_spacing = 0.0; }},
      {"spacing", [](ObjectModel* m) { m->point_spacing = -0.1; }},
      {"spacing", [](ObjectModel* m) { m->point_spacing = std::nan(""); }},
      {"no points", [](ObjectModel* m) { m->points.clear(), m->normals.clear(); }},
      {"differ in number", [](ObjectModel* m) { m->normals.pop_back(); }},
      {"not finite", [&](ObjectModel* m) { m->points[3].x() = nan; }},
      {"not finite", [&](ObjectModel* m) { m->normals[3].z() = nan; }},
      {"not finite", [](ObjectModel* m) { m->points[3].x() = 1e30f; }},
      {"box", [](ObjectModel* m) { m->box_max.x() = 1e9; }},
      {"viewpoint", [](ObjectModel* m) { m->views[0].viewpoint.z() = -1e9; }},
      {"outside", [](ObjectModel* m) { m->views[0].outside_points[0].y() = -2000.0f; }},
      {"feature", [](ObjectModel* m) { m->views[0].features[0].position.y() = 1e20f; }},
      {"viewpoint", [](ObjectModel* m) { m->views[0].viewpoint.x() = std::nan(""); }},
      {"validation", [&](ObjectModel* m) { m->views[0].validation_points[0].x() = nan; }},
      {"validation", [&](ObjectModel* m) { m->views[0].validation_normals[0].x() = nan; }},
      {"validation", [](ObjectModel* m) { m->views[0].validation_normals.clear(); }},
      {"outside", [&](ObjectModel* m) { m->views[0].outside_points[0].x() = nan; }},
      {"feature", [&](ObjectModel* m) { m->views[0].features[0].position.x() = nan; }},
      {"feature", [&](ObjectModel* m) { m->views[0].features[0].normal.x() = nan; }},
      {"descriptor", [](ObjectModel* m) { m->views[0].features[0].descriptor.pop_back(); }},
      {"descriptor", [](ObjectModel* m) { m->descriptor_size = 5; }},
  };
  for (const Fault& fault : faults) {
    ObjectModel model = GoodModel();
    fault.make(&model);
    EXPECT_TRUE(Complains([&] { ValidateModel(model); }, {"object model", fault.complaint}));
  }
}

}  // namespace
}  // namespace rimod

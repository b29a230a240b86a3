#include "io/model_messages.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "io/message_codec.h"
#include "tests/io/random_models.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_matchers.h"

namespace rimod {
namespace {

TEST(ModelMessagesTest, SectionsGiveTheModelBackBitForBit) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const ObjectModel model = RandomModel(seed, seed == 0 ? 0 : 12, 40 * static_cast<int>(seed));
    const JoinedModel joined = JoinModelSections(ToSections(model, 77));
    ASSERT_TRUE(joined.model) << joined.error;
    EXPECT_TRUE(SameBits(*joined.model, model));
  }
}

TEST(ModelMessagesTest, NoSectionIsTooLongForTheBusAndAllArriveAsSuch) {
  const std::vector<object_model_t> sections = ToSections(RandomModel(1, 30, 2000), 5);
  EXPECT_GT(sections.size(), 3u);
  for (std::size_t i = 0; i < sections.size(); ++i) {
    EXPECT_LE(sections[i].getEncodedSize(), kMaxModelSectionBytes);
    EXPECT_EQ(sections[i].utime, 5);
    EXPECT_EQ(sections[i].section, static_cast<int>(i));
    EXPECT_EQ(sections[i].num_sections, static_cast<int>(sections.size()));
    const std::vector<std::uint8_t> bytes = EncodeMessage(sections[i]);
    const auto decoded = DecodeMessage<object_model_t>(bytes.data(), bytes.size());
    ASSERT_TRUE(decoded.message) << decoded.error;
    EXPECT_EQ(EncodeMessage(*decoded.message), bytes);
  }
}

TEST(ModelMessagesTest, OrderAndRepetitionOfSectionsDoNotMatter) {
  const ObjectModel model = RandomModel(2, 20, 1500);
  std::vector<object_model_t> sections = ToSections(model, 0);
  ASSERT_GE(sections.size(), 3u);
  std::reverse(sections.begin(), sections.end());
  sections.push_back(sections[1]);
  const JoinedModel joined = JoinModelSections(sections);
  ASSERT_TRUE(joined.model) << joined.error;
  EXPECT_TRUE(SameBits(*joined.model, model));
}

TEST(ModelMessagesTest, MissingForeignAndDifferingSectionsAreErrors) {
  const std::vector<object_model_t> good = ToSections(RandomModel(3, 20, 1500), 0);
  EXPECT_TRUE(Mentions(JoinModelSections({}).error, {"no sections"}));
  std::vector<object_model_t> sections = good;
  sections.erase(sections.begin() + 1);
  EXPECT_TRUE(Mentions(JoinModelSections(sections).error, {"section 1 of", "missing"}));
  sections = good;
  sections[1].name = "other";
  EXPECT_TRUE(Mentions(JoinModelSections(sections).error, {"different models"}));
  sections = good;
  sections[1].utime = 9;
  EXPECT_TRUE(Mentions(JoinModelSections(sections).error, {"different models"}));
  sections = good;
  sections.push_back(good[0]);
  sections.back().x[0] += 1.0f;
  EXPECT_TRUE(Mentions(JoinModelSections(sections).error, {"twice"}));
  for (const int number : {-1, static_cast<int>(good.size()), INT32_MAX}) {
    sections = good;
    sections[0].section = number;
    EXPECT_TRUE(Mentions(JoinModelSections(sections).error, {"out of range"}));
  }
  for (const int total : {0, -5, INT32_MAX}) {
    sections = good;
    for (object_model_t& section : sections) section.num_sections = total;
    EXPECT_TRUE(Mentions(JoinModelSections(sections).error, {"number of sections"}));
  }
}

TEST(ModelMessagesTest, ContentsThatDoNotFitAreErrors) {
  const std::vector<object_model_t> good = ToSections(RandomModel(4, 3, 30), 0);
  ASSERT_EQ(good.size(), 1u);
  const auto error_after = [&good](const std::function<void(object_model_t*)>& change) {
    std::vector<object_model_t> sections = good;
    change(&sections[0]);
    return JoinModelSections(sections).error;
  };
  EXPECT_TRUE(Mentions(error_after([](object_model_t* s) { s->num_points = -1; }), {"count"}));
  EXPECT_TRUE(Mentions(error_after([](object_model_t* s) { ++s->num_features; }), {"count"}));
  EXPECT_TRUE(Mentions(error_after([](object_model_t* s) { s->values.pop_back(); }), {"count"}));
  EXPECT_TRUE(
      Mentions(error_after([](object_model_t* s) { s->descriptor_size = -2; }), {"absurd"}));
  EXPECT_TRUE(Mentions(error_after([](object_model_t* s) { s->descriptor_unit = 1.0; }), {"unit"}));
  EXPECT_TRUE(
      Mentions(error_after([](object_model_t* s) { ++s->views[0].num_features; }), {"view"}));
  EXPECT_TRUE(
      Mentions(error_after([](object_model_t* s) { s->views[0].num_features = -1; }), {"view"}));
  EXPECT_TRUE(Mentions(error_after([](object_model_t* s) { --s->views[2].num_validation_points; }),
                       {"view"}));
  EXPECT_TRUE(Mentions(error_after([](object_model_t* s) { s->x[3] = NAN; }), {"finite"}));
  EXPECT_TRUE(Mentions(error_after([](object_model_t* s) { s->name = "../evil"; }), {"name"}));
  EXPECT_TRUE(Mentions(error_after([](object_model_t* s) { s->box_min[0] = 1e9; }), {"box"}));
}

TEST(ModelMessagesTest, InvalidModelsAreNotSent) {
  ObjectModel model = RandomModel(5, 3, 30);
  model.source = std::string(2000, 'x');
  EXPECT_TRUE(Complains([&] { ToSections(model, 0); }, {"source"}));
  model = RandomModel(5, 3, 30);
  model.name = "a b";
  EXPECT_TRUE(Complains([&] { ToSections(model, 0); }, {"name"}));
  model = RandomModel(5, 3, 30);
  model.normals.pop_back();
  EXPECT_TRUE(Complains([&] { ToSections(model, 0); }, {"normals"}));
}

}  // namespace
}  // namespace rimod

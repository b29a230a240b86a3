#include "io/config.h"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <set>
#include <type_traits>
#include <utility>

#include "io/config_table.h"
#include "tests/io/random_values.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_matchers.h"

namespace rimod {
namespace {

std::string ErrorOf(const std::string& yaml) {
  const ConfigurationResult result = ParseConfiguration(yaml, "my.yaml");
  EXPECT_NE(result.configuration.has_value(), !result.error.empty());
  return result.error;
}

TEST(ConfigTest, NothingSetGivesTheDefaults) {
  const std::string defaults = DumpConfiguration(DefaultConfiguration(Method::kDefault));
  for (const char* yaml : {"", "# only a comment\n", "sweep:\n", "{}"}) {
    const ConfigurationResult result = ParseConfiguration(yaml, "my.yaml");
    ASSERT_TRUE(result.configuration) << result.error;
    EXPECT_EQ(DumpConfiguration(*result.configuration), defaults);
  }
  EXPECT_EQ(DumpConfiguration(*ReadConfiguration("").configuration), defaults);
}

TEST(ConfigTest, SingleKeysOverrideTheMethodsBase) {
  const ConfigurationResult result = ParseConfiguration(
      "range_image:\n  resolution_deg: 0.5\nmethod: paper\ninterest_points: {measure: harris}\n",
      "my.yaml");
  ASSERT_TRUE(result.configuration) << result.error;
  Configuration expected = DefaultConfiguration(Method::kPaper);
  expected.pipeline.range_image.resolution = 0.5 * 3.14159265358979323846 / 180.0;
  expected.pipeline.interest_points.measure = InterestMeasure::kHarris;
  EXPECT_EQ(result.configuration->pipeline.method, Method::kPaper);
  EXPECT_EQ(result.configuration->pipeline.range_image.resolution,
            expected.pipeline.range_image.resolution);
  EXPECT_EQ(DumpConfiguration(*result.configuration), DumpConfiguration(expected));
}

TEST(ConfigTest, MistakesNameFileLineAndKey) {
  EXPECT_TRUE(Mentions(ErrorOf("\nswep:\n  min_range: 1\n"), {"my.yaml:2", "unknown", "swep"}));
  EXPECT_TRUE(Mentions(ErrorOf("sweep:\n  min_rnge: 1\n"), {"my.yaml:2", "sweep", "min_rnge"}));
  EXPECT_TRUE(Mentions(ErrorOf("sweep:\n  min_range: near\n"),
                       {"my.yaml:2", "sweep", "min_range", "near", "number"}));
  EXPECT_TRUE(Mentions(ErrorOf("sweep:\n  beams_per_line: 1.5\n"), {"beams_per_line", "whole"}));
  EXPECT_TRUE(Mentions(ErrorOf("sweep:\n  beams_per_line: 99999999999\n"), {"whole number"}));
  EXPECT_TRUE(Mentions(ErrorOf("sweep:\n  max_range: .nan\n"), {"max_range", "number"}));
  EXPECT_TRUE(Mentions(ErrorOf("sweep:\n  max_range: inf\n"), {"max_range", "number"}));
  EXPECT_TRUE(Mentions(ErrorOf("sweep:\n  max_range: [1]\n"), {"max_range", "number"}));
  EXPECT_TRUE(Mentions(ErrorOf("range_patch:\n  mask_empty_cells: yes\n"),
                       {"mask_empty_cells", "true or false"}));
  EXPECT_TRUE(Mentions(ErrorOf("interest_points:\n  measure: naarf\n"),
                       {"measure", "naarf", "harris or surface_change"}));
  EXPECT_TRUE(Mentions(ErrorOf("method: best\n"), {"my.yaml:1", "method", "paper or default"}));
}

TEST(ConfigTest, ValuesOutOfRangeNameFileLineAndKey) {
  EXPECT_TRUE(Mentions(ErrorOf("sweep:\n  pause_duration: 1\n  line_duration: -1\n"),
                       {"my.yaml:3", "sweep", "line_duration", "-1"}));
  EXPECT_TRUE(Mentions(ErrorOf("range_image:\n  resolution_deg: 20\n"),
                       {"my.yaml:2", "range_image", "resolution_deg", "radians"}));
  EXPECT_TRUE(Mentions(ErrorOf("validation_scoring:\n  epsilon: -1\n"),
                       {"my.yaml:2", "validation_scoring", "epsilon"}));
  EXPECT_TRUE(Mentions(ErrorOf("cloud:\ndescriptor: spherical_spin\n"),
                       {"my.yaml:2", "key 'descriptor'", "spherical_spin", "method paper"}));
  EXPECT_EQ(ErrorOf("descriptor: spherical_spin\nmethod: paper\n"), "");
  EXPECT_TRUE(Mentions(ErrorOf("bus:\n  idle_time: 0\n"), {"my.yaml:2", "bus", "idle_time"}));
  EXPECT_TRUE(Mentions(ErrorOf("result:\n  max_reported_hypotheses: 0\n"),
                       {"my.yaml:2", "max_reported_hypotheses"}));
}

TEST(ConfigTest, RepeatedKeysAndOtherDocumentsAreErrors) {
  EXPECT_TRUE(
      Mentions(ErrorOf("sweep:\n  min_range: 1\n  min_range: 2\n"), {"my.yaml:3", "twice"}));
  EXPECT_TRUE(Mentions(ErrorOf("sweep:\n  min_range: 1\nsweep:\n  max_range: 2\n"),
                       {"my.yaml:3", "twice"}));
  EXPECT_TRUE(Mentions(ErrorOf("method: paper\nmethod: paper\n"), {"method", "twice"}));
  EXPECT_TRUE(Mentions(ErrorOf("- a\n- b\n"), {"my.yaml:1"}));
  EXPECT_TRUE(Mentions(ErrorOf("sweep: 5\n"), {"my.yaml:1", "sweep"}));
  EXPECT_TRUE(Mentions(ErrorOf("sweep: {min_range: 1\n"), {"my.yaml", "not YAML"}));
  EXPECT_TRUE(Mentions(ErrorOf("{a: b}: 5\n"), {"my.yaml:1"}));
  EXPECT_TRUE(Mentions(ErrorOf(std::string(5000, '[')), {"my.yaml"}));
  const TemporaryFolder folder;
  EXPECT_TRUE(Mentions(ReadConfiguration(folder.PathOf("no.yaml")).error, {"no.yaml"}));
}

TEST(ConfigTest, KeysAreUniqueAndTheirSectionsTogetherAndChecked) {
  Configuration configuration;
  std::set<std::pair<std::string, std::string>> keys;
  std::vector<std::string> sections;
  for (const ConfigKey& key : ConfigTable(&configuration)) {
    EXPECT_TRUE(keys.emplace(key.section, key.key).second) << key.section << " " << key.key;
    if (sections.empty() || sections.back() != key.section) sections.push_back(key.section);
    const bool in_degrees = std::holds_alternative<DegreesOf>(key.value);
    EXPECT_EQ(in_degrees, key.key.size() > 4 && key.key.substr(key.key.size() - 4) == "_deg");
    EXPECT_FALSE(key.comment.empty());
  }
  EXPECT_EQ(std::set<std::string>(sections.begin(), sections.end()).size(), sections.size());
  std::set<std::string> checked = {""};
  for (const SectionCheck& check : SectionChecks()) checked.insert(check.first);
  EXPECT_EQ(checked, std::set<std::string>(sections.begin(), sections.end()));
}

// Fits any field of an aggregate.
struct Anything {
  template <typename T>
  operator T() const;
};

template <typename Aggregate, typename Numbers, typename = void>
struct CanTake : std::false_type {};
template <typename Aggregate, std::size_t... numbers>
struct CanTake<Aggregate, std::index_sequence<numbers...>,
               std::void_t<decltype(Aggregate{(static_cast<void>(numbers), Anything())...})>>
    : std::true_type {};

// How many fields an aggregate has: the most that it can be initialised with.
template <typename Aggregate, std::size_t number = 40>
constexpr int CountFields() {
  if constexpr (CanTake<Aggregate, std::make_index_sequence<number>>::value) {
    return static_cast<int>(number);
  } else {
    return CountFields<Aggregate, number - 1>();
  }
}

TEST(ConfigTest, EveryFieldOfTheParametersHasAKey) {
  Configuration configuration;
  std::map<std::string, int> num_keys;
  for (const ConfigKey& key : ConfigTable(&configuration)) ++num_keys[key.section];
  EXPECT_EQ(num_keys["sweep"], CountFields<SweepParams>());
  EXPECT_EQ(num_keys["range_image"], CountFields<RangeImageParams>());
  EXPECT_EQ(num_keys["interest_points"], CountFields<InterestPointParams>());
  EXPECT_EQ(num_keys["range_patch"], CountFields<RangePatchParams>());
  EXPECT_EQ(num_keys["spherical_spin"], CountFields<SphericalSpinParams>());
  EXPECT_EQ(num_keys["model_surface"], CountFields<ModelSurfaceParams>());
  EXPECT_EQ(num_keys["model_views"], CountFields<ModelViewParams>());
  EXPECT_EQ(num_keys["matching"], CountFields<MatchingParams>());
  EXPECT_EQ(num_keys["goodsac"], CountFields<GoodsacParams>());
  EXPECT_EQ(num_keys["scoring"], CountFields<ScoringParams>());
  EXPECT_EQ(num_keys["pruning"], CountFields<PruningParams>());
  EXPECT_EQ(num_keys["collisions"], CountFields<CollisionParams>());
  EXPECT_EQ(num_keys["validation_scoring"], CountFields<ScoringParams>());
  EXPECT_EQ(num_keys["validation"], CountFields<ValidationParams>() - 1);  // scoring apart
  EXPECT_EQ(num_keys["pose_refinement"], CountFields<PoseRefinementParams>());
  // Two of its fields are quotas.
  EXPECT_EQ(num_keys["ranking"],
            CountFields<RankingParams>() + 2 * (CountFields<ModelQuota>() - 1));
  EXPECT_EQ(num_keys["refinement"], CountFields<RefinementParams>());
  EXPECT_EQ(num_keys["evidence"], CountFields<EvidenceParams>());
  EXPECT_EQ(num_keys["choice"], CountFields<ChoiceParams>());
  EXPECT_EQ(num_keys["bus"], CountFields<BusParams>());
  // Each struct has a section; `result` has one field, the top level two.
  const int num_structs = CountFields<PipelineParams>() - 3 + CountFields<Configuration>() - 1;
  EXPECT_EQ(num_keys.size() - 3u, static_cast<std::size_t>(num_structs)) << "validation has two";
}

// Changes every value a little and reads what is printed: nothing of it may get lost.
TEST(ConfigTest, PrintedConfigurationsAreReadBackBitForBit) {
  RandomValues random(7);
  for (int round = 0; round < 50; ++round) {
    Configuration configuration = DefaultConfiguration(Method::kDefault);
    for (const ConfigKey& key : ConfigTable(&configuration)) {
      if (double* const* const value = std::get_if<double*>(&key.value)) {
        **value *= 1.0 + random.Between(-1e-3, 1e-3);
      }
    }
    const ConfigurationResult read =
        ParseConfiguration(DumpConfiguration(configuration), "printed");
    if (!read.configuration) continue;  // an edge of a range was crossed
    Configuration copy = *read.configuration;
    const std::vector<ConfigKey> written = ConfigTable(&configuration);
    const std::vector<ConfigKey> back = ConfigTable(&copy);
    for (std::size_t i = 0; i < back.size(); ++i) {
      if (double* const* const value = std::get_if<double*>(&back[i].value)) {
        EXPECT_EQ(**value, **std::get_if<double*>(&written[i].value)) << back[i].key;
      }
    }
  }
}

TEST(ConfigTest, DefaultsAreReadBackBitForBit) {
  for (const Method method : {Method::kPaper, Method::kDefault}) {
    Configuration defaults = DefaultConfiguration(method);
    ConfigurationResult read = ParseConfiguration(DumpConfiguration(defaults), "printed");
    ASSERT_TRUE(read.configuration) << read.error;
    const std::vector<ConfigKey> written = ConfigTable(&defaults);
    const std::vector<ConfigKey> back = ConfigTable(&*read.configuration);
    for (std::size_t i = 0; i < back.size(); ++i) {
      if (const DegreesOf* const value = std::get_if<DegreesOf>(&back[i].value)) {
        EXPECT_EQ(*value->radians, *std::get_if<DegreesOf>(&written[i].value)->radians)
            << back[i].key;
      }
    }
    EXPECT_EQ(DumpConfiguration(*read.configuration), DumpConfiguration(defaults));
  }
}

// The files that we ship list every key with the built-in value. After a change:
// rimod-detect --print-config METHOD > config/METHOD.yaml
TEST(ConfigTest, ShippedFilesListEveryKeyWithItsDefault) {
  for (const auto& [method, name] :
       {std::pair(Method::kPaper, "paper"), std::pair(Method::kDefault, "default")}) {
    const std::string path = std::string(RIMOD_SOURCE_DIR) + "/config/" + name + ".yaml";
    std::ifstream file(path);
    const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    EXPECT_EQ(text, DumpConfiguration(DefaultConfiguration(method))) << path;
  }
}

}  // namespace
}  // namespace rimod

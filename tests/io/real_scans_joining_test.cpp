// The scans in logs/ go through sections, joiners and pairing: none is refused, none is mixed.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <random>

#include "io/feature_messages.h"
#include "io/partner_joiner.h"
#include "io/range_image_messages.h"
#include "io/scan_source.h"
#include "io/section_joiner.h"
#include "rimod/detector.h"
#include "rimod/feature_origin.h"

namespace rimod {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

class RealScansJoiningTest : public ::testing::Test {
 protected:
  // The office, and of each recording as many scans as asked for.
  static std::vector<DescribedScan> Scans(int per_recording) {
    const fs::path logs = fs::path(RIMOD_SOURCE_DIR) / "logs";
    std::vector<fs::path> paths = {logs / "office.lcm"};
    for (const auto& recording : fs::directory_iterator(logs / "recordings")) {
      std::vector<fs::path> of_it;
      for (const auto& file : fs::directory_iterator(recording))
        if (file.path().extension() == ".pcd") of_it.push_back(file.path());
      std::sort(of_it.begin(), of_it.end());
      of_it.resize(std::min(of_it.size(), static_cast<std::size_t>(per_recording)));
      paths.insert(paths.end(), of_it.begin(), of_it.end());
    }
    const PipelineParams params = DefaultParams(Method::kDefault);
    std::vector<DescribedScan> scans;
    for (const fs::path& path : paths) {
      const ScanSourceReport report =
          ReadScans(path.string(), SweepParams(), [&](const NamedScan& scan) {
            DescribedScan described;
            described.image = ComputeRangeImage(scan.scan, params, Execution());
            described.features = ExtractFeatures(described.image, params, Execution());
            EXPECT_FALSE(described.features.features.empty()) << path;
            scans.push_back(std::move(described));
          });
      EXPECT_TRUE(report.errors.empty()) << path;
    }
    return scans;
  }

  template <typename Section>
  std::vector<Section> Shuffled(std::vector<Section> sections) {
    std::shuffle(sections.begin(), sections.end(), random_);
    return sections;
  }

  std::mt19937 random_{1};
};

TEST_F(RealScansJoiningTest, EachIsPairedWithItselfHoweverItsSectionsCome) {
  const std::vector<DescribedScan> scans = Scans(2);
  ASSERT_GE(scans.size(), 15u);
  SectionJoiner<range_image_t> images;
  SectionJoiner<feature_set_t> features;
  PartnerJoiner partners{std::chrono::milliseconds(1000)};
  std::int64_t num_paired = 0;
  const auto now = Clock::now();
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const auto utime = static_cast<std::int64_t>(i);
    const auto count = [&](const std::optional<DescribedScan>& scan) {
      num_paired += scan.has_value();
    };
    for (range_image_t& section : Shuffled(ToSections(scans[i].image, utime)))
      if (const auto whole = images.Add(std::move(section), now))
        count(partners.AddImage(utime, *JoinRangeImageSections(*whole).image, now));
    for (feature_set_t& section : Shuffled(ToSections(scans[i].features, utime)))
      if (const auto whole = features.Add(std::move(section), now))
        count(partners.AddFeatures(utime, *JoinFeatureSections(*whole).features, now));
  }
  EXPECT_EQ(num_paired, static_cast<std::int64_t>(scans.size()));
  EXPECT_EQ(partners.num_refused(), 0);
  EXPECT_EQ(partners.num_unpaired(), 0);
}

TEST_F(RealScansJoiningTest, NoFeaturesAreTakenForThoseOfAnotherScan) {
  const std::vector<DescribedScan> scans = Scans(1);
  for (std::size_t i = 0; i < scans.size(); ++i)
    for (std::size_t k = 0; k < scans.size(); ++k)
      EXPECT_EQ(AreFeaturesOf(scans[i].image, scans[k].features), i == k);
}

}  // namespace
}  // namespace rimod

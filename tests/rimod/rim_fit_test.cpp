#include "rimod/rim_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/io/random_values.h"

namespace rimod {
namespace {

// '.': not rendered, '?': unknown, '#': fits, 'o': seen through.
FitImage Drawn(const std::vector<std::string>& rows) {
  FitImage fits;
  fits.height = static_cast<int>(rows.size());
  fits.width = rows.empty() ? 0 : static_cast<int>(rows[0].size());
  for (const std::string& row : rows)
    for (const char c : row)
      fits.pixels.push_back(c == '.'   ? PixelFit::kNotRendered
                            : c == '?' ? PixelFit::kUnknown
                            : c == '#' ? PixelFit::kFits
                                       : PixelFit::kSeenThrough);
  return fits;
}

TEST(FitOfRimTest, AFittingModelHasAFittingRim) {
  const RimFit rim = FitOfRim(Drawn({"####", "####", "####", "####"}), 0);
  EXPECT_EQ(rim.worst, 0.0);
  EXPECT_EQ(rim.second_worst, 0.0);
  EXPECT_EQ(rim.mean, 0.0);
}

TEST(FitOfRimTest, AModelTooWideIsSeenThroughOnOneSide) {
  const RimFit rim = FitOfRim(Drawn({"####o", "####o", "####o", "####o"}), 0);
  EXPECT_EQ(rim.worst, 1.0);         // right
  EXPECT_EQ(rim.second_worst, 0.2);  // one of five above and below
  EXPECT_DOUBLE_EQ(rim.mean, 6.0 / 18.0);
}

TEST(FitOfRimTest, TheOutermostPixelsMayBeLeftOut) {
  const FitImage fits = Drawn({".....", ".ooo.", ".o#o.", ".ooo.", "....."});
  EXPECT_EQ(FitOfRim(fits, 0).worst, 1.0);
  const RimFit inside = FitOfRim(fits, 1);  // the middle row and column, both ways
  EXPECT_EQ(inside.mean, 2.0 / 3.0);
  EXPECT_EQ(FitOfRim(fits, 2).mean, 0.0);  // no part is that wide
}

TEST(FitOfRimTest, WhatIsUnknownSaysNothing) {
  const RimFit rim = FitOfRim(Drawn({"?##o", "?##o", "?###", "?###"}), 0);
  EXPECT_EQ(rim.worst, 0.5);
  EXPECT_EQ(FitOfRim(Drawn({"??", "??"}), 0).mean, 0.0);
  EXPECT_EQ(FitOfRim(FitImage{}, 3).worst, 0.0);
}

TEST(FitOfRimTest, IsTheSameForTheImageTurnedOver) {
  RandomValues random(1);
  for (int round = 0; round < 50; ++round) {
    FitImage fits, turned;
    fits.width = turned.height = 1 + static_cast<int>(random.Between(0, 12));
    fits.height = turned.width = 1 + static_cast<int>(random.Between(0, 12));
    fits.pixels.resize(fits.width * fits.height);
    turned.pixels.resize(fits.pixels.size());
    for (int row = 0; row < fits.height; ++row) {
      for (int column = 0; column < fits.width; ++column) {
        const auto fit = static_cast<PixelFit>(static_cast<int>(random.Between(0, 3.999)));
        fits.pixels[row * fits.width + column] = fit;
        turned.pixels[column * turned.width + row] = fit;
      }
    }
    for (const int inset : {0, 1, 2}) {
      const RimFit a = FitOfRim(fits, inset), b = FitOfRim(turned, inset);
      EXPECT_EQ(a.worst, b.worst);
      EXPECT_EQ(a.second_worst, b.second_worst);
      EXPECT_EQ(a.mean, b.mean);
      EXPECT_LE(a.second_worst, a.worst);
      EXPECT_LE(a.mean, a.worst > 0.0 ? 1.0 : a.mean);
    }
    EXPECT_EQ(LargestSeenThroughRegion(fits), LargestSeenThroughRegion(turned));
  }
}

TEST(LargestSeenThroughRegionTest, CountsWhatTouchesBySides) {
  EXPECT_EQ(LargestSeenThroughRegion(Drawn({"######", "#oo#o#", "##o#o#", "#o##o#", "######"})), 3);
  EXPECT_EQ(LargestSeenThroughRegion(Drawn({"####", "##o#", "#o##", "####"})), 1);  // corners
  EXPECT_EQ(LargestSeenThroughRegion(Drawn({"####", "#?##", "####"})), 0);
  EXPECT_EQ(LargestSeenThroughRegion(FitImage{}), 0);
}

TEST(LargestSeenThroughRegionTest, TheOutermostPixelsDoNotCount) {
  EXPECT_EQ(LargestSeenThroughRegion(Drawn({"ooooo", "o###o", "o###o", "ooooo"})), 0);
  EXPECT_EQ(LargestSeenThroughRegion(Drawn({".oo..", ".ooo.", ".oooo", "..oo."})), 3);
  EXPECT_EQ(LargestSeenThroughRegion(Drawn({"ooooo", "oo#oo", "ooooo"})), 1);
}

}  // namespace
}  // namespace rimod

#pragma once

#include <gtest/gtest.h>

#include "rimod/features.h"

namespace rimod {

// That two feature sets are the same to the bit.
inline void ExpectEqual(const FeatureSet& a, const FeatureSet& b) {
  EXPECT_EQ(a.descriptor_kind, b.descriptor_kind);
  EXPECT_EQ(a.descriptor_size, b.descriptor_size);
  ASSERT_EQ(a.features.size(), b.features.size());
  for (std::size_t i = 0; i < a.features.size(); ++i) {
    EXPECT_EQ(a.features[i].position, b.features[i].position);
    EXPECT_EQ(a.features[i].normal, b.features[i].normal);
    EXPECT_EQ(a.features[i].descriptor, b.features[i].descriptor);
  }
}

}  // namespace rimod

#include "io/message_codec.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "tests/support/sample_messages.h"

namespace {

// The largest piece of memory that was asked for since it was set to 0.
std::size_t largest_allocation = 0;

void* Allocate(std::size_t size) {
  largest_allocation = std::max(largest_allocation, size);
  void* const memory = std::malloc(size == 0 ? 1 : size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(std::size_t size) { return Allocate(size); }
void* operator new[](std::size_t size) { return Allocate(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace rimod {
namespace {

template <typename Message>
class MessageCodecTest : public ::testing::Test {
 protected:
  MessageCodecTest() : bytes_(EncodeMessage(SampleMessage<Message>())) {}

  Decoded<Message> Decode() const { return DecodeMessage<Message>(bytes_.data(), bytes_.size()); }
  // Decodes and tells how much memory that took at once.
  std::size_t MemoryToDecode() const {
    largest_allocation = 0;
    const Decoded<Message> decoded = Decode();
    return largest_allocation;
  }
  void PutInt32(std::size_t position, std::uint32_t value) {
    for (std::size_t i = 0; i < 4; ++i) {
      bytes_[position + i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
    }
  }

  std::vector<std::uint8_t> bytes_;
};

using Messages =
    ::testing::Types<bot_core::planar_lidar_t, bot_core::rigid_transform_t, scan_t, range_image_t,
                     feature_set_t, object_model_t, pose_hypotheses_t, detections_t, status_t,
                     bot_core::pointcloud2_t, partial_scan_t, partial_range_image_t,
                     partial_feature_set_t, early_detections_t, scan_end_t, shard_t,
                     shard_candidates_t, shard_scan_t, shard_turn_t>;
TYPED_TEST_SUITE(MessageCodecTest, Messages);

// Fails also when a field is added to a type and not to its walk.
TYPED_TEST(MessageCodecTest, MessagesComeBackByteForByte) {
  const auto decoded = this->Decode();
  ASSERT_TRUE(decoded.message) << decoded.error;
  EXPECT_EQ(EncodeMessage(*decoded.message), this->bytes_);
}

TYPED_TEST(MessageCodecTest, CutOffAnywhereTheyAreRejected) {
  for (std::size_t size = 0; size < this->bytes_.size(); ++size) {
    const auto decoded = DecodeMessage<TypeParam>(this->bytes_.data(), size);
    EXPECT_FALSE(decoded.message) << size << " bytes";
    EXPECT_FALSE(decoded.error.empty());
  }
}

TYPED_TEST(MessageCodecTest, LeftOverBytesAreRejected) {
  this->bytes_.push_back(0);
  EXPECT_EQ(this->Decode().error, "has bytes left over");
}

TYPED_TEST(MessageCodecTest, AnotherFingerprintIsRejected) {
  this->bytes_[3] ^= 1;
  EXPECT_EQ(this->Decode().error, "is of another type");
}

TYPED_TEST(MessageCodecTest, NoCountMakesItAllocateMuchOrThrow) {
  const std::vector<std::uint8_t> good = this->bytes_;
  for (std::size_t position = 8; position + 4 <= good.size(); ++position) {
    for (const std::uint32_t value : {0xffffffffu, 0x80000000u, 0x7fffffffu, 0x00ffffffu, 1000u}) {
      this->bytes_ = good;
      this->PutInt32(position, value);
      EXPECT_LE(this->MemoryToDecode(), 10000u) << "value " << value << " at byte " << position;
    }
  }
}

TYPED_TEST(MessageCodecTest, RandomDamageNeverThrows) {
  RandomValues random(5);
  const std::vector<std::uint8_t> good = this->bytes_;
  for (int i = 0; i < 5000; ++i) {
    this->bytes_ = good;
    const int num_changes = random.Int(1, 8);
    for (int k = 0; k < num_changes; ++k) {
      const int position = random.Int(8, static_cast<int>(good.size()) - 1);
      this->bytes_[static_cast<std::size_t>(position)] =
          static_cast<std::uint8_t>(random.Int(0, 255));
    }
    EXPECT_NO_THROW(this->Decode());
  }
}

TEST(MessageCodecCausesTest, CausesAreNamed) {
  std::vector<std::uint8_t> bytes = EncodeMessage(SampleMessage<scan_t>());
  const auto error = [&bytes] { return DecodeMessage<scan_t>(bytes.data(), bytes.size()).error; };
  constexpr std::size_t kNumPoints = 8 + 16 + 16 + 56;  // where the count stands
  ASSERT_EQ(bytes[kNumPoints + 3], 5);
  bytes[kNumPoints + 3] = 4;
  EXPECT_EQ(error(), "has a count that is larger than its bytes");  // floats are read as a count
  bytes[kNumPoints] = 0x7f;
  EXPECT_EQ(error(), "has a count that is larger than its bytes");
  bytes[kNumPoints] = 0xff;
  EXPECT_EQ(error(), "has a negative count");
  EXPECT_EQ(DecodeMessage<scan_t>(nullptr, 0).error, "is empty");
}

TEST(MessageCodecCausesTest, ATextWithoutItsEndIsRejected) {
  const detections_t message = SampleMessage<detections_t>();
  std::vector<std::uint8_t> bytes = EncodeMessage(message);
  const std::string name = "chair";
  const auto found = std::search(bytes.begin(), bytes.end(), name.begin(), name.end());
  ASSERT_NE(found, bytes.end());
  found[5] = 'x';  // the final zero
  EXPECT_EQ(DecodeMessage<detections_t>(bytes.data(), bytes.size()).error,
            "has a text that does not end where it should");
  found[5] = 0;
  found[2] = 0;
  EXPECT_EQ(DecodeMessage<detections_t>(bytes.data(), bytes.size()).error,
            "has a text that does not end where it should");
}

}  // namespace
}  // namespace rimod

// Many sections, mixed up, through the joiners. The input is a row of pieces: type (1 byte), length
// (2 bytes, big-endian), the fields of a section.

#include <chrono>

#include "io/feature_messages.h"
#include "io/message_codec.h"
#include "io/model_messages.h"
#include "io/range_image_messages.h"
#include "io/scan_messages.h"
#include "io/section_joiner.h"
#include "tests/fuzz/input_file.h"
#include "tests/fuzz/message_types.h"

namespace rimod {
namespace {

using Clock = std::chrono::steady_clock;

void Join(const std::vector<scan_t>& sections) {
  const JoinedScan joined = JoinScanSections(sections);
  Require(joined.scan.has_value() == joined.error.empty(), "a scan or an error");
}
void Join(const std::vector<range_image_t>& sections) {
  const JoinedRangeImage joined = JoinRangeImageSections(sections);
  Require(joined.image.has_value() == joined.error.empty(), "an image or an error");
}
void Join(const std::vector<feature_set_t>& sections) {
  const JoinedFeatures joined = JoinFeatureSections(sections);
  Require(joined.features.has_value() == joined.error.empty(), "features or an error");
}
void Join(const std::vector<object_model_t>& sections) {
  const JoinedModel joined = JoinModelSections(sections);
  Require(joined.model.has_value() == joined.error.empty(), "a model or an error");
}

template <typename Section>
void Add(const std::uint8_t* fields, std::size_t size, Clock::time_point now,
         SectionJoiner<Section>* joiner) {
  const std::vector<std::uint8_t> bytes = WithFingerprint<Section>(fields, size);
  Decoded<Section> decoded = DecodeMessage<Section>(bytes.data(), bytes.size());
  if (!decoded.message) return;
  const auto sections = joiner->Add(std::move(*decoded.message), now);
  Require(joiner->num_open() <= 4, "wholes under way");
  if (sections) Join(*sections);
}

}  // namespace
}  // namespace rimod

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace rimod;
  SectionJoiner<scan_t> scans;
  SectionJoiner<range_image_t> images;
  SectionJoiner<feature_set_t> features;
  SectionJoiner<object_model_t> models;
  Clock::time_point now{};
  for (std::size_t i = 0; i + 3 <= size;) {
    const int type = bytes[i];
    const std::size_t length =
        std::min<std::size_t>(size_t{256} * bytes[i + 1] + bytes[i + 2], size - i - 3);
    const std::uint8_t* const fields = bytes + i + 3;
    now += std::chrono::milliseconds(10 * (type >> 2));
    if (type % 4 == 0) Add(fields, length, now, &scans);
    if (type % 4 == 1) Add(fields, length, now, &images);
    if (type % 4 == 2) Add(fields, length, now, &features);
    if (type % 4 == 3) Add(fields, length, now, &models);
    i += 3 + length;
  }
  return 0;
}

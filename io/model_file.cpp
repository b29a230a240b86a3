#include "io/model_file.h"

#include <zlib.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string_view>

#include "io/files.h"
#include "io/message_codec.h"
#include "io/model_messages.h"

namespace rimod {
namespace {

constexpr std::string_view kMagicLine = "rimod-model\n";
constexpr std::size_t kNumberBytes = 4;
constexpr std::int64_t kMaxFileBytes = 1'000'000'000;

void AppendNumber(std::uint32_t value, std::string* bytes) {
  for (int shift = 24; shift >= 0; shift -= 8) {
    bytes->push_back(static_cast<char>((value >> shift) & 0xff));
  }
}

std::uint32_t NumberAt(std::string_view bytes, std::size_t position) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < kNumberBytes; ++i) {
    value = (value << 8) | static_cast<unsigned char>(bytes[position + i]);
  }
  return value;
}

std::uint32_t Checksum(std::string_view bytes) {
  const auto* const begin = reinterpret_cast<const Bytef*>(bytes.data());
  return static_cast<std::uint32_t>(crc32_z(crc32_z(0, Z_NULL, 0), begin, bytes.size()));
}

// Where in a model file what stands.
constexpr std::size_t kVersionAt = kMagicLine.size();
constexpr std::size_t kNumSectionsAt = kVersionAt + kNumberBytes;
constexpr std::size_t kSectionsAt = kNumSectionsAt + kNumberBytes;

// Checks all but the sections' content. Returns an error text.
std::string CheckFrame(std::string_view bytes) {
  if (bytes.empty()) return "is empty";
  if (bytes.substr(0, kMagicLine.size()) != kMagicLine.substr(0, bytes.size())) {
    return "is not a rimod model";
  }
  if (bytes.size() < kSectionsAt + kNumberBytes) return "is truncated";
  const std::uint32_t version = NumberAt(bytes, kVersionAt);
  const std::uint32_t checksum = NumberAt(bytes, bytes.size() - kNumberBytes);
  const bool intact = checksum == Checksum(bytes.substr(0, bytes.size() - kNumberBytes));
  if (version != kModelFileVersion) {
    return intact ? "is of format version " + std::to_string(version) + ", this program reads " +
                        std::to_string(kModelFileVersion)
                  : "is damaged or of another version (" + std::to_string(version) +
                        ", this reads " + std::to_string(kModelFileVersion) + ")";
  }
  return intact ? "" : "is truncated or damaged: its checksum does not fit";
}

// Decodes the sections. Returns an error text.
std::string DecodeSections(std::string_view bytes, std::vector<object_model_t>* sections) {
  const std::uint32_t num_sections = NumberAt(bytes, kNumSectionsAt);
  const std::size_t end = bytes.size() - kNumberBytes;
  std::size_t position = kSectionsAt;
  for (std::uint32_t i = 0; i < num_sections; ++i) {
    const std::string which = "section " + std::to_string(i);
    if (end - position < kNumberBytes) return which + " is missing";
    const std::size_t length = NumberAt(bytes, position);
    position += kNumberBytes;
    if (end - position < length) return which + " is longer than the file";
    Decoded<object_model_t> decoded =
        DecodeMessage<object_model_t>(bytes.data() + position, length);
    if (!decoded.message) return which + ": " + decoded.error;
    sections->push_back(std::move(*decoded.message));
    position += length;
  }
  return position == end ? "" : "has bytes after its last section";
}

}  // namespace

std::string EncodeModelFile(const ObjectModel& model) {
  const std::vector<object_model_t> sections = ToSections(model, 0);
  std::string bytes(kMagicLine);
  AppendNumber(kModelFileVersion, &bytes);
  AppendNumber(static_cast<std::uint32_t>(sections.size()), &bytes);
  for (const object_model_t& section : sections) {
    const std::vector<std::uint8_t> encoded = EncodeMessage(section);
    AppendNumber(static_cast<std::uint32_t>(encoded.size()), &bytes);
    bytes.append(encoded.begin(), encoded.end());
  }
  AppendNumber(Checksum(bytes), &bytes);
  return bytes;
}

ModelFileResult DecodeModelFile(const std::string& bytes, const std::string& name) {
  std::string error = CheckFrame(bytes);
  std::vector<object_model_t> sections;
  if (error.empty()) error = DecodeSections(bytes, &sections);
  if (!error.empty()) return {std::nullopt, name + ": " + error};
  JoinedModel joined = JoinModelSections(sections);
  if (!joined.model) return {std::nullopt, name + ": " + joined.error};
  return {std::move(joined.model), ""};
}

ModelFileResult ReadModelFile(const std::string& path) {
  const FileBytes file = ReadFile(path, kMaxFileBytes);
  if (!file.bytes) return {std::nullopt, file.error};
  return DecodeModelFile(*file.bytes, path);
}

std::string WriteModelFile(const std::string& path, const ObjectModel& model) {
  try {
    return WriteFileAtomically(path, EncodeModelFile(model));
  } catch (const std::invalid_argument& invalid) {
    return path + ": not written: " + invalid.what();
  }
}

ModelFolder LoadModelFolder(const std::string& folder, const Execution& execution) {
  ModelFolder loaded;
  const FolderListing listing = ListFolder(folder, "", ".rimod");
  loaded.error = listing.error;
  std::vector<ModelFileResult> files(listing.paths.size());
  execution.parallel_for(files.size(),
                         [&](std::size_t i) { files[i] = ReadModelFile(listing.paths[i]); });
  std::set<std::string> names;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::string& path = listing.paths[i];
    ModelFileResult& file = files[i];
    if (!file.model) {
      loaded.bad_files.push_back(file.error);
    } else if (!names.insert(file.model->name).second) {
      loaded.bad_files.push_back(path + ": another file has a model of the class '" +
                                 file.model->name + "' already");
    } else {
      loaded.models.push_back(std::move(*file.model));
    }
  }
  return loaded;
}

}  // namespace rimod

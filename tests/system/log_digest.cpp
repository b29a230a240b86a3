// Reads a log of lcm-logger for the system tests.
//   log_digest messages LOG        a line a message of rimod's channels: channel, utime, section,
//                                  CRC-32 of what it says (without wall times); RIMOD_STATUS left
//                                  out
//   log_digest detections LOG NAME a line a detection, as rimod-detect prints it for scan NAME
//   log_digest early LOG NAME      the same of the final messages on RIMOD_DETECTIONS_EARLY
//   log_digest told LOG            a line an object and message there: id, look or final, status
#include <zlib.h>

#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>

#include "io/channels.h"
#include "io/event_log.h"
#include "io/message_codec.h"
#include "rimod/detections_t.hpp"
#include "rimod/early_detections_t.hpp"
#include "rimod/feature_set_t.hpp"
#include "rimod/partial_feature_set_t.hpp"
#include "rimod/partial_range_image_t.hpp"
#include "rimod/partial_scan_t.hpp"
#include "rimod/pose_hypotheses_t.hpp"
#include "rimod/range_image_t.hpp"
#include "rimod/scan_end_t.hpp"
#include "rimod/scan_t.hpp"

namespace rimod {
namespace {

template <typename Message>
Message Decode(const LogEvent& event) {
  Decoded<Message> decoded = DecodeMessage<Message>(event.bytes.data(), event.bytes.size());
  if (decoded.message) return std::move(*decoded.message);
  std::fprintf(stderr, "%s: %s\n", event.channel.c_str(), decoded.error.c_str());
  std::exit(1);
}

template <typename Message>
void PrintMessage(const LogEvent& event, const Message& message, int section, int num_sections) {
  const std::vector<std::uint8_t> bytes = EncodeMessage(message);
  const unsigned long checksum = crc32(0, bytes.data(), static_cast<uInt>(bytes.size()));
  std::printf("%s %lld %d/%d %08lx\n", event.channel.c_str(), static_cast<long long>(message.utime),
              section, num_sections, checksum);
}

// The section within names the growth or the look.
template <typename Message>
void PrintPartial(const LogEvent& event) {
  const auto& section = Decode<Message>(event).section;
  PrintMessage(event, section, section.section, section.num_sections);
}

template <typename Message>
void PrintSection(const LogEvent& event) {
  const Message message = Decode<Message>(event);
  PrintMessage(event, message, message.section, message.num_sections);
}

void PrintDigest(const LogEvent& event) {
  const Channels channels;
  if (event.channel == channels.scan) {
    PrintSection<scan_t>(event);
  } else if (event.channel == channels.range_image) {
    PrintSection<range_image_t>(event);
  } else if (event.channel == channels.features) {
    PrintSection<feature_set_t>(event);
  } else if (event.channel == channels.scan_ahead || event.channel == channels.partial_scan) {
    PrintPartial<partial_scan_t>(event);
  } else if (event.channel == channels.scan_end) {
    PrintMessage(event, Decode<scan_end_t>(event), 0, 1);
  } else if (event.channel == channels.partial_range_image) {
    PrintPartial<partial_range_image_t>(event);
  } else if (event.channel == channels.partial_features) {
    PrintPartial<partial_feature_set_t>(event);
  } else if (event.channel == channels.hypotheses) {
    PrintMessage(event, Decode<pose_hypotheses_t>(event), 0, 1);
  } else if (event.channel == channels.detections) {
    detections_t message = Decode<detections_t>(event);
    message.stage_times.clear();
    message.num_stage_times = 0;
    PrintMessage(event, message, 0, 1);
  } else if (event.channel == channels.laser || event.channel == channels.laser_to_local) {
    const unsigned long checksum =
        crc32(0, event.bytes.data(), static_cast<uInt>(event.bytes.size()));
    std::printf("%s - 0/1 %08lx\n", event.channel.c_str(), checksum);
  }
}

void PrintDetection(const detection_t& d, const std::string& name) {
  nlohmann::ordered_json line = {{"scan", name}, {"class", d.class_name}};
  line["pose"] = {d.position[0],    d.position[1],    d.position[2],   d.orientation[0],
                  d.orientation[1], d.orientation[2], d.orientation[3]};
  line["score"] = d.score;
  std::printf("%s\n", line.dump().c_str());
}

void PrintDetections(const LogEvent& event, const std::string& name) {
  if (event.channel != Channels().detections) return;
  for (const detection_t& d : Decode<detections_t>(event).detections) PrintDetection(d, name);
}

void PrintEarly(const LogEvent& event, const std::string& name) {
  if (event.channel != Channels().early_detections) return;
  const early_detections_t message = Decode<early_detections_t>(event);
  for (const early_detection_t& d : message.detections) {
    const bool withdrawn = d.status == early_detection_t::STATUS_WITHDRAWN;
    if (message.is_final && !withdrawn) PrintDetection(d.detection, name);
  }
}

void PrintTold(const LogEvent& event) {
  if (event.channel != Channels().early_detections) return;
  const early_detections_t message = Decode<early_detections_t>(event);
  for (const early_detection_t& d : message.detections) {
    std::printf("%lld %s %d\n", static_cast<long long>(d.id), message.is_final ? "final" : "look",
                static_cast<int>(d.status));
  }
}

}  // namespace
}  // namespace rimod

int main(int argc, char** argv) {
  const bool messages = argc == 3 && std::strcmp(argv[1], "messages") == 0;
  const bool detections = argc == 4 && std::strcmp(argv[1], "detections") == 0;
  const bool early = argc == 4 && std::strcmp(argv[1], "early") == 0;
  const bool told = argc == 3 && std::strcmp(argv[1], "told") == 0;
  if (!messages && !detections && !early && !told) return 2;
  rimod::EventLogReader log(argv[2]);
  while (const std::optional<rimod::LogEvent> event = log.Next()) {
    if (messages) {
      rimod::PrintDigest(*event);
    } else if (detections) {
      rimod::PrintDetections(*event, argv[3]);
    } else if (early) {
      rimod::PrintEarly(*event, argv[3]);
    } else {
      rimod::PrintTold(*event);
    }
  }
}

#include "io/section_header.h"

#include "io/message_codec.h"

namespace rimod {

scan_t HeaderOf(const scan_t& section) {
  scan_t header = {};
  header.utime = section.utime;
  header.utime_end = section.utime_end;
  header.num_sections = section.num_sections;
  header.num_lines = section.num_lines;
  header.num_missing_lines = section.num_missing_lines;
  for (int i = 0; i < 3; ++i) header.sensor_position[i] = section.sensor_position[i];
  for (int i = 0; i < 4; ++i) header.sensor_orientation[i] = section.sensor_orientation[i];
  return header;
}

range_image_t HeaderOf(const range_image_t& section) {
  range_image_t header = {};
  header.utime = section.utime;
  header.num_sections = section.num_sections;
  for (int i = 0; i < 3; ++i) header.sensor_position[i] = section.sensor_position[i];
  for (int i = 0; i < 4; ++i) header.sensor_orientation[i] = section.sensor_orientation[i];
  header.width = section.width;
  header.height = section.height;
  header.resolution = section.resolution;
  header.azimuth_left = section.azimuth_left;
  header.elevation_top = section.elevation_top;
  header.range_unit = section.range_unit;
  header.projection = section.projection;
  header.axis_azimuth = section.axis_azimuth;
  header.axis_elevation = section.axis_elevation;
  return header;
}

feature_set_t HeaderOf(const feature_set_t& section) {
  feature_set_t header = {};
  header.utime = section.utime;
  header.num_sections = section.num_sections;
  header.descriptor = section.descriptor;
  header.descriptor_size = section.descriptor_size;
  header.descriptor_unit = section.descriptor_unit;
  return header;
}

object_model_t HeaderOf(const object_model_t& section) {
  object_model_t header = {};
  header.utime = section.utime;
  header.num_sections = section.num_sections;
  header.name = section.name;
  header.source = section.source;
  for (int i = 0; i < 3; ++i) header.box_min[i] = section.box_min[i];
  for (int i = 0; i < 3; ++i) header.box_max[i] = section.box_max[i];
  header.point_spacing = section.point_spacing;
  header.descriptor = section.descriptor;
  header.descriptor_size = section.descriptor_size;
  header.descriptor_unit = section.descriptor_unit;
  return header;
}

shard_candidates_t HeaderOf(const shard_candidates_t& section) {
  shard_candidates_t header = {};
  header.utime = section.utime;
  header.num_sections = section.num_sections;
  header.shard = section.shard;
  header.scan = section.scan;
  header.num_pixels = section.num_pixels;
  for (int i = 0; i < 3; ++i) header.sensor_position[i] = section.sensor_position[i];
  for (int i = 0; i < 4; ++i) header.sensor_orientation[i] = section.sensor_orientation[i];
  header.num_found = section.num_found;
  return header;
}

// Encoded headers are compared: that tells every bit, also of values that are not numbers.

bool SameHeader(const scan_t& a, const scan_t& b) {
  return EncodeMessage(HeaderOf(a)) == EncodeMessage(HeaderOf(b));
}

bool SameHeader(const range_image_t& a, const range_image_t& b) {
  return EncodeMessage(HeaderOf(a)) == EncodeMessage(HeaderOf(b));
}

bool SameHeader(const feature_set_t& a, const feature_set_t& b) {
  return EncodeMessage(HeaderOf(a)) == EncodeMessage(HeaderOf(b));
}

bool SameHeader(const object_model_t& a, const object_model_t& b) {
  return EncodeMessage(HeaderOf(a)) == EncodeMessage(HeaderOf(b));
}

bool SameHeader(const shard_candidates_t& a, const shard_candidates_t& b) {
  return EncodeMessage(HeaderOf(a)) == EncodeMessage(HeaderOf(b));
}

}  // namespace rimod

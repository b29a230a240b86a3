#include "io/range_image_messages.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "io/message_codec.h"
#include "io/pose_messages.h"
#include "io/section_header.h"

namespace rimod {
namespace {

constexpr int kHeaderBytes = 300;  // fixed fields, generously
constexpr int kBytesPerPixel = 4;
static_assert(kHeaderBytes + kMaxRangeImageWidth * kBytesPerPixel <= kMaxMessageBytes,
              "a row fits into a message");

constexpr double kFinestResolution = 1e-5;  // positions in coarser images are small numbers
constexpr double kWidestTangent = 4.0;      // of a pinhole image's edges: a bit above 75 degrees'

constexpr std::uint16_t kNeverObserved = 0;
constexpr std::uint16_t kNoReturn = 65535;
static_assert(PixelRounding::kMaxRangeSteps < kNoReturn, "ranges and marks are told apart");
static_assert(PixelRounding::kOffsetSteps == 256, "as the message type states");

void AppendPixel(const RangeImage& image, int row, int column, range_image_t* section) {
  const RoundedPixel rounded = image.rounded(row, column);
  const Pixel kind = image.pixel(row, column);
  const std::uint16_t range = kind == Pixel::kMeasured   ? rounded.range
                              : kind == Pixel::kNoReturn ? kNoReturn
                                                         : kNeverObserved;
  section->range.push_back(static_cast<std::int16_t>(range));
  const bool measured = kind == Pixel::kMeasured;
  section->offset_azimuth.push_back(measured ? static_cast<std::uint8_t>(rounded.offset_left)
                                             : std::uint8_t{0});
  section->offset_elevation.push_back(measured ? static_cast<std::uint8_t>(rounded.offset_up)
                                               : std::uint8_t{0});
}

// Empty when the projection is one that we know and fits its axis.
std::string CheckProjection(const range_image_t& header) {
  const double azimuth = header.axis_azimuth, elevation = header.axis_elevation;
  switch (header.projection) {
    case range_image_t::SPHERICAL:
      if (!(azimuth == 0.0 && elevation == 0.0)) return "spherical image with an axis";
      return "";
    case range_image_t::PINHOLE:
      if (!(std::abs(azimuth) <= 2.0 * M_PI && std::abs(elevation) <= 0.5001 * M_PI))
        return "absurd axis";
      return "";
    default:
      return "unknown projection";
  }
}

// Empty when the image is not larger than its projection can be.
std::string CheckExtent(const range_image_t& header) {
  constexpr double kTurn = 2.0 * M_PI;
  const bool pinhole = header.projection == range_image_t::PINHOLE;
  const double widest = pinhole ? 2.0 * kWidestTangent : kTurn;
  const double highest = pinhole ? 2.0 * kWidestTangent : M_PI;
  // An image may overlap a full turn by the pixels at its ends.
  if (static_cast<double>(header.width - 2) * header.resolution > widest ||
      static_cast<double>(header.height - 2) * header.resolution > highest) {
    return pinhole ? "image is wider than a pinhole's" : "image is wider than a sphere";
  }
  if (!(std::abs(header.azimuth_left) <= 2.0 * kTurn && std::abs(header.elevation_top) <= kTurn)) {
    return "absurd image edges";
  }
  const double right = header.azimuth_left - header.width * header.resolution;
  const double bottom = header.elevation_top - header.height * header.resolution;
  for (const double edge : {header.azimuth_left, right, header.elevation_top, bottom})
    if (pinhole && std::abs(edge) > kWidestTangent) return "image is wider than a pinhole's";
  return "";
}

// Empty when header fields describe an image that we take.
std::string CheckHeader(const range_image_t& header) {
  const auto width = static_cast<std::int64_t>(header.width);
  const auto height = static_cast<std::int64_t>(header.height);
  if (width < 0 || height < 0 || width > kMaxRangeImageWidth ||
      width * height > kMaxRangeImagePixels || (width == 0) != (height == 0)) {
    return "absurd image size";
  }
  if (!(header.resolution >= kFinestResolution && header.resolution < 1.0))
    return "absurd resolution";
  std::string error = CheckExtent(header);
  if (!error.empty()) return error;
  if (header.range_unit != PixelRounding::kRangeUnit) return "ranges in another unit than ours";
  return "";
}

// Empty when the section is the index-th of total and its rows follow those before it.
std::string CheckSection(const range_image_t& section, const range_image_t& first,
                         std::size_t index, std::size_t total, std::int64_t next_row) {
  if (section.section != static_cast<std::int32_t>(index) ||
      section.num_sections != static_cast<std::int32_t>(total)) {
    return "sections are not in order or not complete";
  }
  if (!SameHeader(section, first)) return "sections are of different images";
  const auto num_pixels = static_cast<std::size_t>(std::max(section.num_pixels, 0));
  if (section.num_pixels < 0 || section.range.size() != num_pixels ||
      section.offset_azimuth.size() != num_pixels ||
      section.offset_elevation.size() != num_pixels) {
    return "a count does not fit its list";
  }
  if (section.num_rows < 0 || static_cast<std::int64_t>(section.num_rows) * section.width !=
                                  static_cast<std::int64_t>(section.num_pixels)) {
    return "pixels are not whole rows";
  }
  if (section.first_row != next_row) return "rows are missing or there twice";
  return "";
}

void SetPixels(const range_image_t& section, RangeImage* image) {
  std::size_t i = 0;
  for (int row = section.first_row; row < section.first_row + section.num_rows; ++row) {
    for (int column = 0; column < section.width; ++column, ++i) {
      const auto range = static_cast<std::uint16_t>(section.range[i]);
      if (range == kNeverObserved) continue;
      if (range == kNoReturn) {
        image->SetNoReturn(row, column);
      } else {
        image->SetMeasured(row, column,
                           {range, static_cast<std::int8_t>(section.offset_azimuth[i]),
                            static_cast<std::int8_t>(section.offset_elevation[i])});
      }
    }
  }
}

}  // namespace

std::vector<range_image_t> ToSections(const RangeImage& image, std::int64_t utime) {
  if (image.width() > kMaxRangeImageWidth) {
    throw std::invalid_argument("range image is " + std::to_string(image.width()) +
                                " pixels wide, a message takes " +
                                std::to_string(kMaxRangeImageWidth));
  }
  const int row_bytes = std::max(1, image.width() * kBytesPerPixel);
  const int rows_per_section = std::max(1, (kSectionBytes - kHeaderBytes) / row_bytes);
  const int num_sections = std::max(1, (image.height() + rows_per_section - 1) / rows_per_section);

  range_image_t header = {};
  header.utime = utime;
  header.num_sections = num_sections;
  SetPosition(image.T_local_sensor().translation(), header.sensor_position);
  SetOrientation(LevelQuaternionOf(image.T_local_sensor()), header.sensor_orientation);
  header.width = image.width();
  header.height = image.height();
  header.resolution = image.grid().resolution;
  header.azimuth_left = image.grid().left;
  header.elevation_top = image.grid().top;
  header.range_unit = PixelRounding::kRangeUnit;
  header.projection = range_image_t::SPHERICAL;
  if (image.grid().projection == Projection::kPinhole) header.projection = range_image_t::PINHOLE;
  header.axis_azimuth = image.grid().axis.azimuth;
  header.axis_elevation = image.grid().axis.elevation;

  std::vector<range_image_t> sections(static_cast<std::size_t>(num_sections), header);
  for (int i = 0; i < num_sections; ++i) {
    range_image_t& section = sections[static_cast<std::size_t>(i)];
    section.section = i;
    section.first_row = i * rows_per_section;
    section.num_rows = std::min(rows_per_section, image.height() - section.first_row);
    section.num_pixels = section.num_rows * image.width();
    for (int row = section.first_row; row < section.first_row + section.num_rows; ++row) {
      for (int column = 0; column < image.width(); ++column) {
        AppendPixel(image, row, column, &section);
      }
    }
  }
  return sections;
}

JoinedRangeImage JoinRangeImageSections(const std::vector<range_image_t>& sections) {
  if (sections.empty()) return {std::nullopt, "no sections"};
  const range_image_t& first = sections.front();
  const std::optional<Eigen::Isometry3d> T_local_sensor =
      LevelPoseFrom(first.sensor_position, first.sensor_orientation);
  if (!T_local_sensor) return {std::nullopt, "sensor pose is not a pose"};
  std::string error = CheckProjection(first);
  const bool is_empty = first.width == 0 && first.height == 0;
  if (error.empty() && !is_empty) error = CheckHeader(first);
  std::int64_t num_rows = 0;
  for (std::size_t i = 0; i < sections.size() && error.empty(); ++i) {
    error = CheckSection(sections[i], first, i, sections.size(), num_rows);
    num_rows += sections[i].num_rows;
  }
  if (error.empty() && num_rows != first.height) error = "rows are missing or there twice";
  if (!error.empty()) return {std::nullopt, std::move(error)};

  PixelGrid grid;
  grid.width = first.width;
  grid.height = first.height;
  grid.resolution = first.resolution;
  grid.left = first.azimuth_left;
  grid.top = first.elevation_top;
  if (first.projection == range_image_t::PINHOLE) grid.projection = Projection::kPinhole;
  grid.axis = {first.axis_azimuth, first.axis_elevation};
  try {
    RangeImage image(grid, *T_local_sensor);
    for (const range_image_t& section : sections) SetPixels(section, &image);
    return {std::move(image), ""};
  } catch (const std::invalid_argument&) {
    return {std::nullopt, "absurd image grid"};
  }
}

}  // namespace rimod

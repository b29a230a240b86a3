#include "io/shard_messages.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <set>

#include "io/config.h"
#include "io/feature_messages.h"
#include "io/message_codec.h"
#include "io/pose_messages.h"
#include "io/range_image_messages.h"
#include "io/section_header.h"

namespace rimod {
namespace {

constexpr std::size_t kMaxShardName = 200;
constexpr std::size_t kMaxModels = 10'000;
constexpr std::size_t kMaxCandidates = 20'000;
constexpr std::size_t kMaxStageTimes = 200;
constexpr std::size_t kMaxStageName = 64;
constexpr int kMaxPixels = 16'000'000;              // as range images
constexpr std::int64_t kMaxExplained = 50'000'000;  // pixels of all candidates of an answer
constexpr int kMaxFound = 10'000'000;
constexpr double kFarthest = 1000.0;        // m, boxes: as object models
constexpr double kMaxRotationError = 0.01;  // of the axes' products: rounding, not another thing

constexpr int kRunBytes = 8;

// FNV-1a.
class Digest {
 public:
  void Add(const std::vector<std::uint8_t>& bytes) {
    for (const std::uint8_t byte : bytes) Add(byte);
  }
  void Add(const std::string& text) {
    for (const char c : text) Add(static_cast<std::uint8_t>(c));
  }
  std::int64_t value() const {
    std::int64_t value = 0;
    std::memcpy(&value, &hash_, sizeof value);
    return value;
  }

 private:
  void Add(std::uint8_t byte) { hash_ = (hash_ ^ byte) * 1099511628211u; }
  std::uint64_t hash_ = 14695981039346656037u;
};

shard_candidate_t ToMessage(const ExplainingCandidate& item) {
  shard_candidate_t message = {};
  const Candidate& candidate = item.candidate;
  message.model = candidate.model;
  const Eigen::Matrix3d R = candidate.T_sensor_object.linear();
  for (int i = 0; i < 9; ++i) message.rotation[i] = R(i / 3, i % 3);
  SetPosition(candidate.T_sensor_object.translation(), message.position);
  message.score = candidate.score;
  message.rank_score = item.rank_score;
  message.num_runs = static_cast<std::int32_t>(item.explained.size());
  return message;
}

// Fills sections one after the other.
class SectionFiller {
 public:
  explicit SectionFiller(const shard_candidates_t& header) : header_(header) { Begin(); }

  // The section that takes so many bytes more.
  shard_candidates_t& WithRoomFor(int bytes) {
    if (used_ + bytes > kSectionBytes) Begin();
    used_ += bytes;
    return sections_.back();
  }

  std::vector<shard_candidates_t> Finish() {
    for (std::size_t i = 0; i < sections_.size(); ++i) {
      shard_candidates_t& section = sections_[i];
      section.section = static_cast<std::int32_t>(i);
      section.num_sections = static_cast<std::int32_t>(sections_.size());
      section.num_models = static_cast<std::int32_t>(section.models.size());
      section.num_candidates = static_cast<std::int32_t>(section.candidates.size());
      section.num_runs = static_cast<std::int32_t>(section.run_first.size());
      section.num_stage_times = static_cast<std::int32_t>(section.stage_times.size());
    }
    return std::move(sections_);
  }

 private:
  void Begin() {
    sections_.push_back(header_);
    used_ = header_.getEncodedSize();
  }

  shard_candidates_t header_;
  std::vector<shard_candidates_t> sections_;
  int used_ = 0;
};

shard_candidates_t HeaderFor(const ShardAnswer& answer) {
  shard_candidates_t header = {};
  header.utime = answer.utime;
  header.shard = ToMessage(answer.shard, answer.utime);
  header.scan = answer.scan;
  header.num_pixels = answer.judged.num_pixels;
  SetPosition(answer.judged.T_local_sensor.translation(), header.sensor_position);
  SetOrientation(LevelQuaternionOf(answer.judged.T_local_sensor), header.sensor_orientation);
  header.num_found = std::min(answer.judged.num_found, kMaxFound);
  return header;
}

std::string CheckSection(const shard_candidates_t& section, const shard_candidates_t& first,
                         std::size_t index, std::size_t total) {
  if (section.section != static_cast<std::int32_t>(index) ||
      section.num_sections != static_cast<std::int32_t>(total)) {
    return "sections are not in order or not complete";
  }
  if (!SameHeader(section, first)) return "sections are of different answers";
  const auto fits = [](std::int32_t count, std::size_t size) {
    return count >= 0 && static_cast<std::size_t>(count) == size;
  };
  if (!fits(section.num_models, section.models.size()) ||
      !fits(section.num_candidates, section.candidates.size()) ||
      !fits(section.num_runs, section.run_first.size()) ||
      !fits(section.num_runs, section.run_length.size()) ||
      !fits(section.num_stage_times, section.stage_times.size())) {
    return "a count does not fit its list";
  }
  return "";
}

// All sections' lists in one; only the first's header.
shard_candidates_t Concatenated(const std::vector<shard_candidates_t>& sections) {
  shard_candidates_t all = HeaderOf(sections.front());
  const auto append = [](const auto& from, auto* to) {
    to->insert(to->end(), from.begin(), from.end());
  };
  for (const shard_candidates_t& section : sections) {
    append(section.models, &all.models);
    append(section.candidates, &all.candidates);
    append(section.run_first, &all.run_first);
    append(section.run_length, &all.run_length);
    append(section.stage_times, &all.stage_times);
  }
  return all;
}

std::string ReadModels(const shard_candidates_t& all, std::vector<CandidateModel>* models) {
  if (all.models.size() > kMaxModels ||
      all.models.size() != static_cast<std::size_t>(std::max(all.shard.num_models, 0))) {
    return "its number of models is wrong";
  }
  std::set<std::string> names;
  for (const shard_model_t& item : all.models) {
    const CandidateModel model{item.name, Eigen::Vector3d(item.box_min),
                               Eigen::Vector3d(item.box_max)};
    if (!IsValidModelName(model.name)) return "a class name is not valid";
    if (!names.insert(model.name).second) return "a class name comes twice";
    const bool is_box = model.box_min.allFinite() && model.box_max.allFinite() &&
                        (model.box_min.array() <= model.box_max.array()).all() &&
                        model.box_min.cwiseAbs().maxCoeff() <= kFarthest &&
                        model.box_max.cwiseAbs().maxCoeff() <= kFarthest;
    if (!is_box) return "a box is not a box";
    models->push_back(model);
  }
  return "";
}

// Nothing when it is no pose.
std::optional<Eigen::Isometry3d> ExactPoseFrom(const shard_candidate_t& item) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 9; ++i) T.linear()(i / 3, i % 3) = item.rotation[i];
  T.translation() = Eigen::Vector3d(item.position);
  const Eigen::Matrix3d R = T.linear();
  if (!T.matrix().allFinite()) return std::nullopt;
  const Eigen::Matrix3d error = R * R.transpose() - Eigen::Matrix3d::Identity();
  if (!(error.cwiseAbs().maxCoeff() <= kMaxRotationError) || R.determinant() < 0.0)
    return std::nullopt;
  return T;
}

// The runs [begin, begin + count) of the list; false when they overlap or leave the image.
bool ReadRuns(const shard_candidates_t& all, std::size_t begin, std::size_t count,
              std::vector<PixelRun>* runs) {
  std::int64_t end = 0;
  for (std::size_t i = begin; i < begin + count; ++i) {
    const std::int64_t first = all.run_first[i], length = all.run_length[i];
    if (first < end || length < 1 || first + length > all.num_pixels) return false;
    end = first + length;
    runs->push_back({static_cast<int>(first), static_cast<int>(length)});
  }
  return true;
}

std::string ReadCandidates(const shard_candidates_t& all, JudgedScan* judged) {
  std::size_t next_run = 0;
  std::int64_t num_explained = 0;
  for (const shard_candidate_t& item : all.candidates) {
    const std::optional<Eigen::Isometry3d> pose = ExactPoseFrom(item);
    if (!pose) return "a pose is not a pose";
    if (item.model < 0 || item.model >= all.shard.num_models) return "a model is not in the list";
    if (!(item.score >= 0.0 && item.score <= 1.0)) return "a score is not within 0 .. 1";
    if (!std::isfinite(item.rank_score)) return "a rank score is not finite";
    if (item.num_runs < 0 ||
        static_cast<std::size_t>(item.num_runs) > all.run_first.size() - next_run) {
      return "a count does not fit its list";
    }
    ExplainingCandidate candidate{{item.model, *pose, item.score}, item.rank_score, {}};
    const auto num_runs = static_cast<std::size_t>(item.num_runs);
    if (!ReadRuns(all, next_run, num_runs, &candidate.explained))
      return "runs of pixels overlap or leave the image";
    next_run += num_runs;
    for (const PixelRun& run : candidate.explained) num_explained += run.count;
    if (num_explained > kMaxExplained) return "absurdly many pixels are explained";
    judged->candidates.push_back(std::move(candidate));
  }
  return next_run == all.run_first.size() ? "" : "a count does not fit its list";
}

}  // namespace

std::int64_t DigestOf(const DescribedScan& scan) {
  Digest digest;
  for (const range_image_t& section : ToSections(scan.image, scan.utime))
    digest.Add(EncodeMessage(section));
  for (const feature_set_t& section : ToSections(scan.features, scan.utime))
    digest.Add(EncodeMessage(section));
  return digest.value();
}

std::int64_t DigestOf(const PipelineParams& params) {
  Configuration configuration;
  configuration.pipeline = params;
  Digest digest;
  digest.Add(DumpConfiguration(configuration));
  return digest.value();
}

shard_t ToMessage(const Shard& shard, std::int64_t utime) {
  shard_t message = {};
  message.utime = utime;
  message.name = shard.name;
  message.index = shard.index;
  message.count = shard.count;
  message.instance = shard.instance;
  message.params = shard.params;
  message.num_models = shard.num_models;
  return message;
}

ShardFromMessage FromMessage(const shard_t& message) {
  const std::string& name = message.name;
  const bool is_printable = std::all_of(name.begin(), name.end(), [](char c) {
    return std::isgraph(static_cast<unsigned char>(c)) != 0;
  });
  if (name.empty() || name.size() > kMaxShardName || !is_printable)
    return {std::nullopt, "a shard's name is not valid"};
  const bool by_name = message.index == 0 && message.count == 0;
  const bool by_number =
      message.index >= 1 && message.index <= message.count && message.count <= kMaxShards &&
      name == std::to_string(message.index) + "/" + std::to_string(message.count);
  if (!by_name && !by_number) return {std::nullopt, "a shard's number is not valid"};
  if (message.num_models < 0) return {std::nullopt, "a count is negative"};
  return {Shard{name, message.index, message.count, message.instance, message.params,
                message.num_models},
          ""};
}

std::vector<shard_candidates_t> ToSections(const ShardAnswer& answer) {
  SectionFiller filler(HeaderFor(answer));
  for (const auto& [stage, ms] : answer.stage_times) {
    stage_time_t item = {};
    item.stage = stage.substr(0, kMaxStageName);
    item.ms = ms;
    filler.WithRoomFor(item.getEncodedSize()).stage_times.push_back(item);
  }
  for (const CandidateModel& model : answer.judged.models) {
    shard_model_t item = {};
    item.name = model.name;
    SetPosition(model.box_min, item.box_min);
    SetPosition(model.box_max, item.box_max);
    filler.WithRoomFor(item.getEncodedSize()).models.push_back(item);
  }
  for (const ExplainingCandidate& candidate : answer.judged.candidates) {
    const shard_candidate_t item = ToMessage(candidate);
    filler.WithRoomFor(item.getEncodedSize()).candidates.push_back(item);
  }
  for (const ExplainingCandidate& candidate : answer.judged.candidates) {
    for (const PixelRun& run : candidate.explained) {
      shard_candidates_t& section = filler.WithRoomFor(kRunBytes);
      section.run_first.push_back(run.first);
      section.run_length.push_back(run.count);
    }
  }
  return filler.Finish();
}

JoinedShardAnswer JoinShardSections(const std::vector<shard_candidates_t>& sections) {
  if (sections.empty()) return {std::nullopt, "no sections"};
  for (std::size_t i = 0; i < sections.size(); ++i) {
    std::string error = CheckSection(sections[i], sections.front(), i, sections.size());
    if (!error.empty()) return {std::nullopt, std::move(error)};
  }
  const shard_candidates_t all = Concatenated(sections);
  ShardFromMessage shard = FromMessage(all.shard);
  if (!shard.shard) return {std::nullopt, std::move(shard.error)};
  const std::optional<Eigen::Isometry3d> T_local_sensor =
      LevelPoseFrom(all.sensor_position, all.sensor_orientation);
  if (!T_local_sensor) return {std::nullopt, "sensor pose is not a pose"};
  if (all.num_pixels < 0 || all.num_pixels > kMaxPixels || all.num_found < 0 ||
      all.num_found > kMaxFound || all.stage_times.size() > kMaxStageTimes ||
      all.candidates.size() > kMaxCandidates) {
    return {std::nullopt, "a count is absurd"};
  }
  ShardAnswer answer;
  answer.utime = all.utime;
  answer.scan = all.scan;
  answer.shard = std::move(*shard.shard);
  answer.judged.num_pixels = all.num_pixels;
  answer.judged.T_local_sensor = *T_local_sensor;
  answer.judged.num_found = all.num_found;
  for (const stage_time_t& item : all.stage_times) {
    if (item.stage.size() > kMaxStageName) return {std::nullopt, "a stage's name is too long"};
    answer.stage_times.emplace_back(item.stage, item.ms);
  }
  std::string error = ReadModels(all, &answer.judged.models);
  if (error.empty()) error = ReadCandidates(all, &answer.judged);
  if (!error.empty()) return {std::nullopt, std::move(error)};
  return {std::move(answer), ""};
}

}  // namespace rimod

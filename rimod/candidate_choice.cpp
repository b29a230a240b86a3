#include "rimod/candidate_choice.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

namespace rimod {
namespace {

// Indices of the candidates, best first. A model's own candidates keep their order where all else
// is equal, so that it does not matter between which others they stand.
std::vector<int> BestFirst(const JudgedScan& judged) {
  const auto key = [&](int i) {
    const ExplainingCandidate& c = judged.candidates[i];
    const std::string& name = judged.models[c.candidate.model].name;
    return std::make_tuple(-c.candidate.score, -c.rank_score, std::cref(name));
  };
  std::vector<int> order(judged.candidates.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
  return order;
}

// The pixels of an image that are explained already.
class ExplainedPixels {
 public:
  explicit ExplainedPixels(int num_pixels) : explained_(static_cast<std::size_t>(num_pixels), 0) {}

  void Add(const std::vector<PixelRun>& runs) {
    for (const PixelRun& run : runs)
      std::fill_n(explained_.begin() + run.first, run.count, static_cast<char>(1));
  }

  // The share of these; 1 of none.
  double ShareOf(const std::vector<PixelRun>& runs) const {
    std::ptrdiff_t known = 0, all = 0;
    for (const PixelRun& run : runs) {
      const auto begin = explained_.begin() + run.first;
      known += std::count(begin, begin + run.count, static_cast<char>(1));
      all += run.count;
    }
    return all == 0 ? 1.0 : static_cast<double>(known) / static_cast<double>(all);
  }

 private:
  std::vector<char> explained_;
};

bool TooNear(const Candidate& better, const Candidate& candidate,
             const std::vector<CandidateModel>& models, const ChoiceParams& params) {
  const CandidateModel& a = models[better.model];
  const CandidateModel& b = models[candidate.model];
  const double share =
      better.model == candidate.model ? params.same_class_distance : params.other_class_distance;
  const Eigen::Vector3d apart =
      better.T_sensor_object * a.Centre() - candidate.T_sensor_object * b.Centre();
  return apart.norm() < share * std::min(a.Diameter(), b.Diameter());
}

bool SamePose(const Candidate& a, const Candidate& b) {
  return a.model == b.model && a.T_sensor_object.matrix() == b.T_sensor_object.matrix();
}

bool Contains(const CandidateList& list, const Candidate& candidate) {
  return std::any_of(list.begin(), list.end(),
                     [&](const Candidate& other) { return SamePose(candidate, other); });
}

std::vector<PoseHypothesis> ReportedHypotheses(const StagedCandidates& found,
                                               const std::vector<CandidateModel>& models,
                                               const Eigen::Isometry3d& T_local_sensor,
                                               int max_reported) {
  const std::pair<HypothesisStage, const CandidateList*> stages[] = {
      {HypothesisStage::kValidated, &found.validated},
      {HypothesisStage::kNoCollision, &found.collision_free},
      {HypothesisStage::kPruned, &found.pruned},
      {HypothesisStage::kScored, &found.scored}};
  CandidateList reported;
  std::vector<PoseHypothesis> hypotheses;
  for (const auto& [stage, candidates] : stages) {
    for (const Candidate& candidate : *candidates) {
      if (static_cast<int>(reported.size()) >= max_reported) return hypotheses;
      if (Contains(reported, candidate)) continue;
      reported.push_back(candidate);
      hypotheses.push_back({models[candidate.model].name,
                            T_local_sensor * candidate.T_sensor_object, candidate.score, stage});
    }
  }
  return hypotheses;
}

}  // namespace

std::vector<CandidateModel> CandidateModelsOf(const std::vector<ObjectModel>& models) {
  std::vector<CandidateModel> list;
  list.reserve(models.size());
  for (const ObjectModel& model : models)
    list.push_back({model.name, model.box_min, model.box_max});
  return list;
}

std::vector<PixelRun> RunsOf(const std::vector<int>& pixels) {
  std::vector<PixelRun> runs;
  for (const int pixel : pixels) {
    if (!runs.empty() && pixel == runs.back().first + runs.back().count) {
      ++runs.back().count;
    } else {
      runs.push_back({pixel, 1});
    }
  }
  return runs;
}

JudgedScan Joined(const std::vector<JudgedScan>& parts) {
  JudgedScan joined;
  if (parts.empty()) return joined;
  joined.T_local_sensor = parts.front().T_local_sensor;
  std::set<std::string> names;
  for (const JudgedScan& part : parts) {
    joined.num_pixels = std::max(joined.num_pixels, part.num_pixels);
    const std::size_t num_before = joined.models.size();
    std::vector<int> place(part.models.size(), -1);  // in the joined list
    for (std::size_t m = 0; m < place.size(); ++m) {
      if (!names.insert(part.models[m].name).second) continue;
      place[m] = static_cast<int>(joined.models.size());
      joined.models.push_back(part.models[m]);
    }
    if (part.models.empty() || joined.models.size() > num_before)
      joined.num_found += part.num_found;
    for (const ExplainingCandidate& item : part.candidates) {
      const int model = place[item.candidate.model];
      if (model < 0) continue;
      joined.candidates.push_back(item);
      joined.candidates.back().candidate.model = model;
    }
  }
  return joined;
}

JudgedScan WorthJoining(JudgedScan judged, const PipelineParams& params) {
  std::vector<char> is_worth(judged.candidates.size(), 0);
  CandidateList listed;
  for (const int i : BestFirst(judged)) {
    ExplainingCandidate& item = judged.candidates[i];
    const bool is_probable = item.candidate.score >= params.choice.min_probability;
    const bool can_be_listed = static_cast<int>(listed.size()) < params.max_reported_hypotheses &&
                               !Contains(listed, item.candidate);
    if (can_be_listed) listed.push_back(item.candidate);
    is_worth[i] = is_probable || can_be_listed ? 1 : 0;
    if (!is_probable) item.explained.clear();
  }
  std::vector<ExplainingCandidate> worth;
  for (std::size_t i = 0; i < is_worth.size(); ++i)
    if (is_worth[i] != 0) worth.push_back(std::move(judged.candidates[i]));
  judged.candidates = std::move(worth);
  return judged;
}

StagedCandidates ChooseCandidates(const JudgedScan& judged, const ChoiceParams& params) {
  StagedCandidates found;
  found.num_found = judged.num_found;
  ExplainedPixels explained(judged.num_pixels);
  for (const int i : BestFirst(judged)) {
    const auto& [candidate, rank_score, pixels] = judged.candidates[i];
    found.scored.push_back(candidate);
    if (!(candidate.score >= params.min_probability)) continue;
    if (explained.ShareOf(pixels) > params.max_explained_share) continue;
    CandidateList& chosen = found.validated;
    const bool too_near = std::any_of(chosen.begin(), chosen.end(), [&](const Candidate& better) {
      return TooNear(better, judged.candidates[i].candidate, judged.models, params);
    });
    if (too_near) continue;
    explained.Add(pixels);
    chosen.push_back(candidate);
  }
  return found;
}

DetectionResult ToResult(const StagedCandidates& found, const std::vector<CandidateModel>& models,
                         const Eigen::Isometry3d& T_local_sensor, int max_reported) {
  DetectionResult result;
  result.num_hypotheses_found = found.num_found;
  for (const Candidate& candidate : found.validated) {
    const CandidateModel& model = models[candidate.model];
    result.detections.push_back({model.name, T_local_sensor * candidate.T_sensor_object,
                                 model.box_min, model.box_max, candidate.score});
  }
  result.hypotheses = ReportedHypotheses(found, models, T_local_sensor, max_reported);
  return result;
}

DetectionResult ChooseDetections(const JudgedScan& judged, const PipelineParams& params) {
  return ToResult(ChooseCandidates(judged, params.choice), judged.models, judged.T_local_sensor,
                  params.max_reported_hypotheses);
}

}  // namespace rimod

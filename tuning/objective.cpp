#include "tuning/objective.h"

#include "io/numbers.h"

namespace rimod {
namespace {

double Ratio(double part, double whole, double otherwise) {
  return whole > 0.0 ? part / whole : otherwise;
}

double FScore(double right, double false_alarms, double missed, double beta) {
  const double b = beta * beta;
  return Ratio((1.0 + b) * right, (1.0 + b) * right + b * missed + false_alarms, 0.0);
}

// Infinite in the paper when all is found without a false alarm; here twice what one alarm leaves.
double Zeta(double right, double false_alarms, double missed) {
  constexpr double kPerfectLoss = 0.5;
  const double loss = missed * missed + false_alarms;
  return right * right / (loss > 0.0 ? loss : kPerfectLoss);
}

std::optional<double> NumberWithin(const std::string& text, double low, double high) {
  const std::optional<double> number = ParseNumber(text);
  return number && *number >= low && *number <= high ? number : std::nullopt;
}

bool StartsWith(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

}  // namespace

ScanCounts& ScanCounts::operator+=(const ScanCounts& other) {
  scans += other.scans;
  right += other.right;
  posed += other.posed;
  false_alarms += other.false_alarms;
  missed += other.missed;
  ms += other.ms;
  return *this;
}

double ScanCounts::Recall() const { return Ratio(right, right + missed, 0.0); }

double ScanCounts::Precision() const { return Ratio(right, right + false_alarms, 1.0); }

double Objective::Score(const ScanCounts& counts) const {
  const double mean_ms = Ratio(counts.ms, counts.scans, 0.0);
  if (max_ms > 0.0 && mean_ms > max_ms) return -1.0 - mean_ms / max_ms;
  switch (kind) {
    case Kind::kPosedF: {
      const int off = counts.right - counts.posed;
      return FScore(counts.posed, counts.false_alarms + off, counts.missed + off, beta);
    }
    case Kind::kZeta:
      return Zeta(counts.right, counts.false_alarms, counts.missed);
    case Kind::kRecallAt: {
      const double lack = min_precision - counts.Precision();
      return lack > 0.0 ? -lack : counts.Recall();
    }
    case Kind::kF:
      break;
  }
  return FScore(counts.right, counts.false_alarms, counts.missed, beta);
}

std::optional<Objective> ObjectiveFrom(const std::string& name) {
  constexpr double kMinBeta = 0.01, kMaxBeta = 100.0;
  Objective objective;
  if (name == "zeta") {
    objective.kind = Objective::Kind::kZeta;
    return objective;
  }
  if (StartsWith(name, "recall@")) {
    const std::optional<double> precision = NumberWithin(name.substr(7), 0.0, 1.0);
    if (!precision) return std::nullopt;
    objective.kind = Objective::Kind::kRecallAt;
    objective.min_precision = *precision;
    return objective;
  }
  const bool posed = StartsWith(name, "pose-f");
  if (!posed && !StartsWith(name, "f")) return std::nullopt;
  const std::optional<double> beta = NumberWithin(name.substr(posed ? 6 : 1), kMinBeta, kMaxBeta);
  if (!beta) return std::nullopt;
  objective.kind = posed ? Objective::Kind::kPosedF : Objective::Kind::kF;
  objective.beta = *beta;
  return objective;
}

}  // namespace rimod

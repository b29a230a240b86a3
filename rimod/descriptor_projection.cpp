#include "rimod/descriptor_projection.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace rimod {
namespace {

Eigen::VectorXf ToVector(const Descriptor& descriptor) {
  Eigen::VectorXf vector(descriptor.size());
  for (std::size_t i = 0; i < descriptor.size(); ++i)
    vector(static_cast<Eigen::Index>(i)) = descriptor[i] == kEmptyCell ? 0.0f : descriptor[i];
  return vector;
}

// Row k: the cosine of k half periods over the cells (DCT-II, orthonormal).
Eigen::MatrixXd Cosines(int resolution) {
  Eigen::MatrixXd cosines(resolution, resolution);
  for (int k = 0; k < resolution; ++k) {
    const double scale = std::sqrt((k == 0 ? 1.0 : 2.0) / resolution);
    for (int cell = 0; cell < resolution; ++cell)
      cosines(k, cell) = scale * std::cos(M_PI * (cell + 0.5) * k / resolution);
  }
  return cosines;
}

struct Frequency {
  int row = 0, column = 0;
};

// All but the constant, low ones first.
std::vector<Frequency> Frequencies(int resolution) {
  std::vector<Frequency> frequencies;
  for (int row = 0; row < resolution; ++row)
    for (int column = 0; column < resolution; ++column)
      if (row + column > 0) frequencies.push_back({row, column});
  const auto squared = [](const Frequency& f) { return f.row * f.row + f.column * f.column; };
  std::stable_sort(frequencies.begin(), frequencies.end(),
                   [&](const Frequency& a, const Frequency& b) { return squared(a) < squared(b); });
  return frequencies;
}

}  // namespace

DescriptorProjection::DescriptorProjection(int resolution, int dimensions) {
  const Eigen::MatrixXd cosines = Cosines(resolution);
  std::vector<Frequency> frequencies = Frequencies(resolution);
  frequencies.resize(std::min(frequencies.size(), static_cast<std::size_t>(dimensions)));
  axes_.resize(static_cast<Eigen::Index>(frequencies.size()), resolution * resolution);
  for (std::size_t i = 0; i < frequencies.size(); ++i)
    for (int row = 0; row < resolution; ++row)
      for (int column = 0; column < resolution; ++column)
        axes_(static_cast<Eigen::Index>(i), row * resolution + column) = static_cast<float>(
            cosines(frequencies[i].row, row) * cosines(frequencies[i].column, column));
}

Descriptor DescriptorProjection::Project(const Descriptor& descriptor) const {
  if (static_cast<Eigen::Index>(descriptor.size()) != axes_.cols()) return {};
  const Eigen::VectorXf projected = axes_ * ToVector(descriptor);
  Descriptor result(static_cast<std::size_t>(projected.size()));
  for (Eigen::Index i = 0; i < projected.size(); ++i) {
    result[static_cast<std::size_t>(i)] =
        static_cast<std::int16_t>(std::clamp(std::round(projected(i)), -32767.0f, 32767.0f));
  }
  return result;
}

}  // namespace rimod

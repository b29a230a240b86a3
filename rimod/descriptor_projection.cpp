#include "rimod/descriptor_projection.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace rimod {
namespace {

Eigen::VectorXf ToVector(const Descriptor& descriptor) {
  Eigen::VectorXf vector(descriptor.size());
  for (std::size_t i = 0; i < descriptor.size(); ++i)
    vector(static_cast<Eigen::Index>(i)) = descriptor[i] == kEmptyCell ? 0.0f : descriptor[i];
  return vector;
}

}  // namespace

DescriptorProjection::DescriptorProjection(const std::vector<const Descriptor*>& descriptors,
                                           int dimensions) {
  if (descriptors.empty()) return;
  // Thinned: some thousand descriptors give the same axes as all.
  constexpr std::size_t kMaxSamples = 4000;
  const std::size_t step = 1 + descriptors.size() / kMaxSamples;
  const Eigen::Index size = static_cast<Eigen::Index>(descriptors.front()->size());
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t i = 0; i < descriptors.size(); i += step) {
    const Eigen::VectorXd values = ToVector(*descriptors[i]).cast<double>();
    products.selfadjointView<Eigen::Lower>().rankUpdate(values);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(products);
  const Eigen::Index kept = std::min<Eigen::Index>(dimensions, size);
  axes_.resize(kept, size);
  for (Eigen::Index i = 0; i < kept; ++i)
    axes_.row(i) = solver.eigenvectors().col(size - 1 - i).transpose().cast<float>();
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

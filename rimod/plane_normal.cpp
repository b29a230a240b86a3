#include "rimod/plane_normal.h"

#include <Eigen/Geometry>

namespace rimod {

Eigen::Vector3f PlaneNormal(const Eigen::Matrix3f& covariance) {
  const double trace = static_cast<double>(covariance.trace());
  if (!(trace > 0.0)) return Eigen::Vector3f::Zero();
  // Eigenvalues within 0 .. 1, their sum is 1.
  const Eigen::Matrix3d C = covariance.cast<double>() / trace;
  const double xx = C(0, 0), xy = C(0, 1), xz = C(0, 2), yy = C(1, 1), yz = C(1, 2), zz = C(2, 2);
  const double minors = xx * yy - xy * xy + xx * zz - xz * xz + yy * zz - yz * yz;
  const double determinant =
      xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
  // Newton's method on the characteristic polynomial, from below its smallest root: it only rises.
  constexpr int kSteps = 5;
  double smallest = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double value = ((smallest - 1.0) * smallest + minors) * smallest - determinant;
    const double slope = (3.0 * smallest - 2.0) * smallest + minors;
    if (!(slope > 0.0)) break;
    smallest -= value / slope;
  }
  // The normal is orthogonal to the rows that are left: the longest product of two of them.
  const Eigen::Vector3d x(xx - smallest, xy, xz), y(xy, yy - smallest, yz),
      z(xz, yz, zz - smallest);
  const Eigen::Vector3d products[] = {x.cross(y), y.cross(z), z.cross(x)};
  Eigen::Vector3d normal = products[0];
  for (const Eigen::Vector3d& product : products)
    if (product.squaredNorm() > normal.squaredNorm()) normal = product;
  constexpr double kLine = 1e-12;
  const double length = normal.norm();
  return length > kLine ? Eigen::Vector3f((normal / length).cast<float>())
                        : Eigen::Vector3f(Eigen::Vector3f::Zero());
}

}  // namespace rimod

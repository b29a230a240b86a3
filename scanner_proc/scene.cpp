#include "scanner_proc/scene.h"

namespace rimod::simulation {
namespace {

void ExtendByVertices(const std::vector<Eigen::Vector3d>& vertices, const Eigen::Isometry3d& T,
                      Eigen::AlignedBox3d* box) {
  for (const Eigen::Vector3d& vertex : vertices) box->extend(T * vertex);
}

// A disc about T's z-axis reaches radius * sqrt(1 - n_i^2) along axis i, n being its normal.
void ExtendByDisc(double radius, double height, const Eigen::Isometry3d& T,
                  Eigen::AlignedBox3d* box) {
  const Eigen::Vector3d centre = T * Eigen::Vector3d(0.0, 0.0, height);
  const Eigen::Array3d normal = T.linear().col(2).array();
  const Eigen::Vector3d reach =
      (radius * (1.0 - normal.square()).max(Eigen::Array3d::Zero()).sqrt()).matrix();
  box->extend(centre - reach);
  box->extend(centre + reach);
}

struct ExtendBox {
  const Eigen::Isometry3d& T;
  Eigen::AlignedBox3d* box;

  void operator()(const BoxShape& shape) const {
    ExtendByVertices(TrianglesOf(shape).vertices, T, box);
  }
  void operator()(const FrustumShape& shape) const {
    ExtendByDisc(shape.bottom_radius, 0.0, T, box);
    ExtendByDisc(shape.top_radius, shape.height, T, box);
  }
  void operator()(const SphereShape& shape) const {
    const Eigen::Vector3d centre = T * Eigen::Vector3d(0.0, 0.0, shape.radius);
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(shape.radius);
    box->extend(centre - reach);
    box->extend(centre + reach);
  }
  void operator()(const RectangleShape& shape) const {
    ExtendByVertices(TrianglesOf(shape).vertices, T, box);
  }
  void operator()(const MeshShape& shape) const { ExtendByVertices(shape.mesh->vertices, T, box); }
};

}  // namespace

Eigen::AlignedBox3d BoundingBox(const SceneObject& object) {
  Eigen::AlignedBox3d box;
  for (const Part& part : object.parts) {
    std::visit(ExtendBox{part.T_object_part, &box}, part.shape);
  }
  return box;
}

ObjectFrame ObjectFrameOf(const SceneObject& object) {
  const Eigen::AlignedBox3d box = BoundingBox(object);
  ObjectFrame frame;
  frame.T_scene_object = object.T_scene_object;
  if (box.isEmpty()) return frame;
  const Eigen::Vector3d centre = box.center();
  const Eigen::Vector3d origin(centre.x(), centre.y(), box.min().z());
  frame.T_scene_object.translate(origin);
  frame.box =
      Eigen::AlignedBox3d(Eigen::Vector3d(box.min() - origin), Eigen::Vector3d(box.max() - origin));
  return frame;
}

Mesh TrianglesOf(const BoxShape& box) {
  Mesh mesh;
  for (int corner = 0; corner < 8; ++corner) {
    mesh.vertices.emplace_back((corner & 1 ? 0.5 : -0.5) * box.size.x(),
                               (corner & 2 ? 0.5 : -0.5) * box.size.y(),
                               corner & 4 ? box.size.z() : 0.0);
  }
  constexpr int kFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& face : kFaces) {
    mesh.triangles.emplace_back(face[0], face[1], face[2]);
    mesh.triangles.emplace_back(face[0], face[2], face[3]);
  }
  return mesh;
}

Mesh TrianglesOf(const RectangleShape& rectangle) {
  const double x = 0.5 * rectangle.size.x();
  const double y = 0.5 * rectangle.size.y();
  Mesh mesh;
  mesh.vertices = {{-x, -y, 0.0}, {x, -y, 0.0}, {x, y, 0.0}, {-x, y, 0.0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

}  // namespace rimod::simulation

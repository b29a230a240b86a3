#include "scanner_proc/scene_object_reader.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include "io/mesh_file.h"
#include "rimod/object_model.h"

namespace rimod::simulation {
namespace {

constexpr Limits kCoordinate = {-10000.0, 10000.0};
constexpr Limits kSize = {1e-4, 10000.0};
constexpr Limits kRadius = {0.0, 10000.0};
constexpr Limits kAnyAngle = {-360.0, 360.0};
// Keep a hostile file from filling the memory.
constexpr std::size_t kMaxParts = 100000;
constexpr std::size_t kMaxTriangles = 20000000;

constexpr std::array<const char*, 8> kShapeKeys = {"box",       "cylinder", "cone",  "sphere",
                                                   "rectangle", "mesh",     "parts", "shape"};
constexpr std::array<const char*, 4> kSymmetries = {"none", "yaw2", "yaw4", "yaw_continuous"};

// position, yaw_deg, pitch_deg, roll_deg: turned about z last, about x first.
Eigen::Isometry3d ReadPose(YamlSection* section) {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  double yaw = 0.0, pitch = 0.0, roll = 0.0;
  section->ReadVector3("position", kCoordinate, &position);
  section->ReadDegrees("yaw_deg", kAnyAngle, &yaw);
  section->ReadDegrees("pitch_deg", kAnyAngle, &pitch);
  section->ReadDegrees("roll_deg", kAnyAngle, &roll);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = position;
  T.rotate(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
  T.rotate(Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()));
  T.rotate(Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()));
  return T;
}

BoxShape ReadBox(YamlSection section) {
  BoxShape box;
  section.Require("size");
  section.ReadVector3("size", kSize, &box.size);
  section.RejectOtherKeys();
  return box;
}

FrustumShape ReadCylinder(YamlSection section) {
  FrustumShape cylinder;
  section.Require("radius");
  section.Require("height");
  section.Read("radius", kSize, &cylinder.bottom_radius);
  section.Read("height", kSize, &cylinder.height);
  section.RejectOtherKeys();
  cylinder.top_radius = cylinder.bottom_radius;
  return cylinder;
}

FrustumShape ReadCone(YamlSection section) {
  FrustumShape cone;
  section.Require("bottom_radius");
  section.Require("top_radius");
  section.Require("height");
  section.Read("bottom_radius", kRadius, &cone.bottom_radius);
  section.Read("top_radius", kRadius, &cone.top_radius);
  section.Read("height", kSize, &cone.height);
  section.RejectOtherKeys();
  if (std::max(cone.bottom_radius, cone.top_radius) < kSize.least) {
    section.Fail("bottom_radius", "one of the radii must be above 0");
  }
  return cone;
}

SphereShape ReadSphere(YamlSection section) {
  SphereShape sphere;
  section.Require("radius");
  section.Read("radius", kSize, &sphere.radius);
  section.RejectOtherKeys();
  return sphere;
}

RectangleShape ReadRectangle(YamlSection section) {
  RectangleShape rectangle;
  section.Require("size");
  section.ReadVector2("size", kSize, &rectangle.size);
  section.RejectOtherKeys();
  return rectangle;
}

// The middle of the bounding box's bottom face.
Eigen::Vector3d BottomMiddle(const std::vector<Eigen::Vector3d>& vertices) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : vertices) box.extend(vertex);
  return {box.center().x(), box.center().y(), box.min().z()};
}

template <typename Names>
std::string Join(const Names& names) {
  std::string text;
  for (const char* name : names) text += (text.empty() ? "" : ", ") + std::string(name);
  return text;
}

}  // namespace

void SceneObjectReader::ReadShapes(YamlSection shapes) {
  for (const std::string& name : shapes.Keys()) {
    if (shapes_.count(name) != 0) shapes.Fail(name, "is the name of another shape already");
    YamlSection section = shapes.Section(name);
    SceneObject shape;
    shape.name = name;
    ReadLooks(&section, &shape);
    section.RejectOtherKeys();
    shapes_.emplace(name, std::move(shape));
  }
}

std::vector<SceneObject> SceneObjectReader::ReadObjects(YamlSection* section,
                                                        const std::string& key) {
  std::vector<SceneObject> objects;
  for (YamlSection& entry : section->Sections(key)) objects.push_back(ReadObject(std::move(entry)));
  return objects;
}

SceneObject SceneObjectReader::ReadObject(YamlSection section) {
  SceneObject object;
  ReadLooks(&section, &object);
  object.T_scene_object = ReadPose(&section);
  section.RejectOtherKeys();
  return object;
}

void SceneObjectReader::ReadLooks(YamlSection* section, SceneObject* object) {
  const std::string shape_key = ShapeKey(*section);
  if (shape_key == "shape") {
    std::string name;
    section->ReadString("shape", &name);
    const auto shape = shapes_.find(name);
    if (shape == shapes_.end()) section->Fail("shape", "there is no shape '" + name + "'");
    *object = shape->second;
    CountParts(*section, object->parts.size());
  }
  section->ReadString("name", &object->name);
  section->ReadString("class", &object->class_name);
  if (!object->class_name.empty() && !IsValidModelName(object->class_name)) {
    section->Fail("class", "must be 1 .. 64 letters, digits, '_', '-' or '.'");
  }
  section->ReadString("symmetry", &object->symmetry);
  if (std::find(kSymmetries.begin(), kSymmetries.end(), object->symmetry) == kSymmetries.end()) {
    section->Fail("symmetry", "must be one of " + Join(kSymmetries));
  }
  double reflectivity = Part().reflectivity;
  section->Read("reflectivity", {0.0, 1.0}, &reflectivity);
  if (shape_key == "shape") {
    if (section->Has("reflectivity")) {
      for (Part& part : object->parts) part.reflectivity = reflectivity;
    }
  } else {
    object->parts = ReadParts(section, reflectivity);
  }
}

std::vector<Part> SceneObjectReader::ReadParts(YamlSection* section, double reflectivity) {
  std::vector<Part> parts;
  if (!section->Has("parts")) {
    Part part;
    part.shape = ReadShape(section);
    part.reflectivity = reflectivity;
    parts.push_back(std::move(part));
  } else {
    for (YamlSection& entry : section->Sections("parts")) {
      parts.push_back(ReadPart(std::move(entry), reflectivity));
    }
  }
  if (parts.empty()) section->Fail("parts", "is empty");
  CountParts(*section, parts.size());
  return parts;
}

Part SceneObjectReader::ReadPart(YamlSection section, double reflectivity) {
  const std::string key = ShapeKey(section);
  if (key == "parts" || key == "shape") section.Fail(key, "is not possible inside parts");
  Part part;
  part.shape = ReadShape(&section);
  part.T_object_part = ReadPose(&section);
  part.reflectivity = reflectivity;
  section.Read("reflectivity", {0.0, 1.0}, &part.reflectivity);
  section.RejectOtherKeys();
  return part;
}

std::string SceneObjectReader::ShapeKey(const YamlSection& section) const {
  std::string found;
  for (const char* key : kShapeKeys) {
    if (!section.Has(key)) continue;
    if (!found.empty()) section.Fail(key, "there is " + found + " already: one shape only");
    found = key;
  }
  if (found.empty()) section.Fail("", "needs one of " + Join(kShapeKeys));
  return found;
}

Shape SceneObjectReader::ReadShape(YamlSection* section) {
  const std::string key = ShapeKey(*section);
  YamlSection shape = section->Section(key);
  if (key == "box") return ReadBox(std::move(shape));
  if (key == "cylinder") return ReadCylinder(std::move(shape));
  if (key == "cone") return ReadCone(std::move(shape));
  if (key == "sphere") return ReadSphere(std::move(shape));
  if (key == "rectangle") return ReadRectangle(std::move(shape));
  return ReadMeshShape(std::move(shape));
}

MeshShape SceneObjectReader::ReadMeshShape(YamlSection section) {
  section.Require("file");
  std::string file, up = "z";
  section.ReadString("file", &file);
  section.ReadString("up", &up);
  if (up != "y" && up != "z") section.Fail("up", "must be y or z");
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
  section.ReadVector3("scale", {1e-6, 1e6}, &scale);
  bool keep_origin = false;
  section.ReadBool("keep_origin", &keep_origin);
  section.RejectOtherKeys();

  const std::string path =
      (std::filesystem::path(section.file()).parent_path() / file).lexically_normal().string();
  std::shared_ptr<const Mesh>& original = meshes_[path];
  if (!original) {
    MeshResult result = ReadMesh(path);
    if (!result.mesh) section.Fail("file", result.error);
    original = std::make_shared<const Mesh>(std::move(*result.mesh));
  }
  num_triangles_ += original->triangles.size();
  if (num_triangles_ > kMaxTriangles) section.Fail("file", "too many triangles in the scene");

  Mesh mesh = *original;
  for (Eigen::Vector3d& vertex : mesh.vertices) {
    vertex = vertex.cwiseProduct(scale);
    if (up == "y") vertex = Eigen::Vector3d(vertex.x(), -vertex.z(), vertex.y());
  }
  const Eigen::Vector3d origin =
      keep_origin ? Eigen::Vector3d::Zero() : BottomMiddle(mesh.vertices);
  for (Eigen::Vector3d& vertex : mesh.vertices) {
    vertex -= origin;
    if (vertex.cwiseAbs().maxCoeff() > kCoordinate.most) {
      section.Fail("scale",
                   "makes the mesh larger than " + std::to_string(kCoordinate.most) + " m");
    }
  }
  return {std::make_shared<const Mesh>(std::move(mesh))};
}

void SceneObjectReader::CountParts(const YamlSection& section, std::size_t number) {
  num_parts_ += number;
  if (num_parts_ > kMaxParts) section.Fail("", "too many parts in the scene");
}

}  // namespace rimod::simulation

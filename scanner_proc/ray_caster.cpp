#include "scanner_proc/ray_caster.h"

#include <embree3/rtcore.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <type_traits>

#include "scanner_proc/curved_shapes.h"

namespace rimod::simulation {
namespace {

constexpr double kMinRange = 0.001;  // m
// Embree works in float: boxes and ranges get this much more, relative to the scene's coordinates.
constexpr double kFloatMargin = 1e-6;
constexpr double kGrazing = 1e-3;

// One part as the ray caster needs it: triangles in the scene frame, or a curved shape.
struct CastSurface {
  std::size_t object = 0;
  double reflectivity = 0.0;
  Mesh mesh;                                                       // scene frame; empty if curved
  std::variant<std::monostate, SphereShape, FrustumShape> curved;  // part frame
  Eigen::Isometry3d T_part_scene = Eigen::Isometry3d::Identity();
  Eigen::AlignedBox3d box;  // of a curved shape, scene frame
};

std::optional<SurfacePoint> IntersectCurved(const CastSurface& surface, const Ray& ray,
                                            double min_range, double max_range) {
  const Eigen::Vector3d origin = surface.T_part_scene * ray.origin;
  const Eigen::Vector3d direction = surface.T_part_scene.linear() * ray.direction;
  std::optional<SurfacePoint> point;
  if (const auto* const sphere = std::get_if<SphereShape>(&surface.curved)) {
    point = Intersect(*sphere, origin, direction, min_range, max_range);
  } else if (const auto* const frustum = std::get_if<FrustumShape>(&surface.curved)) {
    point = Intersect(*frustum, origin, direction, min_range, max_range);
  }
  if (point) point->normal = surface.T_part_scene.linear().transpose() * point->normal;
  return point;
}

// The plane of a triangle that Embree found, in double precision.
std::optional<SurfacePoint> IntersectTriangle(const CastSurface& surface, std::size_t triangle,
                                              const Ray& ray) {
  const Eigen::Vector3i& corners = surface.mesh.triangles[triangle];
  const Eigen::Vector3d& a = surface.mesh.vertices[corners[0]];
  const Eigen::Vector3d& b = surface.mesh.vertices[corners[1]];
  const Eigen::Vector3d& c = surface.mesh.vertices[corners[2]];
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const double along = normal.dot(ray.direction);
  if (along == 0.0) return std::nullopt;
  return SurfacePoint{normal.dot(a - ray.origin) / along, normal};
}

Ray RayOf(const RTCRay& ray) {
  return {Eigen::Vector3d(ray.org_x, ray.org_y, ray.org_z),
          Eigen::Vector3d(ray.dir_x, ray.dir_y, ray.dir_z)};
}

void SetBounds(const RTCBoundsFunctionArguments* arguments) {
  const CastSurface& surface = *static_cast<const CastSurface*>(arguments->geometryUserPtr);
  const double margin =
      kFloatMargin * (1.0 + surface.box.min().cwiseAbs().cwiseMax(surface.box.max()).maxCoeff());
  RTCBounds* const bounds = arguments->bounds_o;
  bounds->lower_x = static_cast<float>(surface.box.min().x() - margin);
  bounds->lower_y = static_cast<float>(surface.box.min().y() - margin);
  bounds->lower_z = static_cast<float>(surface.box.min().z() - margin);
  bounds->upper_x = static_cast<float>(surface.box.max().x() + margin);
  bounds->upper_y = static_cast<float>(surface.box.max().y() + margin);
  bounds->upper_z = static_cast<float>(surface.box.max().z() + margin);
}

void IntersectForEmbree(const RTCIntersectFunctionNArguments* arguments) {
  if (arguments->valid[0] == 0) return;
  const CastSurface& surface = *static_cast<const CastSurface*>(arguments->geometryUserPtr);
  RTCRayHit* const ray_hit = reinterpret_cast<RTCRayHit*>(arguments->rayhit);
  const std::optional<SurfacePoint> point =
      IntersectCurved(surface, RayOf(ray_hit->ray), ray_hit->ray.tnear, ray_hit->ray.tfar);
  if (!point) return;
  ray_hit->ray.tfar = static_cast<float>(point->range);
  ray_hit->hit.geomID = arguments->geomID;
  ray_hit->hit.primID = arguments->primID;
  ray_hit->hit.instID[0] = arguments->context->instID[0];
}

struct MakeCastSurface {
  const Eigen::Isometry3d& T_scene_part;
  CastSurface* surface;

  void operator()(const BoxShape& box) const { AddMesh(TrianglesOf(box)); }
  void operator()(const RectangleShape& rectangle) const { AddMesh(TrianglesOf(rectangle)); }
  void operator()(const MeshShape& shape) const { AddMesh(*shape.mesh); }
  void operator()(const SphereShape& sphere) const { surface->curved = sphere; }
  void operator()(const FrustumShape& frustum) const { surface->curved = frustum; }

  void AddMesh(const Mesh& mesh) const {
    surface->mesh = mesh;
    for (Eigen::Vector3d& vertex : surface->mesh.vertices) vertex = T_scene_part * vertex;
  }
};

CastSurface SurfaceOf(const SceneObject& object, const Part& part, std::size_t index) {
  CastSurface surface;
  surface.object = index;
  surface.reflectivity = part.reflectivity;
  const Eigen::Isometry3d T_scene_part = object.T_scene_object * part.T_object_part;
  surface.T_part_scene = T_scene_part.inverse();
  std::visit(MakeCastSurface{T_scene_part, &surface}, part.shape);
  SceneObject placed;  // its box in the scene frame
  placed.parts = {part};
  placed.parts[0].T_object_part = T_scene_part;
  surface.box = BoundingBox(placed);
  return surface;
}

RTCGeometry MakeTriangles(RTCDevice device, const Mesh& mesh) {
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                               RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                               mesh.vertices.size()));
  auto* indices = static_cast<unsigned*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(unsigned), mesh.triangles.size()));
  if (vertices == nullptr || indices == nullptr) {
    rtcReleaseGeometry(geometry);
    throw std::runtime_error("Embree has no memory for the scene's triangles");
  }
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    for (int i = 0; i < 3; ++i) *vertices++ = static_cast<float>(vertex[i]);
  }
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    for (int i = 0; i < 3; ++i) *indices++ = static_cast<unsigned>(triangle[i]);
  }
  return geometry;
}

RTCGeometry MakeCurved(RTCDevice device, CastSurface* surface) {
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, 1);
  rtcSetGeometryUserData(geometry, surface);
  rtcSetGeometryBoundsFunction(geometry, &SetBounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, &IntersectForEmbree);
  return geometry;
}

}  // namespace

struct RayCaster::Surfaces {
  std::vector<CastSurface> surfaces;  // index = Embree's geomID; never moved once built
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  ~Surfaces() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
};

RayCaster::RayCaster(const std::vector<SceneObject>& objects)
    : surfaces_(std::make_unique<Surfaces>()) {
  Surfaces& s = *surfaces_;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    for (const Part& part : objects[i].parts) {
      s.surfaces.push_back(SurfaceOf(objects[i], part, i));
    }
  }
  // One thread builds the same tree every time, so that ties between surfaces repeat.
  s.device = rtcNewDevice("threads=1");
  if (s.device == nullptr) throw std::runtime_error("Embree cannot be started");
  s.scene = rtcNewScene(s.device);
  rtcSetSceneFlags(s.scene, RTC_SCENE_FLAG_ROBUST);
  for (std::size_t i = 0; i < s.surfaces.size(); ++i) {
    CastSurface& surface = s.surfaces[i];
    const bool curved = !std::holds_alternative<std::monostate>(surface.curved);
    const RTCGeometry geometry =
        curved ? MakeCurved(s.device, &surface) : MakeTriangles(s.device, surface.mesh);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(s.scene, geometry, static_cast<unsigned>(i));
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(s.scene);
  if (rtcGetDeviceError(s.device) != RTC_ERROR_NONE) {
    throw std::runtime_error("Embree cannot take the scene");
  }
}

RayCaster::~RayCaster() = default;

std::optional<Hit> RayCaster::Cast(const Ray& ray, double max_range) const {
  RTCRayHit ray_hit = {};
  ray_hit.ray.org_x = static_cast<float>(ray.origin.x());
  ray_hit.ray.org_y = static_cast<float>(ray.origin.y());
  ray_hit.ray.org_z = static_cast<float>(ray.origin.z());
  ray_hit.ray.dir_x = static_cast<float>(ray.direction.x());
  ray_hit.ray.dir_y = static_cast<float>(ray.direction.y());
  ray_hit.ray.dir_z = static_cast<float>(ray.direction.z());
  ray_hit.ray.tnear = static_cast<float>(kMinRange);
  ray_hit.ray.tfar = static_cast<float>(max_range * (1.0 + kFloatMargin));
  ray_hit.ray.mask = std::numeric_limits<unsigned>::max();
  ray_hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  ray_hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(surfaces_->scene, &context, &ray_hit);
  if (ray_hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;

  const CastSurface& surface = surfaces_->surfaces[ray_hit.hit.geomID];
  const bool curved = !std::holds_alternative<std::monostate>(surface.curved);
  const std::optional<SurfacePoint> exact =
      curved ? IntersectCurved(surface, ray, kMinRange, std::numeric_limits<double>::infinity())
             : IntersectTriangle(surface, ray_hit.hit.primID, ray);
  // A ray that only grazes may miss in double precision what it hits in float, or hit it elsewhere.
  const double apart = exact ? std::abs(exact->range - ray_hit.ray.tfar) : 0.0;
  if (apart > kGrazing * (1.0 + ray_hit.ray.tfar)) return std::nullopt;
  if (!exact || exact->range < kMinRange || exact->range > max_range) return std::nullopt;
  Hit hit;
  hit.range = exact->range;
  hit.cos_incidence = std::abs(exact->normal.normalized().dot(ray.direction));
  hit.reflectivity = surface.reflectivity;
  hit.object = surface.object;
  return hit;
}

}  // namespace rimod::simulation

#include "stereovox/simulation/scene.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>
#include <mutex>
#include <new>

#include "stereovox/core/error.h"

namespace stereovox {
namespace {

constexpr unsigned kLanes = 8;
constexpr std::array<int, kLanes> kActive = {-1, -1, -1, -1, -1, -1, -1, -1};
constexpr float kSurfaceOffset_m = 1e-3F;  // keeps a surface from blocking itself
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// The lanes below `count` take part.
std::array<int, kLanes> active(std::size_t count) {
  std::array<int, kLanes> lanes = kActive;
  for (std::size_t i = count; i < kLanes; ++i) lanes[i] = 0;
  return lanes;
}

void set_lane(RTCRay8& packet, std::size_t lane, const Ray& ray, float near, float far) {
  packet.org_x[lane] = ray.origin_m.x();
  packet.org_y[lane] = ray.origin_m.y();
  packet.org_z[lane] = ray.origin_m.z();
  packet.dir_x[lane] = ray.direction.x();
  packet.dir_y[lane] = ray.direction.y();
  packet.dir_z[lane] = ray.direction.z();
  packet.tnear[lane] = near;
  packet.tfar[lane] = far;
  packet.time[lane] = 0.0F;
  packet.mask[lane] = ~0U;
  packet.id[lane] = 0;
  packet.flags[lane] = 0;
}

std::vector<Lamp> nearest_lamps(std::vector<Lamp> lamps, const Eigen::Vector2d& to_m) {
  constexpr std::size_t kLamps = 8;
  std::ranges::stable_sort(
      lamps, {}, [&](const Lamp& lamp) { return (lamp.at_m.head<2>() - to_m).squaredNorm(); });
  lamps.resize(std::min(lamps.size(), kLamps));
  return lamps;
}

Eigen::Vector3f facing(const Eigen::Vector3f& normal, const Eigen::Vector3f& direction) {
  return normal.dot(direction) > 0 ? Eigen::Vector3f(-normal.normalized()) : normal.normalized();
}

// Embree's devices share threads and settings: a scene that is built while another device is made
// or released can end up empty. Casting rays needs no lock.
std::mutex& building_mutex() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace

struct Scene::Embree {
  Embree() = default;
  // Delegates, so that what was made is released when the rest fails.
  explicit Embree(const TriangleMesh& mesh) : Embree() {
    const std::scoped_lock lock(building_mutex());
    device = rtcNewDevice(nullptr);
    scene = device != nullptr ? rtcNewScene(device) : nullptr;
    if (scene == nullptr) throw ResourceError("the ray caster cannot be started");
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    add(mesh);
    if (rtcGetDeviceError(device) != RTC_ERROR_NONE)
      throw ResourceError("the ray caster cannot take the world");
  }
  ~Embree() {
    const std::scoped_lock lock(building_mutex());
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
  Embree(const Embree&) = delete;
  Embree& operator=(const Embree&) = delete;

  void add(const TriangleMesh& mesh) {
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* corners = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), mesh.corners.size()));
    auto* triangles = static_cast<unsigned*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(unsigned), mesh.triangles.size()));
    if (corners == nullptr || triangles == nullptr) throw std::bad_alloc();
    for (const Eigen::Vector3f& corner : mesh.corners)
      corners = std::copy_n(corner.data(), 3, corners);
    for (const auto& triangle : mesh.triangles)
      triangles = std::copy_n(triangle.data(), 3, triangles);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
  }

  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
};

Scene::Scene(const World& world, double time_s) : solids_(world.solids) {
  const auto clothes = std::ranges::find(world.materials, "clothes", &Material::name);
  const int material = static_cast<int>(clothes - world.materials.begin());
  assert(world.people.empty() || clothes != world.materials.end());
  for (const Person& person : world.people)
    for (Prism& solid : solids_of(person, time_s, material)) solids_.push_back(std::move(solid));

  TriangleMesh all;
  for (std::size_t i = 0; i < solids_.size(); ++i) {
    const TriangleMesh mesh = mesh_of(solids_[i]);
    const auto first = static_cast<unsigned>(all.corners.size());
    all.corners.insert(all.corners.end(), mesh.corners.begin(), mesh.corners.end());
    for (const auto& t : mesh.triangles)
      all.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    solid_of_triangle_.resize(all.triangles.size(), static_cast<int>(i));
  }
  embree_ = std::make_unique<Embree>(all);

  first_square_ = world.min_m.array().floor().cast<int>();
  squares_ = world.max_m.array().ceil().cast<int>() - first_square_.array();
  for (int y = 0; y < squares_.y(); ++y)
    for (int x = 0; x < squares_.x(); ++x)
      lamps_of_square_.push_back(nearest_lamps(
          world.lamps, (first_square_ + Eigen::Vector2i(x, y)).cast<double>().array() + 0.5));
}

std::span<const Lamp> Scene::lamps_near(const Eigen::Vector3f& p_m) const {
  const Eigen::Vector2i square = (p_m.head<2>().array().floor().cast<int>() - first_square_.array())
                                     .max(0)
                                     .min(squares_.array() - 1);
  return lamps_of_square_[static_cast<std::size_t>(square.y() * squares_.x() + square.x())];
}

Scene::~Scene() = default;

void Scene::cast(std::span<const Ray> rays, std::span<Hit> hits) const {
  assert(rays.size() == hits.size());
  RTCRayHit8 packet{};
  for (std::size_t first = 0; first < rays.size(); first += kLanes) {
    const std::size_t count = std::min<std::size_t>(kLanes, rays.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      set_lane(packet.ray, i, rays[first + i], 0.0F, kInfinity);
      packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect8(active(count).data(), embree_->scene, &context, &packet);
    for (std::size_t i = 0; i < count; ++i) {
      Hit& hit = hits[first + i];
      hit = {};
      if (packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
      hit.distance = packet.ray.tfar[i];
      hit.normal = facing({packet.hit.Ng_x[i], packet.hit.Ng_y[i], packet.hit.Ng_z[i]},
                          rays[first + i].direction);
      hit.solid = solid_of_triangle_[packet.hit.primID[i]];
    }
  }
}

void Scene::block(std::span<const LightPath> paths, std::span<char> is_blocked) const {
  assert(paths.size() == is_blocked.size());
  RTCRay8 packet{};
  for (std::size_t first = 0; first < paths.size(); first += kLanes) {
    const std::size_t count = std::min<std::size_t>(kLanes, paths.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      const LightPath& path = paths[first + i];
      const Eigen::Vector3f way = path.to_m - path.from_m;
      const float margin = kSurfaceOffset_m / std::max(way.norm(), kSurfaceOffset_m);
      set_lane(packet, i, {path.from_m, way}, margin, 1.0F - margin);
    }
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcOccluded8(active(count).data(), embree_->scene, &context, &packet);
    for (std::size_t i = 0; i < count; ++i) is_blocked[first + i] = packet.tfar[i] < 0.0F;
  }
}

}  // namespace stereovox

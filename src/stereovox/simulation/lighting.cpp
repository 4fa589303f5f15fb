#include "stereovox/simulation/lighting.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace stereovox {
namespace {

// Shadows are cast by the lamps that matter most to a point; the light of the others, which mostly
// stand in other rooms, is left out.
constexpr std::size_t kLampsPerPoint = 3;
constexpr float kMinLight = 0.004F;  // of a lamp 1 m away; less does not show in 8 bit
constexpr float kMirrorOffset_m = 1e-3F;

struct LitBy {
  std::array<float, kLampsPerPoint> light{};  // strongest first, before shadows
  std::array<const Lamp*, kLampsPerPoint> lamp{};
};

// A lamp shines downwards as a flat panel does.
float light_of(const Lamp& lamp, const Eigen::Vector3f& p, const Eigen::Vector3f& normal) {
  const Eigen::Vector3f to_lamp = lamp.at_m.cast<float>() - p;
  const float below = to_lamp.z(), facing = normal.dot(to_lamp);
  if (below <= 0 || facing <= 0) return 0.0F;
  const float square = to_lamp.squaredNorm();
  return static_cast<float>(lamp.power) * below * facing / (square * square);
}

LitBy strongest_lamps(const Scene& scene, const Eigen::Vector3f& p, const Eigen::Vector3f& n) {
  LitBy lit;
  for (const Lamp& candidate : scene.lamps_near(p)) {
    float light = light_of(candidate, p, n);
    const Lamp* lamp = &candidate;
    if (light < kMinLight) continue;
    for (std::size_t k = 0; k < kLampsPerPoint; ++k)
      if (light > lit.light[k]) {
        std::swap(light, lit.light[k]);
        std::swap(lamp, lit.lamp[k]);
      }
  }
  return lit;
}

// Walls bounce light: surfaces that look up or along x get a little more of it, so that the two
// sides of a corner differ.
float ambient_light(const World& world, const Eigen::Vector3f& normal) {
  return static_cast<float>(world.ambient) * (0.8F + 0.15F * normal.z() + 0.1F * normal.x());
}

float albedo_of(const World& world, const Scene& scene, const Seen& seen) {
  const Prism& solid = scene.solids()[static_cast<std::size_t>(seen.hit.solid)];
  const Eigen::Vector3d p = seen.point_m().cast<double>() - solid.texture_origin_m;
  const float length = seen.ray.direction.norm();
  const float slant = std::max(0.1F, -seen.hit.normal.dot(seen.ray.direction) / length);
  const double footprint = seen.hit.distance * length * seen.pixel_rad / std::sqrt(slant);
  return static_cast<float>(albedo_at(world.materials[static_cast<std::size_t>(solid.material)], p,
                                      seen.hit.normal.cast<double>(), footprint));
}

const Material& material_of(const World& world, const Scene& scene, const Hit& hit) {
  const Prism& solid = scene.solids()[static_cast<std::size_t>(hit.solid)];
  return world.materials[static_cast<std::size_t>(solid.material)];
}

std::vector<LitBy> without_shadows(const Scene& scene, std::span<const Seen> seen) {
  std::vector<LitBy> lit(seen.size());
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (seen[i].hit.is_there())
      lit[i] = strongest_lamps(scene, seen[i].point_m(), seen[i].hit.normal);
  return lit;
}

void cast_shadows(const Scene& scene, std::span<const Seen> seen, std::vector<LitBy>& lit) {
  std::vector<LightPath> segments;
  std::vector<float*> lights;
  for (std::size_t k = 0; k < kLampsPerPoint; ++k)
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (lit[i].light[k] <= 0) continue;
      segments.push_back({seen[i].point_m(), lit[i].lamp[k]->at_m.cast<float>()});
      lights.push_back(&lit[i].light[k]);
    }
  std::vector<char> is_blocked(segments.size());
  scene.block(segments, is_blocked);
  for (std::size_t i = 0; i < lights.size(); ++i)
    if (is_blocked[i]) *lights[i] = 0.0F;
}

float direct_radiance(const World& world, const Scene& scene, const Seen& seen, const LitBy& lit) {
  if (!seen.hit.is_there()) return 0.0F;
  float light = ambient_light(world, seen.hit.normal);
  for (const float part : lit.light) light += part;
  return albedo_of(world, scene, seen) * light +
         static_cast<float>(material_of(world, scene, seen.hit).emission);
}

// The mirror's share grows towards grazing view, as Fresnel's law has it.
float mirror_share(const Material& material, const Seen& seen) {
  const float cosine = -seen.hit.normal.dot(seen.ray.direction.normalized());
  const auto r = static_cast<float>(material.reflectivity);
  return r + (1 - r) * r * 4 * std::pow(1 - cosine, 4.0F);
}

Seen mirrored(const Seen& seen) {
  const Eigen::Vector3f direction = seen.ray.direction.normalized();
  const Eigen::Vector3f& normal = seen.hit.normal;
  return {.ray = {seen.point_m() + normal * kMirrorOffset_m,
                  direction - 2 * normal.dot(direction) * normal},
          .hit = {},
          .pixel_rad = seen.pixel_rad};
}

void add_mirror_images(const World& world, const Scene& scene, std::span<const Seen> seen,
                       std::vector<float>& radiance) {
  std::vector<Seen> images;
  std::vector<std::size_t> of;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (!seen[i].hit.is_there()) continue;
    if (material_of(world, scene, seen[i].hit).reflectivity <= 0) continue;
    images.push_back(mirrored(seen[i]));
    of.push_back(i);
  }
  std::vector<Ray> rays;
  for (const Seen& image : images) rays.push_back(image.ray);
  std::vector<Hit> hits(rays.size());
  scene.cast(rays, hits);
  for (std::size_t k = 0; k < images.size(); ++k) {
    images[k].hit = hits[k];
    // A mirror image of a shadow is not worth its rays.
    const LitBy lit = without_shadows(scene, {&images[k], 1})[0];
    const float image = direct_radiance(world, scene, images[k], lit);
    const float share = mirror_share(material_of(world, scene, seen[of[k]].hit), seen[of[k]]);
    radiance[of[k]] += std::min(share, 1.0F) * (image - radiance[of[k]]);
  }
}

}  // namespace

std::vector<float> radiance_of(const World& world, const Scene& scene, std::span<const Seen> seen) {
  std::vector<LitBy> lit = without_shadows(scene, seen);
  cast_shadows(scene, seen, lit);
  std::vector<float> radiance(seen.size());
  for (std::size_t i = 0; i < seen.size(); ++i)
    radiance[i] = direct_radiance(world, scene, seen[i], lit[i]);
  add_mirror_images(world, scene, seen, radiance);
  return radiance;
}

}  // namespace stereovox

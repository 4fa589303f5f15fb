// The surfaces of a world at one moment, ready for casting rays (Embree inside).
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "stereovox/simulation/world.h"

namespace stereovox {

struct Ray {
  Eigen::Vector3f origin_m, direction;  // the direction need not have length 1
};

// Where a ray first meets a surface, at origin + distance * direction.
struct Hit {
  float distance = 0.0F;
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  // length 1, towards the side the ray came from
  int solid = -1;                                    // position in Scene::solids(); -1 = none

  bool is_there() const { return solid >= 0; }
};

struct LightPath {
  Eigen::Vector3f from_m, to_m;
};

// May be asked from several threads at once.
class Scene {
 public:
  Scene(const World& world, double time_s);
  ~Scene();
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  std::span<const Prism> solids() const { return solids_; }

  // The lamps that can matter at a place: the nearest ones to the square metre it lies in.
  std::span<const Lamp> lamps_near(const Eigen::Vector3f& p_m) const;

  // hits[i] belongs to rays[i]; both lists have the same length.
  void cast(std::span<const Ray> rays, std::span<Hit> hits) const;
  // is_blocked[i]: whether something stands between the ends of paths[i].
  void block(std::span<const LightPath> paths, std::span<char> is_blocked) const;

 private:
  struct Embree;
  std::vector<Prism> solids_;
  std::vector<int> solid_of_triangle_;
  Eigen::Vector2i first_square_, squares_;
  std::vector<std::vector<Lamp>> lamps_of_square_;
  std::unique_ptr<Embree> embree_;
};

}  // namespace stereovox

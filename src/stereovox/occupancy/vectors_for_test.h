// The test vectors of the method, and its camera.
#pragma once

#include <fstream>
#include <nlohmann/json.hpp>

#include "stereovox/core/camera.h"
#include "stereovox/occupancy/stereo_error_model.h"

namespace stereovox::vectors {

inline constexpr double kHalfEdge_m = 0.125;

inline nlohmann::json section(const char* name) {
  std::ifstream file(STEREOVOX_SOURCE_DIR "/src/stereovox/occupancy/testdata/vectors.json");
  return nlohmann::json::parse(file).at(name);
}

// Principal point 0: the vectors' u and v are relative to it.
inline RectifiedCamera camera() {
  return {.pinhole =
              {.width = 640, .height = 480, .fx_px = 525.0, .fy_px = 525.0, .cx_px = 0, .cy_px = 0},
          .baseline_m = 0.12};
}

inline StereoErrorModel corrected_model() {
  StereoErrorModel model;
  model.min_sigma_disparity_px = 0.5;
  return model;
}

inline StereoErrorModel printed_model() {
  StereoErrorModel model = corrected_model();
  model.noise = NoiseReading::printed;
  model.depth_variance = DepthVariance::printed;
  return model;
}

inline PointMeasurement point(const StereoErrorModel& model, const nlohmann::json& row) {
  const Eigen::Vector2d pixel(row.at("u").get<double>(), row.at("v").get<double>());
  return measure_point(model, camera(), SE3{}, pixel, row.at("d"), 0.5);
}

inline Eigen::Vector3d vector3(const nlohmann::json& row) {
  return {row[0].get<double>(), row[1].get<double>(), row[2].get<double>()};
}

}  // namespace stereovox::vectors

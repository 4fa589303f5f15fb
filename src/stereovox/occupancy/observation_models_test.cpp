#include "stereovox/occupancy/observation_models.h"

#include <gtest/gtest.h>

#include "stereovox/occupancy/vectors_for_test.h"

namespace stereovox {
namespace {

using vectors::kHalfEdge_m;

// Every model against the column of the vectors that is named for it.
template <class Model>
void expect_column(const char* column, const StereoErrorModel& errors) {
  for (const auto& row : vectors::section("observation")) {
    SCOPED_TRACE(row.dump());
    const PointMeasurement point = vectors::point(errors, row);
    const Eigen::Vector3d offset_m = point.p_world - vectors::vector3(row.at("voxel_centre"));
    EXPECT_NEAR(Model{}.observe(point, offset_m, kHalfEdge_m), row.at(column).get<double>(), 1e-9);
  }
}

TEST(ObservationModels, LiteralGivesTheVectors) {
  expect_column<LiteralObservation>("O_literal", vectors::printed_model());
}

TEST(ObservationModels, PrintedShapeGivesTheVectors) {
  expect_column<PrintedShapeObservation>("O_printed_shape_with_corrected_delta",
                                         vectors::corrected_model());
}

TEST(ObservationModels, EuclidContinuousGivesTheVectors) {
  expect_column<EuclidContinuousObservation>("O_continuous", vectors::corrected_model());
}

TEST(ObservationModels, MinRampGivesTheVectors) {
  expect_column<MinRampObservation>("O_min_ramp", vectors::corrected_model());
}

TEST(ObservationModels, BoxGivesTheVectors) {
  expect_column<BoxObservation>("O_box", vectors::corrected_model());
}

TEST(ObservationModels, DistanceErrorsAreThoseOfTheVectors) {
  for (const auto& row : vectors::section("observation")) {
    const auto error_m = [&](DistanceError reading, const StereoErrorModel& errors) {
      const PointMeasurement point = vectors::point(errors, row);
      return distance_error_m(reading, point,
                              point.p_world - vectors::vector3(row.at("voxel_centre")));
    };
    EXPECT_NEAR(error_m(DistanceError::printed, vectors::printed_model()),
                row.at("delta_rho_literal").get<double>(), 1e-12);
    EXPECT_NEAR(error_m(DistanceError::corrected, vectors::corrected_model()),
                row.at("delta_rho_corrected").get<double>(), 1e-12);
  }
}

TEST(ObservationModels, MinRampGivesOneHalfOnAFaceToBothVoxels) {
  const PointMeasurement point = measure_point(vectors::corrected_model(), vectors::camera(), SE3{},
                                               {20, 20}, 63.0 / 2.0, 0.5);  // z = 2 m = a face
  std::map<int, float> evidence_by_z;
  for_each_observed_voxel(MinRampObservation{}, point, 2.0 * kHalfEdge_m,
                          [&](const Eigen::Vector3i& voxel, float evidence) {
                            if (voxel.x() == 0 && voxel.y() == 0)
                              evidence_by_z[voxel.z()] = evidence;
                          });
  EXPECT_FLOAT_EQ(evidence_by_z[7], 0.5F);
  EXPECT_FLOAT_EQ(evidence_by_z[8], 0.5F);
}

// The models' reach must not cut off evidence.
template <class Model>
void expect_nothing_beyond_reach(double tolerance) {
  const Model model;
  for (const auto& row : vectors::section("observation")) {
    const PointMeasurement point = vectors::point(vectors::corrected_model(), row);
    const Eigen::Vector3d reach_m = model.reach_m(point, kHalfEdge_m);
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d offset_m = 1.0001 * reach_m[axis] * Eigen::Vector3d::Unit(axis);
      EXPECT_LE(model.observe(point, offset_m, kHalfEdge_m), tolerance) << Model::kName;
    }
  }
}

TEST(ObservationModels, SeeNothingBeyondTheirReach) {
  expect_nothing_beyond_reach<LiteralObservation>(0.0);
  expect_nothing_beyond_reach<PrintedShapeObservation>(0.0);
  expect_nothing_beyond_reach<EuclidContinuousObservation>(0.0);
  expect_nothing_beyond_reach<MinRampObservation>(0.0);
  expect_nothing_beyond_reach<BoxObservation>(0.00135);  // one tail beyond 3 sigma
}

}  // namespace
}  // namespace stereovox

#include "stereovox/occupancy/stereo_error_model.h"

#include <gtest/gtest.h>

#include "stereovox/occupancy/vectors_for_test.h"

namespace stereovox {
namespace {

constexpr double kRelative = 1e-12;

TEST(StereoErrorModel, GivesTheRangeErrorsOfTheVectors) {
  const auto rows = vectors::section("triangulation_and_range_sigma");
  ASSERT_EQ(rows.size(), 36U);
  for (const auto& row : rows) {
    SCOPED_TRACE(row.dump());
    const PointMeasurement corrected = vectors::point(vectors::corrected_model(), row);
    const double sigma_m = row.at("sigma_range_corrected");
    EXPECT_LT((corrected.p_world - vectors::vector3(row.at("X"))).norm(), 1e-12);
    EXPECT_NEAR(corrected.range_m, row.at("range"), 1e-12);
    EXPECT_NEAR(corrected.sigma_range_m, sigma_m, kRelative * sigma_m);

    const PointMeasurement printed = vectors::point(vectors::printed_model(), row);
    const double error_m = row.at("delta_rho_literal_closed_form");
    EXPECT_NEAR(distance_error_m(DistanceError::printed, printed, {0.1, 0, 0}), error_m,
                kRelative * error_m);
  }
}

TEST(StereoErrorModel, GivesTheCovariancesOfTheVectors) {
  for (const auto& row : vectors::section("covariance")) {
    SCOPED_TRACE(row.dump());
    const auto& expected = row.at("C_X_corrected");
    const Eigen::Matrix3d C = vectors::point(vectors::corrected_model(), row).covariance_world;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        EXPECT_NEAR(C(i, j), expected[std::size_t(i)][std::size_t(j)].get<double>(), 1e-15);
  }
}

TEST(StereoErrorModel, PrintedReadingGivesThePrintedConstants) {
  const Eigen::Matrix3d C =
      point_covariance(vectors::printed_model(), vectors::camera(), {100, -50}, 21.0, 0.5);
  EXPECT_NEAR(C(0, 0), 3.783794e-4, 1e-10);
  EXPECT_NEAR(C(1, 1), 1.007173e-4, 1e-10);
  EXPECT_NEAR(C(2, 2), 1.021224e-2, 1e-8);
  EXPECT_NEAR(C(0, 1), -1.851081e-4, 1e-10);
  EXPECT_NEAR(C(0, 2), 1.943635e-3, 1e-9);
  EXPECT_NEAR(C(1, 2), -9.718173e-4, 1e-10);
}

TEST(StereoErrorModel, TheMatchersSigmaCountsAboveTheFloorOnly) {
  const auto sigma_m = [](double sigma_px) {
    return measure_point({.min_sigma_disparity_px = 0.25}, vectors::camera(), SE3{}, {0, 0}, 31.5,
                         sigma_px)
        .sigma_range_m;
  };
  EXPECT_DOUBLE_EQ(sigma_m(0.0), sigma_m(0.25));
  EXPECT_DOUBLE_EQ(sigma_m(0.5), 2.0 * sigma_m(0.25));
}

TEST(StereoErrorModel, ErrorsTurnWithTheCamera) {
  const SE3 T_world_camera{
      Eigen::Quaterniond(Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, -1).normalized())),
      {4, -5, 6}};
  const auto measured_from = [](const SE3& T) {
    return measure_point(StereoErrorModel{}, vectors::camera(), T, {90, -40}, 30.0, 0.4);
  };
  const PointMeasurement at_home = measured_from(SE3{}), away = measured_from(T_world_camera);
  const Eigen::Matrix3d R = T_world_camera.rotation.toRotationMatrix();
  EXPECT_LT((away.p_world - T_world_camera * at_home.p_world).norm(), 1e-12);
  EXPECT_LT((away.covariance_world - R * at_home.covariance_world * R.transpose()).norm(), 1e-12);
  EXPECT_DOUBLE_EQ(away.sigma_range_m, at_home.sigma_range_m);
}

}  // namespace
}  // namespace stereovox

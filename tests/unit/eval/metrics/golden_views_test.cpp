#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "core/io/trajectory_file.h"
#include "eval/metrics/depth_metrics.h"
#include "eval/metrics/image_metrics.h"
#include "eval/metrics/sharpness.h"
#include "eval/metrics/trajectory/reprojection.h"
#include "tests/support/source_path.h"

namespace saccade {
namespace {

namespace fs = std::filesystem;

const fs::path kGolden = fs::path(testing::source_path("tests/golden"));

std::vector<std::vector<double>> read_table(const std::string& name) {
  std::vector<std::vector<double>> rows;
  std::ifstream file(kGolden / "views" / name);
  for (std::string line; std::getline(file, line);) {
    std::istringstream numbers(line);
    rows.emplace_back();
    for (double number = 0; numbers >> number;) rows.back().push_back(number);
  }
  EXPECT_FALSE(rows.empty()) << name;
  return rows;
}

template <class T>
Image<T> read_picture(const std::string& name) {
  const auto rows = read_table(name);
  Image<T> image(static_cast<int>(rows.at(0).size()), static_cast<int>(rows.size()));
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      image(x, y) =
          static_cast<T>(rows[static_cast<std::size_t>(y)].at(static_cast<std::size_t>(x)));
  return image;
}

/// Scores against those of tests/golden/views/expected.json below `theirs`, to 1e-9 of their size.
void expect_golden(const Metrics& scores, const std::string& ours, const std::string& theirs) {
  std::size_t compared = 0;
  const Metrics expected = read_json_metrics(kGolden / "views/expected.json");
  for (const auto& [key, value] : expected.values()) {
    if (!key.starts_with(theirs)) continue;
    const auto score = scores.get(ours + key.substr(theirs.size()));
    ASSERT_TRUE(score && value) << key;
    EXPECT_NEAR(*score, *value, 1e-9 * std::abs(*value)) << key;
    ++compared;
  }
  EXPECT_GT(compared, 0U) << theirs;
}

class GoldenImages : public ::testing::TestWithParam<const char*> {};

TEST_P(GoldenImages, HaveTheScoresOfAnIndependentProgram) {
  const std::string name = GetParam();
  ImageComparison c;
  c.truth = read_picture<float>("images/truth.txt");
  c.estimate = read_picture<float>("images/" + name + "/estimate.txt");
  c.mask = read_picture<std::uint8_t>("images/" + name + "/observed.txt");
  for (const std::uint8_t seen : c.mask.pixels())
    c.observed += seen / static_cast<double>(c.mask.size());
  Metrics scores;
  set_image_scores(scores, std::array{score_image(c)});
  expect_golden(scores, "reconstruction.", "images." + name + ".");
}

INSTANTIATE_TEST_SUITE_P(Metrics, GoldenImages,
                         ::testing::Values("full", "holes", "negative", "constant"),
                         [](const auto& test) { return std::string(test.param); });

TEST(GoldenSharpness, IsThatOfAnIndependentProgram) {
  Metrics scores;
  scores.set("sharpness", sharpness(read_picture<float>("images/truth.txt")));
  expect_golden(scores, "sharpness", "sharpness");
}

DepthErrors golden_view(const std::string& name) {
  DepthTruth truth;
  truth.depth = read_picture<float>("depth/" + name + "/depth.txt");
  truth.edges = read_picture<std::uint8_t>("depth/" + name + "/edges.txt");
  truth.has_edges = true;
  std::vector<DepthPoint> points;
  for (const auto& row : read_table("depth/" + name + "/points.txt")) {
    DepthPoint point{{row.at(0), row.at(1)}, row.at(2), std::nullopt};
    if (row.at(3) > 0) point.sigma_m = row[3];
    points.push_back(point);
  }
  return compare_depth(points, truth, 0);
}

TEST(GoldenDepth, HasTheScoresOfAnIndependentProgram) {
  Metrics scores;
  set_depth_scores(scores, std::array{golden_view("slope"), golden_view("step")});
  expect_golden(scores, "depth.", "depth.");
}

TEST(GoldenReprojection, HasTheScoresOfAnIndependentProgram) {
  const Trajectory truth = read_tum_trajectory(kGolden / "trajectories/noise/truth.txt");
  const Trajectory estimate = read_tum_trajectory(kGolden / "trajectories/noise/estimate.txt");
  std::vector<Eigen::Vector3f> map;
  for (const auto& row : read_table("reprojection/map.txt"))
    map.push_back(Eigen::Vector3d(row.at(0), row.at(1), row.at(2)).cast<float>());
  const auto interval = scored_interval(truth, {});
  ASSERT_TRUE(interval);
  Metrics scores;
  set_reprojection(scores, reproject(map, take_samples(estimate, truth, *interval),
                                     {240, 180, 200, 200, 119.5, 89.5, {}}));
  expect_golden(scores, "trajectory.reprojection_px.", "reprojection_px.");
}

}  // namespace
}  // namespace saccade

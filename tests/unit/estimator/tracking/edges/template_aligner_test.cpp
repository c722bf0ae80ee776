#include "estimator/tracking/edges/template_aligner.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/unit/estimator/tracking/edges/synthetic_template.h"

namespace saccade {
namespace {

using testing::add_point;
using testing::pixels_between;
using testing::random_frame;
using testing::rectangle_map;
using testing::small_camera;

constexpr double kTemplateGain = 0.8;
constexpr double kTemplateOffset = 0.05;

/// The motion along one degree of freedom that shifts the image of points 2 m away and 50 px off
/// the centre by `px`.
Rigid3 offset_of(int degree_of_freedom, double px) {
  constexpr double kFocal = 133;
  constexpr double kDepth = 2;
  constexpr double kOffCentre = 50 / kFocal;
  const double angle = px / kFocal;
  Twist twist = Twist::Zero();
  const double scale[6] = {kDepth, kDepth, kDepth / kOffCentre, 1, 1, 1 / kOffCentre};
  twist(degree_of_freedom) = angle * scale[degree_of_freedom];
  return Rigid3::exp(twist);
}

/// A template, the frame of another view, and the aligner between them.
class Alignment {
 public:
  explicit Alignment(const AlignOptions& options, const Rigid3& truth = {})
      : map_(rectangle_map()),
        aligner_(options, small_camera()),
        truth_(truth),
        frame_(random_frame(map_, truth, kTemplateGain, kTemplateOffset, 1)) {
    TemplateDrawer drawer(small_camera(), TemplateOptions{}, map_);
    const std::span<const TemplatePoint> drawn = drawer.draw({});
    points_.assign(drawn.begin(), drawn.end());
    aligner_.set_template(points_);
  }

  [[nodiscard]] AlignResult align(const Rigid3& first_guess, std::uint64_t seed = 1,
                                  std::uint64_t draw = 0) const {
    return aligner_.align(frame_, first_guess, Matrix6::Zero(), {}, seed, draw);
  }

  /// Error of a result [px RMS].
  [[nodiscard]] double error_px(const AlignResult& result) const {
    return pixels_between(points_, result.current_from_template, truth_);
  }

  [[nodiscard]] const TemplateAligner& aligner() const { return aligner_; }
  [[nodiscard]] const EventFrame& frame() const { return frame_; }
  [[nodiscard]] const std::vector<TemplatePoint>& points() const { return points_; }

 private:
  MapPoints map_;
  TemplateAligner aligner_;
  Rigid3 truth_;
  EventFrame frame_;
  std::vector<TemplatePoint> points_;
};

AlignOptions options_with(int samples, int iterations, bool sampled_hessian = false) {
  AlignOptions options;
  options.samples = samples;
  options.iterations = iterations;
  options.sampled_hessian = sampled_hessian;
  return options;
}

AlignOptions options_with(SelectionOptions::Kind selection) {
  AlignOptions options;
  options.selection.kind = selection;
  return options;
}

AlignOptions options_with(RobustLoss loss, bool sampled_hessian) {
  AlignOptions options = options_with(500, 30, sampled_hessian);
  options.robust_loss = loss;
  return options;
}

struct Setting {
  std::string name;
  AlignOptions options;
  double bound_px;
};

class AlignerFromOffsets : public ::testing::TestWithParam<Setting> {};

TEST_P(AlignerFromOffsets, ConvergesInEveryDegreeOfFreedom) {
  // One binary pixel is off its probability by 0.5 at most; a template of some 4000 points with a
  // gradient of 0.2 / px places six unknowns to about 0.05 px. Sampling adds its own noise.
  const Alignment alignment(GetParam().options);
  for (int dof = 0; dof < 6; ++dof)
    for (const double px : {-2.0, 2.0}) {
      const Rigid3 first_guess = offset_of(dof, px);
      const AlignResult result = alignment.align(first_guess);
      EXPECT_EQ(result.status, AlignStatus::kOk);
      if (GetParam().options.selection.kind == SelectionOptions::Kind::kRandom) {
        EXPECT_EQ(result.iterations, GetParam().options.iterations);
      } else {
        EXPECT_LT(result.iterations, GetParam().options.iterations) << "converges";
      }
      EXPECT_GT(pixels_between(alignment.points(), first_guess, {}), 1) << "the test must move";
      EXPECT_LT(alignment.error_px(result), GetParam().bound_px)
          << "degree of freedom " << dof << ", " << px << " px";
    }
}

INSTANTIATE_TEST_SUITE_P(
    Selections, AlignerFromOffsets,
    ::testing::Values(Setting{"AllSamples", options_with(1'000'000, 30), 0.15},
                      Setting{"Dense", options_with(SelectionOptions::Kind::kDense), 0.15},
                      Setting{"SemiDense", options_with(SelectionOptions::Kind::kSemiDense), 0.2},
                      Setting{"SparsePatches", options_with(SelectionOptions::Kind::kSparsePatches),
                              0.3},
                      Setting{"Accurate", options_with(500, 30), 0.25},
                      Setting{"AccurateSampledHessian", options_with(500, 30, true), 0.25},
                      Setting{"Huber", options_with(RobustLoss::kHuber, false), 0.25},
                      Setting{"TukeySampledHessian", options_with(RobustLoss::kTukey, true), 0.25},
                      Setting{"Sparse", options_with(100, 30), 0.5}),
    [](const auto& test) { return test.param.name; });

TEST(TemplateAligner, RecoversATrueMotion) {
  const Rigid3 truth = offset_of(0, 1.5) * offset_of(4, -1) * offset_of(5, 2) * offset_of(2, 1);
  const Alignment alignment(options_with(500, 30), truth);
  EXPECT_LT(alignment.error_px(alignment.align({})), 0.3);
}

TEST(TemplateAligner, RecoversGainAndOffset) {
  const AlignResult result = Alignment(options_with(1'000'000, 30)).align({});
  EXPECT_NEAR(result.brightness.gain, kTemplateGain, 0.08);
  EXPECT_NEAR(result.brightness.offset, kTemplateOffset, 0.05);
  EXPECT_GT(result.visible_ratio, 0.9);
  EXPECT_GT(result.inlier_ratio, 0.6);
  EXPECT_LE(result.inlier_ratio, 1);
}

TEST(TemplateAligner, BrightnessModelsNestEachOther) {
  AlignOptions options = options_with(1'000'000, 30);
  options.solve_brightness = false;
  const AlignResult none = Alignment(options).align({});
  EXPECT_EQ(none.brightness.gain, 1);
  EXPECT_EQ(none.brightness.offset, 0);
  options.solve_brightness = true;
  const AlignResult affine = Alignment(options).align({});
  EXPECT_LE(affine.residual, none.residual * 1.001);
}

TEST(TemplateAligner, SameSeedAndDrawGiveTheSameBits) {
  const Alignment alignment(options_with(50, 5));
  const Rigid3 guess = offset_of(0, 1);
  const AlignResult a = alignment.align(guess, 7, 3);
  const AlignResult b = alignment.align(guess, 7, 3);
  EXPECT_EQ(a.current_from_template.translation(), b.current_from_template.translation());
  EXPECT_EQ(a.current_from_template.rotation().coeffs(),
            b.current_from_template.rotation().coeffs());
  EXPECT_EQ(a.residual, b.residual);
  for (const AlignResult& other : {alignment.align(guess, 8, 3), alignment.align(guess, 7, 4)})
    EXPECT_NE(a.current_from_template.translation(), other.current_from_template.translation());
}

TEST(TemplateAligner, FixedPointsKnowNoSeed) {
  const Alignment alignment(options_with(SelectionOptions::Kind::kDense));
  const Rigid3 guess = offset_of(0, 1);
  const AlignResult a = alignment.align(guess, 7, 3);
  const AlignResult b = alignment.align(guess, 8, 4);
  EXPECT_EQ(a.current_from_template.translation(), b.current_from_template.translation());
  EXPECT_EQ(a.residual, b.residual);
}

TEST(TemplateAligner, AStricterTestOfConvergenceIteratesLonger) {
  AlignOptions strict = options_with(SelectionOptions::Kind::kDense);
  strict.converged_px = 1e-4;
  AlignOptions loose = strict;
  loose.converged_px = 0.1;
  AlignOptions never = strict;
  never.converged_px = 0;
  const Rigid3 guess = offset_of(0, 1);
  const int few = Alignment(loose).align(guess).iterations;
  EXPECT_LT(few, Alignment(strict).align(guess).iterations);
  EXPECT_EQ(Alignment(never).align(guess).iterations, never.iterations);
}

TEST(TemplateAligner, AStrongPredictionHolds) {
  const Alignment alignment(options_with(500, 30));
  const Rigid3 prediction = offset_of(0, 2);
  const auto moved_px = [&](double precision) {
    const AlignResult result = alignment.aligner().align(alignment.frame(), prediction,
                                                         precision * Matrix6::Identity(), {}, 1, 0);
    return pixels_between(alignment.points(), result.current_from_template, prediction);
  };
  EXPECT_LT(moved_px(1e14), 0.01);
  EXPECT_GT(moved_px(0), 1);
  EXPECT_NEAR(moved_px(1e-9), moved_px(0), 1e-6) << "a prediction that says nothing";
}

TEST(TemplateAligner, InformationIsOfTheOrderOfTheError) {
  // The squared error in units of its covariance has mean 6; a factor of 10 either way is allowed
  // for samples that are not independent.
  const Alignment alignment(options_with(1'000'000, 30));
  const AlignResult result = alignment.align({});
  const Twist error = result.current_from_template.log();
  const double normalised = error.dot(result.information * error);
  EXPECT_LT(normalised, 60);
  EXPECT_GT(result.information.diagonal().minCoeff(), 0);
  EXPECT_LT((result.information - result.information.transpose()).norm(),
            1e-9 * result.information.norm());
}

TEST(TemplateAligner, TooFewVisiblePointsAreAStatus) {
  for (const bool sampled_hessian : {false, true}) {
    const Alignment alignment(options_with(500, 30, sampled_hessian));
    for (const Rigid3& away : {offset_of(0, 1000), Rigid3({1, 0, 0, 0}, {0, 0, -10}),
                               Rigid3(so3_exp({0, 3, 0}), Eigen::Vector3d::Zero())}) {
      const AlignResult result = alignment.align(away);
      EXPECT_EQ(result.status, AlignStatus::kTooFewVisible);
      EXPECT_LT(result.visible_ratio, 0.3);
      EXPECT_LT(result.iterations, 30) << "gives up";
    }
  }
}

AlignResult align_map(const MapPoints& map, bool sampled_hessian) {
  TemplateDrawer drawer(small_camera(), TemplateOptions{}, map);
  TemplateAligner aligner(options_with(500, 30, sampled_hessian), small_camera());
  aligner.set_template(drawer.draw({}));
  return aligner.align(random_frame(map, {}, kTemplateGain, kTemplateOffset, 1), {},
                       Matrix6::Zero(), {}, 1, 0);
}

TEST(TemplateAligner, OneStraightLineIsSingular) {
  // A vertical line across the whole view: nothing tells how far the camera slid along it.
  MapPoints map;
  for (int y = -30; y < 150; ++y) add_point(map, 2 * small_camera().ray({70, y}));
  for (const bool sampled_hessian : {false, true})
    EXPECT_EQ(align_map(map, sampled_hessian).status, AlignStatus::kSingular);
}

TEST(TemplateAligner, NoTemplateIsAStatus) {
  for (const bool sampled_hessian : {false, true})
    EXPECT_NE(align_map({}, sampled_hessian).status, AlignStatus::kOk);
}

TEST(TemplateAligner, ATemplateWithoutGradientIsSingular) {
  std::vector<TemplatePoint> points;
  for (int y = 10; y < 110; ++y)
    for (int x = 10; x < 150; ++x) {
      const Eigen::Vector3d ray = small_camera().ray({x, y});
      points.push_back(
          {ray.head<2>().cast<float>(), 0.5F, 0.01F * static_cast<float>(x % 7), {0, 0}});
    }
  for (const bool sampled_hessian : {false, true}) {
    TemplateAligner aligner(options_with(500, 30, sampled_hessian), small_camera());
    aligner.set_template(points);
    const EventFrame frame(small_camera());
    EXPECT_EQ(aligner.align(frame, {}, Matrix6::Zero(), {}, 1, 0).status, AlignStatus::kSingular);
  }
}

TEST(TemplateAligner, AnEmptyFrameGivesAFinitePose) {
  const Alignment alignment(options_with(500, 30));
  const EventFrame empty(small_camera());
  const AlignResult result = alignment.aligner().align(empty, {}, Matrix6::Zero(), {}, 1, 0);
  EXPECT_TRUE(result.current_from_template.translation().allFinite());
  EXPECT_TRUE(result.current_from_template.rotation().coeffs().allFinite());
}

}  // namespace
}  // namespace saccade

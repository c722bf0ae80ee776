#include "estimator/tracking/edges/template_aligner.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/random.h"
#include "estimator/tracking/edges/sample_batch.h"

namespace saccade {
namespace {

using Vector = TemplateAligner::Vector;
using Matrix = TemplateAligner::Matrix;
using Means = TemplateAligner::Means;

constexpr int kGainIndex = 6;
constexpr int kOffsetIndex = 7;
/// Enough for means over the whole template within a few percent.
constexpr int kManySamples = 2048;
constexpr double kMinGain = 0.05;
constexpr double kMinVariance = 1e-3;
/// With fewer of the samples inside the frame the result is kTooFewVisible.
constexpr double kMinVisible = 0.3;

template <class Body>
void for_each_chunk(int total, const Body& body) {
  for (int first = 0; first < total; first += SampleBatch::kCapacity)
    body(first, std::min(SampleBatch::kCapacity, total - first));
}

void add_normal(const SampleBatch& chunk, Matrix& normal) {
  for (int i = 0; i < TemplateAligner::kUnknowns; ++i)
    for (int j = i; j < TemplateAligner::kUnknowns; ++j)
      normal(i, j) += chunk.column_dot_column(i, j);
}

/// Removes unknown `k` from the equations.
void fix_unknown(int k, Matrix& normal) {
  normal.row(k).setZero();
  normal.col(k).setZero();
  normal(k, k) = 1;
}

}  // namespace

void BrightnessModel::learn(const BrightnessModel& measured) {
  constexpr double kLearningRate = 0.1;
  gain += kLearningRate * (measured.gain - gain);
  offset += kLearningRate * (measured.offset - offset);
  variance += kLearningRate * (measured.variance - variance);
}

struct TemplateAligner::State {
  Rigid3 current_from_template;
  BrightnessModel brightness;
  double step_gain = 1;             ///< gain that turns a solution of the equations into a twist
  Matrix6 prior = Matrix6::Zero();  ///< precision of the prediction, in units of the normal matrix
  Twist error = Twist::Zero();      ///< from the prediction, in the template's frame
  double weight = 0;                ///< information per unit of the normal matrix
  double sigma = 0;                 ///< of the residuals, for robust weights; 0: all count alike
  double step_px = 0;               ///< image motion across the edges by the last step
  Cholesky<kUnknowns> factors;
};

TemplateAligner::TemplateAligner(const AlignOptions& options, const PinholeCamera& camera)
    : options_(options), camera_(camera), selector_(options.selection, camera) {}

void TemplateAligner::set_template(std::span<const TemplatePoint> points) {
  points_ = selector_.select(points);
  template_normal_.setZero();
  pose_normal_.setZero();
  if (points_.empty()) return;
  const int total = std::min(kManySamples, static_cast<int>(points_.size()));
  SampleBatch chunk;
  for_each_chunk(total, [&](int first, int count) {
    chunk.load(points_, first, count, total, 0);
    chunk.show_all();
    chunk.differentiate();
    add_normal(chunk, template_normal_);
  });
  template_normal_ /= total;
  mean_value_ = static_cast<float>(template_normal_(kGainIndex, kOffsetIndex));
  if (is_fixed()) gradient_px_ = root_mean_squared_gradient();
  eliminate_brightness();
}

void TemplateAligner::eliminate_brightness() {
  // Schur complement; with gain or offset fixed the pose would be known a little better.
  const Eigen::Matrix<double, 6, 2> mixed = template_normal_.topRightCorner<6, 2>();
  const double tt = template_normal_(kGainIndex, kGainIndex);
  const double t1 = template_normal_(kGainIndex, kOffsetIndex);
  const double determinant = tt - t1 * t1;
  pose_normal_ = template_normal_.topLeftCorner<6, 6>().selfadjointView<Eigen::Upper>();
  if (!(determinant > 0)) return;
  Eigen::Matrix2d inverse;
  inverse << 1, -t1, -t1, tt;
  pose_normal_ -= mixed * (inverse / determinant) * mixed.transpose();
}

double TemplateAligner::root_mean_squared_gradient() const {
  double sum = 0;
  for (const TemplatePoint& p : points_) {
    const double gx = static_cast<double>(p.slope.x()) / camera_.fx;
    const double gy = static_cast<double>(p.slope.y()) / camera_.fy;
    sum += gx * gx + gy * gy;
  }
  return std::sqrt(sum / static_cast<double>(points_.size()));
}

double TemplateAligner::effective_samples() const {
  // Neighbouring samples see the same events: beyond a third of the points nothing new is learnt.
  constexpr double kCorrelated = 3;
  const double points = static_cast<double>(points_.size());
  const double drawn = is_fixed() ? points
                                  : std::min(static_cast<double>(options_.samples), points) *
                                        std::max(1, options_.iterations - options_.averaging_from);
  return drawn / (1 + kCorrelated * drawn / std::max(points, 1.0));
}

Means TemplateAligner::draw_means(const EventFrame& frame, const State& state, int samples,
                                  std::uint32_t key) const {
  const int total = std::min(samples, static_cast<int>(points_.size()));
  const auto gain = static_cast<float>(state.brightness.gain);
  const auto offset = static_cast<float>(state.brightness.offset);
  Means means;
  double weights = 0;
  SampleBatch chunk;
  for_each_chunk(total, [&](int first, int count) {
    if (is_fixed() && samples >= total) {
      chunk.load_all(
          points_.subspan(static_cast<std::size_t>(first), static_cast<std::size_t>(count)));
    } else {
      chunk.load(points_, first, count, total, key);
    }
    chunk.warp(camera_, frame, state.current_from_template);
    chunk.compare(frame, options_.smooth, gain, offset);
    means.squared_residual += chunk.squared_residual();
    means.agreeing += chunk.agreeing(mean_value_, gain * mean_value_ + offset);
    means.visible += chunk.visible();
    chunk.weigh(options_.robust_loss, static_cast<float>(state.sigma));
    weights += chunk.visible();
    const auto sums = chunk.columns_dot_residual();
    means.rhs += Eigen::Map<const Vector>(sums.data());
    if (options_.sampled_hessian) {
      chunk.differentiate();
      add_normal(chunk, means.normal);
    }
  });
  const double scale = means.visible > 0 ? 1 / means.visible : 0;
  const double weight_scale = weights > 0 ? 1 / weights : 0;
  means.rhs *= weight_scale;
  means.normal *= weight_scale;
  means.squared_residual *= scale;
  means.agreeing *= scale;
  means.visible /= std::max(total, 1);
  return means;
}

bool TemplateAligner::factor(Matrix normal, State& state) const {
  normal.topLeftCorner<6, 6>() += state.prior;
  if (!options_.solve_brightness) {
    fix_unknown(kOffsetIndex, normal);
    fix_unknown(kGainIndex, normal);
  }
  return state.factors.factor(normal);
}

bool TemplateAligner::step(const Means& means, double step_length, State& state) const {
  if (options_.sampled_hessian && !factor(means.normal, state)) return false;
  Vector rhs = means.rhs;
  rhs.head<6>() -= state.step_gain * (state.prior * state.error);
  if (!options_.solve_brightness) rhs.tail<2>().setZero();
  const Vector solution = state.factors.solve(rhs) * step_length;  // (4.7)
  const Twist xi = solution.head<6>() / state.step_gain;
  if (!xi.allFinite()) return false;
  state.current_from_template = state.current_from_template * Rigid3::exp(-xi);  // (4.19)
  state.error += xi;
  if (is_fixed()) state.step_px = std::sqrt(xi.dot(pose_normal_ * xi)) / gradient_px_;
  state.brightness.gain += solution(kGainIndex);
  state.brightness.offset += solution(kOffsetIndex);
  return true;
}

BrightnessModel TemplateAligner::measure_brightness(const EventFrame& frame,
                                                    const Rigid3& current_from_template) const {
  State state;
  state.current_from_template = current_from_template;
  state.brightness = {0, 0, 0};  // the residual is the frame itself
  const Means means = draw_means(frame, state, kManySamples, 0);
  const double mean_t = template_normal_(kGainIndex, kOffsetIndex);
  const double mean_i = means.rhs(kOffsetIndex);
  const double variance_t = template_normal_(kGainIndex, kGainIndex) - mean_t * mean_t;
  BrightnessModel model;
  if (!(variance_t > 0) || !(means.visible > 0)) return model;
  const double covariance = means.rhs(kGainIndex) - mean_t * mean_i;
  model.gain = std::max(covariance / variance_t, kMinGain);
  model.offset = mean_i - model.gain * mean_t;
  model.variance =
      std::max(means.squared_residual - mean_i * mean_i - model.gain * covariance, kMinVariance);
  return model;
}

TemplateAligner::State TemplateAligner::start(const Rigid3& prediction, const Matrix6& precision,
                                              const BrightnessModel& brightness,
                                              const std::optional<Rigid3>& first_guess) const {
  State state;
  state.current_from_template = first_guess.value_or(prediction);
  if (first_guess) state.error = -(prediction.inverse() * *first_guess).log();
  state.brightness = brightness;
  if (!options_.solve_brightness) state.brightness = {1, 0};
  // Not the gain under estimation: with few samples it may come near zero for an iteration.
  state.step_gain = std::max(state.brightness.gain, kMinGain);
  const double variance = std::max(brightness.variance, kMinVariance);
  state.weight = effective_samples() * state.step_gain * state.step_gain / variance;
  if (state.weight > 0) state.prior = precision / state.weight;
  state.sigma = std::sqrt(variance);
  return state;
}

AlignResult TemplateAligner::align(const EventFrame& frame, const Rigid3& prediction,
                                   const Matrix6& precision, const BrightnessModel& brightness,
                                   std::uint64_t seed, std::uint64_t draw,
                                   const std::optional<Rigid3>& first_guess) const {
  SACCADE_CHECK(frame.width() == camera_.width && frame.height() == camera_.height);
  AlignResult result;
  State state = start(prediction, precision, brightness, first_guess);
  if (!options_.sampled_hessian && !factor(template_normal_, state))
    result.status = AlignStatus::kSingular;
  const Random random(seed);
  const int samples = is_fixed() ? static_cast<int>(points_.size()) : options_.samples;
  while (result.iterations < options_.iterations && result.status == AlignStatus::kOk) {
    const int i = result.iterations++;
    const std::uint32_t key = random.bits(draw, static_cast<std::uint64_t>(i))[0];
    const Means means = draw_means(frame, state, samples, key);
    state.sigma = std::sqrt(std::max(means.squared_residual, kMinVariance));
    // Fixed points have no noise of their own, but on a binary frame they may end in a cycle, of
    // which the mean is the best.
    const int averaged = std::max(0, i - options_.averaging_from);
    // The evidence is the mean over the same iterations as the pose.
    const double weight = 1.0 / (1 + averaged);
    result.visible_ratio += weight * (means.visible - result.visible_ratio);
    result.inlier_ratio += weight * (means.agreeing - result.inlier_ratio);
    result.brightness.variance += weight * (means.squared_residual - result.brightness.variance);
    if (means.visible < kMinVisible || points_.size() < kUnknowns) {
      result.status = AlignStatus::kTooFewVisible;
    } else if (!step(means, weight, state)) {
      result.status = AlignStatus::kSingular;
    } else if (is_fixed() && state.step_px < options_.converged_px) {
      break;
    }
  }
  result.current_from_template = state.current_from_template;
  result.brightness.gain = state.brightness.gain;
  result.brightness.offset = state.brightness.offset;
  result.residual = std::sqrt(result.brightness.variance);
  result.information = state.weight * pose_normal_;
  return result;
}

}  // namespace saccade

#include "estimator/edges/path/inertial_factors.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "estimator/edges/least_squares/prior_cost.h"

namespace saccade {
namespace {

constexpr double kHalfStep_s = 5e-3;     ///< over which the path's own velocity is measured
constexpr double kKnownScale = 1e-5;     ///< sigma of a scale that is known
constexpr double kFree = 1e3;            ///< sigma of what may be anything
constexpr double kGyroBiasSigma = 0.1;   ///< of the first bias [rad/s]
constexpr double kAccelBiasSigma = 0.2;  ///< of the first bias [m/s^2], a consumer's sensor
// Random walk of the biases from one to the next, kBiasSpacing_s later [rad/s, m/s^2].
constexpr double kBiasSpacing_s = 10;
constexpr double kGyroBiasWalk = 1e-3, kAccelBiasWalk = 1e-2;
constexpr double kOffsetSigma_s = 0.01;  ///< of the samples' clock from what the rotations say
// What the path's spline cannot follow, in rotation [rad] and position, relative to the depth.
constexpr double kSplineError_rad = 3e-4, kSplineError = 1e-4;

Twist biases_of(double gyro, double accel) {
  Twist both;
  both.head<3>().setConstant(gyro);
  both.tail<3>().setConstant(accel);
  return both;
}

}  // namespace

InertialFactors::InertialFactors(const Trajectory& path, const SplineKnots& knots,
                                 const InertialStart& start, double interval_s, double weight)
    : path_(path),
      knots_(knots),
      start_(start),
      interval_s_(interval_s),
      weight_(weight),
      frame_(InertialFrame::about(start.aligned.gravity)) {
  const double length_s = path.end_s() - path.start_s();
  const auto count = static_cast<std::size_t>(length_s / interval_s);
  for (std::size_t j = 0; j <= count; ++j) {
    times_s_.push_back(path.start_s() + static_cast<double>(j) * interval_s);
    nodes_.push_back(node_at(times_s_.back()));
  }
  const ImuBias& bias = start.aligned.bias;
  for (std::size_t j = 0; j < count; ++j)
    if (auto sum =
            preintegrate(start.imu.samples, times_s_[j] - start.aligned.time_offset_s,
                         times_s_[j + 1] - start.aligned.time_offset_s, bias, start.imu.noise))
      links_.push_back({j, *sum});
  biases_ = bias_of(count) + 1;
  const double scale = start.is_metric ? 1 : start.aligned.scale;
  for (const InertialNode& node : nodes_) {
    // The sensor's velocity; motion is the camera's.
    const Eigen::Vector3d in_camera =
        scale * node.motion.head<3>() + node.motion.tail<3>().cross(start.imu.position_in_camera);
    const Eigen::Vector3d velocity = node.given.rotation() * in_camera;
    unknowns_.insert(unknowns_.end(), velocity.begin(), velocity.end());
  }
  for (std::size_t i = 0; i < biases_; ++i) {
    unknowns_.insert(unknowns_.end(), bias.gyro.begin(), bias.gyro.end());
    unknowns_.insert(unknowns_.end(), bias.accel.begin(), bias.accel.end());
  }
  const double frame[InertialFrame::kSize] = {0, 0, scale, 0};
  unknowns_.insert(unknowns_.end(), std::begin(frame), std::end(frame));
}

InertialNode InertialFactors::node_at(double t_s) const {
  const double from_s = std::max(path_.start_s(), t_s - kHalfStep_s);
  const double to_s = std::min(path_.end_s(), t_s + kHalfStep_s);
  const Rigid3 step = path_.at_clamped(from_s).inverse() * path_.at_clamped(to_s);
  return {path_.at_clamped(t_s), step.log() / (to_s - from_s), knots_.at(t_s)};
}

std::size_t InertialFactors::bias_of(std::size_t node) const {
  return static_cast<std::size_t>(static_cast<double>(node) * interval_s_ / kBiasSpacing_s);
}

InertialCost::Matrix9 InertialFactors::root_of(const Preintegration& sum) const {
  InertialCost::Matrix9 covariance = sum.covariance;
  const double error_m = kSplineError * start_.typical_depth_m;
  covariance.diagonal().head<3>().array() += kSplineError_rad * kSplineError_rad;
  covariance.diagonal().tail<3>().array() += error_m * error_m;
  const Eigen::LLT<InertialCost::Matrix9> factor(covariance);
  return weight_ * InertialCost::Matrix9(factor.matrixL().solve(InertialCost::Matrix9::Identity()));
}

void InertialFactors::add_to(PathBundle& bundle, PathCorrection& correction) {
  // Block by block: velocities far apart do not couple.
  for (std::size_t j = 0; j < nodes_.size(); ++j) bundle.keep({velocity(j), 3});
  for (std::size_t i = 0; i < biases_; ++i) bundle.keep({bias(i), 6});
  bundle.keep({frame(), InertialFrame::kSize});
  for (const Link& link : links_) {
    auto cost = std::make_unique<InertialCost>(std::array{nodes_[link.node], nodes_[link.node + 1]},
                                               link.sum, start_.imu.position_in_camera, frame_,
                                               root_of(link.sum));
    std::vector<double*> blocks;
    for (std::size_t k = 0; k < cost->controls(); ++k)
      blocks.push_back(correction.data(cost->first_control() + k));
    blocks.insert(blocks.end(), {velocity(link.node), velocity(link.node + 1),
                                 bias(bias_of(link.node)), frame()});
    bundle.add_factor(std::move(cost), std::move(blocks));
  }
  add_priors(bundle);
}

void InertialFactors::add_priors(PathBundle& bundle) {
  // Where there are no samples; far beyond what a hand does.
  const Eigen::Matrix3d free = root_of_sigma<3>(Eigen::Vector3d::Constant(kFree));
  for (std::size_t j = 0; j < nodes_.size(); ++j)
    bundle.add_factor(
        std::make_unique<LinearPriorCost<3>>(free, Eigen::Map<const Eigen::Vector3d>(velocity(j))),
        {velocity(j)});
  bundle.add_factor(
      std::make_unique<LinearPriorCost<6>>(
          root_of_sigma<6>(biases_of(kGyroBiasSigma, kAccelBiasSigma)), Twist::Zero()),
      {bias(0)});
  const Matrix6 walk = root_of_sigma<6>(biases_of(kGyroBiasWalk, kAccelBiasWalk));
  for (std::size_t i = 0; i + 1 < biases_; ++i)
    bundle.add_factor(
        std::make_unique<LinearPriorCost<6>>(walk, Twist::Zero(), std::vector<double>{-1, 1}),
        {bias(i), bias(i + 1)});
  const Eigen::Map<const InertialFrame::Vector> mean(frame());
  const InertialFrame::Vector sigma(kFree, kFree, start_.is_metric ? kKnownScale : kFree,
                                    kOffsetSigma_s);
  bundle.add_factor(std::make_unique<LinearPriorCost<InertialFrame::kSize>>(
                        root_of_sigma<InertialFrame::kSize>(sigma), mean),
                    {frame()});
}

InertialAlignment InertialFactors::found() const {
  InertialAlignment found = start_.aligned;
  const double* frame = &unknowns_[unknowns_.size() - InertialFrame::kSize];
  const double* bias = &unknowns_[3 * nodes_.size()];
  found.gravity = frame_.gravity_at(Eigen::Vector2d(frame[0], frame[1]));
  found.scale = frame[InertialFrame::kScale];
  found.time_offset_s += frame[InertialFrame::kOffset];
  found.bias = {Eigen::Map<const Eigen::Vector3d>(bias),
                Eigen::Map<const Eigen::Vector3d>(bias + 3)};
  found.intervals = links_.size();
  return found;
}

}  // namespace saccade

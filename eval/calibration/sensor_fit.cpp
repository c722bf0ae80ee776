#include "eval/calibration/sensor_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/process/progress.h"

namespace saccade {
namespace {

/// A fitted parameter: its value is exp(x), but the mismatch, whose square is x, since the moments
/// are linear in it.
struct FitAxis {
  const char* name;
  std::optional<double> SensorParameters::*member;
  bool is_square;
  double step;       ///< of the differences, in x
  double prior;      ///< sigma of x about where the fit starts
  double low, high;  ///< of the value

  [[nodiscard]] double x_of(const SensorParameters& sensor) const {
    const double value = *(sensor.*member);
    return is_square ? value * value : std::log(value);
  }
  [[nodiscard]] double value_at(double x) const {
    return std::clamp(is_square ? std::sqrt(std::max(x, 0.0)) : std::exp(x), low, high);
  }
};

/// So wide that it matters only where the data says nothing.
constexpr double kWide = 2;
constexpr FitAxis kContrastOnAxis{.name = "contrast_on",
                                  .member = &SensorParameters::contrast_on,
                                  .is_square = false,
                                  .step = 0.08,
                                  .prior = kWide,
                                  .low = 0.02,
                                  .high = 3};
constexpr FitAxis kContrastOffAxis{.name = "contrast_off",
                                   .member = &SensorParameters::contrast_off,
                                   .is_square = false,
                                   .step = 0.08,
                                   .prior = kWide,
                                   .low = 0.02,
                                   .high = 3};
/// It starts at the floor of the gaps, which is right but where edges are slow.
constexpr FitAxis kRefractoryAxis{.name = "refractory.period_us",
                                  .member = &SensorParameters::refractory_us,
                                  .is_square = false,
                                  .step = 0.1,
                                  .prior = 0.3,
                                  .low = 1,
                                  .high = 1e5};
constexpr FitAxis kMismatchAxis{.name = "mismatch.sigma",
                                .member = &SensorParameters::mismatch_sigma,
                                .is_square = true,
                                .step = 0.01,
                                .prior = 0.1,
                                .low = 0,
                                .high = 0.5};
constexpr FitAxis kCutoffAxis{.name = "bandwidth.cutoff_hz",
                              .member = &SensorParameters::cutoff_hz,
                              .is_square = false,
                              .step = 0.25,
                              .prior = kWide,
                              .low = 20,
                              .high = 5e4};

/// What the moments of a replica of the right sensor differ by in any case: the frame is not the
/// scene. Counts matter most.
Moments replica_error() {
  Moments error;
  error << 0.01, 0.01, 0.04, 0.04, 0.05, 0.08, 0.04;
  return error;
}

using BlockMoments = std::vector<Moments>;  ///< without each block

BlockMoments without_blocks(const StreamMoments& stream) {
  BlockMoments moments;
  for (std::size_t left_out = 0; left_out < StreamMoments::kBlocks; ++left_out)
    moments.push_back(stream.of([&](std::size_t, std::size_t block) { return block != left_out; }));
  return moments;
}

/// The moments of all recordings below one another, and their weights.
class MomentFit {
 public:
  MomentFit(std::span<const RepeatedRecording> recordings, const SensorParameters& start,
            std::vector<FitAxis> axes, const SensorFitOptions& options)
      : recordings_(recordings), start_(start), axes_(std::move(axes)), options_(options) {
    for (const RepeatedRecording& r : recordings)
      recorded_.emplace_back(r.recorded, r.size, r.duration_s, options.shortest_gap_us);
    start_x_.resize(std::ssize(axes_));
    prior_.resize(std::ssize(axes_));
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      start_x_[at(i)] = axes_[i].x_of(start);
      prior_[at(i)] = axes_[i].prior;
    }
    x_ = start_x_;
  }

  void run(Progress& progress);

  [[nodiscard]] SensorParameters sensor_at(const Eigen::VectorXd& x) const {
    SensorParameters sensor = start_;
    for (std::size_t i = 0; i < axes_.size(); ++i)
      sensor.*axes_[i].member = axes_[i].value_at(x[at(i)]);
    return sensor;
  }
  [[nodiscard]] SensorParameters sensor() const { return sensor_at(x_); }
  [[nodiscard]] std::vector<FittedParameter> parameters() const;
  /// As fitted to one fold alone, by the derivatives at the optimum of all.
  [[nodiscard]] SensorParameters sensor_without(std::size_t fold) const;
  [[nodiscard]] const std::vector<Events>& events() const { return events_; }
  [[nodiscard]] int simulations() const { return simulations_; }
  [[nodiscard]] bool has_converged() const { return has_converged_; }

 private:
  using Simulated = std::vector<StreamMoments>;

  [[nodiscard]] static Eigen::Index at(std::size_t i) { return static_cast<Eigen::Index>(i); }
  Simulated simulate(const Eigen::VectorXd& x, Progress& progress);
  template <class MomentsOf>
  [[nodiscard]] Eigen::VectorXd stacked(const Simulated& simulated, const MomentsOf& of) const;
  [[nodiscard]] Eigen::VectorXd residuals(const Simulated& simulated) const {
    return stacked(simulated, [](const StreamMoments& s) { return s.all(); });
  }
  void set_weights(const Simulated& simulated);
  void differentiate(const Eigen::VectorXd& residuals, Progress& progress);
  [[nodiscard]] double cost(const Eigen::VectorXd& r, const Eigen::VectorXd& x) const {
    return r.cwiseProduct(weights_).squaredNorm() +
           (x - start_x_).cwiseQuotient(prior_).squaredNorm();
  }
  /// The least-squares change of x, from `from`, that explains differences of the moments.
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& r, const Eigen::VectorXd& from) const;
  /// With squares that are none below 0 set to 0.
  [[nodiscard]] Eigen::VectorXd bounded(Eigen::VectorXd x) const;

  std::span<const RepeatedRecording> recordings_;
  SensorParameters start_;
  std::vector<FitAxis> axes_;
  SensorFitOptions options_;
  Simulated recorded_;
  Eigen::VectorXd start_x_, prior_;  ///< where the fit starts, and how far it may go from there
  Eigen::VectorXd x_;
  Eigen::VectorXd weights_;   ///< 1 / sigma of each moment
  Eigen::MatrixXd jacobian_;  ///< of the simulated moments
  Simulated simulated_;       ///< at x_
  std::vector<Events> events_;
  int simulations_ = 0;
  bool has_converged_ = false;
};

auto MomentFit::simulate(const Eigen::VectorXd& x, Progress& progress) -> Simulated {
  Simulated simulated;
  events_.clear();
  for (const RepeatedRecording& r : recordings_) {
    events_.push_back(r.simulate(sensor_at(x)));
    simulated.emplace_back(events_.back(), r.size, r.duration_s, options_.shortest_gap_us);
  }
  ++simulations_;
  progress.add(1);
  return simulated;
}

template <class MomentsOf>
Eigen::VectorXd MomentFit::stacked(const Simulated& simulated, const MomentsOf& of) const {
  Eigen::VectorXd r(static_cast<Eigen::Index>(recordings_.size()) * kMoments);
  for (std::size_t i = 0; i < recordings_.size(); ++i)
    r.segment<kMoments>(at(i) * kMoments) = of(recorded_[i]) - of(simulated[i]);
  return r;
}

/// The jackknife's variance of the differences, with the replica's own error.
void MomentFit::set_weights(const Simulated& simulated) {
  constexpr auto kBlocks = static_cast<double>(StreamMoments::kBlocks);
  weights_.resize(at(recordings_.size()) * kMoments);
  for (std::size_t i = 0; i < recordings_.size(); ++i) {
    const BlockMoments recorded = without_blocks(recorded_[i]);
    const BlockMoments repeated = without_blocks(simulated[i]);
    Moments mean = Moments::Zero(), squares = Moments::Zero();
    for (std::size_t b = 0; b < recorded.size(); ++b) {
      const Moments difference = recorded[b] - repeated[b];
      mean += difference / kBlocks;
      squares += difference.cwiseAbs2() / kBlocks;
    }
    const Moments variance =
        (kBlocks - 1) * (squares - mean.cwiseAbs2()).cwiseMax(0) + replica_error().cwiseAbs2();
    Moments weights = variance.cwiseSqrt().cwiseInverse();
    if (!options_.fits_mismatch) weights[kRoughness] = 0;
    weights_.segment<kMoments>(at(i) * kMoments) = weights;
  }
}

void MomentFit::differentiate(const Eigen::VectorXd& r, Progress& progress) {
  jacobian_.resize(r.size(), x_.size());
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    Eigen::VectorXd moved = x_;
    moved[at(i)] += axes_[i].step;
    jacobian_.col(at(i)) = (r - residuals(simulate(moved, progress))) / axes_[i].step;
  }
}

Eigen::VectorXd MomentFit::solve(const Eigen::VectorXd& r, const Eigen::VectorXd& from) const {
  const Eigen::MatrixXd weighted = weights_.asDiagonal() * jacobian_;
  const Eigen::MatrixXd normal = weighted.transpose() * weighted;
  const Eigen::VectorXd information = prior_.cwiseAbs2().cwiseInverse();
  return (normal + Eigen::MatrixXd(information.asDiagonal()))
      .ldlt()
      .solve(weighted.transpose() * r.cwiseProduct(weights_) +
             information.cwiseProduct(start_x_ - from));
}

Eigen::VectorXd MomentFit::bounded(Eigen::VectorXd x) const {
  for (std::size_t i = 0; i < axes_.size(); ++i)
    if (axes_[i].is_square) x[at(i)] = std::max(x[at(i)], 0.0);
  return x;
}

void MomentFit::run(Progress& progress) {
  constexpr double kLongestStep = 0.5, kTolerance = 0.005;
  constexpr int kHalvings = 3;
  simulated_ = simulate(x_, progress);
  set_weights(simulated_);
  for (int iteration = 0; iteration < options_.iterations && !has_converged_; ++iteration) {
    const Eigen::VectorXd r = residuals(simulated_);
    differentiate(r, progress);
    // From near the optimum on the weights are those of the optimum.
    if (iteration == 2) set_weights(simulated_);
    Eigen::VectorXd step = solve(r, x_);
    step *= std::min(1.0, kLongestStep / std::max(step.cwiseAbs().maxCoeff(), 1e-9));
    has_converged_ = true;  // unless a step of some length improves
    for (int halving = 0; halving < kHalvings; ++halving, step /= 2) {
      const Eigen::VectorXd next = bounded(x_ + step);
      Simulated simulated = simulate(next, progress);
      if (cost(residuals(simulated), next) >= cost(r, x_)) continue;
      has_converged_ = step.cwiseAbs().maxCoeff() < kTolerance;
      x_ = next;
      simulated_ = std::move(simulated);
      break;
    }
  }
  simulated_ = simulate(x_, progress);  // events_ are those of x_
}

std::vector<FittedParameter> MomentFit::parameters() const {
  constexpr auto kBlocks = static_cast<double>(StreamMoments::kBlocks);
  Eigen::VectorXd variance = Eigen::VectorXd::Zero(x_.size());
  for (std::size_t i = 0; i < recordings_.size(); ++i) {
    Eigen::MatrixXd changes(x_.size(), static_cast<Eigen::Index>(StreamMoments::kBlocks));
    const Moments all = recorded_[i].all() - simulated_[i].all();
    const BlockMoments recorded = without_blocks(recorded_[i]);
    const BlockMoments repeated = without_blocks(simulated_[i]);
    for (std::size_t b = 0; b < recorded.size(); ++b) {
      Eigen::VectorXd r = Eigen::VectorXd::Zero(weights_.size());
      r.segment<kMoments>(at(i) * kMoments) = recorded[b] - repeated[b] - all;
      changes.col(at(b)) = solve(r, start_x_);
    }
    const Eigen::VectorXd mean = changes.rowwise().mean();
    variance += (kBlocks - 1) / kBlocks * (changes.colwise() - mean).rowwise().squaredNorm();
  }
  // What the moments themselves leave open, were they independent.
  const Eigen::MatrixXd weighted = weights_.asDiagonal() * jacobian_;
  Eigen::MatrixXd normal = weighted.transpose() * weighted;
  normal.diagonal().array() += 1e-9;
  const Eigen::VectorXd model = normal.inverse().diagonal();
  std::vector<FittedParameter> found;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const double half = 1.96 * std::sqrt(std::max(variance[at(i)], model[at(i)]));
    const FitAxis& axis = axes_[i];
    FittedParameter p{axis.name, axis.value_at(x_[at(i)]), axis.value_at(x_[at(i)] - half),
                      axis.value_at(x_[at(i)] + half)};
    p.is_told = p.low > p.value / 1.5 && p.high < p.value * 1.5;
    found.push_back(p);
  }
  return found;
}

SensorParameters MomentFit::sensor_without(std::size_t fold) const {
  const auto of = [&](const StreamMoments& stream) {
    return stream.of([&](std::size_t f, std::size_t) { return f != fold; });
  };
  const Eigen::VectorXd step = solve(stacked(simulated_, of), x_);
  return sensor_at(bounded(x_ + step.cwiseMax(-0.5).cwiseMin(0.5)));
}

Events events_of_fold(const Events& events, double duration_s, std::size_t fold) {
  const double length_s = duration_s / static_cast<double>(StreamMoments::kFolds);
  const TimeNs from_ns = ns_from_seconds(static_cast<double>(fold) * length_s);
  const TimeNs to_ns = ns_from_seconds(static_cast<double>(fold + 1) * length_s);
  Events part;
  std::ranges::copy_if(events, std::back_inserter(part), [&](const Event& event) {
    return event.t_ns >= from_ns && event.t_ns < to_ns;
  });
  return part;
}

/// Predicts every fold from the sensor of the other one.
std::vector<HeldOutFold> hold_out(std::span<const RepeatedRecording> recordings,
                                  const MomentFit& fit, Progress& progress) {
  std::vector<HeldOutFold> folds;
  for (std::size_t fold = 0; fold < StreamMoments::kFolds; ++fold) {
    const SensorParameters sensor = fit.sensor_without(fold);
    for (const RepeatedRecording& recording : recordings) {
      const Events recorded = events_of_fold(recording.recorded, recording.duration_s, fold);
      const Events simulated =
          events_of_fold(recording.simulate(sensor), recording.duration_s, fold);
      if (recorded.empty() || simulated.empty()) continue;
      folds.push_back(
          {recording.name, fold, sensor, stream_distance(recorded, simulated, recording.size)});
    }
    progress.add(1);
  }
  return folds;
}

}  // namespace

SensorFit fit_sensor(std::span<const RepeatedRecording> recordings, const SensorParameters& start,
                     const SensorFitOptions& options) {
  SACCADE_CHECK(!recordings.empty() && start.contrast_on && start.contrast_off);
  std::vector<FitAxis> axes{kContrastOnAxis, kContrastOffAxis};
  if (options.fits_refractory) axes.push_back(kRefractoryAxis);
  if (options.fits_mismatch) axes.push_back(kMismatchAxis);
  if (options.fits_cutoff) axes.push_back(kCutoffAxis);
  Progress progress("calibrating", 0, "simulations");
  MomentFit fit(recordings, start, axes, options);
  fit.run(progress);
  SensorFit result;
  result.sensor = fit.sensor();
  result.parameters = fit.parameters();
  for (std::size_t i = 0; i < recordings.size(); ++i)
    if (!fit.events()[i].empty())
      result.distances.push_back(
          stream_distance(recordings[i].recorded, fit.events()[i], recordings[i].size));
  result.simulations = fit.simulations();
  result.has_converged = fit.has_converged();
  result.folds = hold_out(recordings, fit, progress);
  return result;
}

}  // namespace saccade

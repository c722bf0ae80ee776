#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/check.h"
#include "core/error.h"
#include "core/spline/banded.h"
#include "core/spline/rotation.h"
#include "core/spline/spline.h"

namespace saccade {
namespace {

using Vectors = std::vector<Eigen::Vector3d>;
using Index = Eigen::Index;

std::size_t size(Index i) { return static_cast<std::size_t>(i); }

/// Interpolation through M poses in terms of the M + 1 increments between the control poses.
/// Segment i must rotate and move by what lies between poses i and i + 1, which involves increments
/// i, i + 1, i + 2; the first and the last increment follow from their neighbours by the natural
/// ends. Increments longer than half a revolution are allowed, so that a spline can swing beyond
/// its poses.
class Interpolation {
 public:
  explicit Interpolation(std::span<const double> times)
      : bases_(bases_between(times)), segments_(static_cast<Index>(bases_.size())) {
    // No acceleration: B_1''(0) w_0 + B_2''(0) w_1 = 0 and its mirror image; both increments are
    // parallel, so on SO(3) the angular acceleration vanishes as well.
    const Eigen::Array4d start = bases_.front().second(0);
    const Eigen::Array4d end = bases_.back().second(1);
    first_ratio_ = -start[1] / start[0];
    last_ratio_ = -end[1] / end[2];
  }

  /// Increments between control positions for the given steps between poses.
  [[nodiscard]] Vectors solve_linear(const Vectors& steps) const {
    Vectors increments(bases_.size() + 2, Eigen::Vector3d::Zero());
    // The second and third rounds refine what the normal equations lost.
    for (int round = 0; round < 3; ++round) {
      BandedLeastSquares system(segments_, 2, 3);
      for (Index i = 0; i < segments_; ++i) {
        const Eigen::RowVector3d w = weights(i);
        const Eigen::RowVector3d residual =
            (steps[size(i)] - columns(increments, i) * w.transpose()).transpose();
        add<1>(system, i, w, residual);
      }
      const auto correction = system.solve();
      SACCADE_CHECK(correction.has_value());
      for (Index i = 0; i < segments_; ++i)
        increments[size(i) + 1] += correction->row(i).transpose();
      close_ends(increments);
    }
    return increments;
  }

  /// Newton's method from `increments` for the given rotations; false when it gets stuck.
  [[nodiscard]] bool solve_rotations(const std::vector<Eigen::Quaterniond>& rotations,
                                     Vectors& increments) const {
    constexpr int kMaxIterations = 60;
    constexpr double kTolerance = 1e-12;
    for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
      BandedLeastSquares system(3 * segments_, 8, 1);
      double worst = 0;
      double cost = 0;
      for (Index i = 0; i < segments_; ++i) {
        const auto segment = rotation_over_segment(bases_[size(i)], columns(increments, i));
        const Eigen::Vector3d residual = so3_log(segment.rotation.conjugate() * rotations[size(i)]);
        add<3>(system, i, segment.jacobian, residual);
        worst = std::max(worst, residual.norm());
        cost += residual.squaredNorm();
      }
      if (worst < kTolerance) return true;
      const auto step = system.solve();
      if (!step || !descend(rotations, cost, *step, increments)) return false;
    }
    return false;
  }

  [[nodiscard]] const CumulativeBasis& basis(Index i) const { return bases_[size(i)]; }
  [[nodiscard]] Index segments() const { return segments_; }

  /// The three increments of segment i as columns.
  [[nodiscard]] static Eigen::Matrix3d columns(const Vectors& increments, Index i) {
    Eigen::Matrix3d m;
    m << increments[size(i)], increments[size(i) + 1], increments[size(i) + 2];
    return m;
  }

 private:
  [[nodiscard]] Eigen::RowVector3d weights(Index i) const {
    const Eigen::Array4d weights = basis(i).value(1) - basis(i).value(0);
    return weights.head<3>().matrix().transpose();
  }

  void close_ends(Vectors& increments) const {
    increments.front() = first_ratio_ * increments[1];
    increments.back() = last_ratio_ * increments[increments.size() - 2];
  }

  /// Adds the rows of segment i, `jacobian` over its three increments of `Size` parameters each,
  /// with the end increments folded into their neighbours.
  template <int Size, class Jacobian, class Residual>
  void add(BandedLeastSquares& system, Index i, const Jacobian& jacobian,
           const Residual& residual) const {
    Jacobian j = jacobian;
    const bool first = i == 0;
    const bool last = i + 1 == segments_;
    if (first) j.template middleCols<Size>(Size) += first_ratio_ * j.template leftCols<Size>();
    if (last) j.template middleCols<Size>(Size) += last_ratio_ * j.template rightCols<Size>();
    const Index from = first ? 1 : 0;
    const Index count = 3 - from - (last ? 1 : 0);
    system.add(Size * (i - 1 + from), j.middleCols(Size * from, Size * count), residual);
  }

  /// Goes along `step` as far as the squared error falls; false when it does not.
  [[nodiscard]] bool descend(const std::vector<Eigen::Quaterniond>& rotations, double cost,
                             const Eigen::MatrixXd& step, Vectors& increments) const {
    for (double length = 1; length > 1e-3; length /= 2) {
      Vectors candidate = increments;
      for (Index i = 0; i < segments_; ++i) {
        candidate[size(i) + 1] += length * step.middleRows<3>(3 * i);
      }
      close_ends(candidate);
      double candidate_cost = 0;
      for (Index i = 0; i < segments_; ++i) {
        const auto segment = rotation_over_segment(bases_[size(i)], columns(candidate, i));
        candidate_cost += so3_log(segment.rotation.conjugate() * rotations[size(i)]).squaredNorm();
      }
      if (candidate_cost < cost) {
        increments = std::move(candidate);
        return true;
      }
    }
    return false;
  }

  std::vector<CumulativeBasis> bases_;
  Index segments_;
  double first_ratio_ = 1;
  double last_ratio_ = 1;
};

std::vector<Eigen::Quaterniond> exponentials(const Vectors& rotation_vectors, double scale) {
  std::vector<Eigen::Quaterniond> result;
  result.reserve(rotation_vectors.size());
  for (const Eigen::Vector3d& w : rotation_vectors) result.push_back(so3_exp(scale * w));
  return result;
}

[[noreturn]] void fail_rotations(const Vectors& rotations) {
  double largest = 0;
  for (const Eigen::Vector3d& w : rotations) largest = std::max(largest, w.norm());
  throw InputError({}, fmt::format("no spline was found through these rotations (consecutive ones "
                                   "are up to {:.0f} degrees apart); give poses closer together",
                                   largest * 180 / std::numbers::pi));
}

/// Increments between control rotations for the given rotation vectors between poses. The
/// linear solution is exact for rotation about one axis and a good start otherwise; where Newton's
/// method gets stuck from there, the rotations grow from nothing to their size in steps that it can
/// take.
Vectors solve_rotations(const Interpolation& interpolation, const Vectors& rotations) {
  constexpr double kLargestStep = 0.04;
  constexpr double kSmallestStep = 1e-3;
  Vectors increments = interpolation.solve_linear(rotations);
  if (interpolation.solve_rotations(exponentials(rotations, 1), increments)) return increments;

  for (Eigen::Vector3d& w : increments) w.setZero();
  double step = kLargestStep;
  for (double reached = 0; reached < 1;) {
    const double scale = std::min(1.0, reached + step);
    Vectors candidate = increments;
    if (interpolation.solve_rotations(exponentials(rotations, scale), candidate)) {
      increments = std::move(candidate);
      reached = scale;
      step = std::min(kLargestStep, 2 * step);
    } else if ((step /= 2) < kSmallestStep) {
      fail_rotations(rotations);
    }
  }
  return increments;
}

}  // namespace

Spline Spline::interpolate(std::span<const StampedPose> poses) {
  SACCADE_CHECK(poses.size() >= 2);
  std::vector<double> times;
  Vectors steps, rotations;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    times.push_back(poses[i].t_s);
    if (i == 0) continue;
    SACCADE_CHECK(times[i] > times[i - 1]);
    const Rigid3& a = poses[i - 1].world_from_camera;
    const Rigid3& b = poses[i].world_from_camera;
    steps.push_back(b.translation() - a.translation());
    rotations.push_back(so3_log(a.rotation().conjugate() * b.rotation()));
  }
  const Interpolation interpolation(times);
  const Vectors position_steps = interpolation.solve_linear(steps);
  const Vectors increments = solve_rotations(interpolation, rotations);

  // Control pose 0 of each segment is placed by the segment's own first pose, so that nothing
  // drifts.
  std::vector<SplineSegment> segments;
  segments.reserve(steps.size());
  for (Index i = 0; i < interpolation.segments(); ++i) {
    const Rigid3& pose = poses[size(i)].world_from_camera;
    const CumulativeBasis& basis = interpolation.basis(i);
    const Eigen::Vector3d start = basis.value(0).head<3>().matrix();
    const Eigen::Matrix3d s = Interpolation::columns(position_steps, i);
    const Eigen::Matrix3d w = Interpolation::columns(increments, i);
    const Eigen::Quaterniond first_rotation =
        so3_exp(start[0] * w.col(0)) * so3_exp(start[1] * w.col(1));
    segments.emplace_back(times[size(i)], times[size(i) + 1] - times[size(i)], basis,
                          pose.translation() - s * start, s,
                          (pose.rotation() * first_rotation.conjugate()).normalized(), w);
  }
  return {std::move(segments), times.front(), times.back()};
}

}  // namespace saccade

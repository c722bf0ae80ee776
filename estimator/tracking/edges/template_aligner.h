#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/camera.h"
#include "core/rigid3.h"
#include "estimator/tracking/cholesky.h"
#include "estimator/tracking/edges/edge_template.h"
#include "estimator/tracking/edges/event_frame.h"
#include "estimator/tracking/edges/point_selection.h"
#include "estimator/tracking/robust_loss.h"

namespace saccade {

/// How a template is aligned to an event frame. What has no key is varied by presets and tests.
struct AlignOptions {
  SelectionOptions selection;
  int pyramid_levels = 1;
  int samples = 500;
  int iterations = 30;
  /// Selections of fixed points stop at a step that moves the edges by less: below it a pose no
  /// longer changes.
  double converged_px = 0.01;
  /// I = gain T + offset is solved with the pose; without (the thesis) I = T, and what the two
  /// differ in brightness turns into motion, as I is binary and T a blurred line.
  bool solve_brightness = true;
  /// sum J^T J over each iteration's samples (the thesis) instead of over the template. Of few
  /// samples it is noise of its own, and it is factored anew in every iteration.
  bool sampled_hessian = false;
  /// From this iteration on the k-th step is divided by k: the pose becomes the mean over samples.
  int averaging_from = 8;
  RobustLoss robust_loss = RobustLoss::kNone;
  /// Samples read 3 x 3 means of the frame: each hears of more events, which few samples need.
  bool smooth = false;
};

/// The frame as a function of the template: I = gain T + offset + noise.
struct BrightnessModel {
  double gain = 0.5;
  double offset = 0;
  double variance = 0.15;  ///< of the noise, full event = 1

  /// Takes in what one more frame showed; frames resemble each other, so a running mean is kept.
  void learn(const BrightnessModel& measured);
};

enum class AlignStatus { kOk, kTooFewVisible, kSingular };

/// The outcome of one alignment with its evidence.
struct AlignResult {
  Rigid3 current_from_template;
  AlignStatus status = AlignStatus::kOk;
  int iterations = 0;
  double visible_ratio = 0;  ///< samples inside the frame / samples
  /// Fraction of the samples where frame and template are on the same side of their means.
  double inlier_ratio = 0;
  double residual = 0;  ///< root mean square of I - gain T - offset, full event = 1
  BrightnessModel brightness;
  Matrix6 information = Matrix6::Zero();  ///< inverse covariance of the pose by the data alone
};

/// Inverse-compositional Lucas-Kanade on SE(3) (thesis 4.1-4.19; Baker & Matthews, IJCV 56(3),
/// 2004):
///   r(u) = I(W(u; current_from_template)) - gain T(u) - offset            (4.3)
///   J(u) = grad T(u) dW/dxi at xi = 0                                     (4.4), (4.17)
///   xi   = (sum J^T J)^-1 sum J^T r / gain                                (4.7)
///   current_from_template <- current_from_template * exp(xi)^-1           (4.19)
/// Sums run over `samples` template points drawn afresh per iteration (random sparse, thesis 4.3),
/// or over the same selected points until the steps have become small.
/// Deterministic in `seed`; align() is thread-safe.
class TemplateAligner {
 public:
  TemplateAligner(const AlignOptions& options, const PinholeCamera& camera);

  /// `points` must outlive the following calls of align().
  void set_template(std::span<const TemplatePoint> points);

  /// `frame`: of the camera's size. `prediction` is the first guess, towards which its inverse
  /// covariance `precision` pulls; `brightness` the first guess of the frame's brightness, whose
  /// gain also scales the steps. `draw` names the alignment (the index of the frame): the samples
  /// depend on it and on `seed`. `first_guess` is where to start when that is not the prediction.
  [[nodiscard]] AlignResult align(const EventFrame& frame, const Rigid3& prediction,
                                  const Matrix6& precision, const BrightnessModel& brightness,
                                  std::uint64_t seed, std::uint64_t draw,
                                  const std::optional<Rigid3>& first_guess = {}) const;

  /// The brightness of a frame whose pose is known, from many samples; for the first frame.
  [[nodiscard]] BrightnessModel measure_brightness(const EventFrame& frame,
                                                   const Rigid3& current_from_template) const;

  /// The six unknowns of the pose, then gain and offset.
  static constexpr int kUnknowns = 8;
  using Vector = Eigen::Matrix<double, kUnknowns, 1>;
  using Matrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;

  /// Means over one draw of samples.
  struct Means {
    Vector rhs = Vector::Zero();     ///< of (J, T, 1)^T r
    Matrix normal = Matrix::Zero();  ///< upper triangle of (J, T, 1)^T (J, T, 1)
    double squared_residual = 0;
    double agreeing = 0;
    double visible = 0;  ///< fraction of the drawn samples; the others are means over these
  };

 private:
  struct State;
  [[nodiscard]] State start(const Rigid3& prediction, const Matrix6& precision,
                            const BrightnessModel& brightness,
                            const std::optional<Rigid3>& first_guess) const;
  [[nodiscard]] Means draw_means(const EventFrame& frame, const State& state, int samples,
                                 std::uint32_t key) const;
  void eliminate_brightness();
  [[nodiscard]] double effective_samples() const;
  [[nodiscard]] bool factor(Matrix normal, State& state) const;
  [[nodiscard]] bool is_fixed() const {
    return options_.selection.kind != SelectionOptions::Kind::kRandom;
  }
  [[nodiscard]] double root_mean_squared_gradient() const;
  [[nodiscard]] bool step(const Means& means, double step_length, State& state) const;

  AlignOptions options_;
  PinholeCamera camera_;
  PointSelector selector_;
  std::span<const TemplatePoint> points_;
  Matrix template_normal_ = Matrix::Zero();  ///< mean over the template
  Matrix6 pose_normal_ = Matrix6::Zero();    ///< its pose part with the brightness eliminated
  float mean_value_ = 0;
  double gradient_px_ = 1;  ///< root mean square over the points [1/px]
};

}  // namespace saccade

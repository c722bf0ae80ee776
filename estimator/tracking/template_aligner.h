#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/rigid3.h"
#include "estimator/tracking/cholesky.h"
#include "estimator/tracking/edge_template.h"
#include "estimator/tracking/event_frame.h"
#include "estimator/tracking/point_selection.h"
#include "estimator/tracking/robust_weight.h"

namespace saccade {

/// How a template is aligned to an event frame.
struct AlignOptions {
  enum class Brightness { kNone, kGain, kAffine };
  enum class Hessian { kSamples, kTemplate };

  SelectionOptions selection;
  int levels = 1;     ///< resolutions, each half of the one before; the coarsest comes first
  int samples = 500;  ///< of the random selection
  int iterations = 30;
  /// The other selections stop when a step moves the image by less.
  double converged_px = 0.01;
  Brightness brightness = Brightness::kAffine;  ///< solved with the pose: I = gain T + offset
  Hessian hessian =
      Hessian::kTemplate;  ///< sum of J^T J over this iteration's samples, or of the template
  int averaging_from =
      8;  ///< from this iteration on, steps shrink as 1/n: the pose becomes the mean
  RobustWeight weights = RobustWeight::kNone;
  bool smooth = false;  ///< read 3 x 3 means of the frame: every sample then hears of more events
  double min_visible =
      0.3;  ///< share of samples inside the frame below which the result is kTooFewVisible
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
  double inlier_ratio =
      0;                ///< samples whose frame and template agree on being above or below the mean
  double residual = 0;  ///< root mean square of I - gain T - offset, full event = 1
  BrightnessModel brightness;
  Matrix6 information = Matrix6::Zero();  ///< inverse covariance of the pose by the data alone
};

/// Inverse-compositional Lucas-Kanade on SE(3) (thesis 4.1-4.19; Baker & Matthews, IJCV 56(3),
/// 2004):
///   r(u) = I(W(u; current_from_template)) - gain T(u) - offset,   J(u) = grad T(u) dW/dxi at xi =
///   0 xi = (sum J^T J)^-1 sum J^T r / gain,   current_from_template <- current_from_template *
///   exp(xi)^-1
/// Sums run over `samples` template points drawn afresh per iteration (random sparse, thesis 4.3),
/// or over the same selected points until the steps have become small.
/// Deterministic in `seed`; align() is thread-safe.
class TemplateAligner {
 public:
  TemplateAligner(const AlignOptions& options, const PinholeCamera& camera);

  /// `points` must outlive the following calls of align().
  void set_template(std::span<const TemplatePoint> points);

  /// `frame`: of the camera's size. `prediction` is the first guess and what `damping` pulls
  /// towards; `brightness` the first guess of the frame's brightness, whose gain also scales the
  /// steps. `draw` names the alignment (the index of the frame): the samples depend on it and on
  /// `seed`. `first_guess` is where to start when that is not the prediction.
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
    double visible = 0;  ///< share of the drawn samples; the others are means over these
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

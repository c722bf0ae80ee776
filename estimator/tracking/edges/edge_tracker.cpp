#include "estimator/tracking/edges/edge_tracker.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/stopwatch.h"

namespace saccade {
namespace {

/// Harmonic mean of the depths [m], by a few points spread over the template; 1 for none.
double typical_depth(std::span<const TemplatePoint> points) {
  constexpr std::size_t kProbes = 64;
  const std::size_t stride = std::max<std::size_t>(1, points.size() / kProbes);
  double sum = 0;
  double count = 0;
  for (std::size_t i = 0; i < points.size(); i += stride, ++count)
    sum += static_cast<double>(points[i].inverse_depth);
  return sum > 0 ? count / sum : 1;
}

/// Of a frame with the template, as the ratio of what this explains to what it does not; it is 0,
/// which the inlier ratio is not, where they have nothing in common.
double agreement(const AlignResult& aligned) {
  const BrightnessModel& brightness = aligned.brightness;
  return brightness.gain > 0 ? brightness.gain * brightness.gain / brightness.variance : 0;
}

void describe_alignment(config::Fields& fields, AlignOptions& options) {
  using Kind = SelectionOptions::Kind;
  fields
      .value(
          "samples", options.samples,
          "Template points drawn per iteration by the random selection (thesis 4.3). The cost of "
          "a pose is proportional to samples times iterations; more samples give less noise.")
      .range(16, 1e6);
  fields
      .value("iterations", options.iterations,
             "Gauss-Newton iterations per pose: always all of them with random points, at most so "
             "many with fixed ones.")
      .range(1, 1000);
  fields.choice("selection", options.selection.kind,
                {{"random", Kind::kRandom},
                 {"dense", Kind::kDense},
                 {"semi_dense", Kind::kSemiDense},
                 {"sparse_patches", Kind::kSparsePatches}},
                "Template points that are aligned (fig. 4.1): random ones drawn afresh in every "
                "iteration, all, the steepest half, or patches around the steepest ones.");
  fields.choice(
      "robust_loss", options.robust_loss,
      {{"none", RobustLoss::kNone}, {"huber", RobustLoss::kHuber}, {"tukey", RobustLoss::kTukey}},
      "Loss of the residuals, in units of their root mean square. A robust one helps "
      "where the map is incomplete or wrong.");
  fields
      .value("pyramid_levels", options.pyramid_levels,
             "Resolutions of the alignment, coarse to fine; 1 is the full one alone. Each further "
             "level doubles the distance from which a wrong start is corrected and costs time.")
      .range(1, 8);
}

}  // namespace

void describe(config::Fields& fields, EdgeTrackerOptions& options) {
  using Preset = EdgeTrackerOptions::Preset;
  using Kind = EventFrameOptions::Kind;
  using Window = EventFrameOptions::Window;
  fields.choice(
      "preset", options.preset,
      {{"accurate", Preset::kAccurate},
       {"fast", Preset::kFast},
       {"narrow_view", Preset::kNarrowView},
       {"thesis", Preset::kThesis}},
      "Setting that the other keys and motion start from. accurate and fast are the thesis's with "
      "the improvements of this project; narrow_view is accurate for a narrow field of view and "
      "steady motion; thesis is its method as printed.");
  if (fields.has("preset")) options = edge_preset(options.preset);
  describe_alignment(fields, options.align);
  fields
      .value(
          "event_map_ratio", options.event_frame.event_map_ratio,
          "Events per frame, relative to the template's lit pixels (4.21), but at least 200 "
          "events. "
          "A smaller ratio gives more poses, each of fewer events; a larger one blurs fast motion.")
      .range(1e-4, 100);
  fields.choice(
      "event_frame", options.event_frame.kind,
      {{"binary", Kind::kBinary}, {"time_surface", Kind::kTimeSurface}},
      "Value of a pixel of the event frame: whether an event fell, or how recent its last "
      "event is (thesis chapter 9).");
  fields.choice("event_window", options.event_frame.window,
                {{"disjoint", Window::kDisjoint}, {"sliding", Window::kSliding}},
                "Events of a frame: the next ones, or the newest ones, a quarter of which are new "
                "(thesis chapter 9). Sliding frames give four times the poses.");
}

EdgeTrackerOptions edge_preset(EdgeTrackerOptions::Preset preset) {
  EdgeTrackerOptions options;
  options.preset = preset;
  if (preset == EdgeTrackerOptions::Preset::kFast) {
    // So few samples say little about one frame: each reads the mean of 3 x 3 pixels of a wider
    // template, and the poses are filtered under the assumption of a nearly constant velocity. The
    // ratio is 0.09, not the thesis's 0.15: more poses at the same error.
    options.templates = {
        .blur_size_px = 7, .blur_sigma_px = 1.3, .min_gradient_px = 0.13, .redraw_px = 15};
    options.event_frame.event_map_ratio = 0.09;
    options.align.samples = 50;
    options.align.iterations = 5;
    options.align.averaging_from = 0;
    options.align.smooth = true;
    options.motion.acceleration_sigma_px = 250;
  } else if (preset == EdgeTrackerOptions::Preset::kNarrowView) {
    // There a rotation and a translation to the side look nearly alike: only a steady prediction
    // separates them. The wider template and the shorter frames suit images with few edges.
    options.templates.blur_size_px = 5;
    options.templates.blur_sigma_px = 1.1;
    options.templates.redraw_px = 4;
    options.event_frame.event_map_ratio = 0.2;
    options.motion.acceleration_sigma_px = 20;
  } else if (preset == EdgeTrackerOptions::Preset::kThesis) {
    options.templates.bilinear = false;
    options.templates.z_test = false;
    options.templates.min_gradient_px = 0;
    options.templates.redraw_px = 0;
    options.align.solve_brightness = false;
    options.align.sampled_hessian = true;
    options.align.averaging_from = options.align.iterations;  // never
    options.motion = {};
  }
  return options;
}

EdgeTracker::EdgeTracker(const EdgeTrackerOptions& options, const PinholeCamera& camera,
                         const MapPoints& map, const Rigid3& world_from_map, std::uint64_t seed)
    : Tracker(options.motion, camera.fx, world_from_map),
      options_(options),
      camera_(camera.undistorted()),
      seed_(seed),
      drawer_(camera_, options.templates, map),
      aligner_(options.align, camera_),
      pyramid_(options.templates, options.align, camera_),
      window_(options.event_frame),
      frame_(camera) {}

void EdgeTracker::reset(TimeNs t_ns, const Rigid3& world_from_camera, double sigma_px) {
  motion_.reset(t_ns, world_from_map_.inverse() * world_from_camera, sigma_px);
  points_ = {};
  brightness_ = {};
  is_brightness_known_ = false;
  frame_index_ = 0;
  templates_drawn_ = 0;
  timing_ = {};
  suspicious_frames_ = 0;
  mean_agreement_ = last_agreement_ = 0;
  inconsistent_frames_ = 0;
}

void EdgeTracker::set_map(const MapPoints& map) {
  drawer_.set_map(map);
  points_ = {};
  is_brightness_known_ = false;  // another map lights another fraction of the pixels
}

void EdgeTracker::start(std::span<const Event> events) {
  window_.start(events);
  frame_.clear();
}

std::optional<TrackedPose> EdgeTracker::next() {
  if (!window_.advance(next_frame_events())) return std::nullopt;
  return track_frame();
}

std::vector<TrackedPose> EdgeTracker::track(const Recording& recording,
                                            const TrackProgress& progress) {
  std::vector<TrackedPose> poses;
  start(recording.events);
  while (const std::optional<TrackedPose> pose = next()) {
    poses.push_back(*pose);
    if (progress) progress(window_.entered().size());
  }
  return poses;
}

std::size_t EdgeTracker::next_frame_events() {
  prepare_template(motion_.pose());
  return events_per_frame();
}

void EdgeTracker::prepare_template(const Rigid3& map_from_camera) {
  const ScopedTimer clock(timing_.view_s);
  if (template_fits(map_from_camera)) return;
  map_from_template_ = map_from_camera;
  points_ = drawer_.draw(map_from_template_.inverse());
  aligner_.set_template(points_);
  pyramid_.set_template(drawer_);
  typical_depth_m_ = typical_depth(points_);
  ++templates_drawn_;
}

bool EdgeTracker::template_fits(const Rigid3& map_from_camera) const {
  if (points_.empty() || options_.templates.redraw_px <= 0) return false;
  return motion_px(map_from_template_, map_from_camera) < options_.templates.redraw_px;
}

double EdgeTracker::motion_px(const Rigid3& map_from_a, const Rigid3& map_from_b) const {
  // A few points spread over the template will do.
  constexpr std::size_t kProbes = 32;
  const Rigid3 a_from_template = map_from_a.inverse() * map_from_template_;
  const Rigid3 b_from_template = map_from_b.inverse() * map_from_template_;
  const std::size_t stride = std::max<std::size_t>(1, points_.size() / kProbes);
  double squared = 0;
  double probes = 0;
  for (std::size_t i = 0; i < points_.size(); i += stride, ++probes) {
    const Eigen::Vector3d point =
        Eigen::Vector3d(points_[i].ray.x(), points_[i].ray.y(), 1) / points_[i].inverse_depth;
    const Eigen::Vector3d in_a = a_from_template * point, in_b = b_from_template * point;
    if (in_a.z() <= 0 || in_b.z() <= 0) return std::numeric_limits<double>::infinity();
    squared += (camera_.project(in_b) - camera_.project(in_a)).squaredNorm();
  }
  return std::sqrt(squared / std::max(1.0, probes));
}

std::size_t EdgeTracker::events_per_frame() const {
  const double count =
      options_.event_frame.event_map_ratio * static_cast<double>(drawer_.lit_pixels());  // (4.21)
  return std::max(static_cast<std::size_t>(options_.event_frame.min_events),
                  static_cast<std::size_t>(count));
}

void EdgeTracker::draw_frame(TrackedPose& pose) {
  const ScopedTimer clock(timing_.load_s);
  const std::span<const Event> events = window_.events();
  pose.first_ns = events.front().t_ns;
  pose.last_ns = events.back().t_ns;
  if (options_.event_frame.kind == EventFrameOptions::Kind::kTimeSurface) {
    frame_.clear();
    pose.t_ns = frame_.draw_surface(events, options_.event_frame.decay_fraction);
  } else if (options_.event_frame.window == EventFrameOptions::Window::kSliding) {
    pose.t_ns = window_.mean_time();
    frame_.remove(window_.left());
    frame_.add(window_.entered());
  } else {
    frame_.clear();
    pose.t_ns = frame_.draw(events);
  }
}

AlignResult EdgeTracker::align(TimeNs t_ns) {
  const ScopedTimer clock(timing_.align_s);
  const PosePrediction predicted = motion_.predict(t_ns, typical_depth_m_);
  const Rigid3 current_from_template = predicted.map_from_camera.inverse() * map_from_template_;
  // Events that earlier frames had, too, say nothing new: against them the prediction weighs more.
  const Matrix6 precision = predicted.precision / window_.new_fraction();
  const std::optional<Rigid3> first_guess =
      pyramid_.approach(frame_, current_from_template, precision, seed_, frame_index_);
  if (!std::exchange(is_brightness_known_, true))
    brightness_ = aligner_.measure_brightness(frame_, first_guess.value_or(current_from_template));
  return aligner_.align(frame_, current_from_template, precision, brightness_, seed_,
                        frame_index_++, first_guess);
}

TrackedPose EdgeTracker::track_frame() {
  TrackedPose pose;
  draw_frame(pose);
  const AlignResult aligned = align(pose.t_ns);
  if (aligned.status == AlignStatus::kOk)
    update_motion(aligned);
  else
    motion_.stop();
  pose.status = judge(aligned);
  compare_to_mean_agreement(aligned);
  write_evidence(aligned, pose);
  last_ = pose;
  return pose;
}

void EdgeTracker::update_motion(const AlignResult& aligned) {
  motion_.update(map_from_template_ * aligned.current_from_template.inverse(),
                 aligned.information * window_.new_fraction());
  brightness_.learn(aligned.brightness);
}

void EdgeTracker::write_evidence(const AlignResult& aligned, TrackedPose& pose) const {
  pose.iterations = aligned.iterations;
  pose.inlier_ratio = aligned.inlier_ratio;
  pose.residual = aligned.residual;
  write_pose(pose);
}

TrackStatus EdgeTracker::judge(const AlignResult& aligned) {
  const bool is_aligned = aligned.status == AlignStatus::kOk;
  const bool suspicious = !is_aligned || aligned.inlier_ratio < options_.min_inlier_ratio;
  suspicious_frames_ = suspicious ? suspicious_frames_ + 1 : 0;
  return is_aligned && !is_lost() ? TrackStatus::kOk : TrackStatus::kLost;
}

void EdgeTracker::compare_to_mean_agreement(const AlignResult& aligned) {
  constexpr double kInconsistent = 0.25, kLearningRate = 0.05;
  last_agreement_ = aligned.status == AlignStatus::kOk ? agreement(aligned) : 0;
  inconsistent_frames_ =
      last_agreement_ < kInconsistent * mean_agreement_ ? inconsistent_frames_ + 1 : 0;
  mean_agreement_ = mean_agreement_ == 0
                        ? last_agreement_
                        : std::lerp(mean_agreement_, last_agreement_, kLearningRate);
}

std::optional<TrackedPose> EdgeTracker::relocate(std::span<const Rigid3> world_from_camera) {
  // Error of a candidate, the fraction of the mean agreement that it must reach, and how much
  // better than at the last frame it must be.
  constexpr double kCandidateSigma_px = 6;
  constexpr double kMeanFraction = 0.5, kGain = 2;
  // The few events of a frame agree by chance with poses that are a pixel or two beside a good one; a
  // camera that is nearer to where it was tracked than this is not lost.
  constexpr double kElsewhere_px = 4;
  const MotionModel before = motion_;
  std::optional<AlignResult> best;
  double best_agreement = std::max(kMeanFraction * mean_agreement_, kGain * last_agreement_);
  MotionModel best_motion = motion_;
  TrackedPose pose = last_;
  for (const Rigid3& candidate : world_from_camera) {
    const Rigid3 map_from_candidate = world_from_map_.inverse() * candidate;
    points_ = {};
    prepare_template(map_from_candidate);
    // As many events as this template wants: that of a diverged pose may be almost dark.
    const std::span<const Event> events = window_.newest(events_per_frame());
    frame_.clear();
    const TimeNs t_ns = frame_.draw(events);
    motion_.reset(t_ns, map_from_candidate, kCandidateSigma_px);
    is_brightness_known_ = false;
    const AlignResult aligned = align(t_ns);
    if (aligned.status != AlignStatus::kOk || agreement(aligned) <= best_agreement) continue;
    update_motion(aligned);
    if (motion_px(before.pose(), motion_.pose()) < kElsewhere_px) continue;
    best_agreement = agreement(aligned);
    best = aligned;
    best_motion = motion_;
    pose.t_ns = t_ns;
    pose.first_ns = events.front().t_ns;
  }
  frame_.clear();
  if (options_.event_frame.window == EventFrameOptions::Window::kSliding)
    frame_.add(window_.events());
  motion_ = best ? best_motion : before;
  points_ = {};
  is_brightness_known_ = false;
  if (!best) return std::nullopt;
  suspicious_frames_ = inconsistent_frames_ = 0;
  pose.status = TrackStatus::kRelocalised;
  write_evidence(*best, pose);
  return pose;
}

}  // namespace saccade

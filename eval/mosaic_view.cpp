#include "eval/mosaic_view.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/SVD>

#include "core/error.h"
#include "core/io/images/panorama_file.h"
#include "core/io/trajectory_file.h"
#include "core/process/parallel.h"
#include "eval/image_views.h"

namespace saccade {
namespace {

constexpr double kStepS = 1e-3;  ///< between samples over time

/// The rotation nearest to a matrix.
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& matrix) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs(1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant());
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

double angle_of(const Eigen::Matrix3d& rotation) {
  return so3_log(Eigen::Quaterniond(rotation)).norm();
}

/// Times within the run's window at which both orientations are known; perhaps none.
std::vector<double> common_times(const MosaicView& view, const RunFolder& run,
                                 const Trajectory& truth) {
  if (truth.empty() || view.world_from_camera.empty()) return {};
  double start_s = std::max(truth.start_s(), view.world_from_camera.start_s());
  double end_s = std::min(truth.end_s(), view.world_from_camera.end_s());
  if (run.record.window) {
    start_s = std::max(start_s, run.record.window->start_s);
    end_s = std::min(end_s, run.record.window->end_s);
  }
  std::vector<double> times;
  for (double t_s = start_s; t_s <= end_s; t_s += kStepS) times.push_back(t_s);
  return times;
}

Eigen::Matrix3d rotation_at(const Trajectory& trajectory, double t_s) {
  return trajectory.at_clamped(t_s).rotation_matrix();
}

/// truth_from_estimate at each of the times, of the two worlds.
std::vector<Eigen::Matrix3d> world_rotations(const MosaicView& view, const Trajectory& truth,
                                             const std::vector<double>& times) {
  std::vector<Eigen::Matrix3d> rotations;
  for (const double t_s : times)
    rotations.push_back(rotation_at(truth, t_s) *
                        rotation_at(view.world_from_camera, t_s).transpose());
  return rotations;
}

Eigen::Matrix3d mean_rotation(const std::vector<Eigen::Matrix3d>& rotations) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const Eigen::Matrix3d& rotation : rotations) sum += rotation;
  return nearest_rotation(sum);
}

/// RMS of the angles between the rotations and `mean`.
double rms_angle(const std::vector<Eigen::Matrix3d>& rotations, const Eigen::Matrix3d& mean) {
  double squares = 0;
  for (const Eigen::Matrix3d& rotation : rotations)
    squares += std::pow(angle_of(mean.transpose() * rotation), 2);
  return std::sqrt(squares / static_cast<double>(rotations.size()));
}

/// A whole sphere at a direction, bilinear and around the seam.
float sample_sphere(const ImageF& image, const Panorama& sphere, const Eigen::Vector3d& direction) {
  const Eigen::Vector2d pixel = sphere.pixel(direction);
  const double y = std::clamp(pixel.y(), 0.0, image.height() - 1.0);
  const double floor_x = std::floor(pixel.x());
  const int left = (static_cast<int>(floor_x) % image.width() + image.width()) % image.width();
  const int right = (left + 1) % image.width();
  const BilinearCell<double> rows(0, y, image.width(), image.height());
  const double weight = pixel.x() - floor_x;
  const auto at = [&](int x, int v) { return static_cast<double>(image(x, v)); };
  const double above = at(left, rows.y0) + weight * (at(right, rows.y0) - at(left, rows.y0));
  const double below =
      at(left, rows.y0 + 1) + weight * (at(right, rows.y0 + 1) - at(left, rows.y0 + 1));
  return static_cast<float>(above + rows.fy * (below - above));
}

ImageF rotated(const ImageF& image, const Eigen::Matrix3d& truth_from_estimate,
               const Panorama& panorama) {
  const Panorama sphere = Panorama::sphere(image.width());
  ImageF result(panorama.width, panorama.height);
  parallel_for(static_cast<std::size_t>(panorama.height), [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < panorama.width; ++x)
      result(x, y) = sample_sphere(image, sphere, truth_from_estimate * panorama.direction(x, y));
  });
  return result;
}

/// Orientations of the true camera in the estimate's world.
std::vector<Eigen::Matrix3d> true_rotations(const Trajectory& truth,
                                            const std::vector<double>& times,
                                            const Eigen::Matrix3d& truth_from_estimate) {
  std::vector<Eigen::Matrix3d> rotations;
  for (const double t_s : times)
    rotations.push_back(truth_from_estimate.transpose() * rotation_at(truth, t_s));
  return rotations;
}

double solid_angle(const Panorama& panorama, const auto& is_counted) {
  double sum = 0;
  for (int y = 0; y < panorama.height; ++y)
    for (int x = 0; x < panorama.width; ++x)
      if (is_counted(x, y)) sum += panorama.solid_angle(y);
  return sum;
}

void set_extent(MosaicComparison& c, const MosaicView& view, const FieldOfView& camera,
                std::span<const Eigen::Matrix3d> rotations) {
  constexpr double kStepPx = 4;
  const Panorama& panorama = view.panorama;
  const auto steps = thinned(rotations, kStepPx / panorama.pixels_per_radian());
  const Panorama sphere = Panorama::sphere(panorama.around);
  const ImageU8 visible = seen_by(camera, steps, sphere);
  c.swept = ImageU8(panorama.width, panorama.height);
  for (int y = 0; y < panorama.height; ++y)
    for (int x = 0; x < panorama.width; ++x)
      c.swept(x, y) = visible((panorama.left + x) % panorama.around, panorama.top + y);
  const auto is_observed = [&](int x, int y) { return view.observed(x, y) != 0; };
  const double swept = solid_angle(sphere, [&](int x, int y) { return visible(x, y) != 0; });
  const double found =
      solid_angle(panorama, [&](int x, int y) { return is_observed(x, y) && c.swept(x, y) != 0; });
  c.image.observed = swept > 0 ? found / swept : 0;
  c.span = solid_angle(panorama, is_observed) / camera.solid_angle();
  int columns = 0;
  for (int x = 0; x < panorama.width; ++x)
    for (int y = 0; y < panorama.height; ++y)
      if (is_observed(x, y)) {
        ++columns;
        break;
      }
  c.span_horizontal = columns / panorama.pixels_per_radian() / camera.horizontal_angle();
}

}  // namespace

std::optional<MosaicView> load_mosaic(const RunFolder& run) {
  const std::filesystem::path geometry = run.folder / "mosaic.yaml";
  if (!std::filesystem::exists(geometry)) return std::nullopt;
  const std::filesystem::path file = run.folder / "mosaic.exr";
  MosaicView view;
  view.panorama = read_panorama(geometry);
  ImageView image = read_log_image(file, 0);
  if (image.observed.empty())
    image.observed = ImageU8(image.log_image.width(), image.log_image.height(), 1);
  view.log_image = std::move(image.log_image);
  view.observed = std::move(image.observed);
  const auto has_size = [&](const auto& one) {
    return one.width() == view.panorama.width && one.height() == view.panorama.height;
  };
  if (!has_size(view.log_image) || !has_size(view.observed))
    throw InputError(file.string(), "has another size than mosaic.yaml states");
  view.world_from_camera = read_orientations(run.folder / "orientation.txt");
  return view;
}

std::optional<MosaicComparison> compare_mosaic(const MosaicView& view, const RunFolder& run,
                                               const Dataset& dataset) {
  const std::vector<double> times = common_times(view, run, dataset.groundtruth());
  ImageF truth = dataset.load_panorama();
  if (times.empty() || truth.empty()) return std::nullopt;
  for (float& value : truth.pixels())
    value = static_cast<float>(std::log(dataset.facts().log_eps + static_cast<double>(value)));
  MosaicComparison c;
  const auto rotations = world_rotations(view, dataset.groundtruth(), times);
  const Eigen::Matrix3d &initial = rotations.front(), mean = mean_rotation(rotations);
  c.alignments_differ_rad = angle_of(initial.transpose() * mean);
  c.residual_rad = rms_angle(rotations, mean);
  c.image.estimate = view.log_image;
  c.image.mask = view.observed;
  c.image.truth = rotated(truth, initial, view.panorama);
  c.mean_truth = rotated(truth, mean, view.panorama);
  set_extent(c, view, FieldOfView(dataset.camera()),
             true_rotations(dataset.groundtruth(), times, initial));
  return c;
}

Metrics score_mosaic(const std::optional<MosaicComparison>& comparison) {
  Metrics metrics;
  std::optional<ImageScores> initial, aligned;
  if (comparison) {
    initial = score_image(comparison->image);
    ImageComparison other = comparison->image;
    other.truth = comparison->mean_truth;
    aligned = score_image(other);
  }
  const auto set = [&](const std::string& key, const std::optional<ImageScores>& scores,
                       const auto& value_of) {
    metrics.set("mosaic." + key, scores ? std::optional<double>(value_of(*scores)) : std::nullopt);
  };
  set("ssim", initial, [](const ImageScores& s) { return s.ssim; });
  set("pearson", initial, [](const ImageScores& s) { return s.pearson; });
  set("mse", initial, [](const ImageScores& s) { return s.mse; });
  set("rmse_log", initial, [](const ImageScores& s) { return std::sqrt(s.mse); });
  set("gradient_pearson", initial, [](const ImageScores& s) { return s.gradient_pearson; });
  set("fit.scale", initial, [](const ImageScores& s) { return s.scale; });
  set("fit.offset", initial, [](const ImageScores& s) { return s.offset; });
  set("aligned.ssim", aligned, [](const ImageScores& s) { return s.ssim; });
  set("aligned.pearson", aligned, [](const ImageScores& s) { return s.pearson; });
  const auto set_if = [&](const std::string& key, const auto& value_of) {
    metrics.set("mosaic." + key,
                comparison ? std::optional<double>(value_of(*comparison)) : std::nullopt);
  };
  constexpr double kDegrees = 180 / std::numbers::pi;
  set_if("observed", [](const MosaicComparison& c) { return c.image.observed; });
  set_if("span.solid_angle", [](const MosaicComparison& c) { return c.span; });
  set_if("span.horizontal", [](const MosaicComparison& c) { return c.span_horizontal; });
  set_if("alignment.residual_deg",
         [](const MosaicComparison& c) { return kDegrees * c.residual_rad; });
  set_if("alignment.rotation_deg",
         [](const MosaicComparison& c) { return kDegrees * c.alignments_differ_rad; });
  return metrics;
}

}  // namespace saccade

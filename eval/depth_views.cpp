#include "eval/depth_views.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>

#include "core/error.h"
#include "core/io/images/exr_file.h"
#include "core/io/ply_file.h"
#include "core/io/run/view_list.h"
#include "core/io/tables/csv_file.h"

namespace saccade {
namespace {

constexpr double kPlaneTolerance = 0.01;  ///< of the median depth
constexpr std::size_t kPlanes = 6;

const std::vector<float>* find_scalar(const PointCloud& cloud, const std::string& name) {
  for (const PointCloud::Scalar& scalar : cloud.scalars)
    if (scalar.name == name) return &scalar.values;
  return nullptr;
}

/// The points of the cloud that say which view they belong to and where they lie in it; false where
/// the cloud does not say.
bool add_points(const PointCloud& cloud, const std::string& source,
                std::vector<EstimatedView>& views) {
  const auto* view = find_scalar(cloud, "view");
  const auto* x = find_scalar(cloud, "x_px");
  const auto* y = find_scalar(cloud, "y_px");
  const auto* depth = find_scalar(cloud, "depth_m");
  const auto* sigma = find_scalar(cloud, "sigma_m");
  if (view == nullptr || x == nullptr || y == nullptr || depth == nullptr) return false;
  for (std::size_t i = 0; i < cloud.positions.size(); ++i) {
    const auto index = static_cast<double>((*view)[i]);
    if (!(index >= 0) || index >= static_cast<double>(views.size()) || !((*depth)[i] > 0))
      throw InputError(
          source, fmt::format("point {} has view {} and depth {} m; there are {} views", i, index,
                              (*depth)[i], views.size()));
    DepthPoint point{{(*x)[i], (*y)[i]}, static_cast<double>((*depth)[i]), std::nullopt};
    if (sigma != nullptr) point.sigma_m = static_cast<double>((*sigma)[i]);
    views[static_cast<std::size_t>(index)].points.push_back(point);
  }
  return true;
}

std::vector<DepthPoint> read_depth_map(const std::filesystem::path& file) {
  const ImageF depth = read_exr(file);
  ImageF variance;
  for (const ExrChannel& channel : read_exr_channels(file))
    if (channel.name == "variance") variance = channel.image;
  std::vector<DepthPoint> points;
  for (int y = 0; y < depth.height(); ++y)
    for (int x = 0; x < depth.width(); ++x) {
      const auto z = static_cast<double>(depth(x, y));
      if (!(z > 0) || !std::isfinite(z)) continue;
      DepthPoint point{{x, y}, z, std::nullopt};
      if (!variance.empty()) point.sigma_m = std::sqrt(static_cast<double>(variance(x, y)));
      points.push_back(point);
    }
  return points;
}

Rigid3 true_pose(const Dataset& dataset, double t_s) {
  const auto pose = dataset.groundtruth().empty() ? std::nullopt : dataset.groundtruth().at(t_s);
  if (!pose)
    throw InputError(dataset.folder().string(),
                     fmt::format("knows no true pose at {} s, the time of the view", t_s));
  return *pose;
}

}  // namespace

std::vector<EstimatedView> load_depth_views(const std::filesystem::path& folder) {
  const std::filesystem::path list = folder / "views.yaml";
  if (!std::filesystem::exists(list)) return {};
  const std::vector<RunView> entries = read_view_list(list);
  std::vector<EstimatedView> views;
  views.reserve(entries.size());
  for (const RunView& entry : entries) views.push_back({entry.t_s, entry.world_from_camera, {}});
  const std::filesystem::path cloud = folder / "cloud.ply";
  const bool is_exact = std::filesystem::exists(cloud) && add_points(read_ply(cloud), cloud, views);
  for (std::size_t i = 0; i < views.size() && !is_exact; ++i)
    if (!entries[i].depth.empty()) views[i].points = read_depth_map(entries[i].depth);
  std::vector<EstimatedView> with_depth;
  for (std::size_t i = 0; i < views.size(); ++i)
    if (!entries[i].depth.empty()) with_depth.push_back(std::move(views[i]));
  return with_depth;
}

std::vector<EstimatedView> load_depth_views(const RunFolder& run, const Dataset& dataset) {
  return load_depth_views(run, dataset, dataset.facts().mean_depth_m);
}

std::vector<EstimatedView> load_depth_views(const RunFolder& run, const Dataset& dataset,
                                            const std::optional<double>& mean_depth_m) {
  std::vector<EstimatedView> views = load_depth_views(run.folder);
  if (views.empty() || run.freedom() != Alignment::kSim3) return views;
  TrajectoryScoreInput input = score_input(run, dataset);
  input.mean_depth_m = mean_depth_m;
  const double scale = truth_from_estimate(input).scale;
  for (EstimatedView& view : views) {
    view.world_from_camera = {view.world_from_camera.rotation(),
                              scale * view.world_from_camera.translation()};
    for (DepthPoint& point : view.points) {
      point.depth_m *= scale;
      if (point.sigma_m) *point.sigma_m *= scale;
    }
  }
  return views;
}

EstimatedView load_depth_map(const std::filesystem::path& file, const Dataset& dataset,
                             double t_s) {
  return {t_s, true_pose(dataset, t_s), read_depth_map(file)};
}

EstimatedView load_cloud(const std::filesystem::path& file, const Dataset& dataset, double t_s) {
  EstimatedView view{t_s, true_pose(dataset, t_s), {}};
  const PinholeCamera camera = dataset.camera().undistorted();
  const Rigid3 camera_from_world = view.world_from_camera.inverse();
  const PointCloud cloud = read_ply(file);
  const auto* sigma = find_scalar(cloud, "sigma_m");
  for (std::size_t i = 0; i < cloud.positions.size(); ++i) {
    const Eigen::Vector3d point = camera_from_world * cloud.positions[i].cast<double>();
    if (point.z() <= 0) continue;
    DepthPoint visible{camera.project(point), point.z(), std::nullopt};
    if (sigma != nullptr) visible.sigma_m = static_cast<double>((*sigma)[i]);
    if (camera.contains(visible.pixel)) view.points.push_back(visible);
  }
  return view;
}

std::vector<DepthErrors> compare_views(const std::vector<EstimatedView>& views,
                                       const Dataset& dataset) {
  std::vector<DepthErrors> errors;
  for (const EstimatedView& view : views) {
    DepthErrors of_view;
    of_view.t_s = view.t_s;
    of_view.points = view.points.size();
    if (const auto truth = depth_truth_at(dataset, view.t_s))
      of_view = compare_depth(view.points, *truth, view.t_s);
    errors.push_back(std::move(of_view));
  }
  return errors;
}

std::vector<Eigen::Vector3d> points_in_world(const std::vector<EstimatedView>& views,
                                             const PinholeCamera& camera) {
  const PinholeCamera undistorted = camera.undistorted();
  std::vector<Eigen::Vector3d> points;
  for (const EstimatedView& view : views)
    for (const DepthPoint& point : view.points)
      points.push_back(view.world_from_camera * (point.depth_m * undistorted.ray(point.pixel)));
  return points;
}

std::vector<FittedPlane> planes_of(const std::vector<EstimatedView>& views,
                                   const PinholeCamera& camera) {
  std::vector<double> depths;
  for (const EstimatedView& view : views)
    for (const DepthPoint& point : view.points) depths.push_back(point.depth_m);
  if (depths.empty()) return {};
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  return fit_planes(points_in_world(views, camera), kPlaneTolerance * *middle, kPlanes);
}

Metrics score_depth(const std::vector<EstimatedView>& views, const std::vector<DepthErrors>& errors,
                    const PinholeCamera& camera) {
  Metrics metrics;
  set_depth_scores(metrics, errors);
  std::size_t points = 0;
  for (const EstimatedView& view : views) points += view.points.size();
  const auto planes = planes_of(views, camera);
  std::size_t on_planes = 0;
  for (std::size_t i = 0; i < std::min<std::size_t>(planes.size(), 2); ++i)
    on_planes += planes[i].points.size();
  std::optional<double> angle_deg, fraction;
  if (planes.size() >= 2) {
    angle_deg = angle_between_deg(planes[0].plane, planes[1].plane);
    fraction = static_cast<double>(on_planes) / static_cast<double>(points);
  }
  metrics.set("depth.two_planes.angle_deg", angle_deg);
  metrics.set("depth.two_planes.share", fraction);
  return metrics;
}

void write_depth_views_csv(const std::filesystem::path& file,
                           const std::vector<DepthErrors>& views) {
  const std::vector<std::string> scores = {
      "points",         "rel_median",        "rel_mean",          "rmse_m",
      "delta_1_25",     "completeness",      "outlier_5_percent", "within_1_sigma",
      "within_2_sigma", "strict.rel_median", "strict.rel_mean"};
  std::vector<std::string> columns = {"t_s"};
  columns.insert(columns.end(), scores.begin(), scores.end());
  CsvTable table(columns);
  for (const DepthErrors& view : views) {
    const Metrics metrics = view_scores(view);
    std::vector<CsvTable::Cell> row = {view.t_s};
    for (const std::string& score : scores)
      row.emplace_back(metrics.get(score).value_or(std::numeric_limits<double>::quiet_NaN()));
    table.add(row);
  }
  table.save(file);
}

}  // namespace saccade

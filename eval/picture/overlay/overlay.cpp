#include "eval/picture/overlay/overlay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "core/time_search.h"
#include "eval/metrics/trajectory/scored_samples.h"
#include "eval/metrics/trajectory/trajectory_metrics.h"
#include "eval/picture/overlay/depth_occlusion.h"
#include "eval/picture/view/sensor_view.h"

namespace saccade {
namespace {

constexpr double kDefaultViewFraction = 0.25;
/// The picture is placed slightly nearer than almost all of the depths that it covers.
constexpr double kDepthPercentile = 0.02;
constexpr double kDistanceRatio = 0.97;
constexpr double kLostOpacity = 0.3;
/// With fewer depths within the picture, those of the whole view are used.
constexpr std::size_t kMinDepths = 20;

const Trajectory& poses_of(const Dataset& dataset, const RunFolder* run) {
  if (run == nullptr) {
    if (dataset.groundtruth().empty())
      throw InputError(dataset.folder().string(),
                       "has no ground truth to place a picture by; track it first and render the "
                       "run");
    return dataset.groundtruth();
  }
  if (!run->trajectory || run->trajectory->empty())
    throw InputError((run->folder / "trajectory.txt").string(),
                     "holds no pose to place a picture by");
  return *run->trajectory;
}

/// The depths [m] in the image, and those in its centre, which the picture will cover.
class DepthSamples {
 public:
  explicit DepthSamples(const PinholeCamera& camera) : camera_(camera) {}

  void add(const Eigen::Vector2d& pixel, double depth_m) {
    if (!(depth_m > 0) || !std::isfinite(depth_m) || !camera_.contains(pixel)) return;
    all_.push_back(depth_m);
    const double half_side = kDefaultViewFraction / 2 * camera_.width;
    if (std::abs(pixel.x() - camera_.cx) <= half_side &&
        std::abs(pixel.y() - camera_.cy) <= half_side)
      covered_.push_back(depth_m);
  }

  [[nodiscard]] std::optional<double> near_m() {
    std::vector<double>& depths = covered_.size() >= kMinDepths ? covered_ : all_;
    if (depths.empty()) return std::nullopt;
    const auto at = depths.begin() + static_cast<std::ptrdiff_t>(
                                         kDepthPercentile * static_cast<double>(depths.size() - 1));
    std::nth_element(depths.begin(), at, depths.end());
    return *at;
  }

 private:
  const PinholeCamera& camera_;
  std::vector<double> all_;
  std::vector<double> covered_;
};

void add_map(std::span<const Eigen::Vector3f> map_in_world, const Rigid3& world_from_camera,
             const PinholeCamera& camera, DepthSamples& samples) {
  const Rigid3 camera_from_world = world_from_camera.inverse();
  for (const Eigen::Vector3f& point : map_in_world) {
    const Eigen::Vector3d in_camera = camera_from_world * point.cast<double>();
    if (in_camera.z() > 0) samples.add(camera.project(in_camera), in_camera.z());
  }
}

void add_depth_map(const Dataset& dataset, double t_s, DepthSamples& samples) {
  const std::optional<std::size_t> nearest = nearest_file(dataset.depth_maps(), t_s);
  if (!nearest) return;
  const ImageF depth = dataset.load_depth(*nearest);
  for (int y = 0; y < depth.height(); ++y)
    for (int x = 0; x < depth.width(); ++x)
      samples.add(Eigen::Vector2d(x, y), static_cast<double>(depth(x, y)));
}

Similarity truth_from_run(const RunFolder* run, const Dataset& dataset) {
  if (run == nullptr || !run->trajectory || dataset.groundtruth().empty()) return {};
  return truth_from_estimate(score_input(*run, dataset));
}

/// The distance of the picture from the camera, in the units of the map; `scale`: metres of one.
double scene_distance(const Dataset& dataset, std::span<const Eigen::Vector3f> map_in_world,
                      const Rigid3& world_from_camera, double scale, double t_s) {
  const PinholeCamera camera = dataset.camera().undistorted();
  DepthSamples of_map(camera), of_depth(camera);
  add_map(map_in_world, world_from_camera, camera, of_map);
  if (const std::optional<double> distance = of_map.near_m()) return kDistanceRatio * *distance;
  add_depth_map(dataset, t_s, of_depth);
  const std::optional<double> distance_m =
      of_depth.near_m() ? of_depth.near_m() : dataset.facts().mean_depth_m;
  if (!distance_m)
    throw InputError(
        "--overlay",
        fmt::format("neither a map nor a depth map gives the distance of the scene at "
                    "{} s; state the pose of the picture: --overlay-pose \"x y z qx qy qz "
                    "qw\"",
                    t_s));
  return kDistanceRatio * *distance_m / scale;
}

PlanarPicture place_picture(const OverlayOptions& options, const Dataset& dataset,
                            const RunFolder* run, std::span<const Eigen::Vector3f> map_in_world,
                            double scale, double start_s) {
  const double at_s = options.at_s.value_or(start_s);
  const PinholeCamera camera = dataset.camera().undistorted();
  const Trajectory& poses = poses_of(dataset, run);
  if (options.at_s &&
      (at_s < poses.start_s() - kMaxPoseAgeS || at_s > poses.end_s() + kMaxPoseAgeS))
    throw InputError("--overlay-at-s", fmt::format("{} s is not within {:.3f} .. {:.3f} s, the "
                                                   "time of the poses",
                                                   at_s, poses.start_s(), poses.end_s()));
  const Rigid3 world_from_camera = held_pose(poses, at_s);
  PlanarPicture placed{PicturePyramid(read_image_rgba(options.picture)), {}, 1};
  double distance = 0;
  if (options.world_from_picture) {
    placed.world_from_picture = *options.world_from_picture;
    distance = (placed.world_from_picture.translation() - world_from_camera.translation()).norm();
  } else {
    distance = scene_distance(dataset, map_in_world, world_from_camera, scale, at_s);
    // On the optical axis, which need not pass through the centre of the image.
    placed.world_from_picture =
        world_from_camera * Rigid3(Eigen::Quaterniond::Identity(), {0, 0, distance});
  }
  placed.width_m =
      options.width_m.value_or(kDefaultViewFraction * camera.width * distance / camera.fx);
  if (!(placed.width_m > 0))
    throw InputError("--overlay-width",
                     "is needed where the picture is at the position of the camera");
  return placed;
}

}  // namespace

Overlay::Overlay(const OverlayOptions& options, const Dataset& dataset, const RunFolder* run,
                 std::span<const Eigen::Vector3f> map_in_world, double start_s)
    : dataset_(dataset),
      run_(run),
      options_(options),
      camera_(dataset.camera().undistorted()),
      truth_from_run_(truth_from_run(run, dataset)),
      truth_in_run_(truth_from_run_.inverse() * dataset.groundtruth()),
      picture_(place_picture(options, dataset, run, map_in_world, truth_from_run_.scale, start_s)) {
  if (!options.truth) return;
  if (run == nullptr)
    throw InputError("--overlay-truth",
                     "applies to runs; over a dataset the picture is drawn from the true pose");
  if (dataset.groundtruth().empty())
    throw InputError("--overlay-truth", dataset.folder().string() + " has no ground truth");
  if (run->freedom() != Alignment::kNone && associate(score_input(*run, dataset)).empty())
    throw InputError("--overlay-truth",
                     run->folder.string() +
                         " has a world of its own and no pose at a time of the ground truth, by "
                         "which that could be brought there");
}

bool Overlay::is_lost(double t_s) const {
  if (run_ == nullptr) return false;
  const std::optional<std::size_t> before = run_->trajectory->last_before(t_s);
  const StampedPose& pose = run_->trajectory->poses()[before.value_or(0)];
  if (std::abs(pose.t_s - t_s) > kMaxPoseAgeS) return true;
  if (!run_->poses || run_->poses->empty()) return false;
  const std::size_t until = count_until(*run_->poses, t_s, &PoseRow::t_s);
  return (*run_->poses)[until > 0 ? until - 1 : 0].status == "lost";
}

OcclusionTest Overlay::occlusion_at(double t_s) const {
  if (options_.on_top) return {};
  // The true motion where it is known: occlusion is a property of the recording, not of the
  // estimate.
  const Trajectory& truth = dataset_.groundtruth();
  std::vector<PosedDepthMap> maps =
      depth_maps_near(dataset_, truth.empty() ? poses_of(dataset_, run_) : truth, t_s);
  if (maps.empty()) return {};
  return [maps = std::move(maps), scale = truth_from_run_.scale](const Eigen::Vector3d& point) {
    return is_occluded(maps, scale * point);
  };
}

CaptionedPicture Overlay::over(CaptionedPicture drawn, double t_s, int upscale,
                               const Theme& theme) const {
  const bool lost = is_lost(t_s);
  const ScreenView view{camera_, held_pose(poses_of(dataset_, run_), t_s), upscale};
  const bool visible =
      draw_planar_picture(picture_, view, lost ? kLostOpacity : 1, occlusion_at(t_s), drawn.image);
  drawn.caption += run_ == nullptr ? ", picture: true pose" : ", picture: estimate";
  if (!visible) drawn.caption += " (not visible)";
  if (lost) {
    drawn.image = with_outline(std::move(drawn.image), picture_, view, theme.off, 2);
    drawn.caption += " LOST";
  }
  if (options_.truth) {
    const ScreenView true_view{camera_, truth_in_run_.at_clamped(t_s), upscale};
    // A line in the contrasting colour is visible on any background.
    drawn.image = with_outline(std::move(drawn.image), picture_, true_view, theme.background, 3);
    drawn.image = with_outline(std::move(drawn.image), picture_, true_view, theme.text, 1);
    drawn.caption += ", outline: true pose";
  }
  return drawn;
}

}  // namespace saccade

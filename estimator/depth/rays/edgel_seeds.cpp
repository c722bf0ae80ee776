#include "estimator/depth/rays/edgel_seeds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <opencv2/imgproc.hpp>
#include <span>
#include <utility>

#include "core/image.h"
#include "core/process/parallel.h"
#include "estimator/depth/rays/ray_votes.h"

namespace saccade {
namespace {

/// Motion of a point over the part of the window that votes on its depth: longer parts separate
/// depths better, but edges bend and are hidden on the way.
constexpr double kVotingMotion_px = 30;
/// Parallax between neighbouring planes over that part; a ridge is about as wide.
constexpr double kPlaneSpacing_px = 5;
constexpr int kMinPlanes = 8;
constexpr double kBlurSigma_px = 0.8;  ///< of the votes: about the error of a pixel's centre
constexpr double kMinVotes = 1.5;      ///< of a ridge, per pixel after the blur: above chance
/// The same, per pixel of motion: pixels that fire all the time give blobs that do not move.
constexpr double kMinVoteDensity = 0.05;
constexpr double kMinSeedVoteRatio = 0.8;  ///< to the best plane at the same pixel
constexpr double kMinAlignment = 0.1;      ///< |cos| between the normal and the motion of the rays
constexpr float kMaxOffset_px = 0.6F;      ///< of a ridge from the centre of its pixel

/// The votes of one plane and their lengths.
struct Plane {
  Image<Eigen::Vector2f> votes;
  ImageF strength;
  SweepPlane at;
};

/// Largest parallax per inverse depth [px m] of a slice's camera, anywhere in the view.
double largest_parallax(const EventRays::TimeSlice& slice, const PinholeCamera& camera) {
  double largest = 0;
  const Eigen::Vector3d o = slice.centre.cast<double>();
  for (const double u : {-camera.cx, camera.width - 1 - camera.cx})
    for (const double v : {-camera.cy, camera.height - 1 - camera.cy})
      largest = std::max(largest,
                         std::hypot(camera.fx * o.x() - o.z() * u, camera.fy * o.y() - o.z() * v));
  return largest;
}

std::vector<double> parallax_of_slices(const EventRays& rays, const PinholeCamera& camera) {
  std::vector<double> parallax;
  for (const EventRays::TimeSlice& slice : rays.slices())
    parallax.push_back(largest_parallax(slice, camera));
  return parallax;
}

void blur(Image<Eigen::Vector2f>& votes, double sigma) {
  cv::Mat view(votes.height(), votes.width(), CV_32FC2, votes.data());
  const int side = 2 * static_cast<int>(std::ceil(2.5 * sigma)) + 1;
  cv::GaussianBlur(view, view, {side, side}, sigma, sigma, cv::BORDER_CONSTANT);
}

/// Parallax of a pixel over the whole window, from which its depth is estimated.
class ParallaxSigma {
 public:
  ParallaxSigma(const EventRays& rays, const PinholeCamera& camera)
      : focal_(static_cast<float>(camera.fx), static_cast<float>(camera.fy)),
        principal_(static_cast<float>(camera.cx), static_cast<float>(camera.cy)) {
    const auto slices = rays.slices();
    Eigen::Vector3f mean = Eigen::Vector3f::Zero();
    for (const EventRays::TimeSlice& slice : slices) mean += slice.centre;
    mean /= static_cast<float>(slices.size());
    for (const EventRays::TimeSlice& slice : slices)
      covariance_ += (slice.centre - mean) * (slice.centre - mean).transpose();
    covariance_ /= static_cast<float>(slices.size());
  }
  /// Standard deviation of n . b [px m] over the slices.
  [[nodiscard]] float across(const Eigen::Vector2f& pixel, const Eigen::Vector2f& normal) const {
    const Eigen::Vector3f w(normal.x() * focal_.x(), normal.y() * focal_.y(),
                            -normal.dot(pixel - principal_));
    return std::sqrt(w.dot(covariance_ * w));
  }

 private:
  Eigen::Vector2f focal_, principal_;
  Eigen::Matrix3f covariance_ = Eigen::Matrix3f::Zero();  ///< of the camera's centre
};

class RidgeFinder {
 public:
  RidgeFinder(const EventRays& rays, const PinholeCamera& camera, double least_parallax_px)
      : rays_(rays),
        parallax_(rays, camera),
        least_parallax_px_(static_cast<float>(least_parallax_px)),
        best_(camera.width, camera.height) {
    for (Plane& plane : planes_) {
      plane.votes = Image<Eigen::Vector2f>(camera.width, camera.height);
      plane.strength = ImageF(camera.width, camera.height);
    }
  }

  /// The ridges of the planes [first, last) of a sweep.
  FoundSeeds find(std::span<const SweepPlane> sweep, std::size_t first, std::size_t last) {
    // A ridge must exceed the planes on both sides, which may belong to another part.
    const std::size_t begin = first > 0 ? first - 1 : 0;
    const std::size_t end = std::min(last + 1, sweep.size());
    for (std::size_t k = begin; k < end; ++k) {
      vote(sweep[k], planes_[2]);
      if (k > first) collect();
      std::swap(planes_[0], planes_[1]);
      std::swap(planes_[1], planes_[2]);
    }
    return std::move(found_);
  }

  /// All ridges of one plane.
  std::vector<EdgelSeed> find_on(const SweepPlane& plane) {
    vote(plane, planes_[1]);
    collect();
    return std::move(found_.seeds);
  }

  /// Maximum over the planes at each pixel.
  [[nodiscard]] const ImageF& best() const { return best_; }

 private:
  void vote(const SweepPlane& at, Plane& plane) {
    plane.at = at;
    plane.votes.fill(Eigen::Vector2f::Zero());
    const std::size_t begin = rays_.slice_begin(at.first_slice);
    const std::size_t end = rays_.slice_begin(at.last_slice);
    vote_vectors(rays_, begin, end, at.inverse_depth, plane.votes);
    blur(plane.votes, kBlurSigma_px);
    for (std::size_t i = 0; i < plane.strength.size(); ++i) {
      const float strength = plane.votes.pixels()[i].norm();
      plane.strength.pixels()[i] = strength;
      best_.pixels()[i] = std::max(best_.pixels()[i], strength);
    }
  }

  /// Adds the ridges of the middle plane that exceed the planes on both sides.
  void collect() {
    const ImageF& strength = planes_[1].strength;
    const float least = std::max(static_cast<float>(kMinVotes),
                                 static_cast<float>(kMinVoteDensity) * planes_[1].at.motion_px);
    for (int y = 1; y + 1 < strength.height(); ++y)
      for (int x = 1; x + 1 < strength.width(); ++x) {
        const float s = strength(x, y);
        if (s < least || s < planes_[0].strength(x, y) || s < planes_[2].strength(x, y)) continue;
        add_ridge(x, y, least);
      }
  }

  /// Steger's ridge: the largest eigenvector of the Hessian crosses it, the parabola along it has
  /// its top within the pixel.
  void add_ridge(int x, int y, float least) {
    const ImageF& s = planes_[1].strength;
    const Eigen::Vector2f gradient((s(x + 1, y) - s(x - 1, y)) / 2,
                                   (s(x, y + 1) - s(x, y - 1)) / 2);
    const float xx = s(x + 1, y) - 2 * s(x, y) + s(x - 1, y);
    const float yy = s(x, y + 1) - 2 * s(x, y) + s(x, y - 1);
    const float xy = (s(x + 1, y + 1) - s(x + 1, y - 1) - s(x - 1, y + 1) + s(x - 1, y - 1)) / 4;
    const float half = (xx - yy) / 2;
    const float root = std::sqrt(half * half + xy * xy);
    const float lowest = (xx + yy) / 2 - root;
    if (!(lowest < 0)) return;
    // (H - lowest) n = 0, from the row that is farther from 0.
    Eigen::Vector2f normal =
        half < 0 ? Eigen::Vector2f(root - half, -xy) : Eigen::Vector2f(-xy, root + half);
    normal = normal.squaredNorm() > 0 ? normal.normalized() : Eigen::Vector2f(1, 0);
    const float offset = -gradient.dot(normal) / lowest;
    if (std::abs(offset * normal.x()) > kMaxOffset_px ||
        std::abs(offset * normal.y()) > kMaxOffset_px)
      return;
    const Eigen::Vector2f& vote = planes_[1].votes(x, y);
    const float along = normal.dot(vote);
    if (std::abs(along) < static_cast<float>(kMinAlignment) * s(x, y)) return;
    if (along < 0) normal = -normal;
    const Eigen::Vector2f pixel =
        Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y)) +
        std::abs(offset) * (gradient.dot(normal) > 0 ? normal : Eigen::Vector2f(-normal));
    const float parallax_px = parallax_.across(pixel, normal) * planes_[1].at.inverse_depth;
    if (parallax_px < least_parallax_px_) {
      ++found_.still;
      return;
    }
    found_.seeds.push_back({pixel, normal, planes_[1].at.inverse_depth, s(x, y), s(x, y) / least, 1,
                            parallax_px, planes_[1].at});
  }

  const EventRays& rays_;
  ParallaxSigma parallax_;
  float least_parallax_px_;
  std::array<Plane, 3> planes_;  ///< the last three planes
  ImageF best_;                  ///< over all planes
  FoundSeeds found_;
};

float value_near(const ImageF& image, const Eigen::Vector2f& pixel) {
  const int x = static_cast<int>(std::lround(pixel.x()));
  const int y = static_cast<int>(std::lround(pixel.y()));
  return image(std::clamp(x, 0, image.width() - 1), std::clamp(y, 0, image.height() - 1));
}

/// The slices around the reference time in each of which a point moves by at most `allowed` [px m].
SweepPlane plane_over(const EventRays& rays, std::span<const double> parallax, double inverse_depth,
                      double allowed) {
  const int middle = rays.reference_slice();
  SweepPlane plane{static_cast<float>(inverse_depth), 0, 0, middle, middle + 1};
  const auto fits = [&](int slice) { return parallax[static_cast<std::size_t>(slice)] <= allowed; };
  while (plane.first_slice > 0 && fits(plane.first_slice - 1)) --plane.first_slice;
  while (plane.last_slice < rays.slice_count() && fits(plane.last_slice)) ++plane.last_slice;
  return plane;
}

/// Bounds of parts of a sweep of about equal cost: 0, ..., its size.
std::vector<std::size_t> cut(std::span<const SweepPlane> sweep, int parts) {
  constexpr int kBlurSlices = 4;  // the cost of the blur of a plane, in slices
  const auto work = [](const SweepPlane& plane) {
    return plane.last_slice - plane.first_slice + kBlurSlices;
  };
  int left = 0;
  for (const SweepPlane& plane : sweep) left += work(plane);
  std::vector<std::size_t> cuts{0};
  int done = 0;
  for (std::size_t k = 0; k < sweep.size(); ++k) {
    done += work(sweep[k]);
    const auto parts_left = parts - static_cast<int>(cuts.size()) + 1;
    if (parts_left < 2 || done * parts_left < left) continue;
    cuts.push_back(k + 1);
    left -= done;
    done = 0;
  }
  if (cuts.back() < sweep.size()) cuts.push_back(sweep.size());
  return cuts;
}

}  // namespace

std::vector<SweepPlane> sweep_planes(const EventRays& rays, const PinholeCamera& camera,
                                     const DepthLimits& limits) {
  if (rays.slices().empty()) return {};
  const std::vector<double> parallax = parallax_of_slices(rays, camera);
  std::vector<SweepPlane> planes;
  for (double rho = limits.min_inverse(); rho < limits.max_inverse();) {
    SweepPlane plane = plane_over(rays, parallax, rho, kVotingMotion_px / (2 * rho));
    double widest = 1e-9;
    for (int k = plane.first_slice; k < plane.last_slice; ++k)
      widest = std::max(widest, parallax[static_cast<std::size_t>(k)]);
    // Little motion needs few planes, but enough to separate far from near.
    const double range = limits.max_inverse() - limits.min_inverse();
    const double spacing = std::min(kPlaneSpacing_px / (2 * widest), range / kMinPlanes);
    plane.spacing = static_cast<float>(spacing);
    plane.motion_px = static_cast<float>(2 * widest * rho);
    planes.push_back(plane);
    rho += spacing;
  }
  return planes;
}

FoundSeeds find_seeds(const EventRays& rays, const PinholeCamera& camera, const DepthLimits& limits,
                      double least_parallax_px) {
  if (rays.size() == 0) return {};
  const std::vector<SweepPlane> sweep = sweep_planes(rays, camera, limits);
  // Each thread takes a part of the sweep. Planes at the bounds are voted for twice; the result is the
  // same for any number of parts.
  const std::vector<std::size_t> cuts = cut(sweep, thread_count());
  const std::size_t parts = cuts.size() - 1;
  std::vector<RidgeFinder> finders(parts, RidgeFinder(rays, camera, least_parallax_px));
  std::vector<FoundSeeds> found(parts);
  parallel_for(parts,
               [&](std::size_t i) { found[i] = finders[i].find(sweep, cuts[i], cuts[i + 1]); });
  ImageF best(camera.width, camera.height);
  for (const RidgeFinder& finder : finders)
    for (std::size_t i = 0; i < best.size(); ++i)
      best.pixels()[i] = std::max(best.pixels()[i], finder.best().pixels()[i]);
  FoundSeeds all;
  for (const FoundSeeds& part : found) {
    all.still += part.still;
    for (EdgelSeed seed : part.seeds) {
      seed.vote_ratio = seed.score / value_near(best, seed.pixel);
      if (seed.vote_ratio >= static_cast<float>(kMinSeedVoteRatio)) all.seeds.push_back(seed);
    }
  }
  return all;
}

std::vector<EdgelSeed> find_seeds_at(const EventRays& rays, const PinholeCamera& camera,
                                     double inverse_depth, double relative_sigma) {
  if (rays.size() == 0) return {};
  constexpr double kMaxError_px = 1;
  const std::vector<double> parallax = parallax_of_slices(rays, camera);
  const double allowed = kMaxError_px / (relative_sigma * inverse_depth);
  if (parallax[static_cast<std::size_t>(rays.reference_slice())] > allowed) return {};
  constexpr double kAnyParallax_px = 0;
  return RidgeFinder(rays, camera, kAnyParallax_px)
      .find_on(plane_over(rays, parallax, inverse_depth, allowed));
}

}  // namespace saccade

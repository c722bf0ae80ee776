#include "estimator/depth/edge_seeds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <opencv2/imgproc.hpp>
#include <span>
#include <utility>

#include "core/image.h"
#include "core/process/parallel.h"
#include "estimator/depth/ray_votes.h"

namespace saccade {
namespace {

constexpr int kMinPlanes = 8;
constexpr float kMaxOffset_px = 0.6F;  ///< of a ridge from the centre of its pixel

/// The votes of one plane and their lengths.
struct Plane {
  Image<Eigen::Vector2f> votes;
  ImageF strength;
  SweepPlane at;
};

/// Largest parallax per inverse depth [px m] of a slab's camera, anywhere in the view.
double largest_parallax(const EventRays::Slab& slab, const PinholeCamera& camera) {
  double largest = 0;
  const Eigen::Vector3d o = slab.centre.cast<double>();
  for (const double u : {-camera.cx, camera.width - 1 - camera.cx})
    for (const double v : {-camera.cy, camera.height - 1 - camera.cy})
      largest = std::max(largest,
                         std::hypot(camera.fx * o.x() - o.z() * u, camera.fy * o.y() - o.z() * v));
  return largest;
}

void blur(Image<Eigen::Vector2f>& votes, double sigma) {
  cv::Mat view(votes.height(), votes.width(), CV_32FC2, votes.data());
  const int side = 2 * static_cast<int>(std::ceil(2.5 * sigma)) + 1;
  cv::GaussianBlur(view, view, {side, side}, sigma, sigma, cv::BORDER_CONSTANT);
}

/// How far the rays of a place spread, over the whole window, as its depth changes: what there is
/// to tell the depth from.
class ParallaxSpread {
 public:
  ParallaxSpread(const EventRays& rays, const PinholeCamera& camera)
      : focal_(static_cast<float>(camera.fx), static_cast<float>(camera.fy)),
        principal_(static_cast<float>(camera.cx), static_cast<float>(camera.cy)) {
    const auto slabs = rays.slabs();
    Eigen::Vector3f mean = Eigen::Vector3f::Zero();
    for (const EventRays::Slab& slab : slabs) mean += slab.centre;
    mean /= static_cast<float>(slabs.size());
    for (const EventRays::Slab& slab : slabs)
      covariance_ += (slab.centre - mean) * (slab.centre - mean).transpose();
    covariance_ /= static_cast<float>(slabs.size());
  }
  /// Deviation of n . b [px m] over the slabs.
  [[nodiscard]] float across(const Eigen::Vector2f& pixel, const Eigen::Vector2f& normal) const {
    const Eigen::Vector3f w(normal.x() * focal_.x(), normal.y() * focal_.y(),
                            -normal.dot(pixel - principal_));
    return std::sqrt(w.dot(covariance_ * w));
  }

 private:
  Eigen::Vector2f focal_, principal_;
  Eigen::Matrix3f covariance_ = Eigen::Matrix3f::Zero();  ///< of the camera's centre
};

class SeedFinder {
 public:
  SeedFinder(const EventRays& rays, const PinholeCamera& camera, const SeedOptions& options)
      : rays_(rays),
        options_(options),
        parallax_(rays, camera),
        best_(camera.width, camera.height) {
    for (Plane& plane : planes_) {
      plane.votes = Image<Eigen::Vector2f>(camera.width, camera.height);
      plane.strength = ImageF(camera.width, camera.height);
    }
  }

  /// The ridges of the planes [first, last) of a sweep; their shares are those of best().
  std::vector<EdgeSeed> find(std::span<const SweepPlane> sweep, std::size_t first,
                             std::size_t last) {
    // A ridge is stronger than the planes on both sides, which may be others' to collect.
    const std::size_t begin = first > 0 ? first - 1 : 0;
    const std::size_t end = std::min(last + 1, sweep.size());
    for (std::size_t k = begin; k < end; ++k) {
      vote(sweep[k], planes_[2]);
      if (k > first) collect();
      std::swap(planes_[0], planes_[1]);
      std::swap(planes_[1], planes_[2]);
    }
    return std::move(seeds_);
  }

  /// Most that any of the planes has at each pixel.
  [[nodiscard]] const ImageF& best() const { return best_; }

 private:
  void vote(const SweepPlane& at, Plane& plane) {
    plane.at = at;
    plane.votes.fill(Eigen::Vector2f::Zero());
    const std::size_t begin = rays_.slab_begin(at.first_slab);
    const std::size_t end = rays_.slab_begin(at.last_slab);
    if (options_.votes == SeedOptions::Votes::kVector)
      vote_vectors(rays_, begin, end, at.inverse_depth, plane.votes);
    else
      vote_counts(rays_, begin, end, at.inverse_depth, plane.votes);
    blur(plane.votes, options_.blur_px);
    for (std::size_t i = 0; i < plane.strength.size(); ++i) {
      const float strength = plane.votes.pixels()[i].norm();
      plane.strength.pixels()[i] = strength;
      best_.pixels()[i] = std::max(best_.pixels()[i], strength);
    }
  }

  /// The ridges of the middle plane that are stronger than the planes on both sides.
  void collect() {
    const ImageF& strength = planes_[1].strength;
    const float least =
        std::max(static_cast<float>(options_.min_votes),
                 static_cast<float>(options_.min_density) * planes_[1].at.motion_px);
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
    const Eigen::Vector2f& rise = planes_[1].votes(x, y);
    const float along = normal.dot(rise);
    if (std::abs(along) < static_cast<float>(options_.min_alignment) * s(x, y)) return;
    if (along < 0) normal = -normal;
    const Eigen::Vector2f pixel =
        Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y)) +
        std::abs(offset) * (gradient.dot(normal) > 0 ? normal : Eigen::Vector2f(-normal));
    const float parallax_px = parallax_.across(pixel, normal) * planes_[1].at.inverse_depth;
    if (parallax_px < static_cast<float>(options_.min_parallax_px)) return;
    seeds_.push_back({pixel, normal, planes_[1].at.inverse_depth, s(x, y), s(x, y) / least, 1,
                      parallax_px, planes_[1].at});
  }

  const EventRays& rays_;
  const SeedOptions& options_;
  ParallaxSpread parallax_;
  std::array<Plane, 3> planes_;  ///< the last three
  ImageF best_;                  ///< over all planes
  std::vector<EdgeSeed> seeds_;
};

float value_near(const ImageF& image, const Eigen::Vector2f& pixel) {
  const int x = static_cast<int>(std::lround(pixel.x()));
  const int y = static_cast<int>(std::lround(pixel.y()));
  return image(std::clamp(x, 0, image.width() - 1), std::clamp(y, 0, image.height() - 1));
}

/// Where to cut a sweep into parts of about as much work: 0, ..., its size.
std::vector<std::size_t> cut(std::span<const SweepPlane> sweep, int parts) {
  constexpr int kBlurSlabs = 4;  // as long as the blur of a plane takes
  const auto work = [](const SweepPlane& plane) {
    return plane.last_slab - plane.first_slab + kBlurSlabs;
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
                                     const DepthLimits& limits, const SeedOptions& options) {
  const auto slabs = rays.slabs();
  if (slabs.empty()) return {};
  std::vector<double> parallax;
  for (const EventRays::Slab& slab : slabs) parallax.push_back(largest_parallax(slab, camera));
  const int middle = rays.reference_slab();
  std::vector<SweepPlane> planes;
  for (double rho = limits.min_inverse(); rho < limits.max_inverse();) {
    const double allowed = options.motion_px / (2 * rho);
    const auto fits = [&](int slab) { return parallax[static_cast<std::size_t>(slab)] <= allowed; };
    SweepPlane plane{static_cast<float>(rho), 0, 0, middle, middle + 1};
    while (plane.first_slab > 0 && fits(plane.first_slab - 1)) --plane.first_slab;
    while (plane.last_slab < rays.slab_count() && fits(plane.last_slab)) ++plane.last_slab;
    double widest = 1e-9;
    for (int k = plane.first_slab; k < plane.last_slab; ++k)
      widest = std::max(widest, parallax[static_cast<std::size_t>(k)]);
    // Little motion needs few planes, but not fewer than tell far from near.
    const double range = limits.max_inverse() - limits.min_inverse();
    const double step = std::min(options.spacing_px / (2 * widest), range / kMinPlanes);
    plane.step = static_cast<float>(step);
    plane.motion_px = static_cast<float>(2 * widest * rho);
    planes.push_back(plane);
    rho += step;
  }
  return planes;
}

std::vector<EdgeSeed> find_seeds(const EventRays& rays, const PinholeCamera& camera,
                                 const DepthLimits& limits, const SeedOptions& options) {
  if (rays.size() == 0) return {};
  const std::vector<SweepPlane> sweep = sweep_planes(rays, camera, limits, options);
  // Each thread a part of the sweep: where it is cut, planes are voted for twice, and nothing else
  // changes.
  const std::vector<std::size_t> cuts = cut(sweep, thread_count());
  const std::size_t parts = cuts.size() - 1;
  std::vector<SeedFinder> finders(parts, SeedFinder(rays, camera, options));
  std::vector<std::vector<EdgeSeed>> found(parts);
  parallel_for(parts,
               [&](std::size_t i) { found[i] = finders[i].find(sweep, cuts[i], cuts[i + 1]); });
  ImageF best(camera.width, camera.height);
  for (const SeedFinder& finder : finders)
    for (std::size_t i = 0; i < best.size(); ++i)
      best.pixels()[i] = std::max(best.pixels()[i], finder.best().pixels()[i]);
  std::vector<EdgeSeed> seeds;
  for (const std::vector<EdgeSeed>& part : found)
    for (EdgeSeed seed : part) {
      seed.share = seed.score / value_near(best, seed.pixel);
      if (seed.share >= static_cast<float>(options.min_share)) seeds.push_back(seed);
    }
  return seeds;
}

}  // namespace saccade

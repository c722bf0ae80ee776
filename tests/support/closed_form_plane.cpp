#include "tests/support/closed_form_plane.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>
#include <optional>

#include "core/io/images/exr_file.h"

namespace saccade::testing {
namespace {

/// value = c0 + c1 s + c2 s^2.
struct Quadratic {
  double c0, c1, c2;

  [[nodiscard]] double at(double s) const { return c0 + s * (c1 + s * c2); }

  /// The smallest s in (after, until] with value = level.
  [[nodiscard]] std::optional<double> first_root(double level, double after, double until) const {
    std::array<double, 2> roots{std::numeric_limits<double>::infinity(),
                                std::numeric_limits<double>::infinity()};
    const double c = c0 - level;
    const double discriminant = c1 * c1 - 4 * c2 * c;
    if (discriminant < 0) return std::nullopt;
    const double q = -0.5 * (c1 + std::copysign(std::sqrt(discriminant), c1));
    if (c2 != 0) roots[0] = q / c2;
    if (q != 0) roots[1] = c / q;
    std::sort(roots.begin(), roots.end());
    for (const double s : roots)
      if (s > after && s <= until) return s;
    return std::nullopt;
  }
};

/// Straight path through the texture: texel(t) = origin + t * step, exact crossings per cell.
class PixelPath {
 public:
  PixelPath(const ImageF& texture, const Eigen::Vector2d& origin, const Eigen::Vector2d& step)
      : texture_(texture), origin_(origin), step_(step) {}

  /// Times within (0, end) at which the path enters another cell, sorted, and the end.
  [[nodiscard]] std::vector<double> cell_ends(double end) const {
    std::vector<double> times{end};
    for (int axis = 0; axis < 2; ++axis) {
      if (step_[axis] == 0) continue;
      const double a = origin_[axis];
      const double b = a + step_[axis] * end;
      for (double line = std::ceil(std::min(a, b)); line <= std::max(a, b); ++line) {
        const double t = (line - a) / step_[axis];
        if (t > 0 && t < end) times.push_back(t);
      }
    }
    std::sort(times.begin(), times.end());
    return times;
  }

  /// Radiance as a function of t in the cell that holds the path's point at `t`.
  [[nodiscard]] Quadratic radiance_near(double t) const {
    const Eigen::Vector2d p = origin_ + t * step_;
    const int x0 = static_cast<int>(std::floor(p.x()));
    const int y0 = static_cast<int>(std::floor(p.y()));
    const double a = texture_(x0, y0);
    const double b = texture_(x0 + 1, y0) - a;
    const double c = texture_(x0, y0 + 1) - a;
    const double d = texture_(x0 + 1, y0 + 1) - a - b - c;
    const double x = origin_.x() - x0;
    const double y = origin_.y() - y0;
    return {a + b * x + c * y + d * x * y,
            b * step_.x() + c * step_.y() + d * (x * step_.y() + y * step_.x()),
            d * step_.x() * step_.y()};
  }

 private:
  const ImageF& texture_;
  Eigen::Vector2d origin_, step_;
};

}  // namespace

ClosedFormPlane ClosedFormPlane::smooth(int width, int height) {
  ClosedFormPlane plane;
  plane.camera = {width, height, 100, 100, 0.5 * (width - 1), 0.5 * (height - 1), {}};
  plane.texture = ImageF(256, 256);
  constexpr std::array<std::array<double, 3>, 8> kWaves{{{8.3, 0.2, 0.1},
                                                         {9.7, 1.9, 1.2},
                                                         {13.1, 2.7, 2.9},
                                                         {17.9, 0.9, 0.4},
                                                         {23.3, 1.4, 4.1},
                                                         {31.7, 2.3, 5.2},
                                                         {47.1, 0.5, 3.3},
                                                         {71.9, 3.0, 2.2}}};
  for (int j = 0; j < 256; ++j)
    for (int i = 0; i < 256; ++i) {
      double sum = 0;
      for (const auto& [wavelength, direction, phase] : kWaves)
        sum += std::sin(2 * std::numbers::pi / wavelength *
                            (i * std::cos(direction) + j * std::sin(direction)) +
                        phase);
      plane.texture(i, j) = static_cast<float>(0.5 * std::exp(0.35 * sum));
    }
  plane.start = {-0.8, -0.4};
  plane.velocity = {1.3, 0.57};
  return plane;
}

std::filesystem::path ClosedFormPlane::write_mesh(const std::filesystem::path& folder) const {
  std::filesystem::create_directories(folder);
  write_exr(folder / "plane.exr", texture, "Y");
  std::ofstream(folder / "plane.mtl") << "newmtl plane\nKd 1 1 1\nmap_Kd plane.exr\n";
  const double x = 0.5 * texture.width() * metres_per_texel;
  const double y = 0.5 * texture.height() * metres_per_texel;
  std::ofstream obj(folder / "plane.obj");
  obj << "mtllib plane.mtl\nusemtl plane\n";
  obj << "v " << -x << ' ' << -y << ' ' << distance_m << "\nv " << x << ' ' << -y << ' '
      << distance_m << "\nv " << x << ' ' << y << ' ' << distance_m << "\nv " << -x << ' ' << y
      << ' ' << distance_m << "\n";
  obj << "vt 0 1\nvt 1 1\nvt 1 0\nvt 0 0\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n";
  return folder / "plane.obj";
}

Spline ClosedFormPlane::motion() const {
  std::vector<StampedPose> poses(2);
  for (std::size_t k = 0; k < 2; ++k) {
    poses[k].t_s = static_cast<double>(k) * duration_s;
    const Eigen::Vector2d p = start + poses[k].t_s * velocity;
    poses[k].world_from_camera = Rigid3(Eigen::Quaterniond::Identity(), {p.x(), p.y(), 0});
  }
  return Spline::interpolate(poses);
}

Eigen::Vector2d ClosedFormPlane::texel(double x, double y, double t_s) const {
  const Eigen::Vector3d ray = camera.ray({x, y});
  const Eigen::Vector2d point = start + t_s * velocity + distance_m * ray.head<2>();
  return point / metres_per_texel +
         0.5 * Eigen::Vector2d(texture.width() - 1, texture.height() - 1);
}

std::vector<ExactEvent> ClosedFormPlane::events(double contrast_on, double contrast_off,
                                                double log_eps) const {
  std::vector<ExactEvent> events;
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const Eigen::Vector2d origin = texel(x, y, 0);
      const PixelPath path(texture, origin, velocity / metres_per_texel);
      double reference = std::log(log_eps + path.radiance_near(0).at(0));
      double t = 0;
      double cell_start = 0;
      for (const double cell_end : path.cell_ends(duration_s)) {
        const Quadratic radiance = path.radiance_near(0.5 * (cell_start + cell_end));
        while (true) {
          const auto on =
              radiance.first_root(std::exp(reference + contrast_on) - log_eps, t, cell_end);
          const auto off =
              radiance.first_root(std::exp(reference - contrast_off) - log_eps, t, cell_end);
          if (!on && !off) break;
          const bool is_on = on && (!off || *on < *off);
          t = is_on ? *on : *off;
          reference += is_on ? contrast_on : -contrast_off;
          events.push_back({t, x, y, is_on ? 1 : -1});
        }
        t = std::max(t, cell_end);
        cell_start = cell_end;
      }
    }
  return events;
}

ExactMatch match_exact(const std::vector<ExactEvent>& expected, const Events& found, int width,
                       int height) {
  using Sequence = std::vector<std::pair<double, int>>;
  const auto pixels = static_cast<std::size_t>(width * height);
  std::vector<Sequence> truth(pixels);
  std::vector<Sequence> seen(pixels);
  for (const ExactEvent& e : expected)
    truth[static_cast<std::size_t>(e.y * width + e.x)].emplace_back(e.t_s, e.polarity);
  for (const Event& e : found)
    seen[static_cast<std::size_t>(e.y * width + e.x)].emplace_back(seconds_from_ns(e.t_ns),
                                                                   e.polarity);
  ExactMatch match;
  match.expected = expected.size();
  match.found = found.size();
  std::vector<double> errors_us;
  for (std::size_t i = 0; i < pixels; ++i) {
    const auto same_polarity = [](const auto& a, const auto& b) { return a.second == b.second; };
    if (!std::equal(truth[i].begin(), truth[i].end(), seen[i].begin(), seen[i].end(),
                    same_polarity)) {
      ++match.wrong_pixels;
      continue;
    }
    for (std::size_t k = 0; k < truth[i].size(); ++k)
      errors_us.push_back(1e6 * std::abs(truth[i][k].first - seen[i][k].first));
  }
  if (errors_us.empty()) return match;
  std::sort(errors_us.begin(), errors_us.end());
  match.median_us = errors_us[errors_us.size() / 2];
  match.p99_us = errors_us[errors_us.size() * 99 / 100];
  match.max_us = errors_us.back();
  return match;
}

}  // namespace saccade::testing

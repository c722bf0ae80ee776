#pragma once

#include <algorithm>
#include <cmath>

#include "simulator/scene/scene.h"

namespace saccade {

/// What a ray sees of one triangle, under the same lights, from one instant to a later one: the
/// parabolas in time through three samples, with u = 0..1 from the first to the last
///   v(u) = v0 + u (4 vm - 3 v0 - v1) + 2 u^2 (v0 - 2 vm + v1)
/// of the texel, the pyramid's level, the irradiance and what is mirrored. They are many times
/// cheaper than the triangle, the pose and the lights.
class SurfaceArc {
 public:
  /// `middle` is seen halfway from `from_s` to `to_s` > from_s. All are of one triangle.
  SurfaceArc(double from_s, double to_s, const SurfaceSample& from, const SurfaceSample& middle,
             const SurfaceSample& to)
      : from_s_(from_s),
        per_s_(1 / (to_s - from_s)),
        texture_(from.texture),
        x_(from.x, middle.x, to.x),
        y_(from.y, middle.y, to.y),
        light_(light_of(from), light_of(middle), light_of(to)),
        mirrored_(from.mirrored, middle.mirrored, to.mirrored),
        level_(from.level, middle.level, to.level) {
    const double bend = std::max(std::abs(x_.c), std::abs(y_.c));
    const double way = std::max(std::abs(x_.b + x_.c), std::abs(y_.b + y_.c));
    is_smooth_ = from.distance > 0 && middle.distance > 0 && to.distance > 0 &&
                 bend <= kMostBend * way + kLeastBend;
  }

  /// Whether the parabolas can stand for the path: all three rays end on the triangle's plane, and
  /// it turns little. Rays that graze the plane turn fast.
  [[nodiscard]] bool is_smooth() const { return is_smooth_; }

  /// Within the arc.
  [[nodiscard]] double radiance_at(double t_s) const {
    const double u = (t_s - from_s_) * per_s_;
    const double x = x_.at(u);
    if (texture_ == nullptr) return light_.at(u) * x + mirrored_.at(u);
    const double level = level_.at(u);
    return light_.at(u) * (level > 0 ? texture_->at_texel(x, y_.at(u), level)
                                     : texture_->at_texel(x, y_.at(u))) +
           mirrored_.at(u);
  }
  /// When the ray first comes to other texels after `t_s`, or `end_s` where that is earlier: until
  /// then the texture is bilinear along its way.
  [[nodiscard]] double next_border_s(double t_s, double end_s) const {
    if (texture_ == nullptr) return end_s;
    const double u = (t_s - from_s_) * per_s_;
    double next = (end_s - from_s_) * per_s_;
    const double level = level_.at(u + kOnBorder);
    if (level_.a > 0 || level_.a + level_.b + level_.c > 0) {
      // Where other pictures of the pyramid come in.
      const double from = u + kOnBorder;
      next = level_.first_at(std::floor(level), from, next);
      next = level_.first_at(std::floor(level) + 1, from, next);
    }
    if (level > 0) {
      // Between two pictures of the pyramid, whose borders are those of neither.
      const auto finer = std::min(static_cast<std::size_t>(level), texture_->level_count() - 1);
      for (std::size_t k = finer; k < std::min(finer + 2, texture_->level_count()); ++k) {
        const Texture& picture = texture_->level(k);
        next = std::min(next, border_of(x_, scale_of(picture.width(), texture_->width()), u, next));
        next =
            std::min(next, border_of(y_, scale_of(picture.height(), texture_->height()), u, next));
      }
    } else {
      next = border_of(y_, 1, u, border_of(x_, 1, u, next));
    }
    return std::min(end_s, from_s_ + next / per_s_);
  }

 private:
  /// Through values at 0, 1/2 and 1.
  struct Parabola {
    double a = 0, b = 0, c = 0;
    Parabola() = default;
    Parabola(double from, double middle, double to)
        : a(from), b(4 * middle - 3 * from - to), c(2 * (from - 2 * middle + to)) {}
    [[nodiscard]] double at(double u) const { return a + u * (b + u * c); }

    /// Texel coordinates of a picture of `scale` times the size.
    [[nodiscard]] Parabola scaled(double scale) const {
      Parabola result;
      result.a = scale == 1 ? a : (a + 0.5) * scale - 0.5;
      result.b = b * scale;
      result.c = c * scale;
      return result;
    }
    /// The first place from `from` on, up to `next`, at which it is `value`; `next` where none is.
    [[nodiscard]] double first_at(double value, double from, double next) const {
      const double discriminant = b * b - 4 * c * (a - value);
      if (discriminant < 0) return next;
      // Both roots without cancellation.
      const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
      const double first = (a - value) / q;
      const double second = q / c;
      if (first > from && first < next) next = first;
      if (second > from && second < next) next = second;
      return next;
    }
  };

  /// Borders nearer than this part of the arc are passed over: there the ray is just on one.
  static constexpr double kOnBorder = 1e-6;

  [[nodiscard]] static double scale_of(int size, int whole) {
    return static_cast<double>(size) / static_cast<double>(whole);
  }

  /// The first place up to `next` at which the coordinate of a picture of `scale` times the size
  /// comes to the next texel.
  [[nodiscard]] static double border_of(const Parabola& path, double scale, double u, double next) {
    const Parabola scaled = path.scaled(scale);
    const double from = u + kOnBorder;
    const double texel = std::floor(scaled.at(from));
    return scaled.first_at(texel + 1, from, scaled.first_at(texel, from, next));
  }

  /// The path is off the parabola by about the square of its bend, a thirtieth of that: at most
  /// 3e-4 of its way.
  static constexpr double kMostBend = 0.2;
  static constexpr double kLeastBend = 1e-3;  ///< [texel]

  /// What the texture's value, or the albedo, is multiplied by.
  [[nodiscard]] static double light_of(const SurfaceSample& seen) {
    return seen.texture != nullptr ? seen.factor * seen.irradiance : seen.irradiance;
  }

  double from_s_ = 0;
  double per_s_ = 0;
  bool is_smooth_ = true;
  const Texture* texture_ = nullptr;
  Parabola x_, y_, light_, mirrored_, level_;
};

}  // namespace saccade

#include "estimator/edges/least_squares/edge_rows.h"

namespace saccade {
namespace {

using Lanes3 = std::array<DoubleLanes, 3>;

DoubleLanes all(double value) { return DoubleLanes{} + value; }

DoubleLanes dot(const Lanes3& a, const Lanes3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Lanes3 cross(const Lanes3& a, const Lanes3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// a + s b.
Lanes3 plus(const Lanes3& a, const DoubleLanes& s, const Lanes3& b) {
  return {a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]};
}

Lanes3 rotated(const std::array<DoubleLanes, 9>& r, const Lanes3& v) {
  return {r[0] * v[0] + r[1] * v[1] + r[2] * v[2], r[3] * v[0] + r[4] * v[1] + r[5] * v[2],
          r[6] * v[0] + r[7] * v[1] + r[8] * v[2]};
}

Lanes3 rotated_back(const std::array<DoubleLanes, 9>& r, const Lanes3& v) {
  return {r[0] * v[0] + r[3] * v[1] + r[6] * v[2], r[1] * v[0] + r[4] * v[1] + r[7] * v[2],
          r[2] * v[0] + r[5] * v[1] + r[8] * v[2]};
}

constexpr std::size_t kTerms = 11;  ///< of a series: x^11 / 25! is below rounding

/// (-1)^n / (2 n + first)!.
constexpr std::array<double, kTerms> series_from(int first) {
  std::array<double, kTerms> coefficients{};
  double factorial = 1;
  for (int k = 2; k <= first; ++k) factorial *= k;
  for (std::size_t n = 0; n < kTerms; ++n) {
    coefficients[n] = (n % 2 == 0 ? 1 : -1) / factorial;
    const double next = 2 * static_cast<double>(n) + first;
    factorial *= (next + 1) * (next + 2);
  }
  return coefficients;
}

constexpr std::array<double, kTerms> kB = series_from(2), kC = series_from(3);

/// The functions of x = theta^2 of which SO(3)'s exponential and its Jacobian consist,
///   B = (1 - cos theta) / x,  C = (theta - sin theta) / theta^3,  sin theta / theta = 1 - x C,
/// by their series, which need no case for small angles. Exact to rounding for angles to pi / 2: a
/// correction of a path is far below.
struct RotationSeries {
  DoubleLanes a, b, c;  ///< a: sin theta / theta

  explicit RotationSeries(const DoubleLanes& x) {
    b = all(kB.back());
    c = all(kC.back());
    for (std::size_t n = kTerms - 1; n-- > 0;) {
      b = b * x + kB[n];
      c = c * x + kC[n];
    }
    a = 1 - x * c;
  }

  /// Their derivatives by x, twice.
  [[nodiscard]] static std::array<DoubleLanes, 2> twice_slopes(const DoubleLanes& x) {
    constexpr std::size_t kLast = kTerms - 1;
    DoubleLanes b = all(2.0 * kLast * kB[kLast]), c = all(2.0 * kLast * kC[kLast]);
    for (std::size_t n = kLast; n-- > 1;) {
      b = b * x + 2.0 * static_cast<double>(n) * kB[n];
      c = c * x + 2.0 * static_cast<double>(n) * kC[n];
    }
    return {b, c};
  }
};

/// u + a w x u + b w x (w x u).
Lanes3 combined(const Lanes3& u, const DoubleLanes& a, const DoubleLanes& b, const Lanes3& w) {
  const Lanes3 once = cross(w, u);
  return plus(plus(u, a, once), b, cross(w, once));
}

/// What the residual is made of: the event's line in the edge's view, after the motion.
struct MovedEvent {
  Lanes3 v, w;  ///< the motion
  DoubleLanes squared_angle;
  RotationSeries series;
  Lanes3 direction;  ///< R' q
  Lanes3 origin;     ///< o'

  template <int kSupport>
  MovedEvent(const EventLanes<kSupport>& events, const std::array<DoubleLanes, 6>& motion)
      : v{motion[0], motion[1], motion[2]},
        w{motion[3], motion[4], motion[5]},
        squared_angle(dot(w, w)),
        series(squared_angle) {
    const Lanes3 ray = {events.ray[0], events.ray[1], all(1)};
    direction = rotated(events.rotation, combined(ray, series.a, series.b, w));
    origin =
        plus(events.origin, all(1), rotated(events.rotation, combined(v, series.b, series.c, w)));
  }
};

template <int kUnknowns>
struct Residual {
  std::array<DoubleLanes, 2> a;       ///< where the ray leads
  std::array<DoubleLanes, 2> x;       ///< from the edge's pixel to the event's image at its depth
  std::array<DoubleLanes, 2> by_rho;  ///< of x
  double across_x = 0, across_y = 0;  ///< n - m t
  DoubleLanes inverse_z, g;
  DoubleLanes value_px;

  template <int kSupport>
  Residual(const EventLanes<kSupport>& events, const MovedEvent& moved,
           const EdgeState<kUnknowns>& edge, const PinholeCamera& camera) {
    const double rho = edge.unknowns[0], m = edge.unknowns[2];
    inverse_z = 1 / moved.direction[2];
    a = {moved.direction[0] * inverse_z, moved.direction[1] * inverse_z};
    by_rho = {camera.fx * (moved.origin[0] - moved.origin[2] * a[0]),
              camera.fy * (moved.origin[1] - moved.origin[2] * a[1])};
    x = {camera.fx * a[0] + (camera.cx - edge.pixel.x()) + rho * by_rho[0],
         camera.fy * a[1] + (camera.cy - edge.pixel.y()) + rho * by_rho[1]};
    across_x = edge.normal.x() + m * edge.normal.y();
    across_y = edge.normal.y() - m * edge.normal.x();
    g = (1 - rho * moved.origin[2]) * inverse_z;
    DoubleLanes numerator =
        across_x * x[0] + across_y * x[1] - edge.unknowns[1] - edge.unknowns[3] * events.lag;
    if constexpr (kUnknowns == 5) numerator -= edge.unknowns[4] * events.run_offset;
    value_px = numerator / g;
  }

  template <int kSupport>
  [[nodiscard]] bool is_in_front(const EventLanes<kSupport>& events,
                                 const MovedEvent& moved) const {
    for (std::size_t lane = 0; lane < kEventLanes; ++lane)
      if (events.holds(lane) && !(moved.direction[2][lane] > 0 && g[lane] > 0)) return false;
    return true;
  }
};

}  // namespace

template <int kSupport>
EventLanes<kSupport>::EventLanes() {
  // The identity, so that a lane without an event has finite numbers.
  for (const std::size_t i : {0, 4, 8}) rotation[i] = all(1);
}

template <int kSupport>
void EventLanes<kSupport>::set(std::size_t lane, const BundleEvent<kSupport>& event) {
  const Rigid3& view_from_camera = event.observation.view_from_camera;
  const Eigen::Matrix3d r = view_from_camera.rotation_matrix();
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      rotation[3 * i + j][lane] = r(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  for (std::size_t i = 0; i < 3; ++i)
    origin[i][lane] = view_from_camera.translation()[static_cast<Eigen::Index>(i)];
  ray[0][lane] = event.observation.ray.x() / event.observation.ray.z();
  ray[1][lane] = event.observation.ray.y() / event.observation.ray.z();
  lag[lane] = event.observation.lag;
  run_offset[lane] = event.run_offset;
  inverse_sigma[lane] = 1 / event.sigma_px;
  for (std::size_t k = 0; k < kSupport; ++k)
    weight[k][lane] = event.weight[static_cast<Eigen::Index>(k)];
  first[lane] = static_cast<std::uint32_t>(event.first);
}

template <int kSupport>
BundleEvent<kSupport> EventLanes<kSupport>::event(std::size_t lane, const Eigen::Vector2d& pixel,
                                                  const Eigen::Vector2d& normal) const {
  BundleEvent<kSupport> event;
  Eigen::Matrix3d r;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      r(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = rotation[3 * i + j][lane];
  event.observation.view_from_camera =
      Rigid3(Eigen::Quaterniond(r), {origin[0][lane], origin[1][lane], origin[2][lane]});
  event.observation.ray = {ray[0][lane], ray[1][lane], 1};
  event.observation.lag = lag[lane];
  event.observation.pixel = pixel;
  event.observation.normal = normal;
  event.run_offset = run_offset[lane];
  event.sigma_px = 1 / inverse_sigma[lane];
  event.first = first[lane];
  for (std::size_t k = 0; k < kSupport; ++k)
    event.weight[static_cast<Eigen::Index>(k)] = weight[k][lane];
  return event;
}

template <int kSupport>
std::array<DoubleLanes, 6> motion_of(const EventLanes<kSupport>& events,
                                     std::span<const double> path) {
  std::array<DoubleLanes, 6> motion{};
  for (std::size_t lane = 0; lane < kEventLanes; ++lane) {
    const double* unknowns = path.data() + 6 * static_cast<std::size_t>(events.first[lane]);
    for (std::size_t k = 0; k < kSupport; ++k, unknowns += 6)
      for (std::size_t i = 0; i < 6; ++i) motion[i][lane] += events.weight[k][lane] * unknowns[i];
  }
  return motion;
}

template <int kSupport, int kUnknowns>
bool event_residuals(const EventLanes<kSupport>& events, const EdgeState<kUnknowns>& edge,
                     const PinholeCamera& camera, const std::array<DoubleLanes, 6>& motion,
                     DoubleLanes& residuals) {
  const MovedEvent moved(events, motion);
  const Residual<kUnknowns> residual(events, moved, edge, camera);
  residuals = residual.value_px * events.inverse_sigma;
  return residual.is_in_front(events, moved);
}

template <int kSupport, int kUnknowns>
bool event_rows(const EventLanes<kSupport>& events, const EdgeState<kUnknowns>& edge,
                const PinholeCamera& camera, const std::array<DoubleLanes, 6>& motion,
                RowLanes<kUnknowns>& rows) {
  const MovedEvent moved(events, motion);
  const Residual<kUnknowns> residual(events, moved, edge, camera);
  const Lanes3 &v = moved.v, &w = moved.w;
  const DoubleLanes &a = moved.series.a, &b = moved.series.b, &c = moved.series.c;
  const double rho = edge.unknowns[0];
  const DoubleLanes inverse_g = 1 / residual.g;
  const DoubleLanes& r = residual.value_px;

  // By R' q and o'.
  const DoubleLanes sx = residual.across_x * camera.fx * inverse_g;
  const DoubleLanes sy = residual.across_y * camera.fy * inverse_g;
  const DoubleLanes s_along_a = sx * residual.a[0] + sy * residual.a[1];
  const DoubleLanes shrunk = (1 - rho * moved.origin[2]) * residual.inverse_z;
  const Lanes3 by_origin = {rho * sx, rho * sy,
                            rho * (r * inverse_g * residual.inverse_z - s_along_a)};
  const Lanes3 by_direction = {shrunk * sx, shrunk * sy,
                               r * residual.inverse_z - shrunk * s_along_a};
  const Lanes3 u = rotated_back(events.rotation, by_origin);
  const Lanes3 d =
      combined(rotated_back(events.rotation, by_direction), -a, b, w);  // Exp(-w) R^T ...
  const Lanes3 ray = {events.ray[0], events.ray[1], all(1)};

  // By v: V(w)^T u. By w: V(w) (q x d), of the direction, and of the origin V(w) v.
  const Lanes3 by_v = combined(u, -b, c, w);
  const Lanes3 turned = combined(cross(ray, d), b, c, w);
  const auto [twice_b, twice_c] = RotationSeries::twice_slopes(moved.squared_angle);
  const Lanes3 once = cross(w, v);
  const DoubleLanes wv = dot(w, v), wu = dot(w, u), vu = dot(v, u);
  const DoubleLanes along_w =
      twice_b * dot(once, u) + twice_c * dot(cross(w, once), u) - 2 * c * vu;
  const Lanes3 vxu = cross(v, u);
  const DoubleLanes& scale = events.inverse_sigma;
  for (std::size_t i = 0; i < 3; ++i) {
    rows.by_motion[i] = scale * by_v[i];
    rows.by_motion[3 + i] =
        scale * (turned[i] + along_w * w[i] + b * vxu[i] + c * (u[i] * wv + v[i] * wu));
  }

  const DoubleLanes by_offset = -scale * inverse_g;
  rows.residual = r * scale;
  rows.by_edge[0] =
      scale * inverse_g *
      (residual.across_x * residual.by_rho[0] + residual.across_y * residual.by_rho[1] +
       r * moved.origin[2] * residual.inverse_z);
  rows.by_edge[1] = by_offset;
  rows.by_edge[2] = by_offset * (edge.normal.x() * residual.x[1] - edge.normal.y() * residual.x[0]);
  rows.by_edge[3] = by_offset * events.lag;
  if constexpr (kUnknowns == 5) rows.by_edge[4] = by_offset * events.run_offset;
  return residual.is_in_front(events, moved);
}

template struct EventLanes<2>;
template struct EventLanes<4>;
template std::array<DoubleLanes, 6> motion_of(const EventLanes<2>&, std::span<const double>);
template std::array<DoubleLanes, 6> motion_of(const EventLanes<4>&, std::span<const double>);
template bool event_residuals(const EventLanes<2>&, const EdgeState<4>&, const PinholeCamera&,
                              const std::array<DoubleLanes, 6>&, DoubleLanes&);
template bool event_residuals(const EventLanes<4>&, const EdgeState<5>&, const PinholeCamera&,
                              const std::array<DoubleLanes, 6>&, DoubleLanes&);
template bool event_rows(const EventLanes<2>&, const EdgeState<4>&, const PinholeCamera&,
                         const std::array<DoubleLanes, 6>&, RowLanes<4>&);
template bool event_rows(const EventLanes<4>&, const EdgeState<5>&, const PinholeCamera&,
                         const std::array<DoubleLanes, 6>&, RowLanes<5>&);

}  // namespace saccade

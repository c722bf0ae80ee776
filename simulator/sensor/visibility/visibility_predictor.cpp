#include "simulator/sensor/visibility/visibility_predictor.h"

#include <cmath>
#include <limits>

#include "simulator/sensor/visibility/triangle_ray_bounds.h"

namespace saccade {
namespace {

/// With more triangles than this in reach of a tile its pixels are sampled in steps, without a proof.
/// It bounds a tile's memory; in a room of half a million triangles a limit of 4096 lost 0.2 % of
/// the events, one of 32768 as many as no limit: none.
constexpr std::size_t kMaxCandidates = 32768;

/// Whether an edge of one triangle and one of another lie on the same line.
bool share_edge(const TransitTriangle& a, std::size_t edge_of_a, const TransitTriangle& b,
                std::size_t edge_of_b) {
  constexpr double kSame = 1e-9;
  for (std::size_t m = 0; m < a.at.size(); ++m) {
    const Eigen::Vector3d& first = a.at[m].edges[edge_of_a];
    const Eigen::Vector3d& second = b.at[m].edges[edge_of_b];
    if (first.cross(second).norm() > kSame * first.norm() * second.norm()) return false;
  }
  return true;
}

}  // namespace

bool VisibilityPredictor::collect(double farthest_m, double from_s, double to_s) {
  const bool all =
      tracer_.collect(outline_, farthest_m, from_s, to_s, kMaxCandidates, memory_.candidates);
  if (!all) clear();
  return all;
}

void VisibilityPredictor::restrict_to(double from_s, double to_s, std::size_t depth) {
  memory_.transits.clear();
  memory_.culling.clear(edge_margin_);
  tracer_.set_candidates(std::span<const TriangleId>());
  if (memory_.candidates.empty()) return;
  if (memory_.candidates_at_depth.size() <= depth) memory_.candidates_at_depth.resize(depth + 1);
  const std::vector<TriangleId>& before =
      depth == 0 ? memory_.candidates : memory_.candidates_at_depth[depth - 1];
  std::vector<TriangleId>& now = memory_.candidates_at_depth[depth];
  now.clear();
  const std::array<double, 3> times_s{from_s, 0.5 * (from_s + to_s), to_s};
  std::array<CameraFrame, 3> cameras;
  for (std::size_t m = 0; m < cameras.size(); ++m) cameras[m] = tracer_.camera_at(times_s[m]);
  for (const TriangleId candidate : before) {
    TransitTriangle transit{candidate, {}};
    for (std::size_t m = 0; m < cameras.size(); ++m)
      transit.at[m] =
          scene_.edge_functions(candidate, cameras[m].position, cameras[m].rotation, times_s[m]);
    if (transit.misses(outline_)) continue;
    memory_.transits.push_back(transit);
    memory_.culling.add(transit);
    now.push_back(candidate);
  }
  tracer_.set_candidates(now);
}

void VisibilityPredictor::select_rays(std::span<const Eigen::Vector3d> directions) {
  memory_.nearby.clear();
  memory_.nearby_ids.clear();
  for (const Eigen::Vector3d& direction : directions)
    memory_.culling.visit_candidates(direction,
                                     [&](std::size_t k) { memory_.nearby.push_back(k); });
  if (directions.size() > 1) {
    std::sort(memory_.nearby.begin(), memory_.nearby.end());
    memory_.nearby.erase(std::unique(memory_.nearby.begin(), memory_.nearby.end()),
                         memory_.nearby.end());
  }
  for (const std::size_t k : memory_.nearby)
    memory_.nearby_ids.push_back(memory_.transits[k].triangle);
  tracer_.set_candidates(memory_.nearby_ids);
}

const TransitTriangle* VisibilityPredictor::find_opaque(TriangleId triangle) const {
  const auto found = std::find_if(memory_.transits.begin(), memory_.transits.end(),
                                  [&](const auto& each) { return each.triangle == triangle; });
  return found == memory_.transits.end() || scene_.is_cut_out(triangle) ? nullptr : &*found;
}

bool VisibilityPredictor::are_in_front(const Eigen::Vector3d& direction, const TransitTriangle& a,
                                       const TransitTriangle& b) const {
  bool is_certain = true;
  memory_.culling.visit_candidates(direction, [&](std::size_t k) {
    const TransitTriangle& other = memory_.transits[k];
    if (!is_certain || &other == &a || &other == &b) return;
    const TriangleRayBounds bounds(other, direction, edge_margin_);
    is_certain =
        bounds.stays_outside() || (bounds.stays_behind(a) && (&a == &b || bounds.stays_behind(b)));
  });
  return is_certain;
}

bool VisibilityPredictor::stays_visible(const Eigen::Vector3d& direction,
                                        TriangleId triangle) const {
  const TransitTriangle* seen = find_opaque(triangle);
  return seen != nullptr && TriangleRayBounds(*seen, direction, edge_margin_).stays_inside() &&
         are_in_front(direction, *seen, *seen);
}

double VisibilityPredictor::change_s(const Eigen::Vector3d& direction, const VisibleTriangle& from,
                                     const VisibleTriangle& to) const {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  const TransitTriangle* a = find_opaque(from.triangle);
  const TransitTriangle* b = find_opaque(to.triangle);
  if (a == nullptr || b == nullptr) return kUnknown;
  const TriangleRayBounds before(*a, direction, edge_margin_);
  const TriangleRayBounds after(*b, direction, edge_margin_);
  const auto out = before.edge_crossed(false);
  const auto in = after.edge_crossed(true);
  const bool is_single = out && in ? share_edge(*a, *out, *b, *in)
                         : out     ? after.stays_inside() && after.stays_behind(*a)
                               : in.has_value() && before.stays_inside() && before.stays_behind(*b);
  if (!is_single || !are_in_front(direction, *a, *b)) return kUnknown;
  const double guess = out ? before.crossing(*out) : after.crossing(*in);
  const double change_s = tracer_.change_near_s(direction, out ? from.triangle : to.triangle,
                                                {from.t_s, to.t_s}, guess, 0.1 * tolerance_s_);
  return std::isnan(change_s) ? tracer_.change_s(direction, from, to, 0.1 * tolerance_s_)
                              : change_s;
}

void VisibilityPredictor::find_transits(const Eigen::Vector3d& direction,
                                        const StampedRaySample& lo, const StampedRaySample& hi,
                                        std::vector<double>& times_s) const {
  const bool is_open = lo.sample.surface.distance == 0 || hi.sample.surface.distance == 0 ||
                       scene_.is_cut_out(lo.sample.triangle) ||
                       scene_.is_cut_out(hi.sample.triangle);
  const double occluded_beyond =
      is_open ? std::numeric_limits<double>::infinity()
              : std::max(lo.sample.surface.distance, hi.sample.surface.distance);
  const double length_s = hi.t_s - lo.t_s;
  for (const std::size_t index : memory_.nearby) {
    const TransitTriangle& transit = memory_.transits[index];
    const bool at_lo = transit.triangle == lo.sample.triangle;
    const bool at_hi = transit.triangle == hi.sample.triangle;
    if (at_lo && at_hi && transit.leaves(direction)) times_s.push_back(lo.t_s + 0.5 * length_s);
    const bool is_cut_out = scene_.is_cut_out(transit.triangle);
    if ((at_lo || at_hi) && !is_cut_out) continue;
    if (transit.is_occluded(direction, occluded_beyond)) continue;
    transit.find_transits(direction, [&](double begin, double end) {
      const double from_s = lo.t_s + begin * length_s;
      const double to_s = lo.t_s + end * length_s;
      if (is_cut_out)
        find_gaps(direction, transit.triangle, from_s, to_s, lo, hi, times_s);
      else
        find_visible_times(direction, transit.triangle, from_s, to_s, times_s);
    });
  }
}

void VisibilityPredictor::find_gaps(const Eigen::Vector3d& direction, TriangleId triangle,
                                    double from_s, double to_s, const StampedRaySample& lo,
                                    const StampedRaySample& hi,
                                    std::vector<double>& times_s) const {
  for (const OpacityInterval& interval :
       tracer_.find_opacity_intervals(direction, triangle, from_s, to_s)) {
    const bool is_known = (triangle == lo.sample.triangle && interval.from_s == lo.t_s) ||
                          (triangle == hi.sample.triangle && interval.to_s == hi.t_s);
    if (interval.is_opaque && !is_known)
      find_visible_times(direction, triangle, interval.from_s, interval.to_s, times_s);
    if (!interval.is_opaque && interval.from_s > lo.t_s && interval.to_s < hi.t_s)
      times_s.push_back(0.5 * (interval.from_s + interval.to_s));
  }
}

void VisibilityPredictor::find_visible_times(const Eigen::Vector3d& direction, TriangleId triangle,
                                             double from_s, double to_s,
                                             std::vector<double>& times_s) const {
  for (const double fraction : {0.02, 0.5, 0.98}) {
    const double t_s = from_s + fraction * (to_s - from_s);
    if (tracer_.is_nearest(direction, triangle, memory_.nearby_ids, t_s)) times_s.push_back(t_s);
  }
}

void VisibilityPredictor::find_shadows(const Eigen::Vector3d& direction,
                                       const VisibleTriangle& from, const VisibleTriangle& to,
                                       std::vector<double>& times_s) {
  if (from.triangle == to.triangle) {
    find_shadows_on(direction, from.triangle, from.t_s, to.t_s, times_s);
    return;
  }
  const double change_s = tracer_.change_s(direction, from, to, 0.1 * tolerance_s_);
  const bool is_known = !std::isnan(change_s);
  find_shadows_on(direction, from.triangle, from.t_s, is_known ? change_s : to.t_s, times_s);
  find_shadows_on(direction, to.triangle, is_known ? change_s : from.t_s, to.t_s, times_s);
}

void VisibilityPredictor::find_shadows_on(const Eigen::Vector3d& direction, TriangleId triangle,
                                          double from_s, double to_s,
                                          std::vector<double>& times_s) {
  const PatchLighting* lighting = tracer_.lighting_of(triangle);
  if (lighting == nullptr || lighting->partly_occluded.empty()) return;
  const double length_s = to_s - from_s;
  if (!(length_s > 2 * tolerance_s_)) return;
  std::array<Eigen::Vector3d, 3> points;
  for (std::size_t m = 0; m < points.size(); ++m)
    points[m] =
        tracer_.point_at(direction, triangle, from_s + 0.5 * static_cast<double>(m) * length_s) +
        lighting->shadow_offset;
  if (!std::all_of(points.begin(), points.end(), [](const auto& p) { return p.allFinite(); }))
    return;
  for (const PartlyOccludedLight& light : lighting->partly_occluded) {
    double before = -1;  // the last change
    const auto change = [&](double at) {
      if (!(at > 0 && at < 1)) return;
      const double t_s = from_s + at * length_s;
      if (before >= 0) times_s.push_back(from_s + 0.5 * (before + at) * length_s);
      times_s.push_back(t_s - 0.45 * tolerance_s_);
      times_s.push_back(t_s + 0.45 * tolerance_s_);
      before = at;
    };
    memory_.shadows.find(light, points, [&](double begin, double end) {
      change(begin);
      change(end);
    });
  }
}

}  // namespace saccade

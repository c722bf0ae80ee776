#include "simulator/sensor/visibility/visibility_predictor.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulator/sensor/visibility/triangle_ray_bounds.h"

namespace saccade {
namespace {

/// With more triangles than this in reach of a tile, looking at each of them costs more than steps.
constexpr std::size_t kMostCandidates = 4096;

/// Whether an edge of one triangle and one of another lie on the same line.
bool share_edge(const PassingTriangle& a, std::size_t edge_of_a, const PassingTriangle& b,
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

bool Foresight::collect(double farthest_m, double from_s, double to_s) {
  const bool all =
      tracer_.collect(outline_, farthest_m, from_s, to_s, kMostCandidates, candidates_);
  if (!all) forget();
  return all;
}

void Foresight::narrow(double from_s, double to_s, std::size_t depth) {
  passing_.clear();
  outside_.clear();
  tracer_.use(std::span<const TriangleId>());
  if (candidates_.empty()) return;
  if (within_reach_.size() <= depth) within_reach_.resize(depth + 1);
  const std::vector<TriangleId>& before = depth == 0 ? candidates_ : within_reach_[depth - 1];
  std::vector<TriangleId>& now = within_reach_[depth];
  now.clear();
  const std::array<double, 3> times_s{from_s, 0.5 * (from_s + to_s), to_s};
  std::array<CameraFrame, 3> cameras;
  for (std::size_t m = 0; m < cameras.size(); ++m) cameras[m] = tracer_.camera_at(times_s[m]);
  for (const TriangleId candidate : before) {
    PassingTriangle passing{candidate, {}};
    for (std::size_t m = 0; m < cameras.size(); ++m)
      passing.at[m] =
          scene_.triangle_pass(candidate, cameras[m].position, cameras[m].rotation, times_s[m]);
    if (passing.misses(outline_)) continue;
    passing_.push_back(passing);
    outside_.add(passing);
    now.push_back(candidate);
  }
  tracer_.use(now);
}

void Foresight::turn_to(std::span<const Eigen::Vector3d> directions) {
  nearby_.clear();
  nearby_ids_.clear();
  for (const Eigen::Vector3d& direction : directions)
    outside_.visit_others(direction, [&](std::size_t k) { nearby_.push_back(k); });
  if (directions.size() > 1) {
    std::sort(nearby_.begin(), nearby_.end());
    nearby_.erase(std::unique(nearby_.begin(), nearby_.end()), nearby_.end());
  }
  for (const std::size_t k : nearby_) nearby_ids_.push_back(passing_[k].triangle);
  tracer_.use(nearby_ids_);
}

const PassingTriangle* Foresight::find_opaque(TriangleId triangle) const {
  const auto found = std::find_if(passing_.begin(), passing_.end(),
                                  [&](const auto& each) { return each.triangle == triangle; });
  return found == passing_.end() || scene_.is_cut_out(triangle) ? nullptr : &*found;
}

bool Foresight::are_foremost(const Eigen::Vector3d& direction, const PassingTriangle& a,
                             const PassingTriangle& b) const {
  return std::all_of(passing_.begin(), passing_.end(), [&](const PassingTriangle& other) {
    if (&other == &a || &other == &b) return true;
    const TriangleSight sight(other, direction, doubt_);
    return sight.stays_outside() || (sight.stays_behind(a) && (&a == &b || sight.stays_behind(b)));
  });
}

bool Foresight::stays_in_sight(const Eigen::Vector3d& direction, TriangleId triangle) const {
  const PassingTriangle* seen = find_opaque(triangle);
  return seen != nullptr && TriangleSight(*seen, direction, doubt_).stays_inside() &&
         are_foremost(direction, *seen, *seen);
}

double Foresight::change_s(const Eigen::Vector3d& direction, const Sighting& from,
                           const Sighting& to) const {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  const PassingTriangle* a = find_opaque(from.triangle);
  const PassingTriangle* b = find_opaque(to.triangle);
  if (a == nullptr || b == nullptr) return kUnknown;
  const TriangleSight before(*a, direction, doubt_);
  const TriangleSight after(*b, direction, doubt_);
  const auto out = before.edge_passed(false);
  const auto in = after.edge_passed(true);
  const bool is_single = out && in ? share_edge(*a, *out, *b, *in)
                         : out     ? after.stays_inside() && after.stays_behind(*a)
                               : in.has_value() && before.stays_inside() && before.stays_behind(*b);
  if (!is_single || !are_foremost(direction, *a, *b)) return kUnknown;
  return tracer_.change_s(direction, from, to, 0.1 * tolerance_s_);
}

void Foresight::find_passes(const Eigen::Vector3d& direction, const RayLook& lo, const RayLook& hi,
                            std::vector<double>& times_s) const {
  const bool is_open = lo.view.look.distance == 0 || hi.view.look.distance == 0 ||
                       scene_.is_cut_out(lo.view.triangle) || scene_.is_cut_out(hi.view.triangle);
  const double hidden_beyond = is_open ? std::numeric_limits<double>::infinity()
                                       : std::max(lo.view.look.distance, hi.view.look.distance);
  const double length_s = hi.t_s - lo.t_s;
  for (const std::size_t index : nearby_) {
    const PassingTriangle& passing = passing_[index];
    const bool at_lo = passing.triangle == lo.view.triangle;
    const bool at_hi = passing.triangle == hi.view.triangle;
    if (at_lo && at_hi && passing.leaves(direction)) times_s.push_back(lo.t_s + 0.5 * length_s);
    const bool is_cut_out = scene_.is_cut_out(passing.triangle);
    if ((at_lo || at_hi) && !is_cut_out) continue;
    if (passing.is_hidden(direction, hidden_beyond)) continue;
    passing.find_passages(direction, [&](double begin, double end) {
      const double from_s = lo.t_s + begin * length_s;
      const double to_s = lo.t_s + end * length_s;
      if (is_cut_out)
        find_gaps(direction, passing.triangle, from_s, to_s, lo, hi, times_s);
      else
        find_sightings(direction, passing.triangle, from_s, to_s, times_s);
    });
  }
}

void Foresight::find_gaps(const Eigen::Vector3d& direction, TriangleId triangle, double from_s,
                          double to_s, const RayLook& lo, const RayLook& hi,
                          std::vector<double>& times_s) const {
  for (const OpaqueStretch& stretch : tracer_.find_holes(direction, triangle, from_s, to_s)) {
    const bool is_known = (triangle == lo.view.triangle && stretch.from_s == lo.t_s) ||
                          (triangle == hi.view.triangle && stretch.to_s == hi.t_s);
    if (stretch.is_opaque && !is_known)
      find_sightings(direction, triangle, stretch.from_s, stretch.to_s, times_s);
    if (!stretch.is_opaque && stretch.from_s > lo.t_s && stretch.to_s < hi.t_s)
      times_s.push_back(0.5 * (stretch.from_s + stretch.to_s));
  }
}

void Foresight::find_sightings(const Eigen::Vector3d& direction, TriangleId triangle, double from_s,
                               double to_s, std::vector<double>& times_s) const {
  for (const double fraction : {0.02, 0.5, 0.98}) {
    const double t_s = from_s + fraction * (to_s - from_s);
    if (tracer_.sees(direction, triangle, nearby_ids_, t_s)) times_s.push_back(t_s);
  }
}

void Foresight::find_shadows(const Eigen::Vector3d& direction, const Sighting& from,
                             const Sighting& to, std::vector<double>& times_s) {
  if (from.triangle == to.triangle) {
    find_shadows_on(direction, from.triangle, from.t_s, to.t_s, times_s);
    return;
  }
  const double change_s = tracer_.change_s(direction, from, to, 0.1 * tolerance_s_);
  const bool is_known = !std::isnan(change_s);
  find_shadows_on(direction, from.triangle, from.t_s, is_known ? change_s : to.t_s, times_s);
  find_shadows_on(direction, to.triangle, is_known ? change_s : from.t_s, to.t_s, times_s);
}

void Foresight::find_shadows_on(const Eigen::Vector3d& direction, TriangleId triangle,
                                double from_s, double to_s, std::vector<double>& times_s) {
  const PatchLight* light = tracer_.light_of(triangle);
  if (light == nullptr || light->doubtful.empty()) return;
  const double length_s = to_s - from_s;
  if (!(length_s > 2 * tolerance_s_)) return;
  std::array<Eigen::Vector3d, 3> points;
  for (std::size_t m = 0; m < points.size(); ++m)
    points[m] =
        tracer_.point_at(direction, triangle, from_s + 0.5 * static_cast<double>(m) * length_s) +
        light->lift;
  if (!std::all_of(points.begin(), points.end(), [](const auto& p) { return p.allFinite(); }))
    return;
  for (const DoubtfulLamp& lamp : light->doubtful) {
    double before = -1;  // the last change
    const auto change = [&](double at) {
      if (!(at > 0 && at < 1)) return;
      const double t_s = from_s + at * length_s;
      if (before >= 0) times_s.push_back(from_s + 0.5 * (before + at) * length_s);
      times_s.push_back(t_s - 0.45 * tolerance_s_);
      times_s.push_back(t_s + 0.45 * tolerance_s_);
      before = at;
    };
    shadows_.find(lamp, points, [&](double begin, double end) {
      change(begin);
      change(end);
    });
  }
}

}  // namespace saccade

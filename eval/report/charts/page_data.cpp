#include "eval/report/charts/page_data.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "core/check.h"
#include "eval/metrics/statistics.h"
#include "eval/report/html.h"

namespace saccade {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMaxCurvePoints = 1600;
constexpr std::size_t kMaxPathPoints = 800;
constexpr std::size_t kMaxCloudPoints = 4000;
constexpr double kCloudSteps = 65535;

/// At most kMaxCloudPoints of the points in 16-bit steps, little-endian, between their extremes.
Json cloud(std::span<const Eigen::Vector3f> points) {
  const std::size_t stride = (points.size() + kMaxCloudPoints - 1) / kMaxCloudPoints;
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& point : points) box.extend(point.cast<double>());
  const Eigen::Vector3d unit = (box.sizes() / kCloudSteps).cwiseMax(1e-9);
  std::string bytes;
  for (std::size_t i = 0; i < points.size(); i += stride)
    for (int axis = 0; axis < 3; ++axis) {
      const double steps = (points[i].cast<double>() - box.min())[axis] / unit[axis];
      const auto whole = static_cast<unsigned>(std::lround(steps));
      bytes += static_cast<char>(whole & 0xFF);
      bytes += static_cast<char>(whole >> 8);
    }
  return {{"origin", {box.min().x(), box.min().y(), box.min().z()}},
          {"unit", {unit.x(), unit.y(), unit.z()}},
          {"points", base64(bytes)}};
}

Json series(const char* label, const char* unit, std::span<const double> t_s,
            std::span<const double> values) {
  const CurvePoints points = thinned(t_s, values, kMaxCurvePoints);
  return {{"label", label},
          {"unit", unit},
          {"t", points.x},
          {"v", points.y},
          {"mean", five_digits(statistics_of(values).mean)}};
}

Json position(const Rigid3& pose) {
  const Eigen::Vector3d& p = pose.translation();
  const auto micrometre = [](double v) { return std::round(v * 1e6) / 1e6; };
  return {micrometre(p.x()), micrometre(p.y()), micrometre(p.z())};
}

/// Stretches of the scored interval without a pose that is at most 20 ms old.
Json gaps(const RunData& data) {
  Json result = Json::array();
  const double end_s = data.samples.t_s.back();
  double covered_until = data.samples.t_s.front();
  const auto add = [&](double until) {
    if (until > covered_until + kScoreStepS)
      result.push_back({tenth_ms(covered_until), tenth_ms(std::min(until, end_s))});
  };
  for (const StampedPose& pose : data.input.estimate.poses()) {
    if (pose.t_s > end_s) break;
    add(pose.t_s);
    covered_until = std::max(covered_until, pose.t_s + kMaxPoseAgeS);
  }
  add(end_s);
  return result;
}

/// Names of files may hold bytes that are no text.
std::string text_of(const Json& json) {
  return inside_script(json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace

std::string charts_data(std::span<const PageChart> charts) {
  Json all = Json::array();
  for (const PageChart& chart : charts) all.push_back(chart_json(chart));
  return text_of(all);
}

std::string run_page_data(const RunData& data) {
  SACCADE_CHECK(!data.samples.t_s.empty());
  const ScoredSamples& s = data.samples;
  Json run{{"id", data.id}, {"name", data.run.name()}};
  if (!data.map.empty()) run["cloud"] = cloud(data.truth_from_estimate * data.map);
  const std::size_t stride = (s.t_s.size() + kMaxPathPoints - 1) / kMaxPathPoints;
  for (const char* name : {"times", "truth", "estimate"}) run[name] = Json::array();
  for (std::size_t i = 0; i < s.t_s.size(); i += stride) {
    run["times"].push_back(tenth_ms(s.t_s[i]));
    run["truth"].push_back(position(s.truth[i]));
    run["estimate"].push_back(position(s.estimated[i]));
  }
  run["gaps"] = gaps(data);
  Json& all = run["series"] = Json::object();
  const ErrorSeries& e = data.errors;
  if (!e.dt_rel_percent.empty()) {
    all["dt_rel"] = series("relative position error", "%", e.t_s, e.dt_rel_percent);
  } else {
    std::vector<double> dt_mm = e.dt_m;
    for (double& value : dt_mm) value *= 1000;
    all["dt"] = series("position error", "mm", e.t_s, dt_mm);
  }
  all["dtheta"] = series("rotation error", "deg", e.t_s, e.dtheta_deg);
  if (const ReprojectionSeries& r = data.reprojection; !r.t_s.empty())
    all["reprojection"] = series("reprojection error", "px", r.t_s, r.rms_px);
  return text_of(run);
}

}  // namespace saccade

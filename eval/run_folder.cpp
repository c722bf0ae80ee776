#include "eval/run_folder.h"

#include <cmath>
#include <limits>

#include "core/config/convert.h"
#include "core/config/document.h"
#include "core/error.h"
#include "core/io/files/folder_name.h"
#include "core/io/tables/csv_reader.h"
#include "core/io/tables/text_table.h"
#include "core/io/trajectory_file.h"

namespace saccade {
namespace {

std::vector<PoseRow> read_pose_rows(const std::filesystem::path& file) {
  const CsvColumns csv(file);
  const std::size_t t = csv.require("t_s");
  const std::size_t status = csv.require("status");
  const auto first = csv.find("first_event_s");
  const auto last = csv.find("last_event_s");
  const auto inliers = csv.find("inlier_ratio");
  const auto iterations = csv.find("iterations");
  const auto residual = csv.find("residual");
  const auto probability = csv.find("probability");
  std::vector<PoseRow> rows;
  for (std::size_t i = 0; i < csv.rows(); ++i) {
    const auto number = [&](const std::optional<std::size_t>& column) {
      return column ? csv.number(i, *column) : std::numeric_limits<double>::quiet_NaN();
    };
    rows.push_back({csv.number(i, t), number(first), number(last), csv.text(i, status),
                    number(inliers), number(iterations), number(residual), number(probability)});
  }
  return rows;
}

}  // namespace

std::filesystem::path run_record_of(const std::filesystem::path& folder) {
  std::filesystem::path file = folder / "run.yaml";
  if (std::filesystem::exists(file)) return file;
  if (!std::filesystem::exists(folder)) throw InputError(folder.string(), "no such run folder");
  if (std::filesystem::exists(folder / "dataset.yaml"))
    throw InputError(folder.string(), "is a dataset, not a run: saccade run MODULE --data " +
                                          folder.string() + " makes one");
  throw InputError(folder.string(), "is no run: it holds no run.yaml");
}

RunFolder RunFolder::open(const std::filesystem::path& folder) {
  RunFolder run;
  run.folder = folder;
  run.record = read_run_record(run_record_of(folder));
  if (const auto file = folder / "trajectory.txt"; std::filesystem::exists(file))
    run.trajectory = read_estimate(file);
  if (const auto file = folder / "poses.csv"; std::filesystem::exists(file))
    run.poses = read_pose_rows(file);
  if (const auto file = folder / "timing.json"; std::filesystem::exists(file))
    run.timing = read_json_metrics(file);
  if (const auto file = folder / "metrics.json"; std::filesystem::exists(file))
    run.metrics = read_json_metrics(file);
  return run;
}

std::string RunFolder::name() const { return folder_name(folder); }

PointCloud RunFolder::load_map() const {
  const std::filesystem::path file = folder / "map.ply";
  return std::filesystem::exists(file) ? read_ply(file) : PointCloud{};
}

Alignment RunFolder::freedom() const {
  if (!std::filesystem::exists(folder / "start.yaml")) return Alignment::kNone;
  const std::filesystem::path file = folder / "inertial.yaml";
  if (!std::filesystem::exists(file)) return Alignment::kSim3;
  const config::Document document = config::load(file);
  bool is_applied = false;
  if (const config::Entry* entry = document.root().find("applied"))
    config::from_node(entry->value, "applied", is_applied);
  return is_applied ? Alignment::kYaw : Alignment::kSim3;
}

std::vector<StampedCovariance> RunFolder::load_covariances() const {
  const std::filesystem::path file = folder / "covariance.txt";
  if (!std::filesystem::exists(file)) return {};
  return read_covariances(file);
}

Dataset RunFolder::open_dataset(const std::optional<std::filesystem::path>& instead) const {
  return Dataset::open(instead.value_or(record.dataset));
}

Trajectory read_estimate(const std::filesystem::path& file) {
  TextReader reader(file);
  std::string_view line;
  return reader.next(line) ? read_trajectory(file) : Trajectory{};
}

TrajectoryScoreInput score_input(const RunFolder& run, const Dataset& dataset) {
  TrajectoryScoreInput input;
  if (run.trajectory) input.estimate = *run.trajectory;
  input.truth = dataset.groundtruth();
  input.mean_depth_m = dataset.facts().mean_depth_m;
  input.window = run.record.window;
  input.freedom = run.freedom();
  if (run.poses) {
    input.reported.emplace();
    for (const PoseRow& row : *run.poses) {
      PoseStatus status{row.t_s, row.status == "lost"};
      if (std::isfinite(row.probability)) status.probability = row.probability;
      input.reported->push_back(status);
    }
  }
  return input;
}

}  // namespace saccade

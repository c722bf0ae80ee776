#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/io/dataset/dataset.h"
#include "eval/evaluate.h"
#include "eval/gate/baseline_file.h"
#include "eval/gate/comparison.h"
#include "eval/gate/gate_report.h"
#include "eval/metrics/trajectory/trajectory_metrics.h"
#include "eval/store/result_diff.h"
#include "eval/store/result_store.h"
#include "eval/store/result_text.h"
#include "python/binding/bindings.h"
#include "python/binding/conversions.h"

namespace saccade::python {
namespace {

using Paths = std::vector<std::string>;

py::tuple scored(const Metrics& metrics, const std::string& title) {
  return py::make_tuple(metrics_dict(metrics), format_metrics(metrics, title));
}

py::tuple evaluate_folder(const std::string& run, const std::optional<std::string>& dataset,
                          const std::optional<double>& mean_depth_m,
                          const std::optional<std::string>& refined) {
  EvaluateOptions options;
  options.dataset = dataset;
  options.mean_depth_m = mean_depth_m;
  options.refined = refined;
  Metrics metrics;
  {
    const py::gil_scoped_release release;
    metrics = evaluate_run(run, options);
    keep_result(run);
  }
  return scored(metrics, run);
}

py::tuple evaluate_poses(const PoseArray& estimate, const std::string& dataset,
                         const std::optional<double>& mean_depth_m) {
  const Trajectory trajectory(poses_from(estimate, "trajectory"));
  return scored(score_estimate(trajectory, Dataset::open(dataset), mean_depth_m), "trajectory");
}

TrajectoryScoreInput score_input_of(const PoseArray& estimate, const PoseArray& truth,
                                    const std::optional<double>& mean_depth_m) {
  TrajectoryScoreInput input;
  input.estimate = Trajectory(poses_from(estimate, "estimate"));
  input.truth = Trajectory(poses_from(truth, "truth"));
  input.mean_depth_m = mean_depth_m;
  return input;
}

py::dict compare_trajectories(const PoseArray& estimate, const PoseArray& truth,
                              const std::optional<double>& mean_depth_m) {
  return metrics_dict(score_trajectory(score_input_of(estimate, truth, mean_depth_m)));
}

py::dict trajectory_errors(const PoseArray& estimate, const PoseArray& truth,
                           const std::optional<double>& mean_depth_m) {
  TrajectoryScoreInput input = score_input_of(estimate, truth, mean_depth_m);
  // Where nothing is estimated there is no error.
  if (input.estimate.size() > 0)
    input.window = RunRecord::Window{input.estimate.start_s(), input.estimate.end_s()};
  ErrorSeries series = errors_over_time(input);
  py::dict dict;
  dict["t"] = values_array(std::move(series.t_s));
  dict["dt_m"] = values_array(std::move(series.dt_m));
  dict["dt_rel_percent"] = values_array(std::move(series.dt_rel_percent));
  dict["dtheta_deg"] = values_array(std::move(series.dtheta_deg));
  return dict;
}

const char* verdict_name(GateRow::Verdict verdict) {
  switch (verdict) {
    case GateRow::Verdict::kRegressed:
      return "regressed";
    case GateRow::Verdict::kImproved:
      return "improved";
    default:
      return "same";
  }
}

py::list row_dicts(const GateResult& result) {
  py::list rows;
  for (const GateRow& row : result.rows) {
    py::dict dict;
    dict["verdict"] = verdict_name(row.verdict);
    dict["metric"] = row.metric;
    dict["scope"] = row.scope;
    dict["pairs"] = row.pairs;
    dict["before"] = row.before;
    dict["after"] = row.after;
    dict["change"] = row.change;
    dict["low"] = row.low;
    dict["high"] = row.high;
    dict["p"] = row.p;
    dict["note"] = row.note;
    rows.append(dict);
  }
  return rows;
}

std::vector<GateRun> runs_in(const Paths& folders) {
  const std::vector<std::filesystem::path> named(folders.begin(), folders.end());
  return read_gate_runs(without_store(named));
}

py::dict gate_runs(const Paths& folders, const std::string& baseline, const GateOptions& options) {
  const GateResult result = [&] {
    const py::gil_scoped_release release;
    options.check();
    return compare_with_baseline(baseline, runs_in(folders), options);
  }();
  py::dict dict;
  dict["tripped"] = result.tripped();
  dict["rows"] = row_dicts(result);
  dict["text"] = gate_text(result, false);
  dict["markdown"] = gate_markdown(result);
  dict["junit"] = gate_junit(result);
  return dict;
}

std::string results_json(const std::string& store, const std::string& where, const Paths& columns) {
  ResultReader reader(find_result_store(store));
  return list_results(reader, where, columns, ResultFormat::kJson);
}

std::string results_diff(const std::string& store, const std::string& a, const std::string& b,
                         const std::string& where) {
  ResultReader reader(find_result_store(store));
  return format_diff(diff_results(reader, a, b, where), ResultFormat::kJson);
}

}  // namespace

void bind_scores(py::module_& module) {
  module.def("evaluate_run", &evaluate_folder);
  module.def("evaluate_poses", &evaluate_poses);
  module.def("compare_trajectories", &compare_trajectories);
  module.def("trajectory_errors", &trajectory_errors);
  py::class_<GateOptions>(module, "GateOptions")
      .def(py::init<>())
      .def_readwrite("tolerance", &GateOptions::tolerance)
      .def_readwrite("gross", &GateOptions::gross)
      .def_readwrite("slower", &GateOptions::slower)
      .def_readwrite("confidence", &GateOptions::confidence)
      .def_readwrite("resamples", &GateOptions::resamples)
      .def_readwrite("speed", &GateOptions::speed)
      .def_readwrite("partial", &GateOptions::partial)
      .def_readwrite("metrics", &GateOptions::metrics);
  module.def("gate", &gate_runs);
  module.def("update_baseline",
             [](const Paths& folders, const std::string& baseline, bool partial) {
               return update_baseline(baseline, runs_in(folders), partial);
             });
  module.def("results_json", &results_json);
  module.def("results_diff", &results_diff);
}

}  // namespace saccade::python

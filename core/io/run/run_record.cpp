#include "core/io/run/run_record.h"

#include "core/config/config.h"
#include "core/io/files/atomic_file.h"

namespace saccade {

void describe(config::Fields& fields, RunRecord::Contrast& contrast) {
  fields.value("on", contrast.on, "of ON events").required().above(0);
  fields.value("off", contrast.off, "of OFF events").required().above(0);
}

void describe(config::Fields& fields, RunRecord::Window& window) {
  fields.value("start_s", window.start_s, "first instant").required();
  fields.value("end_s", window.end_s, "instant after the last event").required();
  fields.expect(window.start_s <= window.end_s, "end_s", "must not be below start_s");
}

void describe(config::Fields& fields, RunRecord::External& external) {
  fields.value("name", external.name, "of the method").required();
  fields.value("version", external.version, "as it states it");
  fields.value("status", external.status, "how it ended")
      .one_of({"ok", "crashed", "timed out", "bad output"});
  fields.value("reason", external.reason, "what went wrong");
}

void describe(config::Fields& fields, RunRecord& record) {
  fields.value("format_version", record.format_version, "layout of this folder")
      .required()
      .range(1, 1);
  fields.value("module", record.module, "estimator").required();
  fields.group(
      "dataset",
      [&](config::Fields& dataset) {
        dataset.value("path", record.dataset, "folder").required();
        dataset.value("sha256", record.dataset_sha256, "of dataset.yaml or of the events");
      },
      "what it was given");
  if (fields.has("poses_from") || (!fields.reading() && !record.poses_from.empty()))
    fields.value("poses_from", record.poses_from, "whose poses it took in place of the truth's");
  if (fields.has("smooth_poses_s") || (!fields.reading() && record.smooth_poses_s))
    fields
        .value("smooth_poses_s", record.smooth_poses_s,
               "spacing of the knots of the spline by which its poses were smoothed")
        .above(0);
  if (fields.has("depth_from") || (!fields.reading() && !record.depth_from.empty()))
    fields.value("depth_from", record.depth_from, "whose depth it took in place of the dataset's");
  if (fields.has("from") || (!fields.reading() && !record.from.empty()))
    fields.value("from", record.from, "run that was refined");
  if (fields.has("external") || (!fields.reading() && record.external))
    fields.section("external", record.external, "program of somebody else");
  if (fields.has("class") || (!fields.reading() && record.method_class))
    fields.section("class", record.method_class,
                   "what it was given, with that of the runs above, and how far it looks ahead");
  if (fields.has("contrast") || (!fields.reading() && record.contrast))
    fields.section("contrast", record.contrast,
                   "contrast thresholds that were found, as nobody stated them [log units]");
  fields.section("window", record.window, "part of the dataset [s]; ~ is the whole");
  fields.value("seed", record.seed, "of every random number");
  fields.value("threads", record.threads, "it ran on; 0 is not stated").at_least(0);
  fields.value("tool_version", record.tool_version, "that wrote this folder");
  fields.value("command", record.command, "command line");
  fields.value("machine", record.machine, "it ran on");
  if (fields.has("config") || (!fields.reading() && !record.config_yaml.empty()))
    fields.embed("config", record.config_yaml, "resolved configuration");
}

std::string RunRecord::problem() const {
  if (!external || external->status == "ok") return {};
  return external->status + ": " + external->reason;
}

std::string RunRecord::version() const { return tool_version.substr(0, tool_version.find(" (")); }

std::string RunRecord::commit() const {
  const std::size_t open = tool_version.find(" (");
  if (open == std::string::npos || !tool_version.ends_with(')')) return {};
  return tool_version.substr(open + 2, tool_version.size() - open - 3);
}

RunRecord read_run_record(const std::filesystem::path& file) {
  return config::read<RunRecord>(config::load(file));
}

void write_run_record(const std::filesystem::path& file, const RunRecord& record) {
  write_atomically(file, config::print(record));
}

}  // namespace saccade

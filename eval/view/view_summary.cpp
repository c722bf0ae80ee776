#include "eval/view/view_summary.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/io/run/path_so_far.h"
#include "eval/picture/view/view_pictures.h"
#include "eval/report/charts/curve_points.h"

namespace saccade {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

constexpr std::size_t kMostPoses = 2000;

/// Names may be any bytes that a file system takes.
std::string dump(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// Times and ids of the entries that `is_there`.
template <class Entry, class IsThere>
Json pictures(const std::vector<Entry>& all, std::size_t most, const IsThere& is_there) {
  std::vector<std::size_t> ids;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (is_there(all[i])) ids.push_back(i);
  Json t = Json::array(), id = Json::array();
  for (const std::size_t i : evenly_spaced_indices(ids.size(), most)) {
    t.push_back(tenth_ms(all[ids[i]].t_s));
    id.push_back(ids[i]);
  }
  return {{"t", t}, {"id", id}, {"count", ids.size()}};
}

void set_pictures(Json& json, const char* name, const Json& list) {
  if (list["count"] > 0) json[name] = list;
}

Json recording_json(const ViewRecording& recording, std::size_t most) {
  const Dataset& data = recording.dataset;
  const PinholeCamera& c = data.camera();
  const ViewSpan span = view_span(recording);
  Json json{{"name", data.facts().name},
            {"folder", recording.folder.string()},
            {"width", c.width},
            {"height", c.height},
            {"camera", {c.fx, c.fy, c.cx, c.cy}},
            {"start_us", span.start_us},
            {"end_us", span.end_us},
            {"truth", !data.groundtruth().empty()}};
  if (recording.events) {
    json["events"] = recording.events->info().count;
    json["slot_us"] = slot_us(recording);
  }
  const auto is_there = [](const StampedFile& entry) { return fs::exists(entry.file); };
  set_pictures(json, "frames", pictures(data.frames(), most, is_there));
  set_pictures(json, "depth", pictures(data.depth_maps(), most, is_there));
  if (recording.depth_range && json.contains("depth")) {
    json["depth"]["near"] = five_digits(recording.depth_range->near_m);
    json["depth"]["far"] = five_digits(recording.depth_range->far_m);
  }
  return json;
}

Json run_json(const ViewRun& run, std::size_t most) {
  Json json{{"name", run.name},
            {"folder", run.run.folder.string()},
            {"module", run.run.record.module},
            {"poses", run.run.trajectory ? run.run.trajectory->size() : 0},
            {"is_aligned", run.is_aligned}};
  if (run.recording) json["recording"] = *run.recording;
  if (const std::string problem = run.run.record.problem(); !problem.empty())
    json["problem"] = problem;
  const auto is_there = [](const fs::path& file) { return !file.empty() && fs::exists(file); };
  if (run.recording)
    set_pictures(json, "depth", pictures(run.views, most, [&](const RunView& view) {
                   return is_there(view.depth);
                 }));
  set_pictures(json, "image", pictures(run.views, most, [&](const RunView& view) {
                 return is_there(view.image);
               }));
  return json;
}

std::size_t count_files(const fs::path& folder, const char* extension) {
  std::error_code error;
  std::size_t count = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
    if (entry.path().extension() == extension) ++count;
  return count;
}

/// What is visible of a folder while it grows.
Json unfinished_json(const ViewUnfinished& unfinished) {
  const fs::path content =
      fs::exists(unfinished.hidden / "content") ? unfinished.hidden / "content" : unfinished.hidden;
  std::error_code error;
  std::uintmax_t bytes = 0;
  for (const fs::directory_entry& entry :
       fs::recursive_directory_iterator(unfinished.hidden, error)) {
    std::error_code gone;
    const std::uintmax_t size = entry.is_regular_file(gone) ? entry.file_size(gone) : 0;
    if (!gone) bytes += size;
  }
  Json json{{"name", unfinished.folder.string()},
            {"frames", unfinished.frames()},
            {"depth_maps", count_files(content / "depth", ".exr")},
            {"mb", std::round(static_cast<double>(bytes) / 1e4) / 100}};
  if (unfinished.recording) {
    json["recording"] = *unfinished.recording;
    if (const auto shown = read_path_so_far(unfinished.hidden))
      json["path_s"] = shown->path.end_s();
  }
  if (!unfinished.events) return json;
  unfinished.events->refresh();
  if (const auto reached_us = unfinished.events->reached_us()) {
    const SensorSize size = unfinished.events->size();
    json["reached_us"] = *reached_us;
    json["width"] = size.width;
    json["height"] = size.height;
  }
  return json;
}

double rounded(double value, double unit) { return std::round(value / unit) * unit; }

}  // namespace

ViewSpan view_span(const ViewRecording& recording) {
  if (recording.events) {
    const EventFileInfo info = recording.events->info();
    if (info.count > 0) return {info.first_ns / kNsPerUs, info.last_ns / kNsPerUs + 1};
  }
  double first_s = std::numeric_limits<double>::infinity(), last_s = -first_s;
  const auto take = [&](double from_s, double to_s) {
    first_s = std::min(first_s, from_s);
    last_s = std::max(last_s, to_s);
  };
  const Dataset& data = recording.dataset;
  if (!data.groundtruth().empty()) take(data.groundtruth().start_s(), data.groundtruth().end_s());
  if (!data.frames().empty()) take(data.frames().front().t_s, data.frames().back().t_s);
  if (first_s > last_s) return {0, 1};
  return {std::llround(1e6 * first_s), std::llround(1e6 * last_s) + 1};
}

std::int64_t slot_us(const ViewRecording& recording) {
  constexpr std::int64_t kMs = 1000, kLongest = 1000 * kMs;
  const ViewSpan span = view_span(recording);
  const std::uint64_t count = recording.events ? recording.events->info().count : 0;
  const double slots =
      std::max(1.0, static_cast<double>(count) / static_cast<double>(kEventsOfSlot));
  const double length = static_cast<double>(span.end_us - span.start_us) / slots;
  return std::clamp(std::llround(length / kMs) * kMs, 1LL * kMs, 1LL * kLongest);
}

std::string view_summary(const ViewContent& content, std::size_t most_pictures) {
  Json recordings = Json::array(), runs = Json::array(), unfinished = Json::array();
  for (const auto& recording : content.recordings)
    recordings.push_back(recording_json(*recording, most_pictures));
  for (const ViewRun& run : content.runs) runs.push_back(run_json(run, most_pictures));
  for (const ViewUnfinished& folder : content.unfinished)
    unfinished.push_back(unfinished_json(folder));
  return dump({{"recordings", recordings}, {"runs", runs}, {"unfinished", unfinished}});
}

std::string path_json(const Trajectory& path) {
  Json t = Json::array(), p = Json::array();
  for (const std::size_t i : evenly_spaced_indices(path.size(), kMostPoses)) {
    const StampedPose& pose = path.poses()[i];
    const Eigen::Vector3d& at = pose.world_from_camera.translation();
    const Eigen::Quaterniond& q = pose.world_from_camera.rotation();
    t.push_back(tenth_ms(pose.t_s));
    Json row = Json::array();
    for (const double metres : {at.x(), at.y(), at.z()}) row.push_back(rounded(metres, 1e-6));
    for (const double part : {q.x(), q.y(), q.z(), q.w()}) row.push_back(rounded(part, 1e-6));
    p.push_back(std::move(row));
  }
  return dump({{"t", t}, {"p", p}});
}

std::string event_rate_json(const ViewRecording& recording, int bins) {
  Json counts = Json::array();
  const ViewSpan span = view_span(recording);
  const std::int64_t length = span.end_us - span.start_us;
  for (int i = 0; recording.events && i < bins; ++i) {
    const auto edge = [&](int bin) { return (span.start_us + length * bin / bins) * kNsPerUs; };
    counts.push_back(recording.events->count({edge(i), edge(i + 1)}));
  }
  return dump(counts);
}

}  // namespace saccade
